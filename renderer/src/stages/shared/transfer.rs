//! The transfer function as the shaders read it (`transfer.wgsl`): exact, not resampled.

use bytemuck::{Pod, Zeroable};

use crate::error::RenderError;
use crate::gpu::{Buffer, Entry, Gpu};
use crate::transfer::{ControlPoint, TransferFunction};

/// The first three texels of a row of the node texture (`transfer.wgsl`).
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct Node {
    /// Colour and opacity at `u`.
    value: [f32; 4],
    /// Their change up to the next node.
    change: [f32; 4],
    u: f32,
    /// 1/(u of the next node − u); 0 at a step.
    inverse_width: f32,
    next_u: f32,
    padding: f32,
}

/// Four channels of colour and opacity.
type Texel = [f32; 4];

/// `BUCKETS` of `transfer.wgsl`.
const BUCKETS: usize = 256;

/// Nodes of the transfer function, and the node at the start of each of 256 parts of [0, 1].
pub(crate) struct TransferTables {
    pub nodes: wgpu::TextureView,
    entry: Option<Entry>,
    pub buckets: Buffer,
    /// The function that they hold.
    held: Option<TransferFunction>,
}

impl TransferTables {
    pub(crate) fn new(gpu: &Gpu) -> TransferTables {
        TransferTables {
            nodes: node_texture(gpu, [1, 1]).create_view(&Default::default()),
            entry: None,
            buckets: Buffer::storage(gpu, "transfer buckets", 4),
            held: None,
        }
    }

    /// Brings the function to the device where it is not there yet.
    pub(crate) fn write(&mut self, gpu: &Gpu, transfer: &TransferFunction) -> Result<(), RenderError> {
        if self.held.as_ref() == Some(transfer) {
            return Ok(());
        }
        self.held = None;
        let nodes = nodes(transfer);
        self.buckets.write(gpu, &buckets(&nodes))?;
        let texels = texels(&nodes);
        let width = (texels.len() / nodes.len()) as u32;
        let texture = node_texture(gpu, [width, nodes.len() as u32]);
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(width * size_of::<Texel>() as u32),
            rows_per_image: None,
        };
        gpu.queue.write_texture(
            texture.as_image_copy(),
            bytemuck::cast_slice(&texels),
            layout,
            texture.size(),
        );
        self.nodes = texture.create_view(&Default::default());
        self.entry = Some(gpu.ledger.enter(size_of_val(&texels[..]) as u64));
        // A texture that could not be had is not to be kept.
        gpu.check()?;
        self.held = Some(transfer.clone());
        Ok(())
    }
}

fn node_texture(gpu: &Gpu, [width, height]: [u32; 2]) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("transfer nodes"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Rows of the node texture: the node itself, then least and greatest value and greatest steepness of runs
/// of 1, 2, 4, ... nodes from it on, which end at the last node at the latest.
fn texels(nodes: &[Node]) -> Vec<Texel> {
    let values: Vec<Texel> = nodes.iter().map(|node| node.value).collect();
    let steepness = nodes.iter().map(Node::steepness).collect();
    let mut runs = vec![[values.clone(), values, steepness]];
    while 2 << (runs.len() - 1) <= nodes.len() {
        let half = 1 << (runs.len() - 1);
        let [least, greatest, steepest] = &runs[runs.len() - 1];
        let greater = |runs: &[Texel]| doubled(runs, half, f32::max);
        runs.push([doubled(least, half, f32::min), greater(greatest), greater(steepest)]);
    }
    let row = |(i, node): (usize, &Node)| {
        let own: [Texel; 3] = bytemuck::cast(*node);
        let runs = runs.iter().flat_map(move |run| [run[0][i], run[1][i], run[2][i]]);
        own.into_iter().chain(runs).collect::<Vec<_>>()
    };
    nodes.iter().enumerate().flat_map(row).collect()
}

impl Node {
    /// By how much each channel changes up to the next node, by u: beyond all bounds at a step.
    fn steepness(&self) -> Texel {
        let is_step = self.next_u <= self.u && self.u <= 1.0;
        self.change.map(|change| match change.abs() {
            0.0 => 0.0,
            _ if is_step => STEP,
            change => (change * self.inverse_width).min(STEP),
        })
    }
}

/// Steeper than anything that a slope could follow.
const STEP: f32 = 1e30;

/// Extremes of runs of twice the length, from those of runs of length `half`.
fn doubled(runs: &[Texel], half: usize, extreme: fn(f32, f32) -> f32) -> Vec<Texel> {
    let later = |i: usize| runs[(i + half).min(runs.len() - 1)];
    (0..runs.len()).map(|i| std::array::from_fn(|c| extreme(runs[i][c], later(i)[c]))).collect()
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
                next_u: pair[1].u,
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
        while nodes[node].next_u <= u {
            node += 1;
        }
        let left = nodes[node];
        std::array::from_fn(|c| left.value[c] + (u - left.u) * left.inverse_width * left.change[c])
    }

    #[test]
    fn runs_hold_their_extremes() {
        let points: Vec<ControlPoint> = (0..13)
            .map(|i| ControlPoint { u: i as f32 / 12.0, rgb: [(i * 7 % 13) as f32 / 13.0; 3], opacity: 0.5 })
            .collect();
        let nodes = nodes(&TransferFunction::new(&points).unwrap());
        let texels = texels(&nodes);
        let width = texels.len() / nodes.len();
        assert_eq!(width, 3 + 3 * 4, "15 or 16 nodes have runs of 1, 2, 4 and 8");
        for (i, level) in (0..nodes.len()).flat_map(|i| (0..4).map(move |level| (i, level))) {
            let run = nodes[i..].iter().take(1 << level).map(|node| node.value[0]);
            let expected = run.fold([1.0_f32, 0.0], |[a, b], v| [a.min(v), b.max(v)]);
            let found = [0, 1].map(|end| texels[i * width + 3 + 3 * level + end][0]);
            assert_eq!(found, expected, "run of {} from {i}", 1 << level);
            let steepest =
                nodes[i..].iter().take(1 << level).map(|node| node.steepness()[0]).fold(0.0, f32::max);
            assert_eq!(texels[i * width + 5 + 3 * level][0], steepest, "run of {} from {i}", 1 << level);
        }
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
