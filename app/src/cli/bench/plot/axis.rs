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
    Log,
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

    /// From the smallest of the whole numbers `values` to the largest, with room for one alone.
    pub fn whole(title: &'static str, values: impl Iterator<Item = usize>, ends: [f64; 2]) -> Axis {
        let (least, most) =
            values.fold((usize::MAX, 0), |(least, most), value| (least.min(value), most.max(value)));
        let margin = if least >= most { 1.0 } else { 0.02 * (most - least) as f64 };
        Axis { title, scale: Scale::Whole, range: [least as f64 - margin, most as f64 + margin], ends }
    }

    /// Around the positive ones of `values`; others are placed at its beginning.
    pub fn log(title: &'static str, values: impl Iterator<Item = f64>, ends: [f64; 2]) -> Axis {
        let values = values.filter(|value| value.is_finite() && *value > 0.0);
        let (least, most) =
            values.fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), x| (least.min(x), most.max(x)));
        let (least, most) = if least > most { (1e-3, 1.0) } else { (least, most) };
        Axis { title, scale: Scale::Log, range: [least / 1.5, most * 1.5], ends }
    }

    /// Where `value` stands, in pixels; what is beyond an end stands there.
    pub fn place(&self, value: f64) -> f64 {
        let on = |value: f64| if self.scale == Scale::Log { value.ln() } else { value };
        let [low, high] = self.range.map(on);
        let share = ((on(value) - low) / (high - low)).clamp(0.0, 1.0);
        self.ends[0] + share * (self.ends[1] - self.ends[0])
    }

    /// Round values with their labels.
    pub fn marks(&self) -> Vec<(f64, String)> {
        let [low, high] = self.range;
        let values: Vec<f64> = match self.scale {
            Scale::Log => log_marks(low, high),
            scale => {
                let step = step(high - low).max(if scale == Scale::Whole { 1.0 } else { 0.0 });
                let first = (low / step).ceil() as i64;
                (first..=((high / step + 1e-9).floor() as i64)).map(|i| i as f64 * step).collect()
            }
        };
        values.into_iter().map(|value| (value, label(value))).collect()
    }
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
        assert_eq!(labels(&Axis::whole("", [0].into_iter(), ends)), ["-1", "0", "1"]);
        let axis = Axis::log("", [0.001, 0.01].into_iter(), ends);
        assert_eq!(labels(&axis), ["0.001", "0.002", "0.005", "0.01"]);
        assert_eq!(labels(&Axis::log("", [1e-6, 1e-2].into_iter(), ends))[0], "1e-6");
    }

    #[test]
    fn everything_has_a_place_within_the_ends() {
        let ends = [100.0, 0.0];
        let linear = Axis::from_zero("", [10.0].into_iter(), ends);
        assert_eq!([0.0, 5.0, 10.0, 99.0].map(|value| linear.place(value)), [100.0, 50.0, 0.0, 0.0]);
        let log = Axis::log("", [0.0, 0.1, 10.0].into_iter(), ends);
        assert!((log.place(1.0) - 50.0).abs() < 1e-9);
        assert_eq!(log.place(0.0), 100.0);
        let nothing = Axis::log("", std::iter::empty(), ends);
        assert!(nothing.place(0.1).is_finite() && !nothing.marks().is_empty());
    }
}
