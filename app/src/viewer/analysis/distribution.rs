//! The distribution of a quantity over a frame, for the range and for the histogram.

use std::sync::Arc;

use rayon::prelude::*;
use renderer::Scale;

use crate::frames::Frame;
use crate::scene::Selection;

/// Bars of a histogram.
pub const BARS: usize = 128;

/// What is to be counted.
#[derive(Clone)]
pub struct Question {
    pub index: usize,
    pub frame: Arc<Frame>,
    /// The quantity's name, as a view has it.
    pub quantity: Option<String>,
    /// The range that the bars divide; the frame's own where it is `None`.
    pub range: Option<[f64; 2]>,
    /// Whether the bars are at equal differences or at equal ratios.
    pub scale: Scale,
    /// Shares of the particles, from 0 to 1, whose values are asked for.
    pub quantiles: Option<[f64; 2]>,
    /// The name of the field that decides the opacity, where that is another one.
    pub opacity: Option<Option<String>>,
}

/// What was counted.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    pub index: usize,
    pub quantity: Option<String>,
    /// Finite minimum and maximum over the frame, on a logarithmic scale of what is positive.
    pub extremes: Option<[f64; 2]>,
    /// Particles whose value is not finite.
    pub not_finite: usize,
    /// As asked for.
    pub range: Option<[f64; 2]>,
    pub scale: Scale,
    pub quantiles: Option<[f64; 2]>,
    /// The values at the quantiles.
    pub between: Option<[f64; 2]>,
    /// Particles in each bar; those outside the range are in none.
    pub bars: Vec<u64>,
    /// The field that decides the opacity, and its extremes.
    pub opacity: Option<(Option<String>, Option<[f64; 2]>)>,
}

impl Question {
    /// Whether `answer` is the answer to this question.
    pub fn is_answered_by(&self, answer: &Analysis) -> bool {
        let opacity = answer.opacity.as_ref().map(|(name, _)| name);
        let same_fields = self.quantity == answer.quantity && self.opacity.as_ref() == opacity;
        let same_axis = self.range == answer.range && self.scale == answer.scale;
        let same_quantiles = self.quantiles.is_none() || self.quantiles == answer.quantiles;
        self.index == answer.index && same_fields && same_axis && same_quantiles
    }

    /// Counts, on all threads. A quantity that the frame lacks has an empty answer.
    pub fn answer(&self) -> Analysis {
        let mut analysis = Analysis {
            index: self.index,
            quantity: self.quantity.clone(),
            extremes: None,
            not_finite: 0,
            range: self.range,
            scale: self.scale,
            quantiles: self.quantiles,
            between: None,
            bars: vec![0; BARS],
            opacity: self.opacity.clone().map(|name| {
                let selection = Selection::new(&self.frame, name.as_deref());
                let extremes =
                    selection.ok().and_then(|selection| extremes(&self.frame, &selection, Scale::Linear));
                (name, extremes)
            }),
        };
        let Ok(selection) = Selection::new(&self.frame, self.quantity.as_deref()) else { return analysis };
        let all = || (0..self.frame.len()).into_par_iter().map(|row| selection.value(row));
        analysis.not_finite = all().filter(|q| !q.is_finite()).count();
        let rows = || all().filter(|q| is_shown(*q, self.scale));
        analysis.extremes = extremes(&self.frame, &selection, self.scale);
        let Some(extremes) = analysis.extremes else { return analysis };
        analysis.between = self.quantiles.map(|shares| quantiles(rows().collect(), shares));
        let [low, high] = self.range.unwrap_or(extremes);
        let bar = |q: f64| (self.scale.u([low, high], q) * BARS as f64) as usize;
        analysis.bars = rows()
            .filter(|q| (low..=high).contains(q))
            .fold(
                || vec![0; BARS],
                |mut bars, q| {
                    bars[bar(q).min(BARS - 1)] += 1;
                    bars
                },
            )
            .reduce(|| vec![0; BARS], |a, b| a.into_iter().zip(b).map(|(a, b)| a + b).collect());
        analysis
    }
}

const NOTHING: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Whether a value has a place on a scale.
fn is_shown(q: f64, scale: Scale) -> bool {
    q.is_finite() && (scale == Scale::Linear || q > 0.0)
}

/// Finite minimum and maximum over a frame, on a logarithmic scale of what is positive.
pub fn extremes(frame: &Frame, selection: &Selection, scale: Scale) -> Option<[f64; 2]> {
    let [low, high] = (0..frame.len())
        .into_par_iter()
        .map(|row| selection.value(row))
        .filter(|q| is_shown(*q, scale))
        .fold(|| NOTHING, |[low, high], q| [low.min(q), high.max(q)])
        .reduce(|| NOTHING, |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
    (low <= high).then_some([low, high])
}

/// The values below which `shares` of all lie; there is at least one value.
fn quantiles(mut values: Vec<f64>, shares: [f64; 2]) -> [f64; 2] {
    let last = values.len() - 1;
    shares.map(|share| {
        let place = (share.clamp(0.0, 1.0) * last as f64).round() as usize;
        *values.select_nth_unstable_by(place, f64::total_cmp).1
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Column, Field, Metadata};

    fn question(values: &[f64], range: Option<[f64; 2]>) -> Question {
        let positions = Column::new(3, vec![0.0; 3 * values.len()]).unwrap();
        let field = Field { name: "q".into(), column: Column::scalars(values.to_vec()) };
        let frame = Frame::new(positions, vec![field], Metadata::default()).unwrap();
        let quantity = Some("q".into());
        let frame = Arc::new(frame);
        Question { index: 3, frame, quantity, range, scale: Scale::Linear, quantiles: None, opacity: None }
    }

    #[test]
    fn every_finite_value_is_in_one_bar() {
        let question = question(&[0.0, 0.5, 1.0, f64::NAN, f64::INFINITY], None);
        let analysis = question.answer();
        assert_eq!(analysis.extremes, Some([0.0, 1.0]));
        assert_eq!((analysis.bars[0], analysis.bars[BARS / 2], analysis.bars[BARS - 1]), (1, 1, 1));
        assert_eq!(analysis.bars.iter().sum::<u64>(), 3);
        assert!(question.is_answered_by(&analysis));
    }

    #[test]
    fn the_field_of_the_opacity_has_extremes_too() {
        let mut question = question(&[0.0, 0.5, 1.0], Some([0.0, 0.5]));
        question.opacity = Some(Some("q".into()));
        let answer = question.answer();
        assert_eq!(answer.opacity, Some((Some("q".into()), Some([0.0, 1.0]))));
        assert!(question.is_answered_by(&answer));
        question.opacity = None;
        assert!(!question.is_answered_by(&answer));
    }

    #[test]
    fn values_outside_a_fixed_range_are_in_none() {
        let analysis = question(&[-1.0, 2.0, 2.5, 9.0], Some([2.0, 3.0])).answer();
        assert_eq!(analysis.extremes, Some([-1.0, 9.0]));
        assert_eq!(analysis.bars.iter().sum::<u64>(), 2);
    }

    #[test]
    fn constant_and_missing_quantities_do_no_harm() {
        assert_eq!(question(&[4.0; 7], None).answer().bars[BARS / 2], 7);
        assert_eq!(question(&[f64::NAN], None).answer().extremes, None);
        let missing = Question { quantity: Some("heat".into()), ..question(&[1.0], None) };
        assert_eq!(missing.answer().extremes, None);
    }

    #[test]
    fn on_a_logarithmic_scale_only_what_is_positive_counts() {
        let values = [-5.0, 0.0, 1e-3, 1e-2, 1e-1, 1.0, f64::NAN];
        let asked = Question { scale: Scale::Log, quantiles: Some([0.0, 1.0]), ..question(&values, None) };
        let analysis = asked.answer();
        assert_eq!((analysis.extremes, analysis.between), (Some([1e-3, 1.0]), Some([1e-3, 1.0])));
        assert_eq!(analysis.not_finite, 1);
        let filled: Vec<usize> = (0..BARS).filter(|&bar| analysis.bars[bar] > 0).collect();
        assert_eq!(filled.len(), 4);
        assert!(filled.windows(2).all(|pair| pair[1] - pair[0] >= BARS / 3 - 1), "{filled:?}");
        let none = Question { scale: Scale::Log, quantiles: Some([0.1, 0.9]), ..question(&[-1.0], None) };
        assert_eq!(none.answer().between, None);
    }

    #[test]
    fn quantiles_leave_out_what_is_rare() {
        let values: Vec<f64> = (0..=1000).map(|i| if i == 1000 { 1e9 } else { f64::from(i) }).collect();
        let asked = Question { quantiles: Some([0.01, 0.99]), ..question(&values, None) };
        assert_eq!(asked.answer().between, Some([10.0, 990.0]));
        let others = Question { quantiles: Some([0.02, 0.98]), ..asked.clone() };
        assert!(!others.is_answered_by(&asked.answer()));
    }
}
