//! The grid's counting sort against a radix sort of pairs, on the same references.
//!
//! The paper (HPG 2016, Sec. 6.1) writes a pair of cell and particle for every reference and sorts
//! the pairs by cell. The grid stage counts the references of every cell instead and writes each
//! one to its place. Both find the same cells for the same particles, by the same code; both must
//! end with the same particles in every cell.
//!
//!     cargo bench -p renderer --bench grid_sort -- [N] [WIDTHxHEIGHT]
//!
//! sorts about N particles (100,000) for a picture of that size (512x512). The two take turns, and
//! every number is a median over the rounds. Left out on both sides: zeroing the buffers of the
//! cells, which are twice as large for the sort of pairs, and reading back the number of pairs.

mod lattice;
mod pair_sort;

use std::error::Error;

use pair_sort::PairSort;
use rayon::prelude::*;
use renderer::bench::{self, Clock, Inputs, Sorted};
use renderer::{Gpu, GpuOptions, RenderError};

/// Milliseconds of each step, in order; a step may come more than once.
type Steps = Vec<(&'static str, f64)>;

/// A reference of a cell to a particle.
type Reference = (u32, u32);

const ROUNDS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let (particles, size) = arguments()?;
    let scene = lattice::scene(particles, size);
    let Sorted { gpu, mut clock, inputs, mut grid } = Sorted::new(Gpu::new(&GpuOptions::default())?, &scene)?;
    let mut pair_sort = PairSort::new(&gpu, &inputs)?;

    // The grid has sorted once already, which is when some drivers compile.
    pair_sort.run(&gpu, &mut clock, &inputs)?;
    let (mut counting, mut sorting) = (Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        counting.push(counting_sort(&gpu, &mut clock, &inputs, &mut grid)?);
        sorting.push(pair_sort.run(&gpu, &mut clock, &inputs)?);
    }
    check(counted(&gpu, &inputs, &grid)?, sorted(&gpu, &inputs, &pair_sort)?);

    let Inputs { store, cells, filled, pairs, .. } = &inputs;
    let (name, digits, [width, height]) = (gpu.adapter_name(), pair_sort.digits(), size);
    println!("{name}: {} particles, {width}x{height}, {ROUNDS} rounds", store.count());
    println!("{pairs} pairs, {filled} of {cells} cells, {digits} digits of 4 bits");
    report("counting sort", &counting, grid.cells.bytes() + grid.pairs.bytes());
    report("sort of pairs", &sorting, pair_sort.bytes());
    let ratios: Vec<f64> = counting.iter().zip(&sorting).map(|(a, b)| total(b) / total(a)).collect();
    let [low, middle, high] = [0.0, 0.5, 1.0].map(|share| quantile(&ratios, share));
    println!("sort of pairs / counting sort: {middle:.2} ({low:.2} to {high:.2})");
    Ok(())
}

fn arguments() -> Result<(u64, [u32; 2]), Box<dyn Error>> {
    // Cargo adds a flag of its own.
    let mut given = std::env::args().skip(1).filter(|argument| argument != "--bench");
    let particles = given.next().map_or(Ok(100_000), |n| n.replace('_', "").parse())?;
    let size = given.next().unwrap_or_else(|| "512x512".to_owned());
    let (width, height) = size.split_once('x').ok_or("the size is not WIDTHxHEIGHT")?;
    Ok((particles, [width.parse()?, height.parse()?]))
}

/// The grid stage, step by step.
fn counting_sort(
    gpu: &Gpu,
    clock: &mut Clock,
    inputs: &Inputs,
    grid: &mut bench::Grid,
) -> Result<Steps, RenderError> {
    let uniforms = [&inputs.frame, &inputs.tile];
    bench::clear(gpu, &[&grid.cells, &grid.totals])?;
    let count = clock.pass(gpu, |pass| {
        grid.count(gpu, pass, uniforms, &inputs.store);
        Ok(())
    })?;
    let scan = clock.pass(gpu, |pass| grid.scan(gpu, pass, inputs.cells))?;
    let scatter = clock.pass(gpu, |pass| {
        grid.scatter(gpu, pass, uniforms, &inputs.store);
        Ok(())
    })?;
    Ok(vec![("count", count), ("scan", scan), ("scatter", scatter)])
}

/// All references that the counting sort left, cell by cell.
fn counted(gpu: &Gpu, inputs: &Inputs, grid: &bench::Grid) -> Result<Vec<Reference>, RenderError> {
    let ends: Vec<u32> = bench::read(gpu, &grid.cells, inputs.cells)?;
    let particles: Vec<u32> = bench::read(gpu, &grid.pairs, inputs.pairs)?;
    let begins = std::iter::once(0).chain(ends.iter().copied());
    Ok(references(begins.zip(ends.iter().copied()), &particles))
}

/// All references that the sort of pairs left, cell by cell.
fn sorted(gpu: &Gpu, inputs: &Inputs, pair_sort: &PairSort) -> Result<Vec<Reference>, RenderError> {
    let bounds: Vec<[u32; 2]> = bench::read(gpu, pair_sort.bounds(), inputs.cells)?;
    let particles: Vec<u32> = bench::read(gpu, pair_sort.particles(), inputs.pairs)?;
    Ok(references(bounds.into_iter().map(Into::into), &particles))
}

fn references(bounds: impl Iterator<Item = (u32, u32)>, particles: &[u32]) -> Vec<Reference> {
    bounds
        .enumerate()
        .flat_map(|(cell, (begin, end))| {
            particles[begin as usize..end as usize].iter().map(move |&particle| (cell as u32, particle))
        })
        .collect()
}

/// Panics unless both sorts found the same references, and unless one wrong reference is noticed.
fn check(mut counted: Vec<Reference>, mut sorted: Vec<Reference>) {
    counted.par_sort_unstable();
    sorted.par_sort_unstable();
    assert!(counted.windows(2).all(|two| two[0] != two[1]), "a reference comes twice");
    assert_eq!(counted.len(), sorted.len(), "numbers of references");
    assert_eq!(difference(&counted, &sorted), None, "references");
    let middle = sorted.len() / 2;
    sorted[middle].1 ^= 1;
    assert!(difference(&counted, &sorted).is_some(), "a wrong reference passes the check");
}

/// The first pair of references that differ.
fn difference(a: &[Reference], b: &[Reference]) -> Option<(Reference, Reference)> {
    a.iter().copied().zip(b.iter().copied()).find(|(a, b)| a != b)
}

/// Prints the median of each step's time over the rounds, and of their sum.
fn report(name: &str, rounds: &[Steps], bytes: u64) {
    let mut labels = Vec::new();
    for &(label, _) in &rounds[0] {
        if !labels.contains(&label) {
            labels.push(label);
        }
    }
    let median = |time: &dyn Fn(&Steps) -> f64| quantile(&rounds.iter().map(time).collect::<Vec<_>>(), 0.5);
    println!("{name}: {:.1} ms, {:.1} MiB", median(&total), bytes as f64 / f64::from(1 << 20));
    for label in labels {
        let of_label = |steps: &Steps| steps.iter().filter(|step| step.0 == label).map(|step| step.1).sum();
        println!("    {label:<12} {:9.1} ms", median(&of_label));
    }
}

fn total(steps: &Steps) -> f64 {
    steps.iter().map(|(_, time)| time).sum()
}

fn quantile(values: &[f64], share: f64) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    values[(share * (values.len() - 1) as f64).round() as usize]
}
