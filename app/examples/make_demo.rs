//! Makes `assets/demo.sphrun` from the frames of a run:
//!
//! ```text
//! cargo run --release -p sphcast --example make_demo -- RUN assets/demo.sphrun 0.044 0.011 0.1
//! ```
//!
//! RUN is a directory of frames with `id` and `concentration`; the numbers are the support radius,
//! the particle radius, and the time between frames.

use std::path::Path;

use anyhow::{Context, bail};
use sphcast::frames::{PackedRun, Sequence};
use sphcast::whole_file::write_whole;

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [run, out, numbers @ ..] = arguments.as_slice() else {
        bail!("expected RUN OUT SUPPORT_RADIUS PARTICLE_RADIUS SECONDS");
    };
    let numbers: Vec<f64> = numbers.iter().map(|number| number.parse()).collect::<Result<_, _>>()?;
    let [support_radius, particle_radius, seconds] = numbers[..] else {
        bail!("expected three numbers, found {}", numbers.len());
    };
    let sequence = Sequence::open(&[run.into()])?;
    let load = |source: &std::sync::Arc<sphcast::frames::Source>| {
        source.load(&Default::default()).context(source.name.clone())
    };
    let frames = sequence.sources().iter().map(load).collect::<Result<Vec<_>, _>>()?;
    // Rounded, so that the third frame is at 0.2 and not at 0.2 and a bit.
    let times = (0..frames.len()).map(|index| (index as f64 * seconds * 1e9).round() / 1e9).collect();
    let packed = PackedRun::new(&frames, "concentration", times, [support_radius, particle_radius])?;
    let bytes = packed.to_bytes()?;
    write_whole(Path::new(out), &bytes)?;
    let [position, .., scalar] = packed.header().channels;
    println!(
        "{} frames, {} particles, {} bytes; errors up to {:.2e} in position, {:.2e} in concentration",
        frames.len(),
        packed.header().particles,
        bytes.len(),
        0.5 * position.step,
        0.5 * scalar.step
    );
    Ok(())
}
