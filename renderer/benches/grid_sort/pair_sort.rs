//! The paper's way (HPG 2016, Sec. 6.1): pairs of cell and particle, sorted by cell.

use bytemuck::{Pod, Zeroable};
use renderer::bench::{Access, Buffer, Clock, Inputs, Pipeline, PipelineDescription, Scan};
use renderer::{Gpu, RenderError};
use wgpu::BindingResource;

use crate::Steps;

/// Threads of a workgroup, and pairs that it reorders (`GROUP` and `BLOCK` of `pair_sort.wgsl`).
const GROUP: u64 = 256;
const BLOCK: u64 = 2048;
/// Values of a digit, and its bits.
const RADIX: u64 = 16;
const DIGIT_BITS: usize = 4;

/// `Sort` of `pair_sort.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Sort {
    pairs: u32,
    blocks: u32,
    shift: u32,
    padding: u32,
}

pub struct PairSort {
    count: Pipeline,
    write: Pipeline,
    histogram: Pipeline,
    reorder: Pipeline,
    find_cells: Pipeline,
    // A scan serves one length: of threads that make pairs, of blocks that are reordered.
    thread_scan: Scan,
    digit_scan: Scan,
    buffers: Buffers,
}

struct Buffers {
    /// One for each digit of the keys.
    sorts: Vec<Buffer>,
    places: Buffer,
    digits: Buffer,
    /// The pairs, and where the next pass puts them.
    keys: [Buffer; 2],
    particles: [Buffer; 2],
    bounds: Buffer,
    totals: Buffer,
}

impl PairSort {
    /// With room for `inputs`, whose number of pairs is known, as from a frame before.
    pub fn new(gpu: &Gpu, inputs: &Inputs) -> Result<PairSort, RenderError> {
        use Access::{Read, Uniform, Write};
        let frame = include_str!("../../src/stages/shared/frame.wgsl");
        let grid = include_str!("../../src/stages/grid.wgsl");
        let pipeline = |sources: &[&str], label, bindings: &[Access]| {
            let description =
                PipelineDescription { label, sources, entry_point: label, constants: &[], bindings };
            Pipeline::new(gpu, &description)
        };
        let making = |entry_point| {
            let bindings = [Uniform, Uniform, Read, Write, Write, Write];
            pipeline(&[frame, grid, include_str!("pairs.wgsl")], entry_point, &bindings)
        };
        let sorting = |entry_point| {
            let bindings = [Uniform, Read, Read, Write, Write, Write, Write];
            pipeline(&[frame, include_str!("pair_sort.wgsl")], entry_point, &bindings)
        };
        Ok(PairSort {
            count: making("count_pairs"),
            write: making("write_pairs"),
            histogram: sorting("histogram"),
            reorder: sorting("reorder"),
            find_cells: sorting("find_cells"),
            thread_scan: Scan::new(gpu),
            digit_scan: Scan::new(gpu),
            buffers: Buffers::new(gpu, inputs)?,
        })
    }

    /// Sorts, and says how long each step took.
    pub fn run(&mut self, gpu: &Gpu, clock: &mut Clock, inputs: &Inputs) -> Result<Steps, RenderError> {
        renderer::bench::clear(gpu, &[&self.buffers.bounds, &self.buffers.totals])?;
        let mut steps = self.make_pairs(gpu, clock, inputs)?;
        for digit in 0..self.digits() {
            steps.extend(self.sort_by(digit, gpu, clock, inputs)?);
        }
        let resources = self.buffers.sorting(0, self.digits());
        let workgroups = inputs.pairs.div_ceil(GROUP);
        steps.push(("find cells", dispatch(gpu, clock, &self.find_cells, &resources, workgroups)?));
        Ok(steps)
    }

    fn make_pairs(&mut self, gpu: &Gpu, clock: &mut Clock, inputs: &Inputs) -> Result<Steps, RenderError> {
        let Buffers { places, totals, keys, particles, .. } = &self.buffers;
        let Inputs { frame, tile, store, .. } = inputs;
        let resources = [frame, tile, &store.projected, places, &keys[0], &particles[0]].map(Buffer::binding);
        let workgroups = store.count().div_ceil(GROUP);
        let count = dispatch(gpu, clock, &self.count, &resources, workgroups)?;
        let scan = &mut self.thread_scan;
        let scan = clock.pass(gpu, |pass| scan.record(gpu, pass, places, totals, workgroups * GROUP))?;
        let write = dispatch(gpu, clock, &self.write, &resources, workgroups)?;
        Ok(vec![("count", count), ("scan", scan), ("write", write)])
    }

    /// One pass of the radix sort.
    fn sort_by(
        &mut self,
        digit: usize,
        gpu: &Gpu,
        clock: &mut Clock,
        inputs: &Inputs,
    ) -> Result<Steps, RenderError> {
        let Buffers { digits, totals, .. } = &self.buffers;
        let resources = self.buffers.sorting(digit, digit);
        let blocks = inputs.pairs.div_ceil(BLOCK);
        let histogram = dispatch(gpu, clock, &self.histogram, &resources, blocks)?;
        let scan = &mut self.digit_scan;
        let scan = clock.pass(gpu, |pass| scan.record(gpu, pass, digits, totals, RADIX * blocks))?;
        let reorder = dispatch(gpu, clock, &self.reorder, &resources, blocks)?;
        Ok(vec![("histograms", histogram), ("digit scans", scan), ("reorder", reorder)])
    }

    /// Digits of the keys, and so passes over all pairs.
    pub fn digits(&self) -> usize {
        self.buffers.sorts.len()
    }

    /// First reference of each cell and the one after its last, both 0 for an empty cell.
    pub fn bounds(&self) -> &Buffer {
        &self.buffers.bounds
    }

    /// The particles of one cell after the other.
    pub fn particles(&self) -> &Buffer {
        &self.buffers.particles[self.digits() % 2]
    }

    pub fn bytes(&self) -> u64 {
        let Buffers { places, digits, keys, particles, bounds, .. } = &self.buffers;
        [places, digits, bounds].into_iter().chain(keys).chain(particles).map(Buffer::bytes).sum()
    }
}

impl Buffers {
    fn new(gpu: &Gpu, inputs: &Inputs) -> Result<Buffers, RenderError> {
        let array = |label, stride, count| {
            let mut buffer = Buffer::storage(gpu, label, stride);
            buffer.reserve(gpu, count).map(|()| buffer)
        };
        let pairs = |label| array(label, 4, inputs.pairs);
        let threads = inputs.store.count().next_multiple_of(GROUP);
        let digits = RADIX * inputs.pairs.div_ceil(BLOCK);
        Ok(Buffers {
            sorts: sorts(gpu, inputs)?,
            places: array("pairs of each thread", 4, Scan::buffer_length(threads))?,
            digits: array("digits of each block", 4, Scan::buffer_length(digits))?,
            keys: [pairs("keys")?, pairs("sorted keys")?],
            particles: [pairs("particles")?, pairs("sorted particles")?],
            bounds: array("bounds of each cell", 8, inputs.cells)?,
            totals: array("totals", 16, 1)?,
        })
    }

    /// Bindings of `pair_sort.wgsl` for a digit, after a number of passes.
    fn sorting(&self, digit: usize, passes: usize) -> [BindingResource<'_>; 7] {
        let (from, to) = (passes % 2, (passes + 1) % 2);
        let Buffers { sorts, digits, keys, particles, bounds, .. } = self;
        [&sorts[digit], &keys[from], &particles[from], digits, &keys[to], &particles[to], bounds]
            .map(Buffer::binding)
    }
}

/// The constants of each pass: as many as the largest key has digits.
fn sorts(gpu: &Gpu, inputs: &Inputs) -> Result<Vec<Buffer>, RenderError> {
    let key_bits = u64::BITS - (inputs.cells - 1).max(1).leading_zeros();
    let sort = |shift| {
        let blocks = inputs.pairs.div_ceil(BLOCK) as u32;
        let mut uniform = Buffer::uniform::<Sort>(gpu, "sort");
        uniform.write(gpu, &[Sort { pairs: inputs.pairs as u32, blocks, shift, padding: 0 }])?;
        Ok(uniform)
    };
    (0..key_bits).step_by(DIGIT_BITS).map(sort).collect()
}

fn dispatch(
    gpu: &Gpu,
    clock: &mut Clock,
    pipeline: &Pipeline,
    resources: &[BindingResource],
    workgroups: u64,
) -> Result<f64, RenderError> {
    clock.pass(gpu, |pass| {
        pipeline.dispatch(gpu, pass, resources, workgroups);
        Ok(())
    })
}
