//! Which rows of a source make particles, and what these take up.

use glam::DVec3;
use rayon::prelude::*;

use super::{Bounds, EMPTY, RawParticle, Rejected, join, weight_of};

/// What a frame's sound particles take up. What the camera and the reference length refer to where a
/// view leaves them open is that of all of them: it stays as a selection changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    pub particles: usize,
    /// Around the centres; `None` without particles.
    pub bounds: Option<Bounds>,
    /// Smallest and largest support radius, in the unit of the run; zeros without particles.
    pub support_radii: [f64; 2],
}

/// What one pass over the source finds out.
pub(super) struct Verdicts {
    /// The rows that are sound and selected.
    pub rows: Vec<u32>,
    /// Those that are not sound, or weigh nothing.
    pub bad: Vec<u32>,
    pub selected: Extent,
    /// Of all that is sound.
    pub whole: Extent,
    pub rejected: Rejected,
    /// Rows of `bad` whose particles are sound, but weigh nothing.
    pub weightless: u64,
    /// Extremes of ln(V/h³) over what is selected.
    pub weights: [f64; 2],
}

/// Judges `count` rows. Only what is sound is asked whether it is selected.
pub(super) fn judge(
    count: usize,
    particle: &(impl Fn(usize) -> RawParticle + Sync),
    selects: &(impl Fn(usize) -> bool + Sync),
) -> Verdicts {
    let mut verdicts = (0..count)
        .into_par_iter()
        .fold(Verdicts::none, |verdicts, row| verdicts.add(row, &particle(row), || selects(row)))
        .reduce(Verdicts::none, Verdicts::and);
    for extent in [&mut verdicts.selected, &mut verdicts.whole] {
        if extent.particles == 0 {
            extent.support_radii = [0.0; 2];
        }
    }
    verdicts
}

impl Verdicts {
    fn none() -> Verdicts {
        Verdicts {
            rows: Vec::new(),
            bad: Vec::new(),
            selected: Extent::NONE,
            whole: Extent::NONE,
            rejected: Rejected::default(),
            weightless: 0,
            weights: EMPTY,
        }
    }

    fn add(mut self, row: usize, raw: &RawParticle, selected: impl FnOnce() -> bool) -> Verdicts {
        let finite = raw.position.iter().all(|x| x.is_finite()) && raw.volume.is_finite();
        let h = raw.support_radius;
        if !(finite && h.is_finite() && h > 0.0) {
            let reason = if finite { &mut self.rejected.bad_radius } else { &mut self.rejected.non_finite };
            *reason += 1;
            self.bad.push(row as u32);
            return self;
        }
        if raw.volume <= 0.0 {
            self.weightless += 1;
            self.bad.push(row as u32);
            return self;
        }
        let point = DVec3::from_array(raw.position);
        let bounds = Some(Bounds { min: point, max: point });
        let here = Extent { particles: 1, bounds, support_radii: [h, h] };
        self.whole = self.whole.and(here);
        if selected() {
            self.rows.push(row as u32);
            self.selected = self.selected.and(here);
            let weight = weight_of(raw);
            self.weights = join(self.weights, [weight, weight]);
        }
        self
    }

    /// Together with what was found out about the rows that follow.
    fn and(mut self, next: Verdicts) -> Verdicts {
        self.rows.extend(next.rows);
        self.bad.extend(next.bad);
        self.selected = self.selected.and(next.selected);
        self.whole = self.whole.and(next.whole);
        self.rejected.non_finite += next.rejected.non_finite;
        self.rejected.bad_radius += next.rejected.bad_radius;
        self.weightless += next.weightless;
        self.weights = join(self.weights, next.weights);
        self
    }
}

impl Extent {
    const NONE: Extent = Extent { particles: 0, bounds: None, support_radii: EMPTY };

    fn and(self, other: Extent) -> Extent {
        let bounds = match (self.bounds, other.bounds) {
            (Some(a), Some(b)) => Some(a.union(&b)),
            (a, b) => a.or(b),
        };
        Extent {
            particles: self.particles + other.particles,
            bounds,
            support_radii: join(self.support_radii, other.support_radii),
        }
    }
}
