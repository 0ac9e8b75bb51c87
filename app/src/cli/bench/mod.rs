//! `sphcast bench`: run time against error.
//!
//! Every frame is rendered with every setting (full sampling, and adaptively within each tolerance),
//! all of that in several rounds. What is timed is what the paper times: projection and **grid**,
//! **analysis**, **merge** and **ray cast**, on the device, from particles in its memory to a picture
//! there. The renderer keeps what is not stale, so two copies of the particles are rendered in turn,
//! and every timed picture takes all stages. The upload is reported beside them and is no part of the
//! total. Not timed are reading a file, preparing particles on the host, and fetching the picture.

mod csv;
mod measure;
mod plot;
mod quartiles;
mod report;
mod settings;
mod summary;
mod text;

use std::num::NonZeroUsize;
use std::path::PathBuf;

use anyhow::{Context, bail};
use renderer::Renderer;

use super::console::Console;
use super::view::{Tolerance, tolerance};
use super::{DeviceArguments, SequenceArguments, ShownArguments};
use crate::export::{Film, Output};
use crate::say::say;
use measure::Measurement;
use report::Report;
use settings::Setting;

/// Measure run time against error: full sampling against adaptive sampling, over all frames.
///
/// Tables go to standard output; with --out also to bench.json, settings.csv and frames.csv, with
/// plots of time and error over the frames, of time against error and, where the frames differ in
/// size, of time over the number of particles.
#[derive(clap::Args)]
#[command(after_help = "\
Times are medians over all frames and rounds. A speed-up is the median of ratios, each within one frame and \
one round, in which the settings take turns: a machine that is busy with something else slows them alike. A \
first round that compiles shaders is not counted. Ctrl-C ends the measurement; what is complete is written.

Examples:
  sphcast bench demo --frames 0..27 --out mixer/
  sphcast bench dambreak/ --view view.json --tolerances off,0.004 --rounds 5 --ablations
  sphcast bench demo:radial:100000 --size 256x256 --tolerances 0.004 --discretisation")]
pub struct BenchArguments {
    #[command(flatten)]
    sequence: SequenceArguments,
    #[command(flatten)]
    shown: ShownArguments,
    /// Largest errors to compare; `off` is full sampling, which is always measured
    #[arg(long, value_name = "E,...", value_delimiter = ',', value_parser = tolerance)]
    #[arg(default_value = "off,0.001,0.004,0.01")]
    tolerances: Vec<Tolerance>,
    /// How often each picture is timed
    #[arg(long, value_name = "N", default_value = "3")]
    rounds: NonZeroUsize,
    /// Also measure what each part of the method is worth: every tolerance without it
    #[arg(long)]
    ablations: bool,
    /// Also measure the error of full sampling itself, against four times as many samples
    #[arg(long)]
    discretisation: bool,
    /// Directory for tables and plots
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    device: DeviceArguments,
}

pub fn run(arguments: &BenchArguments) -> anyhow::Result<()> {
    let run = arguments.sequence.open()?;
    let view = arguments.shown.resolve(&run.sequence)?;
    if arguments.discretisation {
        measure::finer_view(&view).validate().context("--discretisation")?;
    }
    if let Some(folder) = &arguments.out {
        Output::Directory(folder.clone()).prepare()?;
    }
    let renderer = Renderer::new(arguments.device.open()?).context("sphcast")?;
    let counting = Renderer::counting(arguments.device.open()?).context("sphcast")?;
    let settings = Setting::list(&arguments.tolerances, arguments.ablations);
    let rounds = arguments.rounds.get();
    let mut measurement = Measurement::new(settings, rounds, arguments.discretisation, [renderer, counting]);

    let name = arguments.sequence.name();
    let console = Console::listen()?;
    let mut film = Film::new(run, view, None, console.clone());
    let result = film.each(|film, index| measurement.frame(film, index));
    console.clear();
    // Whatever ended the measurement, what it has found so far is worth having.
    if let Some(report) = Report::new(name, &measurement, &film) {
        tell(&report)?;
        if let Some(folder) = &arguments.out {
            report.write(folder)?;
        }
    }
    match result?.as_slice() {
        [] => Ok(()),
        failed => bail!("{}: not measured: {} of {} frames failed", failed[0], failed.len(), film.len()),
    }
}

/// The tables, and on standard error what a reader of them must not miss.
fn tell(report: &Report) -> anyhow::Result<()> {
    say(text::tables(report))?;
    if !report.complete {
        let (measured, all) = (report.frames, report.frames_asked);
        let what = "frames are in the tables, the last perhaps with fewer rounds";
        eprintln!("warning: not complete: {measured} of {all} {what}");
    }
    for summary in report.settings.iter().filter(|summary| summary.is_above()) {
        let (setting, frames) = (&summary.setting, summary.frames);
        let above = summary.error.frames_above.unwrap_or(0);
        eprintln!("warning: {setting}: the error is above the tolerance in {above} of {frames} frames");
    }
    Ok(())
}
