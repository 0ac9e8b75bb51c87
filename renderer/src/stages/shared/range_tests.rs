//! `transfer_range` of `transfer.wgsl`, on the device: it holds the transfer function over an interval,
//! and hardly more.

use super::{TRANSFER_WGSL, TransferTables};
use crate::gpu::{Access, Buffer, Gpu, GpuOptions, Pipeline, PipelineDescription};
use crate::transfer::{ControlPoint, TransferFunction};

const FIND_RANGES_WGSL: &str = "
@group(0) @binding(0) var<storage, read> buckets: array<u32>;
@group(0) @binding(1) var nodes: texture_2d<f32>;
@group(0) @binding(2) var<storage, read> intervals: array<vec2<f32>>;
@group(0) @binding(3) var<storage, read_write> ranges: array<Extremes>;

@compute @workgroup_size(1)
fn find_ranges(@builtin(workgroup_id) workgroup: vec3<u32>) {
    let interval = intervals[workgroup.x];
    ranges[workgroup.x] = transfer_range(interval.x, interval.y);
}
";

type Range = [[f32; 4]; 2];

/// Least and greatest colour and opacity over each interval, as the device finds them.
fn ranges(gpu: &Gpu, transfer: &TransferFunction, intervals: &[[f32; 2]]) -> Vec<Range> {
    let mut tables = TransferTables::new(gpu);
    tables.write(gpu, transfer).unwrap();
    let mut inputs = Buffer::storage(gpu, "intervals", 8);
    inputs.write(gpu, intervals).unwrap();
    let mut outputs = Buffer::storage(gpu, "ranges", 32);
    outputs.reserve(gpu, intervals.len() as u64).unwrap();
    let pipeline = Pipeline::new(
        gpu,
        &PipelineDescription {
            label: "find_ranges",
            sources: &[TRANSFER_WGSL, FIND_RANGES_WGSL],
            entry_point: "find_ranges",
            constants: &[],
            bindings: &[Access::Read, Access::Texture, Access::Read, Access::Write],
        },
    );
    let nodes = wgpu::BindingResource::TextureView(&tables.nodes);
    let resources = [tables.buckets.binding(), nodes, inputs.binding(), outputs.binding()];
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pipeline.dispatch(gpu, &mut pass, &resources, intervals.len() as u64);
    drop(pass);
    let found = outputs.read_back(gpu, &mut encoder, intervals.len() as u64);
    gpu.queue.submit([encoder.finish()]);
    found.take(gpu).unwrap()
}

/// Numbers in [0, 1) from a seed: the same on every machine.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 24) as f32
    }

    fn point(&mut self, u: f32) -> ControlPoint {
        let opacity = match self.unit() {
            share if share < 0.2 => 0.0,
            share if share > 0.8 => 1.0,
            share => share,
        };
        ControlPoint { u, rgb: std::array::from_fn(|_| self.unit()), opacity }
    }

    /// Ramps, steps, and spikes far thinner than a 256th.
    fn transfer(&mut self, count: usize) -> TransferFunction {
        let mut points = Vec::new();
        while points.len() < count {
            let u = self.unit();
            match (3.0 * self.unit()) as u32 {
                0 => points.push(self.point(u)),
                1 => points.extend([self.point(u), self.point(u)]),
                _ => {
                    let width = 1e-4 * self.unit();
                    points.extend([u - width, u, u + width].map(|u| self.point(u.clamp(0.0, 1.0))));
                }
            }
        }
        TransferFunction::new(&points).unwrap()
    }

    /// Long and short intervals, and such as end at or next to a control point.
    fn interval(&mut self, transfer: &TransferFunction) -> [f32; 2] {
        let points = transfer.points();
        let node = points[(self.unit() * points.len() as f32) as usize].u;
        let low = [self.unit(), node, node.next_up(), node.next_down()][(4.0 * self.unit()) as usize];
        let width = [1.0, 0.1, 1e-3, 1e-6, 0.0][(5.0 * self.unit()) as usize] * self.unit();
        let low = low.clamp(0.0, 1.0);
        [low, (low + width).min(1.0)]
    }
}

/// The function itself, in f64: the last of the points that share a u holds there.
fn value(points: &[ControlPoint], u: f64) -> [f64; 4] {
    let channels = |point: &ControlPoint| {
        let ControlPoint { rgb: [r, g, b], opacity, .. } = *point;
        [r, g, b, opacity].map(f64::from)
    };
    let above = points.partition_point(|point| f64::from(point.u) <= u);
    let (a, b) = (&points[above.saturating_sub(1)], &points[above.min(points.len() - 1)]);
    let share = match above == 0 || above == points.len() {
        true => 0.0,
        false => (u - f64::from(a.u)) / f64::from(b.u - a.u),
    };
    let (a, b) = (channels(a), channels(b));
    std::array::from_fn(|c| a[c] + share * (b[c] - a[c]))
}

/// Least and greatest value of each channel at 1000 places of an interval, at its control points and just
/// before them.
fn true_range(points: &[ControlPoint], [low, high]: [f32; 2]) -> [[f64; 2]; 4] {
    let (low, high) = (f64::from(low), f64::from(high));
    let nodes = points.iter().map(|point| f64::from(point.u)).flat_map(|u| [u.next_down(), u]);
    let places = (0..=1000).map(|i| low + (high - low) * f64::from(i) / 1000.0);
    let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
    for u in places.chain(nodes.filter(|u| (low..=high).contains(u))) {
        for (range, value) in range.iter_mut().zip(value(points, u)) {
            *range = [range[0].min(value), range[1].max(value)];
        }
    }
    range
}

/// What the rounding of a number near 1 may be.
const ULP: f64 = 1.2e-7;

#[test]
fn a_range_holds_the_function_over_its_interval_and_hardly_more() {
    let gpu = Gpu::new(&GpuOptions::default()).expect("an adapter");
    let mut random = Random(1);
    for count in [1, 2, 3, 5, 8, 13, 40, 300, 4000] {
        let transfer = random.transfer(count);
        let intervals: Vec<[f32; 2]> = (0..100).map(|_| random.interval(&transfer)).collect();
        for (interval, found) in intervals.iter().zip(ranges(&gpu, &transfer, &intervals)) {
            let truth = true_range(transfer.points(), *interval);
            for (channel, [least, greatest]) in truth.into_iter().enumerate() {
                let [low, high] = found.map(|end| f64::from(end[channel]));
                let what = format!("{count} points, {interval:?}, channel {channel}: [{low}, {high}]");
                assert!(low <= least + ULP && high >= greatest - ULP, "{what} does not hold {truth:?}");
                let near =
                    low >= least * (1.0 - 1e-5) - 2.0 * ULP && high <= greatest * (1.0 + 1e-5) + 2.0 * ULP;
                assert!(near, "{what} is wider than {truth:?}");
            }
        }
    }
}
