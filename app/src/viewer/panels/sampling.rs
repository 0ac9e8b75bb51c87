//! How far the picture may be from full sampling, and what may be left out for that.

use egui::{RichText, Slider, SliderClamping, Ui};
use renderer::{Bound, BrickWidth, SamplingView};

use crate::viewer::session::Session;
use crate::viewer::theme;
use crate::viewer::widgets::{self, Areas};

/// What the panel remembers between frames.
pub struct SamplingPanel {
    /// The tolerance to come back to from full sampling.
    tolerance: f64,
}

/// The tolerances that the slider offers; a number by hand may be any from 0 to 1.
const SLIDER: std::ops::RangeInclusive<f64> = 1e-4..=0.1;
/// Steps of a channel of 8 bits.
const STEPS: f64 = 255.0;
/// A quarter of such a step, one, and two and a half.
const CHOICES: [(f64, &str, &str); 3] = [
    (0.001, "0.255", "A quarter of an 8-bit step: not to be seen on any screen"),
    (0.004, "1.02", "One 8-bit step: the least that a saved PNG can tell apart"),
    (0.01, "2.55", "Two and a half 8-bit steps: hardly to be seen"),
];

impl SamplingPanel {
    pub fn new() -> SamplingPanel {
        let tolerance = SamplingView::default().tolerance;
        SamplingPanel { tolerance: tolerance.unwrap_or(CHOICES[1].0) }
    }

    pub fn show(&mut self, ui: &mut Ui, session: &mut Session) {
        let sampling = &mut session.view.sampling;
        self.switch(ui, sampling);
        if let Some(tolerance) = &mut sampling.tolerance {
            slider(ui, tolerance);
            widgets::row(ui, "In 8-bit steps", |ui| {
                ui.label(RichText::new(in_steps(*tolerance)).font(theme::number_font()))
            });
            widgets::row(ui, "Quick choice", |ui| widgets::choice(ui, tolerance, &CHOICES));
            self.tolerance = *tolerance;
            bound(ui, &mut sampling.bound);
            if sampling.bound == Bound::Paper && session.view.quantity.opacity.is_some() {
                let text = "The interval bound knows one field: with another one for the opacity, all is sampled in full.";
                ui.label(RichText::new(text).small().color(theme::colours().warning));
            }
            if sampling.bound == Bound::Difference {
                brick_width(ui, &mut sampling.brick_width);
            }
            super_pixels(ui, &mut sampling.super_pixels);
            levels(ui, &mut sampling.z_adaptive);
            always_adaptive(ui, &mut sampling.always_adaptive);
            if sampling.z_adaptive {
                relaxation(ui, &mut sampling.relaxation);
            }
        }
    }

    fn switch(&self, ui: &mut Ui, sampling: &mut SamplingView) {
        let mut adaptive = sampling.tolerance.is_some();
        let choices = [
            (true, "Adaptive", "Leaves out what the picture can do without, within the tolerance"),
            (false, "Full sampling", "Every sample of every ray is taken"),
        ];
        if ui.horizontal(|ui| widgets::choice(ui, &mut adaptive, &choices)).inner {
            sampling.tolerance = adaptive.then_some(self.tolerance);
        }
    }
}

fn slider(ui: &mut Ui, tolerance: &mut f64) {
    let hint = "E_I: no channel of any pixel is farther than this from full sampling";
    widgets::row(ui, "Tolerance", |ui| {
        let number = ui.spacing().interact_size.x;
        ui.spacing_mut().slider_width = ui.available_width() - number - ui.spacing().item_spacing.x;
        let slider = Slider::new(tolerance, SLIDER).logarithmic(true).show_value(false);
        // A tolerance from a file may lie outside; looking at it must not change it.
        let slider = ui.add(slider.clamping(SliderClamping::Never));
        let slider = slider.accessible_name("Tolerance").on_hover_text(hint);
        Areas::mark(ui, "tolerance", slider.rect);
        if slider.changed() {
            *tolerance = rounded(tolerance.clamp(*SLIDER.start(), *SLIDER.end()), 2);
        }
        let number = ui.add(widgets::number(tolerance, 0.0).range(0.0..=1.0));
        number.accessible_name("Tolerance").on_hover_text(hint);
    });
}

fn bound(ui: &mut Ui, bound: &mut Bound) {
    let choices = [
        (
            Bound::Difference,
            "Difference",
            "Of the difference from full sampling, in bricks of a few rays, 4 slices deep",
        ),
        (
            Bound::Paper,
            "Interval",
            "The paper's, of all that a ray may show, in cells of 8 × 8 rays, 16 slices deep: for comparison. \
             Strict, it saves next to nothing; relaxed, it guarantees nothing",
        ),
    ];
    widgets::row(ui, "Error bound", |ui| widgets::choice(ui, bound, &choices));
}

fn brick_width(ui: &mut Ui, width: &mut BrickWidth) {
    let choices = [
        (BrickWidth::Four, "4 × 4 rays", "Mostly the fastest"),
        (
            BrickWidth::Two,
            "2 × 2 rays",
            "Leaves the least to be sampled, but it takes up to twice as long to find out what",
        ),
    ];
    widgets::row(ui, "Bricks", |ui| widgets::choice(ui, width, &choices));
}

fn super_pixels(ui: &mut Ui, on: &mut bool) {
    let hint = "Bricks whose samples the tolerance cannot tell apart are shown without a sample: by one colour \
                each or, with z-levels, by a slope. Without them and without z-levels everything that is seen \
                is sampled in full.";
    widgets::row(ui, "Super-pixels", |ui| ui.checkbox(on, "One colour a brick").on_hover_text(hint));
}

fn levels(ui: &mut Ui, on: &mut bool) {
    let hint = "What lies between full sampling and a super-pixel: bricks follow the slope of the quantity or, \
                without super-pixels, are sampled once a ray for their four slices. By the interval bound, \
                cells are sampled once for up to 16.";
    widgets::row(ui, "z-levels", |ui| ui.checkbox(on, "Slopes and longer steps").on_hover_text(hint));
}

fn always_adaptive(ui: &mut Ui, on: &mut bool) {
    let hint = "Adaptive sampling takes time to find out what may be left out. Where a part of the picture shows that \
                this would take longer than it saves, all is sampled in full. With this on, it is done all the same: \
                to see the classes of cells, or to compare.";
    widgets::row(ui, "Adapt", |ui| {
        let checkbox = ui.checkbox(on, "Even where it hardly pays").on_hover_text(hint);
        Areas::mark(ui, "adapt", checkbox.rect);
    });
}

fn relaxation(ui: &mut Ui, relaxation: &mut f64) {
    let hint = "E_relax: how much of the bound of a slope or longer step is not charged to the tolerance. At 0 no pixel \
                is farther from full sampling than the tolerance; above 0 that is likely, and no longer \
                certain.";
    widgets::row(ui, "Relaxation", |ui| {
        let number = ui.spacing().interact_size.x;
        ui.spacing_mut().slider_width = ui.available_width() - number - ui.spacing().item_spacing.x;
        let slider = ui.add(Slider::new(relaxation, 0.0..=1.0).show_value(false));
        let slider = slider.accessible_name("Relaxation").on_hover_text(hint);
        Areas::mark(ui, "relaxation", slider.rect);
        if slider.changed() {
            *relaxation = rounded(*relaxation, 2);
        }
        let number = ui.add(widgets::number(relaxation, 1.0).range(0.0..=1.0));
        number.accessible_name("Relaxation").on_hover_text(hint);
    });
    let guarantee = match *relaxation > 0.0 {
        true => "Relaxed: the tolerance is no guarantee",
        false => "Guaranteed: no pixel exceeds the tolerance",
    };
    ui.label(RichText::new(guarantee).small().weak());
}

/// An error in steps of a channel of 8 bits.
pub fn in_steps(error: f64) -> String {
    format!("{} of 255", plain(STEPS * error))
}

/// An error to three significant digits.
pub fn plain(error: f64) -> String {
    rounded(error, 3).to_string()
}

/// Rounded to significant digits.
fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_choices_are_what_their_labels_say() {
        for (tolerance, label, _) in CHOICES {
            assert_eq!(in_steps(tolerance), format!("{label} of 255"));
        }
        assert_eq!(in_steps(0.0), "0 of 255");
        assert_eq!(plain(0.000_148_04), "0.000148");
        assert_eq!(in_steps(f64::INFINITY), "inf of 255");
    }

    #[test]
    fn the_slider_gives_short_numbers() {
        assert_eq!(rounded(0.001_234_56, 2), 0.0012);
        assert_eq!(rounded(0.0996, 2), 0.1);
    }
}
