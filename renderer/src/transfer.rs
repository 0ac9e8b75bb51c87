//! Transfer function: the colour and opacity of each value of the quantity (contract, section 1).

mod device;

use serde::{Deserialize, Serialize};

use crate::view::ViewError;
pub(crate) use device::joined;

/// Colour (linear light) and opacity of a path of one reference length at the normalised value `u`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlPoint {
    pub u: f32,
    pub rgb: [f32; 3],
    pub opacity: f32,
}

/// Colour (linear light) at the normalised value `u`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColourPoint {
    pub u: f32,
    pub rgb: [f32; 3],
}

/// Control points in ascending order of u, linear between, constant outside. Two points may share
/// one u: a step, whose upper side holds at u itself.
#[derive(Clone, Debug, PartialEq)]
pub struct TransferFunction {
    points: Vec<ControlPoint>,
}

impl TransferFunction {
    /// The most control points that a transfer function may have.
    pub const MAX_POINTS: usize = 4096;

    /// Checks that there is at least one point and that u, colours and opacities lie in [0, 1];
    /// sorts by u, keeping the given order where points share one.
    pub fn new(points: &[ControlPoint]) -> Result<Self, ViewError> {
        const KEY: &str = "transfer.points";
        if points.is_empty() || points.len() > Self::MAX_POINTS {
            let what = format!("has {} points, expected 1 to {}", points.len(), Self::MAX_POINTS);
            return Err(ViewError::new(KEY, what));
        }
        for (i, point) in points.iter().enumerate() {
            let values = [point.u, point.rgb[0], point.rgb[1], point.rgb[2], point.opacity];
            if !values.iter().all(|v| (0.0..=1.0).contains(v)) {
                return Err(ViewError::new(KEY, format!("point {i} has a value outside 0 to 1")));
            }
        }
        let mut points = points.to_vec();
        points.sort_by(|a, b| a.u.total_cmp(&b.u));
        Ok(TransferFunction { points })
    }

    /// In ascending order of u.
    pub fn points(&self) -> &[ControlPoint] {
        &self.points
    }

    /// Colour and opacity at `u`, which is clamped to [0, 1].
    pub fn sample(&self, u: f32) -> [f32; 4] {
        let u = u.clamp(0.0, 1.0);
        let above = self.points.partition_point(|point| point.u <= u);
        let at = |i: usize| {
            let ControlPoint { rgb: [r, g, b], opacity, .. } = self.points[i];
            [r, g, b, opacity]
        };
        if above == 0 {
            return at(0);
        }
        if above == self.points.len() {
            return at(above - 1);
        }
        let (low, high) = (self.points[above - 1].u, self.points[above].u);
        let s = (u - low) / (high - low);
        let (a, b) = (at(above - 1), at(above));
        std::array::from_fn(|c| a[c] + s * (b[c] - a[c]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(u: f32, value: f32) -> ControlPoint {
        ControlPoint { u, rgb: [value; 3], opacity: value }
    }

    #[test]
    fn linear_between_constant_outside() {
        let transfer = TransferFunction::new(&[grey(0.75, 1.0), grey(0.25, 0.0)]).unwrap();
        assert_eq!(transfer.sample(0.0), [0.0; 4]);
        assert_eq!(transfer.sample(0.5), [0.5; 4]);
        assert_eq!(transfer.sample(1.0), [1.0; 4]);
    }

    #[test]
    fn a_step_holds_its_upper_side() {
        let transfer = TransferFunction::new(&[grey(0.5, 0.0), grey(0.5, 1.0)]).unwrap();
        assert_eq!(transfer.sample(0.5_f32.next_down()), [0.0; 4]);
        assert_eq!(transfer.sample(0.5), [1.0; 4]);
    }

    #[test]
    fn values_outside_the_unit_interval_are_refused() {
        assert!(TransferFunction::new(&[]).is_err());
        assert!(TransferFunction::new(&[grey(1.5, 0.0)]).is_err());
        assert!(TransferFunction::new(&[grey(f32::NAN, 0.0)]).is_err());
    }
}
