//! `transfer.wgsl`, on the device: what it looks up is the transfer function, and its ranges hold that over an interval,
//! and hardly more.

use bytemuck::Pod;

use super::{TRANSFER_WGSL, TransferTables};
use crate::gpu::{Access, Gpu, GpuOptions};
use crate::random::Random;
use crate::stages::found::Function;
use crate::transfer::{ControlPoint, TransferFunction};

/// What the device makes of each input: `call` in WGSL, from the first type to the other one.
fn found<I: Pod, O: Pod>(
    gpu: &Gpu,
    transfer: &TransferFunction,
    inputs: &[I],
    types: [&str; 2],
    call: &str,
) -> Vec<O> {
    let mut tables = TransferTables::new(gpu);
    tables.write(gpu, transfer).unwrap();
    let declared = "
        @group(0) @binding(2) var<storage, read> buckets: array<u32>;
        @group(0) @binding(3) var nodes: texture_2d<f32>;
    ";
    let nodes = wgpu::BindingResource::TextureView(&tables.nodes);
    let resources = &[(Access::Read, tables.buckets.binding()), (Access::Texture, nodes)];
    Function { sources: &[declared, TRANSFER_WGSL], resources, types, call }.of(gpu, inputs)
}

type Range = [[f32; 4]; 2];

/// Least and greatest colour and opacity over each interval.
fn ranges(gpu: &Gpu, transfer: &TransferFunction, intervals: &[[f32; 2]]) -> Vec<Range> {
    found(gpu, transfer, intervals, ["vec2<f32>", "Extremes"], "transfer_range(given.x, given.y)")
}

/// Colours and opacities at those of four places that are not negative.
fn shades(gpu: &Gpu, transfer: &TransferFunction, places: &[[f32; 4]]) -> Vec<[[f32; 4]; 4]> {
    let at_four = "transfer_at_four(given, !(given < vec4(0.0)))";
    found(gpu, transfer, places, ["vec4<f32>", "mat4x4<f32>"], at_four)
}

impl Random {
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

#[test]
fn four_looked_up_at_once_are_each_the_function_itself() {
    let gpu = Gpu::new(&GpuOptions::default()).expect("an adapter");
    let mut random = Random(2);
    for count in [1, 2, 3, 8, 40, 4000] {
        let transfer = random.transfer(count);
        let places: Vec<[f32; 4]> = (0..100)
            .map(|_| {
                // Two in one segment, mostly, one anywhere, and one that is not wanted, in any order.
                let [low, high] = random.interval(&transfer);
                let mut four = [low, high, random.unit(), -1.0];
                four.rotate_left((4.0 * random.unit()) as usize);
                four
            })
            .collect();
        for (places, found) in places.iter().zip(shades(&gpu, &transfer, &places)) {
            for (u, found) in places.iter().zip(found) {
                let truth = match *u < 0.0 {
                    true => [0.0; 4],
                    false => value(transfer.points(), f64::from(*u)),
                };
                let far =
                    found.iter().zip(truth).any(|(found, truth)| (f64::from(*found) - truth).abs() > 4e-6);
                assert!(!far, "{count} points, {u} of {places:?}: {found:?} instead of {truth:?}");
            }
        }
    }
}

#[test]
fn what_is_no_number_ends_a_look_up_and_leaves_the_others_alone() {
    let gpu = Gpu::new(&GpuOptions::default()).expect("an adapter");
    let transfer = Random(3).transfer(8);
    let [found] = shades(&gpu, &transfer, &[[0.25, f32::NAN, 0.5, f32::NAN]])[..] else {
        panic!("one input")
    };
    for (u, found) in [(0.25, found[0]), (0.5, found[2])] {
        for (found, truth) in found.iter().zip(value(transfer.points(), u)) {
            assert!((f64::from(*found) - truth).abs() < 4e-6, "{found} instead of {truth} at {u}");
        }
    }
}
