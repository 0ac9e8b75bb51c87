//! The transfer function as the shaders read it (`transfer.wgsl`): exact, not resampled.

use bytemuck::{Pod, Zeroable};

use crate::error::RenderError;
use crate::gpu::{Buffer, Gpu};
use crate::transfer::{ControlPoint, TransferFunction};

/// `Node` of `transfer.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct Node {
    pub value: [f32; 4],
    pub change: [f32; 4],
    pub u: f32,
    pub inverse_width: f32,
    pub padding: [f32; 2],
}

/// `BUCKETS` of `transfer.wgsl`.
const BUCKETS: usize = 256;

/// Nodes of the transfer function, and the node at the start of each of 256 parts of [0, 1].
pub(crate) struct TransferTables {
    pub nodes: Buffer,
    pub buckets: Buffer,
}

impl TransferTables {
    pub(crate) fn new(gpu: &Gpu) -> TransferTables {
        TransferTables {
            nodes: Buffer::storage(gpu, "transfer nodes", size_of::<Node>() as u64),
            buckets: Buffer::storage(gpu, "transfer buckets", 4),
        }
    }

    pub(crate) fn write(&mut self, gpu: &Gpu, transfer: &TransferFunction) -> Result<(), RenderError> {
        let nodes = nodes(transfer);
        self.buckets.write(gpu, &buckets(&nodes))?;
        self.nodes.write(gpu, &nodes)?;
        Ok(())
    }
}

/// Control points, continued to u = 0 and to one node beyond u = 1.
fn nodes(transfer: &TransferFunction) -> Vec<Node> {
    let points = transfer.points();
    let first = ControlPoint { u: 0.0, ..points[0] };
    let last = ControlPoint { u: 2.0, ..points[points.len() - 1] };
    let all: Vec<ControlPoint> = [first].into_iter().chain(points.iter().copied()).chain([last]).collect();
    let value = |p: &ControlPoint| [p.rgb[0], p.rgb[1], p.rgb[2], p.opacity];
    let end = Node { u: 2.0, value: value(&last), ..Node::zeroed() };
    all.windows(2)
        .map(|pair| {
            let (a, b) = (value(&pair[0]), value(&pair[1]));
            let width = pair[1].u - pair[0].u;
            let inverse_width = if width > 0.0 { 1.0 / width } else { 0.0 };
            let change = std::array::from_fn(|c| b[c] - a[c]);
            Node {
                value: a,
                change,
                u: pair[0].u,
                inverse_width: inverse_width.min(f32::MAX),
                ..Node::zeroed()
            }
        })
        .chain([end])
        .collect()
}

/// Last node at or before the start of each part, with one part more for u = 1 itself.
fn buckets(nodes: &[Node]) -> Vec<u32> {
    (0..=BUCKETS)
        .map(|bucket| {
            let u = bucket as f32 / BUCKETS as f32;
            nodes.partition_point(|node| node.u <= u) as u32 - 1
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shader's lookup, line by line.
    fn lookup(nodes: &[Node], buckets: &[u32], u: f32) -> [f32; 4] {
        let mut node = buckets[(u * BUCKETS as f32) as usize] as usize;
        while nodes[node + 1].u <= u {
            node += 1;
        }
        let left = nodes[node];
        std::array::from_fn(|c| left.value[c] + (u - left.u) * left.inverse_width * left.change[c])
    }

    #[test]
    fn tables_hold_the_function_itself() {
        let point = |u, v: f32| ControlPoint { u, rgb: [v, 1.0 - v, 0.5 * v], opacity: v };
        let shapes: [&[ControlPoint]; 4] = [
            &[point(0.3, 0.7)],
            &[point(0.0, 0.1), point(1.0, 0.9)],
            &[point(0.5, 0.0), point(0.5, 1.0), point(0.5001, 0.2)],
            &[point(1.0, 0.2), point(1.0, 0.8), point(0.0, 0.3), point(0.0, 0.6)],
        ];
        for points in shapes {
            let transfer = TransferFunction::new(points).unwrap();
            let nodes = nodes(&transfer);
            let buckets = buckets(&nodes);
            for i in 0..=4096 {
                let u = i as f32 / 4096.0;
                let (a, b) = (lookup(&nodes, &buckets, u), transfer.sample(u));
                assert!(a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-5), "u = {u}: {a:?} and {b:?}");
            }
        }
    }
}
