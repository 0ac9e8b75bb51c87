//! Takes every frame through all settings, again and again.

use anyhow::Context;
use renderer::{Picture, Renderer, Scene, Stats, View};

use super::settings::Setting;
use crate::difference::{Difference, difference};
use crate::export::{Content, Film};
use crate::frames::Frame;
use crate::image_file::Pixels;

/// Measures one frame after the other.
pub struct Measurement {
    pub settings: Vec<Setting>,
    pub rounds: usize,
    pub discretisation: bool,
    /// Which is timed.
    renderer: Renderer,
    /// Which counts the weights above zero, and takes longer for it.
    counting: Renderer,
    /// What is complete so far.
    pub frames: Vec<Measured>,
}

/// What was measured in one frame.
#[derive(Clone, Debug)]
pub struct Measured {
    /// In the whole run.
    pub number: usize,
    pub name: String,
    /// For each round, a sample for each setting. No round is kept in parts.
    pub rounds: Vec<Vec<Sample>>,
    /// Share of the evaluations of full sampling whose weight is above zero.
    pub inside: Option<f64>,
    /// Of full sampling, against sampling [`FINER`] times as fine.
    pub discretisation: Option<Difference>,
}

/// One picture: what it cost, and how far it is from full sampling.
#[derive(Clone, Debug)]
pub struct Sample {
    pub stats: Stats,
    pub error: Difference,
}

/// How much finer the picture is sampled that the discretisation error is measured against.
pub const FINER: f64 = 4.0;

impl Measurement {
    pub fn new(
        settings: Vec<Setting>,
        rounds: usize,
        discretisation: bool,
        renderers: [Renderer; 2],
    ) -> Self {
        let [renderer, counting] = renderers;
        Measurement { settings, rounds, discretisation, renderer, counting, frames: Vec::new() }
    }

    /// Measures frame `index`. Where the user interrupts, the rounds that are complete stay.
    pub fn frame(&mut self, film: &mut Film, index: usize) -> anyhow::Result<()> {
        let frame = film.frame(index)?;
        let content = film.content(index, &frame)?;
        let twins = Twins::new(&frame, content).with_context(|| film.name(index).to_owned())?;
        let mut measured = Measured {
            number: film.number(index),
            name: film.name(index).to_owned(),
            rounds: Vec::new(),
            inside: None,
            discretisation: None,
        };
        let result = self.pictures(film, index, twins, &mut measured);
        if !measured.rounds.is_empty() && (result.is_ok() || film.interrupted()) {
            self.frames.push(measured);
        }
        result
    }

    fn pictures(
        &mut self,
        film: &Film,
        index: usize,
        mut twins: Twins,
        measured: &mut Measured,
    ) -> anyhow::Result<()> {
        let warm_up = self.warm_up();
        let finer = if self.discretisation { FINER as usize } else { 0 };
        let count = warm_up.len() + self.rounds * self.settings.len() + 1 + finer;
        let mut step = 0;
        let mut render = |renderer: &mut Renderer, scene: &Scene, steps: usize| {
            let part = |step: usize| step as f32 / count as f32;
            let picture = film.render(renderer, scene, index, part(step)..part(step + steps));
            step += steps;
            picture
        };

        for setting in &warm_up {
            render(&mut self.renderer, &twins.sampled(setting)?, 1)?;
        }
        let mut full = None;
        for _ in 0..self.rounds {
            let mut round = Vec::new();
            // In turn, so that a machine that grows hot or busy slows all of them alike.
            for setting in &self.settings {
                let picture = render(&mut self.renderer, &twins.sampled(setting)?, 1)?;
                let (pixels, stats) = apart(picture);
                let full = full.get_or_insert_with(|| pixels.clone());
                round.push(Sample {
                    stats,
                    error: difference(&pixels, full, setting.tolerance.unwrap_or(0.0)),
                });
            }
            measured.rounds.push(round);
        }

        let counted = render(&mut self.counting, &twins.sampled(&self.settings[0])?, 1)?;
        let evaluations = counted.stats.evaluations;
        measured.inside = Some(evaluations.inside as f64 / evaluations.done as f64);
        if let Some(full) = full.filter(|_| self.discretisation) {
            let (fine, _) = apart(render(&mut self.renderer, &twins.scene(finer_view)?, finer)?);
            measured.discretisation = Some(difference(&full, &fine, 0.0));
        }
        Ok(())
    }

    /// What is rendered before the clock counts: every setting once, so that all shaders are compiled;
    /// in later frames one picture, since only a buffer may have to grow.
    fn warm_up(&self) -> Vec<Setting> {
        let from = if self.frames.is_empty() { 0 } else { self.settings.len() - 1 };
        self.settings[from..].to_vec()
    }
}

/// The same frame twice, taken in turn. The renderer keeps what is not stale, and would have nothing
/// to do for a second picture of the same particles; from one twin to the other all of it is stale.
struct Twins([Content; 2]);

impl Twins {
    fn new(frame: &Frame, content: Content) -> anyhow::Result<Twins> {
        let twin = Content::new(frame, content.view.clone())?;
        Ok(Twins([content, twin]))
    }

    /// The scene of the other one than last time, as `setting` samples it.
    fn sampled(&mut self, setting: &Setting) -> anyhow::Result<Scene> {
        let mut scene = self.scene(|view| setting.view(view))?;
        scene.sampling.without = setting.without();
        Ok(scene)
    }

    /// The scene of the other one than last time.
    fn scene(&mut self, change: impl FnOnce(&View) -> View) -> anyhow::Result<Scene> {
        self.0.swap(0, 1);
        self.0[0].scene(&change(&self.0[0].view))
    }
}

/// `view`, sampled in full and [`FINER`] times as finely.
pub fn finer_view(view: &View) -> View {
    let mut view = view.clone();
    view.sampling.tolerance = None;
    view.sampling.rate *= FINER;
    view
}

fn apart(picture: Picture) -> (Pixels, Stats) {
    let Picture { width, height, pixels, stats } = picture;
    (Pixels { width, height, data: pixels }, stats)
}
