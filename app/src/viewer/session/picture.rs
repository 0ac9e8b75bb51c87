//! What the session learns from the pictures that arrive.

use std::sync::Arc;
use std::time::Instant;

use renderer::{Rejected, SamplingView, Stats};

use super::Session;
use crate::viewer::inspect::probe::Probed;
use crate::viewer::orbit_camera::OrbitCamera;
use crate::viewer::render_thread::prepare::Facts;
use crate::viewer::render_thread::{Report, Shown};

/// What is known of the picture on the screen.
#[derive(Clone, Debug)]
pub struct PictureFacts {
    pub index: usize,
    pub divisor: u32,
    pub full: [u32; 2],
    /// As it was drawn.
    pub sampling: SamplingView,
    /// The tolerance that it was to have at rest.
    pub wished: Option<f64>,
    pub stats: Stats,
    pub facts: Facts,
    pub probed: Option<Arc<Probed>>,
}

impl PictureFacts {
    /// Its tolerance, where that was raised to keep a moving picture in time.
    pub fn raised(&self) -> Option<f64> {
        self.sampling.tolerance.filter(|_| self.sampling.tolerance != self.wished)
    }
}

impl Session {
    /// Takes note of what the renderer reports; the picture itself is the caller's.
    pub fn note(&mut self, report: &Report) {
        match report {
            Report::Adapter { name, software } => {
                self.adapter = Some((name.clone(), *software));
                self.log(format!("adapter {name}"));
            }
            Report::Picture(shown) => self.note_picture(shown),
            Report::NoDevice(text) => self.complain(text.clone()),
            Report::Failed { index, text, .. } => {
                self.without_picture = Some(*index);
                self.messages.error(text.clone());
                self.log(format!("failed frame={index} {text}"));
            }
            Report::Recovered(text) => self.recovered(text),
        }
    }

    fn note_picture(&mut self, shown: &Shown) {
        self.without_picture = None;
        if shown.drawn.is_some() {
            let reading = self.run.as_ref().map_or(0.0, |run| run.take_reading(shown.index));
            self.costs.note(Instant::now(), shown, reading);
        }
        let facts = &shown.facts;
        let aspect = f64::from(shown.full[0]) / f64::from(shown.full[1].max(1));
        let bounds = match (self.extent.0, facts.bounds) {
            (Some(seen), Some(new)) => Some(seen.union(&new)),
            (seen, new) => seen.or(new),
        };
        let margin = self.extent.1.max(facts.support_radii[1]);
        self.extent = (bounds, margin);
        match &mut self.camera {
            Some(camera) => camera.set_scene(bounds, margin),
            None => {
                let mut camera = OrbitCamera::overview(bounds, margin, aspect);
                if let Some(view) = self.view.camera.take() {
                    camera.adopt(&view.settled(bounds, margin, aspect));
                }
                self.camera = Some(camera);
            }
        }
        if facts.rejected.total() > 0 && self.told_left_out.insert(shown.index) {
            self.messages.warn(left_out(shown.index, facts.rejected));
        }
        let size = if shown.divisor == 1 { "full".into() } else { format!("1/{}", shown.divisor) };
        self.log(format!("picture frame={} {}x{} {size}", shown.index, shown.width, shown.height));
        if let Some(cells) = &shown.cells {
            self.log(format!("cells {:?}", cells.classes()));
        }
        if let Some(probed) = &shown.probed {
            let ([x, y], bundle) = (probed.asked, &probed.bundle);
            self.log(format!("inspected {x},{y} bundle={:?} cells={}", bundle.bundle, bundle.cells.len()));
        }
        self.looking.set_shot(shown.shot.clone());
        self.picture = Some(PictureFacts {
            index: shown.index,
            divisor: shown.divisor,
            full: shown.full,
            sampling: shown.sampling,
            wished: shown.wished,
            stats: shown.stats.clone(),
            facts: facts.clone(),
            probed: shown.probed.clone(),
        });
    }
}

/// Says why particles of a frame are not in its picture.
fn left_out(index: usize, rejected: Rejected) -> String {
    let reasons = [
        (rejected.non_finite, "with a position or value that is not finite"),
        (rejected.bad_radius, "without a valid radius"),
    ];
    let reasons: Vec<String> =
        reasons.iter().filter(|(count, _)| *count > 0).map(|(count, why)| format!("{count} {why}")).collect();
    format!("Frame {index}: left out {}", reasons.join(", "))
}
