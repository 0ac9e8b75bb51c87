//! Axes: from values to places, with marks at round numbers.

/// One axis of a chart.
#[derive(Clone, Debug)]
pub struct Axis {
    pub title: &'static str,
    scale: Scale,
    /// Values at its ends.
    range: [f64; 2],
    /// Places of its ends, in pixels.
    pub ends: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    Linear,
    /// Linear, with marks at whole numbers only.
    Whole,
    /// With a mark for `floor` and all below, where the axis begins there.
    Log {
        floor: f64,
    },
}

/// Marks to aim at.
const MARKS: f64 = 5.0;

impl Axis {
    /// From zero to a round number above all `values`.
    pub fn from_zero(title: &'static str, values: impl Iterator<Item = f64>, ends: [f64; 2]) -> Axis {
        let most = values.filter(|value| value.is_finite()).fold(0.0, f64::max);
        let most = if most > 0.0 { most } else { 1.0 };
        let step = step(most);
        Axis { title, scale: Scale::Linear, range: [0.0, (most / step).ceil() * step], ends }
    }

    /// From the smallest of the whole numbers `values` to the largest.
    pub fn whole(title: &'static str, values: impl Iterator<Item = usize>, ends: [f64; 2]) -> Axis {
        let (least, most) =
            values.fold((usize::MAX, 0), |(least, most), value| (least.min(value), most.max(value)));
        Axis { title, scale: Scale::Whole, range: [least as f64 - 0.5, most as f64 + 0.5], ends }
    }

    /// Around `values`, but not below `floor`, where all smaller ones are placed.
    pub fn log(title: &'static str, values: impl Iterator<Item = f64>, floor: f64, ends: [f64; 2]) -> Axis {
        let (least, most) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, floor), |(least, most): (f64, f64), x| (least.min(x), most.max(x)));
        let least = if least > floor && least <= most { (least / 1.5).max(floor) } else { floor };
        Axis { title, scale: Scale::Log { floor }, range: [least, most * 1.5], ends }
    }

    /// Where `value` stands, in pixels; what is beyond an end stands there.
    pub fn place(&self, value: f64) -> f64 {
        let on = |value: f64| if matches!(self.scale, Scale::Log { .. }) { value.ln() } else { value };
        let [low, high] = self.range.map(on);
        let share = ((on(value) - low) / (high - low)).clamp(0.0, 1.0);
        self.ends[0] + share * (self.ends[1] - self.ends[0])
    }

    /// Round values with their labels.
    pub fn marks(&self) -> Vec<(f64, String)> {
        let [low, high] = self.range;
        let values = match self.scale {
            Scale::Linear => multiples(step(high - low), low, high),
            Scale::Whole => multiples(step(high - low).max(1.0), low, high),
            Scale::Log { .. } => log_marks(low, high),
        };
        let label = |value| match self.scale {
            Scale::Log { floor } if value <= floor => format!("≤ {}", label(floor)),
            _ => label(value),
        };
        let begin = matches!(self.scale, Scale::Log { floor } if low == floor).then_some(low);
        let others = values.into_iter().filter(|value| begin.is_none_or(|begin| *value > 1.5 * begin));
        begin.into_iter().chain(others).map(|value| (value, label(value))).collect()
    }
}

/// Multiples of `step` from `low` to `high`.
fn multiples(step: f64, low: f64, high: f64) -> Vec<f64> {
    let [first, last] = [(low / step).ceil(), (high / step + 1e-9).floor()];
    (first as i64..=last as i64).map(|i| i as f64 * step).collect()
}

/// 1, 2 or 5 times a power of ten, so that about [`MARKS`] of it make the `width`.
fn step(width: f64) -> f64 {
    let rough = width / MARKS;
    let power = 10_f64.powf(rough.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= 0.999 * rough);
    factor.unwrap_or(10.0) * power
}

/// Powers of ten, and 2 and 5 times them where there are few.
fn log_marks(low: f64, high: f64) -> Vec<f64> {
    let decades = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let factors: &[f64] = if high / low < 300.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let marks = decades.flat_map(|decade| factors.iter().map(move |factor| factor * 10_f64.powi(decade)));
    marks.filter(|mark| (low..=high).contains(mark)).collect()
}

/// As short as it is exact to nine digits.
fn label(value: f64) -> String {
    let rounded: f64 = format!("{value:.8e}").parse().unwrap_or(value);
    match rounded.abs() {
        0.0 => "0".to_owned(),
        1e-4..1e6 => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.marks().into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn marks_are_round() {
        let ends = [0.0, 100.0];
        let axis = Axis::from_zero("", [3.0, 47.0].into_iter(), ends);
        assert_eq!(labels(&axis), ["0", "10", "20", "30", "40", "50"]);
        assert_eq!(labels(&Axis::from_zero("", [0.7].into_iter(), ends)), ["0", "0.2", "0.4", "0.6", "0.8"]);
        assert_eq!(labels(&Axis::whole("", [4, 6].into_iter(), ends)), ["4", "5", "6"]);
        assert_eq!(labels(&Axis::whole("", [7].into_iter(), ends)), ["7"]);
        let log = |values: [f64; 2], floor| labels(&Axis::log("", values.into_iter(), floor, ends));
        assert_eq!(log([0.001, 0.01], 1e-5), ["0.001", "0.002", "0.005", "0.01"]);
        assert_eq!(log([0.0, 0.01], 1e-5), ["≤ 1e-5", "0.0001", "0.001", "0.01"]);
    }

    #[test]
    fn everything_has_a_place_within_the_ends() {
        let ends = [100.0, 0.0];
        let linear = Axis::from_zero("", [10.0].into_iter(), ends);
        assert_eq!([0.0, 5.0, 10.0, 99.0].map(|value| linear.place(value)), [100.0, 50.0, 0.0, 0.0]);
        let log = Axis::log("", [0.0, 10.0 / 1.5].into_iter(), 0.1, ends);
        assert!((log.place(1.0) - 50.0).abs() < 1e-9);
        assert_eq!([0.0, 0.1, 99.0].map(|value| log.place(value)), [100.0, 100.0, 0.0]);
        let nothing = Axis::log("", std::iter::empty(), 1e-3, ends);
        assert!(nothing.place(0.1).is_finite() && !nothing.marks().is_empty());
    }
}
