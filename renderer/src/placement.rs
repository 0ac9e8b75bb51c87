//! How the values of a quantity lie on the axis of the transfer function, and on the device's.

use serde::{Deserialize, Serialize};

/// Whether control points at equal distances are at equal differences or at equal ratios of the quantity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    #[default]
    Linear,
    /// Both ends of a range are positive.
    Log,
}

/// The largest ratio of the ends of a range on a logarithmic scale. With a larger one the smallest values
/// would leave the device's numbers, which reach down to 10⁻³⁸.
pub(crate) const LARGEST_RATIO: f64 = 1e30;

impl Scale {
    /// What of the extremes of a quantity is the range on this scale: all, or on a logarithmic one, where `low`
    /// is positive, no more than the upper 30 decades.
    pub fn fitted(self, [low, high]: [f64; 2]) -> [f64; 2] {
        match self {
            Scale::Linear => [low, high],
            Scale::Log => [low.max(high / LARGEST_RATIO), high],
        }
    }

    /// Whether the ends of a range have places on this scale.
    pub fn holds(self, [low, high]: [f64; 2]) -> bool {
        // Ends that were rounded are as good.
        self == Scale::Linear || (low > 0.0 && low >= high / (LARGEST_RATIO * (1.0 + 1e-9)))
    }

    /// u of a value, 0 and 1 at the ends of the range, beyond that outside; ½ in a range of no width.
    /// Values that are not positive are at −∞ on a logarithmic scale.
    pub fn u(self, [low, high]: [f64; 2], value: f64) -> f64 {
        if low >= high {
            return 0.5;
        }
        match self {
            // Halves first: the difference of two huge values may overflow.
            Scale::Linear => (value * 0.5 - low * 0.5) / (high * 0.5 - low * 0.5),
            Scale::Log if value <= 0.0 => f64::NEG_INFINITY,
            Scale::Log => (value / low).ln() / (high / low).ln(),
        }
    }

    /// The value at u in [0, 1].
    pub fn value(self, [low, high]: [f64; 2], u: f64) -> f64 {
        match self {
            Scale::Linear => low * (1.0 - u) + high * u,
            Scale::Log => low * (high / low).powf(u),
        }
    }
}

/// Which values of a quantity are the ends of the transfer function.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Spread {
    /// The extremes over the particles where it is `None`.
    pub range: Option<[f64; 2]>,
    pub scale: Scale,
    /// Whether values outside the range are told from those at its ends.
    pub outside: bool,
}

impl From<Option<[f64; 2]>> for Spread {
    fn from(range: Option<[f64; 2]>) -> Spread {
        Spread { range, ..Spread::default() }
    }
}

/// Where values are on the device's axis, of colours and of opacities where those are of two fields. Particles are interpolated there, so it is linear in the quantity:
/// on a linear scale, [0, 1] is the range itself, or its middle half where values outside are told apart;
/// on a logarithmic one, 0 is the value 0, so that small values keep all their digits, and the upper end of
/// the range is 1, or ½.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    range: [f64; 2],
    scale: Scale,
    outside: bool,
}

impl Default for Placement {
    fn default() -> Self {
        Placement { range: [0.0, 1.0], scale: Scale::Linear, outside: false }
    }
}

impl Placement {
    /// `range`: ascending, and positive on a logarithmic scale. One of no width is linear: a threshold.
    pub(crate) fn new(range: [f64; 2], scale: Scale, outside: bool) -> Placement {
        let scale = if range[0] > 0.0 && range[0] < range[1] { scale } else { Scale::Linear };
        Placement { range, scale, outside }
    }

    /// The values that u = 0 and u = 1 stand for.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Whether the device's axis is that of the transfer function.
    pub(crate) fn is_plain(&self) -> bool {
        self.scale == Scale::Linear && !self.outside
    }

    /// From u of the transfer function, in [0, 1], to the device's.
    pub(crate) fn device(&self, u: f64) -> f64 {
        let [low, high] = self.range;
        match self.scale {
            Scale::Linear => self.margined(u),
            Scale::Log => self.margined((low / high).powf(1.0 - u)),
        }
    }

    /// From the device's u to the transfer function's, where that is in [0, 1], else to its nearer end.
    pub fn u(&self, device: f64) -> f64 {
        let [low, high] = self.range;
        let u = match (self.scale, self.outside) {
            (Scale::Linear, false) => device,
            (Scale::Linear, true) => 2.0 * device - 0.5,
            (Scale::Log, outside) => {
                let share = if outside { 2.0 * device } else { device };
                1.0 - share.max(0.0).ln() / (low / high).ln()
            }
        };
        u.clamp(0.0, 1.0)
    }

    /// Makes room for what lies outside, without a loss: by powers of two.
    pub(crate) fn margined(&self, share: f64) -> f64 {
        match (self.outside, self.scale) {
            (false, _) => share,
            (true, Scale::Linear) => 0.25 + 0.5 * share,
            (true, Scale::Log) => 0.5 * share,
        }
    }

    /// ln of the ratio of the range's ends on a logarithmic scale.
    pub(crate) fn log_width(&self) -> Option<f64> {
        (self.scale == Scale::Log).then(|| self.range[1].ln() - self.range[0].ln())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_go_there_and_back() {
        for (scale, range) in [(Scale::Linear, [-2.0, 6.0]), (Scale::Log, [1e-5, 1e3])] {
            for outside in [false, true] {
                let placement = Placement::new(range, scale, outside);
                for u in [0.0, 0.1, 0.5, 1.0] {
                    assert!((placement.u(placement.device(u)) - u).abs() < 1e-12, "{placement:?} {u}");
                    assert!((scale.u(range, scale.value(range, u)) - u).abs() < 1e-12, "{scale:?} {u}");
                }
            }
        }
        assert_eq!(Scale::Log.u([1.0, 10.0], -3.0), f64::NEG_INFINITY);
        assert_eq!(Scale::Linear.u([4.0, 4.0], 9.0), 0.5);
    }

    #[test]
    fn a_logarithmic_range_is_no_wider_than_the_device_can_tell_apart() {
        assert_eq!(Scale::Log.fitted([1e-310, 0.8]), [0.8 / LARGEST_RATIO, 0.8]);
        assert_eq!(Scale::Log.fitted([1e-3, 0.8]), [1e-3, 0.8]);
        assert_eq!(Scale::Linear.fitted([1e-310, 0.8]), [1e-310, 0.8]);
        for high in [1e-300, 3e-7, 0.8, 1e15, f64::MAX] {
            assert!(Scale::Log.holds(Scale::Log.fitted([f64::MIN_POSITIVE / 8.0, high])), "{high:e}");
            assert!(Scale::Log.holds([high, high]));
        }
        assert!(Scale::Log.holds([1e-15, 1e15]));
        for wide in [[1e-300, 1e300], [1e-16, 1e15], [0.0, 1.0], [-1.0, 1.0]] {
            assert!(!Scale::Log.holds(wide) && Scale::Linear.holds(wide), "{wide:?}");
        }
        let huge = Placement::new([1e-300, 1e300], Scale::Log, false).log_width().unwrap();
        assert!((huge - 600.0 * 10.0_f64.ln()).abs() < 1e-9, "{huge}");
    }

    #[test]
    fn the_devices_axis_is_linear_in_the_quantity() {
        let range = [1.0, 100.0];
        for outside in [false, true] {
            let placement = Placement::new(range, Scale::Log, outside);
            let share = |q: f64| placement.device(Scale::Log.u(range, q)) / q;
            assert!((share(1.0) - share(7.0)).abs() < 1e-12 && (share(7.0) - share(100.0)).abs() < 1e-12);
        }
    }
}
