//! The command line (contract, section 3).

mod bench;
mod compare;
mod console;
mod info;
mod interrupt;
mod render;
mod view;

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::Context;
use clap::{Parser, Subcommand};
use renderer::{Gpu, GpuOptions};

use crate::export::{Run, one_line};
use crate::frames::{FrameRange, Sequence};
use crate::viewer;

pub use view::{ShownArguments, ViewArguments};

/// Desktop viewer for SPH particle runs: ray casts the particles themselves on the GPU, with a
/// bound on the error of the picture.
#[derive(Parser)]
#[command(name = "sphcast", version, args_conflicts_with_subcommands = true, after_help = EXAMPLES)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    window: WindowArguments,
}

const EXAMPLES: &str = "\
FILE is a frame of a run (.vtk, .vtu, .vtp, .bgeo, .ply, .xyz, .csv, .npz, .npy, .hdf5), or a whole run: \
several files, a directory, a pattern in quotes, a .pvd. `demo` is the embedded run, `demo:radial:N` and \
`demo:checker:N` are generated scenes of N particles.

Examples:
  sphcast                            the viewer with the embedded run
  sphcast dambreak/                  the viewer with a directory of frames
  sphcast render demo --frames 12 --out mixer.png";

#[derive(Subcommand)]
enum Command {
    Render(render::RenderArguments),
    Bench(bench::BenchArguments),
    Info(info::InfoArguments),
    Compare(compare::CompareArguments),
}

/// What the viewer is opened with.
#[derive(clap::Args)]
pub struct WindowArguments {
    /// Frames to show; the embedded run without any
    #[arg(value_name = "FILE")]
    pub files: Vec<PathBuf>,
    #[command(flatten)]
    pub view: ViewArguments,
    #[command(flatten)]
    pub device: DeviceArguments,
    /// Show the newest frame, and every new one as the solver writes it; FILE may be a folder without any as yet
    #[arg(long)]
    pub follow: bool,
    /// Write a line on standard error for each thing that happens
    #[arg(long)]
    pub log_events: bool,
}

/// Which device renders.
#[derive(clap::Args)]
pub struct DeviceArguments {
    /// Graphics adapter to use: part of its name
    #[arg(long, value_name = "NAME")]
    pub adapter: Option<String>,
    /// The most device memory that a picture may take, in MiB; one that needs more is made part by part
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u32).range(device_memory_range()))]
    pub device_memory: Option<u32>,
}

fn device_memory_range() -> std::ops::RangeInclusive<i64> {
    let (least, most) = GpuOptions::MEMORY_MIB.into_inner();
    least.into()..=most.into()
}

impl DeviceArguments {
    fn options(&self) -> GpuOptions {
        let memory = self.device_memory.map(|mib| u64::from(mib) << 20);
        GpuOptions { adapter: self.adapter.clone(), memory, ..GpuOptions::default() }
    }

    fn open(&self) -> anyhow::Result<Gpu> {
        Gpu::new(&self.options()).context(if self.adapter.is_some() { "--adapter" } else { "sphcast" })
    }
}

/// The frames that a command works on.
#[derive(clap::Args)]
struct SequenceArguments {
    /// Frames of a run: files, a directory, a pattern, a .pvd, demo, demo:radial:N, demo:checker:N
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Only some of the frames, counted from 0, B left out: A..B, A.., ..B, or one number
    #[arg(long, value_name = "A..B")]
    frames: Option<FrameRange>,
    /// Only every N-th of these frames, the first of them counted in
    #[arg(long, value_name = "N", default_value = "1", hide_default_value = true)]
    every: NonZeroUsize,
}

impl SequenceArguments {
    /// The run, as the user calls it.
    fn name(&self) -> String {
        let names: Vec<_> = self.files.iter().map(|file| file.to_string_lossy()).collect();
        names.join(" ")
    }

    fn open(&self) -> anyhow::Result<Run> {
        let sequence = Sequence::open(&self.files)?;
        for note in sequence.notes() {
            eprintln!("note: {note}");
        }
        let count = sequence.len();
        let wrong = |what| WrongArguments(format!("--frames: {what}"));
        let range = self.frames.map_or(Ok(0..count), |range| range.within(count)).map_err(wrong)?;
        let mut run = Run::whole(sequence);
        run.select(range, self.every.get());
        Ok(run)
    }
}

/// An error in how the program was called that only shows once files were looked at.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct WrongArguments(String);

/// Runs the command line and returns the exit status: 0, 1 for a failure, 2 for wrong arguments.
pub fn run(arguments: impl Iterator<Item = OsString>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version come this way, too. Nobody is left to tell where this fails.
            let _ = error.print();
            return ExitCode::from(error.exit_code() as u8);
        }
    };
    let result = match &arguments.command {
        None => open_window(&arguments.window),
        Some(Command::Render(arguments)) => render::run(arguments),
        Some(Command::Bench(arguments)) => bench::run(arguments),
        Some(Command::Info(arguments)) => info::run(arguments),
        Some(Command::Compare(arguments)) => compare::run(arguments),
    };
    let Err(error) = result else {
        return ExitCode::SUCCESS;
    };
    eprintln!("error: {}", one_line(&error));
    ExitCode::from(if error.is::<WrongArguments>() { 2 } else { 1 })
}

fn open_window(arguments: &WindowArguments) -> anyhow::Result<()> {
    let sequence = Sequence::open_growing(&arguments.files, &|_| false)?;
    if arguments.follow && !sequence.may_grow() {
        let what = "no frames can come to what was named: name a folder, a pattern or a .pvd that is there";
        return Err(WrongArguments(format!("--follow: {what}")).into());
    }
    let mut view = arguments.view.resolve(&sequence)?;
    if arguments.files.is_empty() && arguments.view.shown.view.is_none() {
        // The start page leaves less room than the demo's own camera needs.
        view.camera = None;
    }
    viewer::run(viewer::Options {
        files: arguments.files.clone(),
        sequence,
        view,
        fixed_size: arguments.view.shown.size.is_some() || arguments.view.shown.view.is_some(),
        gpu: arguments.device.options(),
        log_events: arguments.log_events,
        follow: arguments.follow,
    })
}
