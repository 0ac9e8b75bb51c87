//! What the samples of a setting come to, over all frames or one.

use renderer::{CellClasses, Milliseconds};
use serde::Serialize;

use super::measure::{Measured, Sample};
use super::quartiles::{Quartiles, ratio};
use super::settings::Setting;

/// One setting: a row of the paper's tables 2 and 3. Not-a-number where something was not measured.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    pub setting: String,
    /// E_I; absent for full sampling.
    pub tolerance: Option<f64>,
    pub ablation: Option<&'static str>,
    pub frames: usize,
    pub pictures: usize,
    pub milliseconds: Times,
    pub speed_up: SpeedUp,
    pub evaluations: Evaluations,
    pub error: Error,
    pub cells: Cells,
    pub discretisation: Discretisation,
}

/// Over all pictures.
#[derive(Clone, Debug, Serialize)]
pub struct Times {
    pub upload: Quartiles,
    pub grid: Quartiles,
    pub analysis: Quartiles,
    pub merge: Quartiles,
    pub ray_cast: Quartiles,
    /// All of the above but the upload.
    pub total: Quartiles,
}

/// How many times faster than full sampling of the same frame in the same round.
#[derive(Clone, Debug, Serialize)]
pub struct SpeedUp {
    pub ray_cast: Quartiles,
    pub total: Quartiles,
}

#[derive(Clone, Debug, Serialize)]
pub struct Evaluations {
    /// Of those of full sampling, the analysis counted in.
    pub share: f64,
    /// The part of the analysis in it.
    pub analysis: f64,
    /// Median over all pictures, in the time of analysis and ray cast.
    pub per_second: f64,
    /// Share with a weight above zero, of full sampling only.
    pub inside: f64,
}

/// Against full sampling on the same device.
#[derive(Clone, Debug, Serialize)]
pub struct Error {
    /// Over all channels of all pixels of all frames. Infinite where one of two pictures holds no
    /// number; JSON and CSV, which know no infinity, have nothing there.
    pub max: f64,
    pub mean: f64,
    /// Share of the rays with a channel farther off than the tolerance, in the frame with the most.
    pub rays_above: Option<f64>,
    /// Frames with such a ray; like the share absent for full sampling, which is compared with itself.
    pub frames_above: Option<usize>,
    /// Largest budget charged to any bundle.
    pub predicted: f64,
}

/// Shares of the filled cells.
#[derive(Clone, Debug, Serialize)]
pub struct Cells {
    pub full: f64,
    pub mixed: f64,
    pub z_adaptive: f64,
    pub super_pixel: f64,
    pub transparent: f64,
    pub occluded: f64,
}

/// Error of full sampling itself against finer sampling.
#[derive(Clone, Debug, Serialize)]
pub struct Discretisation {
    pub max: f64,
    pub mean: f64,
}

impl Summary {
    /// Of the setting with the number `index`, over `frames`; full sampling is number 0.
    pub fn new(frames: &[Measured], setting: &Setting, index: usize) -> Summary {
        let samples = || frames.iter().flat_map(|frame| &frame.rounds).map(|round| &round[index]);
        // Full sampling is the same for all settings: what is special to it has its place in its row.
        let full_only = if index == 0 { frames } else { &[] };
        Summary {
            setting: setting.name.clone(),
            tolerance: setting.tolerance,
            ablation: setting.ablation.map(|ablation| ablation.name),
            frames: frames.len(),
            pictures: samples().count(),
            milliseconds: Times::new(samples),
            speed_up: SpeedUp::new(frames, index),
            evaluations: Evaluations::new(frames, full_only, index),
            error: Error::new(frames, setting.tolerance, index),
            cells: Cells::new(samples().map(|sample| sample.stats.cells_by_class)),
            discretisation: Discretisation::new(full_only),
        }
    }

    /// Whether some ray is farther from full sampling than it may be.
    pub fn is_above(&self) -> bool {
        self.error.frames_above.is_some_and(|frames| frames > 0)
    }
}

/// From particles on the device to a picture there: grid, analysis, merge and ray cast, as in the
/// paper. The upload is paid once for a new frame, and not for a new camera.
fn total(times: &Milliseconds) -> f64 {
    times.grid + times.analysis + times.merge + times.ray_cast
}

impl Times {
    fn new<'a, I: Iterator<Item = &'a Sample>>(samples: impl Fn() -> I) -> Times {
        let of = |time: fn(&Milliseconds) -> f64| {
            Quartiles::of(samples().map(|sample| time(&sample.stats.milliseconds)))
        };
        Times {
            upload: of(|times| times.upload),
            grid: of(|times| times.grid),
            analysis: of(|times| times.analysis),
            merge: of(|times| times.merge),
            ray_cast: of(|times| times.ray_cast),
            total: of(total),
        }
    }
}

impl SpeedUp {
    fn new(frames: &[Measured], index: usize) -> SpeedUp {
        let rounds = || frames.iter().flat_map(|frame| &frame.rounds);
        let of = |time: fn(&Milliseconds) -> f64| {
            let times = |round: &Vec<Sample>, index: usize| time(&round[index].stats.milliseconds);
            Quartiles::of(rounds().map(|round| ratio(times(round, 0), times(round, index))))
        };
        SpeedUp { ray_cast: of(|times| times.ray_cast), total: of(total) }
    }
}

impl Evaluations {
    fn new(frames: &[Measured], full_only: &[Measured], index: usize) -> Evaluations {
        let rounds = || frames.iter().flat_map(|frame| &frame.rounds);
        let full: u64 = rounds().map(|round| round[0].stats.evaluations.done).sum();
        let samples = || rounds().map(|round| &round[index].stats);
        let done: u64 = samples().map(|stats| stats.evaluations.done).sum();
        let bounds: u64 = samples().map(|stats| stats.evaluations.bounds).sum();
        let rate = |stats: &renderer::Stats| {
            let times = &stats.milliseconds;
            1e3 * ratio(stats.evaluations.done as f64, times.analysis + times.ray_cast)
        };
        Evaluations {
            share: ratio(done as f64, full as f64),
            analysis: ratio(bounds as f64, full as f64),
            per_second: Quartiles::of(samples().map(rate)).median,
            inside: mean(full_only.iter().filter_map(|frame| frame.inside).filter(|share| share.is_finite())),
        }
    }
}

impl Error {
    fn new(frames: &[Measured], tolerance: Option<f64>, index: usize) -> Error {
        let of = |frame: &Measured, value: fn(&Sample) -> f64| {
            largest(frame.rounds.iter().map(|round| value(&round[index])))
        };
        let over_frames = |value| largest(frames.iter().map(|frame| of(frame, value)));
        let errors = frames.iter().flat_map(|frame| &frame.rounds).map(|round| round[index].error.mean);
        let above = |tolerance| {
            frames.iter().filter(|frame| of(frame, |sample| sample.error.max) > tolerance).count()
        };
        Error {
            max: over_frames(|sample| sample.error.max),
            mean: mean(errors),
            rays_above: tolerance.map(|_| over_frames(|sample| sample.error.above)),
            frames_above: tolerance.map(above),
            predicted: over_frames(|sample| sample.stats.predicted_error),
        }
    }
}

impl Cells {
    fn new(classes: impl Iterator<Item = CellClasses>) -> Cells {
        let mut sums = [0; 6];
        for CellClasses { full, mixed, z_adaptive, super_pixel, transparent, occluded } in classes {
            let counts = [full, mixed, z_adaptive.iter().sum(), super_pixel, transparent, occluded];
            sums.iter_mut().zip(counts).for_each(|(sum, count)| *sum += count);
        }
        let all: u64 = sums.iter().sum();
        let [full, mixed, z_adaptive, super_pixel, transparent, occluded] =
            sums.map(|sum| ratio(sum as f64, all as f64));
        Cells { full, mixed, z_adaptive, super_pixel, transparent, occluded }
    }
}

impl Discretisation {
    fn new(frames: &[Measured]) -> Discretisation {
        let errors = || frames.iter().filter_map(|frame| frame.discretisation);
        match errors().count() {
            0 => Discretisation { max: f64::NAN, mean: f64::NAN },
            _ => Discretisation {
                max: largest(errors().map(|error| error.max)),
                mean: mean(errors().map(|error| error.mean)),
            },
        }
    }
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

/// Not-a-number without values.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    sum / f64::from(count)
}

#[cfg(test)]
#[path = "summary_tests.rs"]
mod tests;
