//! Particles by value.

use rayon::prelude::*;
use renderer::Scale;

use crate::frames::Frame;
use crate::scene::{Selection, is_shown};

/// Bars of a histogram.
pub const BARS: usize = 128;

/// How many particles of a frame, or of several, have which value.
#[derive(Clone, Debug, PartialEq)]
pub struct Histogram {
    /// The values at the beginning of the first bar and at the end of the last one.
    pub range: [f64; 2],
    /// Whether the bars are at equal differences or at equal ratios.
    pub scale: Scale,
    /// Particles in each bar; those outside the range are in none.
    pub bars: Vec<u64>,
}

impl Histogram {
    pub fn empty(range: [f64; 2], scale: Scale) -> Histogram {
        Histogram { range, scale, bars: vec![0; BARS] }
    }

    /// Counts the particles of a frame, on all threads.
    pub fn of(frame: &Frame, selection: &Selection, range: [f64; 2], scale: Scale) -> Histogram {
        let bar = |value: f64| ((scale.u(range, value) * BARS as f64) as usize).min(BARS - 1);
        let bars = (0..frame.len())
            .into_par_iter()
            .map(|row| selection.value(row))
            .filter(|value| is_shown(*value, scale) && (range[0]..=range[1]).contains(value))
            .fold(
                || vec![0; BARS],
                |mut bars, value| {
                    bars[bar(value)] += 1;
                    bars
                },
            )
            .reduce(|| vec![0; BARS], |a, b| a.into_iter().zip(b).map(|(a, b)| a + b).collect());
        Histogram { bars, ..Histogram::empty(range, scale) }
    }

    /// Adds the particles of another frame, counted over the same range and scale.
    pub fn add(&mut self, other: &Histogram) {
        self.bars.iter_mut().zip(&other.bars).for_each(|(bar, more)| *bar += more);
    }

    /// u of the beginnings of all bars, and of the end of the last one, where `range` is what is shown; the
    /// counts may be of a range that was in effect before.
    pub fn edges(&self, range: [f64; 2], scale: Scale) -> Vec<f32> {
        let share = |edge: usize| edge as f64 / BARS as f64;
        let same = (self.range, self.scale) == (range, scale);
        let u = |edge| match same {
            true => share(edge),
            false => scale.u(range, self.scale.value(self.range, share(edge))),
        };
        // What has no place on a logarithmic scale lies below it.
        let inside = |u: f64| if u >= 0.0 { u.min(1.0) as f32 } else { 0.0 };
        (0..=BARS).map(|edge| inside(u(edge))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_stay_at_their_values_when_the_range_changes() {
        let counted = Histogram::empty([0.0, 8.0], Scale::Linear);
        assert_eq!(counted.edges([0.0, 8.0], Scale::Linear)[BARS / 2], 0.5);
        let wider = counted.edges([0.0, 16.0], Scale::Linear);
        assert_eq!((wider[BARS / 2], wider[BARS]), (0.25, 0.5));
        let closer = counted.edges([2.0, 4.0], Scale::Linear);
        assert_eq!((closer[0], closer[3 * BARS / 8], closer[BARS]), (0.0, 0.5, 1.0));
        let log = counted.edges([1.0, 16.0], Scale::Log);
        assert_eq!(log[0], 0.0);
        assert!((log[BARS / 2] - 0.5).abs() < 1e-6 && (log[BARS] - 0.75).abs() < 1e-6);
    }

    #[test]
    fn a_range_of_no_width_stays_in_its_middle() {
        assert_eq!(Histogram::empty([4.0, 4.0], Scale::Linear).edges([4.0, 4.0], Scale::Linear)[BARS], 1.0);
        let edges = Histogram::empty([0.0, 8.0], Scale::Linear).edges([4.0, 4.0], Scale::Linear);
        assert!(edges.iter().all(|u| *u == 0.5));
    }
}
