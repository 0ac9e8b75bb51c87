//! The distribution of fields over a frame, for their ranges and for the histogram. The whole frame counts,
//! whatever clip and filter leave: an automatic range goes by it, too.

use std::sync::{Arc, Weak};

use rayon::prelude::*;
use renderer::Scale;

use crate::frames::Frame;
use crate::scene::{Selection, extremes, is_shown};
use crate::viewer::analysis::histogram::Histogram;

/// What is to be counted of a field.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The field's name, as a view has it.
    pub field: Option<String>,
    /// The range that the bars divide; the frame's own where it is `None`.
    pub range: Option<[f64; 2]>,
    /// Whether the bars are at equal differences or at equal ratios.
    pub scale: Scale,
    /// Shares of the particles, from 0 to 1, whose values are asked for.
    pub quantiles: Option<[f64; 2]>,
}

/// What was counted of a field.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    /// As asked for.
    pub axis: Axis,
    /// Finite minimum and maximum over the frame, on a logarithmic scale of what is positive.
    pub extremes: Option<[f64; 2]>,
    /// Particles whose value is not finite.
    pub not_finite: usize,
    /// The values at the quantiles.
    pub between: Option<[f64; 2]>,
    /// `None` where no value has a place on the axis.
    pub histogram: Option<Histogram>,
}

/// What is to be counted of a frame.
#[derive(Clone)]
pub struct Question {
    pub index: usize,
    pub frame: Arc<Frame>,
    /// Of the field that is shown.
    pub colour: Axis,
    /// Of the field that decides the opacity, where that is another one.
    pub opacity: Option<Axis>,
}

/// What was counted of a frame.
#[derive(Clone, Debug)]
pub struct Analysis {
    pub index: usize,
    /// The number may have been another frame's, or the frame may have been written anew.
    frame: Weak<Frame>,
    pub colour: Distribution,
    pub opacity: Option<Distribution>,
    /// Particles that lack a finite value of either field.
    pub left_out: usize,
}

impl Axis {
    fn is_answered_by(&self, answer: &Axis) -> bool {
        let same_axis = self.range == answer.range && self.scale == answer.scale;
        let same_quantiles = self.quantiles.is_none() || self.quantiles == answer.quantiles;
        self.field == answer.field && same_axis && same_quantiles
    }

    /// A field that the frame lacks has an empty answer.
    fn count(&self, frame: &Frame) -> Distribution {
        let mut found = Distribution {
            axis: self.clone(),
            extremes: None,
            not_finite: 0,
            between: None,
            histogram: None,
        };
        let Ok(selection) = Selection::new(frame, self.field.as_deref()) else { return found };
        let all = || (0..frame.len()).into_par_iter().map(|row| selection.value(row));
        found.not_finite = all().filter(|q| !q.is_finite()).count();
        found.extremes = extremes(frame, &selection, self.scale);
        let Some(extremes) = found.extremes else { return found };
        let shown = || all().filter(|q| is_shown(*q, self.scale));
        found.between = self.quantiles.map(|shares| quantiles(shown().collect(), shares));
        let range = self.range.unwrap_or(extremes);
        found.histogram = Some(Histogram::of(frame, &selection, range, self.scale));
        found
    }
}

impl Question {
    /// Whether `answer` is the answer to this question.
    pub fn is_answered_by(&self, answer: &Analysis) -> bool {
        let opacity = match (&self.opacity, &answer.opacity) {
            (Some(asked), Some(answer)) => asked.is_answered_by(&answer.axis),
            (None, None) => true,
            _ => false,
        };
        let same_frame = std::ptr::eq(answer.frame.as_ptr(), Arc::as_ptr(&self.frame));
        same_frame && opacity && self.colour.is_answered_by(&answer.colour.axis)
    }

    /// Counts, on all threads.
    pub fn answer(&self) -> Analysis {
        let colour = self.colour.count(&self.frame);
        let opacity = self.opacity.as_ref().map(|axis| axis.count(&self.frame));
        let left_out = match &self.opacity {
            None => colour.not_finite,
            Some(other) => without_value(&self.frame, [&self.colour, other]),
        };
        Analysis { index: self.index, frame: Arc::downgrade(&self.frame), colour, opacity, left_out }
    }
}

/// Particles that lack a finite value of one of two fields.
fn without_value(frame: &Frame, axes: [&Axis; 2]) -> usize {
    let fields: Vec<Selection> =
        axes.iter().filter_map(|axis| Selection::new(frame, axis.field.as_deref()).ok()).collect();
    let lacks = |row: &usize| fields.iter().any(|field| !field.value(*row).is_finite());
    (0..frame.len()).into_par_iter().filter(lacks).count()
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
    use crate::viewer::analysis::histogram::BARS;

    fn frame(fields: &[(&str, &[f64])]) -> Arc<Frame> {
        let positions = Column::new(3, vec![0.0; 3 * fields[0].1.len()]).unwrap();
        let field = |(name, values): &(&str, &[f64])| Field {
            name: (*name).into(),
            column: Column::scalars(values.to_vec()),
        };
        Arc::new(Frame::new(positions, fields.iter().map(field).collect(), Metadata::default()).unwrap())
    }

    fn axis(field: &str, range: Option<[f64; 2]>) -> Axis {
        Axis { field: Some(field.into()), range, scale: Scale::Linear, quantiles: None }
    }

    fn question(values: &[f64], range: Option<[f64; 2]>) -> Question {
        Question { index: 3, frame: frame(&[("q", values)]), colour: axis("q", range), opacity: None }
    }

    fn bars(analysis: &Analysis) -> Vec<u64> {
        analysis.colour.histogram.as_ref().unwrap().bars.clone()
    }

    #[test]
    fn every_finite_value_is_in_one_bar() {
        let question = question(&[0.0, 0.5, 1.0, f64::NAN, f64::INFINITY], None);
        let analysis = question.answer();
        assert_eq!(analysis.colour.extremes, Some([0.0, 1.0]));
        let bars = bars(&analysis);
        assert_eq!((bars[0], bars[BARS / 2], bars[BARS - 1]), (1, 1, 1));
        assert_eq!(bars.iter().sum::<u64>(), 3);
        assert_eq!(analysis.left_out, 2);
        assert!(question.is_answered_by(&analysis));
    }

    #[test]
    fn the_field_of_the_opacity_is_counted_on_its_own_axis() {
        let values: [(&str, &[f64]); 2] =
            [("q", &[0.0, 0.5, f64::NAN, 1.0]), ("p", &[f64::INFINITY, 1.0, f64::NAN, 100.0])];
        let log = Axis { scale: Scale::Log, ..axis("p", Some([0.1, 100.0])) };
        let opacity = Some(log.clone());
        let mut question = Question { index: 0, frame: frame(&values), colour: axis("q", None), opacity };
        let answer = question.answer();
        let found = answer.opacity.as_ref().unwrap();
        assert_eq!((found.extremes, found.not_finite), (Some([1.0, 100.0]), 2));
        let filled: Vec<usize> =
            (0..BARS).filter(|&bar| found.histogram.as_ref().unwrap().bars[bar] > 0).collect();
        assert_eq!(filled, [BARS / 3, BARS - 1]);
        assert_eq!((answer.colour.not_finite, answer.left_out), (1, 2), "one particle lacks both");
        assert!(question.is_answered_by(&answer));
        question.opacity = Some(Axis { scale: Scale::Linear, ..log });
        assert!(!question.is_answered_by(&answer));
        question.opacity = None;
        assert!(!question.is_answered_by(&answer));
    }

    #[test]
    fn values_outside_a_fixed_range_are_in_none() {
        let analysis = question(&[-1.0, 2.0, 2.5, 9.0], Some([2.0, 3.0])).answer();
        assert_eq!(analysis.colour.extremes, Some([-1.0, 9.0]));
        assert_eq!(bars(&analysis).iter().sum::<u64>(), 2);
    }

    #[test]
    fn constant_and_missing_quantities_do_no_harm() {
        assert_eq!(bars(&question(&[4.0; 7], None).answer())[BARS / 2], 7);
        assert_eq!(question(&[f64::NAN], None).answer().colour.extremes, None);
        let missing = Question { colour: axis("heat", None), ..question(&[1.0], None) };
        assert_eq!(missing.answer().colour.extremes, None);
    }

    #[test]
    fn on_a_logarithmic_scale_only_what_is_positive_counts() {
        let values = [-5.0, 0.0, 1e-3, 1e-2, 1e-1, 1.0, f64::NAN];
        let log = |quantiles| Axis { scale: Scale::Log, quantiles: Some(quantiles), ..axis("q", None) };
        let asked = Question { colour: log([0.0, 1.0]), ..question(&values, None) };
        let analysis = asked.answer();
        let Distribution { extremes, between, not_finite, .. } = analysis.colour;
        assert_eq!((extremes, between, not_finite), (Some([1e-3, 1.0]), Some([1e-3, 1.0]), 1));
        let bars = bars(&analysis);
        let filled: Vec<usize> = (0..BARS).filter(|&bar| bars[bar] > 0).collect();
        assert_eq!(filled.len(), 4);
        assert!(filled.windows(2).all(|pair| pair[1] - pair[0] >= BARS / 3 - 1), "{filled:?}");
        let none = Question { colour: log([0.1, 0.9]), ..question(&[-1.0], None) };
        assert_eq!(none.answer().colour.between, None);
        let wide = Question {
            colour: Axis { quantiles: None, ..log([0.0, 1.0]) },
            ..question(&[1e-310, 1.0], None)
        };
        assert_eq!(wide.answer().colour.extremes, Some([1.0 / 1e30, 1.0]));
    }

    #[test]
    fn quantiles_leave_out_what_is_rare() {
        let values: Vec<f64> = (0..=1000).map(|i| if i == 1000 { 1e9 } else { f64::from(i) }).collect();
        let at = |quantiles| Axis { quantiles: Some(quantiles), ..axis("q", None) };
        let asked = Question { colour: at([0.01, 0.99]), ..question(&values, None) };
        assert_eq!(asked.answer().colour.between, Some([10.0, 990.0]));
        let others = Question { colour: at([0.02, 0.98]), ..asked.clone() };
        assert!(!others.is_answered_by(&asked.answer()));
    }

    #[test]
    fn another_frame_of_the_same_number_is_another_question() {
        let asked = question(&[1.0, 2.0], None);
        let written_anew = Question { frame: frame(&[("q", &[1.0, 2.0])]), ..asked.clone() };
        assert!(!written_anew.is_answered_by(&asked.answer()));
        let numbered_anew = Question { index: 7, ..asked.clone() };
        assert!(numbered_anew.is_answered_by(&asked.answer()));
    }
}
