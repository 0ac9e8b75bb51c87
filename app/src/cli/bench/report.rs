//! What a bench has found out, as one value and as the files in `--out`.

use std::path::Path;

use renderer::View;
use serde::Serialize;

use super::measure::Measurement;
use super::summary::Summary;
use super::{csv, plot};
use crate::export::Film;
use crate::whole_file::write_whole;

/// Everything: `bench.json`.
#[derive(Serialize)]
pub struct Report {
    /// The files, as asked for.
    pub run: String,
    pub adapter: String,
    pub backend: String,
    /// Particles of the largest frame.
    pub particles: u64,
    /// Measured, and asked for.
    pub frames: usize,
    pub frames_asked: usize,
    pub rounds: usize,
    /// Nothing failed, and nobody interrupted.
    pub complete: bool,
    /// With the camera and the reference length of the run filled in; its tolerance is that of no setting.
    pub view: View,
    pub settings: Vec<Summary>,
    pub by_frame: Vec<FrameRow>,
}

/// One setting in one frame.
#[derive(Serialize)]
pub struct FrameRow {
    /// Number in the whole run.
    pub frame: usize,
    pub name: String,
    pub particles: u64,
    #[serde(flatten)]
    pub summary: Summary,
}

impl Report {
    /// `None` where no frame was measured.
    pub fn new(run: String, measurement: &Measurement, film: &Film) -> Option<Report> {
        let Measurement { settings, frames, rounds, .. } = measurement;
        let first = frames.first()?.rounds[0][0].stats.clone();
        let complete = frames.len() == film.len() && frames.iter().all(|frame| frame.rounds.len() == *rounds);
        let by_frame = frames.iter().flat_map(|frame| {
            settings.iter().enumerate().map(|(index, setting)| FrameRow {
                frame: frame.number,
                name: frame.name.clone(),
                particles: frame.rounds[0][index].stats.particles,
                summary: Summary::new(std::slice::from_ref(frame), setting, index),
            })
        });
        let by_frame: Vec<FrameRow> = by_frame.collect();
        let settings = settings.iter().enumerate();
        Some(Report {
            run,
            adapter: first.adapter,
            backend: first.backend,
            particles: by_frame.iter().map(|row| row.particles).max().unwrap_or(0),
            frames: frames.len(),
            frames_asked: film.len(),
            rounds: *rounds,
            complete,
            view: film.view().clone(),
            settings: settings.map(|(index, setting)| Summary::new(frames, setting, index)).collect(),
            by_frame,
        })
    }

    /// One line on what was measured where.
    pub fn title(&self) -> String {
        let Report { run, adapter, particles, frames, frames_asked, rounds, .. } = self;
        let [width, height] = [self.view.image.width, self.view.image.height];
        let frames = match frames == frames_asked {
            true => frames.to_string(),
            false => format!("{frames} of {frames_asked}"),
        };
        let run = shortened(run);
        format!(
            "{run}; frames: {frames}; rounds: {rounds}; particles: {particles}; {width} x {height} pixels; {adapter}"
        )
    }

    /// Writes the files. All are made before the first is written, so that there are all or none
    /// unless the disk fails.
    pub fn write(&self, folder: &Path) -> anyhow::Result<()> {
        let growth = plot::time_over_particles(self).map(|plot| ("time-over-particles.svg", plot));
        let files = [
            ("bench.json", format!("{}\n", serde_json::to_string_pretty(self)?)),
            ("settings.csv", csv::table(&self.settings)?),
            ("frames.csv", csv::table(&self.by_frame)?),
            ("error-over-frames.svg", plot::error_over_frames(self)),
            ("time-over-frames.svg", plot::time_over_frames(self)),
            ("time-against-error.svg", plot::time_against_error(self)),
        ];
        for (name, text) in files.into_iter().chain(growth) {
            write_whole(&folder.join(name), text.as_bytes())?;
        }
        Ok(())
    }
}

/// The names of a run's files, but not so many that a line could not hold them.
fn shortened(run: &str) -> String {
    const MOST: usize = 64;
    match run.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &run[..end]),
        None => run.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::shortened;

    #[test]
    fn long_names_are_cut_at_a_character() {
        assert_eq!(shortened("demo"), "demo");
        assert_eq!(shortened(&"ä".repeat(64)), "ä".repeat(64));
        assert_eq!(shortened(&"ä".repeat(65)), format!("{}…", "ä".repeat(64)));
    }
}
