//! What is compared: full sampling, and one way or another to sample less.

use renderer::{Bound, BrickWidth, View, Without};

use crate::cli::view::Tolerance;

/// One way to sample.
#[derive(Clone, Debug)]
pub struct Setting {
    /// As tables and figures call it.
    pub name: String,
    /// `None` for full sampling.
    pub tolerance: Option<f64>,
    pub ablation: Option<&'static Ablation>,
}

/// A part of the method that can be taken away, to see what it is worth.
#[derive(Debug)]
pub struct Ablation {
    pub name: &'static str,
    change: Change,
}

#[derive(Debug)]
enum Change {
    /// Of what a view can say itself.
    View(fn(&mut View)),
    /// Of the method.
    Method(Without),
}

/// A line for each: its name, and what it changes.
static ABLATIONS: [Ablation; 12] = [
    // All of them are: what they measure would be gone where full sampling is faster.
    Ablation { name: "always adaptive", change: Change::View(|_| ()) },
    Ablation {
        name: "finer bricks",
        change: Change::View(|view| view.sampling.brick_width = BrickWidth::Two),
    },
    Ablation { name: "extremes only", change: Change::Method(Without::Expansion) },
    Ablation { name: "no coverage", change: Change::Method(Without::Coverage) },
    Ablation { name: "no slopes", change: Change::Method(Without::Slopes) },
    Ablation { name: "no greedy: from front", change: Change::Method(Without::GreedFromFront) },
    Ablation { name: "no greedy: from back", change: Change::Method(Without::GreedFromBack) },
    Ablation { name: "only z", change: Change::View(|view| view.sampling.super_pixels = false) },
    Ablation {
        name: "skipping only",
        change: Change::View(|view| {
            (view.sampling.super_pixels, view.sampling.z_adaptive) = (false, false);
        }),
    },
    Ablation {
        name: "only z relaxed",
        change: Change::View(|view| (view.sampling.super_pixels, view.sampling.relaxation) = (false, 1.0)),
    },
    Ablation { name: "paper's bound", change: Change::View(|view| by_the_paper(view, 0.0)) },
    Ablation { name: "paper's bound relaxed", change: Change::View(|view| by_the_paper(view, 1.0)) },
];

/// Full sampling as it would be without cells along the rays: no tolerance makes a difference to it.
static OBJECT_SPACE: Ablation =
    Ablation { name: "object space", change: Change::Method(Without::CellsAlongRays) };

/// The paper's bound in place of ours.
fn by_the_paper(view: &mut View, relaxation: f64) {
    view.sampling.bound = Bound::Paper;
    view.sampling.relaxation = relaxation;
}

impl Setting {
    /// Full sampling, which all others are measured against, and then each of `tolerances`, followed by
    /// its ablations.
    pub fn list(tolerances: &[Tolerance], with_ablations: bool) -> Vec<Setting> {
        let mut settings = vec![Setting { name: "full".to_owned(), tolerance: None, ablation: None }];
        if with_ablations {
            let ablation = Some(&OBJECT_SPACE);
            settings.push(Setting { name: OBJECT_SPACE.name.to_owned(), tolerance: None, ablation });
        }
        let mut seen = Vec::new();
        for tolerance in tolerances.iter().filter_map(|tolerance| tolerance.0) {
            if seen.contains(&tolerance) {
                continue;
            }
            seen.push(tolerance);
            let (name, tolerance) = (tolerance.to_string(), Some(tolerance));
            settings.push(Setting { name: name.clone(), tolerance, ablation: None });
            let ablations = ABLATIONS.iter().filter(|_| with_ablations).map(|ablation| Setting {
                name: format!("{name} {}", ablation.name),
                tolerance,
                ablation: Some(ablation),
            });
            settings.extend(ablations);
        }
        settings
    }

    /// `view`, sampled this way.
    pub fn view(&self, view: &View) -> View {
        let mut view = view.clone();
        view.sampling.tolerance = self.tolerance;
        view.sampling.always_adaptive |= self.ablation.is_some();
        if let Some(Ablation { change: Change::View(change), .. }) = self.ablation {
            change(&mut view);
        }
        view
    }

    /// The part of the method that is left out.
    pub fn without(&self) -> Without {
        match self.ablation {
            Some(Ablation { change: Change::Method(without), .. }) => *without,
            _ => Without::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(tolerances: &[Option<f64>], with_ablations: bool) -> Vec<String> {
        let tolerances: Vec<Tolerance> = tolerances.iter().copied().map(Tolerance).collect();
        Setting::list(&tolerances, with_ablations).into_iter().map(|setting| setting.name).collect()
    }

    #[test]
    fn full_sampling_comes_first_and_everything_once() {
        assert_eq!(names(&[Some(0.01), None, Some(0.001), Some(0.01)], false), ["full", "0.01", "0.001"]);
        assert_eq!(names(&[None], true), ["full", "object space"]);
        assert_eq!(names(&[Some(0.01)], true).len(), 3 + ABLATIONS.len());
    }

    #[test]
    fn every_ablation_changes_how_the_view_is_sampled_and_nothing_else() {
        let view = View::default();
        let settings = Setting::list(&[Tolerance(Some(0.25))], true);
        for setting in settings.iter().skip(3).filter(|setting| setting.without() == Without::Nothing) {
            let mut changed = setting.view(&view);
            let adaptive = View { sampling: changed.sampling, ..view.clone() };
            assert_eq!(changed, adaptive, "{}", setting.name);
            assert_eq!(changed.sampling.tolerance, Some(0.25));
            changed.sampling.tolerance = view.sampling.tolerance;
            assert_ne!(changed, view, "{}", setting.name);
        }
    }

    #[test]
    fn parts_of_the_method_are_left_out_one_by_one() {
        let settings = Setting::list(&[Tolerance(Some(0.25))], true);
        let mut parts: Vec<Without> = settings.iter().map(Setting::without).collect();
        parts.retain(|part| *part != Without::Nothing);
        let [front, back] = [Without::GreedFromFront, Without::GreedFromBack];
        let [cells, slopes] = [Without::CellsAlongRays, Without::Slopes];
        assert_eq!(parts, [cells, Without::Expansion, Without::Coverage, slopes, front, back]);
        assert_eq!(settings[2].without(), Without::Nothing);
    }
}
