//! Which values a scale is marked with.

use renderer::Scale;

use crate::numbers::{short, with_digits};

/// A mark on a scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Its place from the low end to the high one, 0 to 1.
    pub share: f32,
    pub label: String,
}

/// Closer to an end, as a share of the scale, a mark would touch the end's own.
const APART: f64 = 0.09;
/// Ratio of the ends up to which a logarithmic scale is hardly another one than a linear scale.
const FEW: f64 = 5.0;
/// Marks to aim at.
const AIM: f64 = 5.0;

/// Both ends of the range, exactly as they are, and round values between them: on a logarithmic scale the
/// decades, or what is 1, 2 or 5 times a decade where there are few, or those of a linear scale where these
/// are few, too. A range of no width has one mark, in its middle.
pub fn ticks([low, high]: [f64; 2], scale: Scale) -> Vec<Tick> {
    let width = high - low;
    if width <= 0.0 || !width.is_finite() {
        return vec![Tick { share: 0.5, label: short(low) }];
    }
    if scale == Scale::Log && high > FEW * low && low > 0.0 {
        return decades([low, high]);
    }
    let step = round_below(width / AIM * 2.0);
    let largest = low.abs().max(high.abs());
    let digits = (largest.log10().floor() - step.log10().floor()).clamp(3.0, 14.0) as usize + 1;
    let label = |value: f64| match value.abs() < 1e-6 * width {
        true => "0".to_owned(),
        false => with_digits(value, digits),
    };
    let end = |share, value| Tick { share, label: label(value) };
    let first = (low / step).ceil();
    let between = (0..20).map(|i| (first + f64::from(i)) * step).filter_map(|value| {
        let share = scale.u([low, high], value);
        let inside = (APART..=1.0 - APART).contains(&share);
        inside.then(|| Tick { share: share as f32, label: label(value) })
    });
    std::iter::once(end(0.0, low)).chain(between).chain([end(1.0, high)]).collect()
}

fn decades(range: [f64; 2]) -> Vec<Tick> {
    let [first, last] = range.map(|end| end.log10().floor() as i32);
    let count = (range[1] / range[0]).log10();
    let factors: &[f64] = if count < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let every = (count / AIM).ceil().max(1.0) as i32;
    let powers = (first..=last).filter(|power| power.rem_euclid(every) == 0);
    let round = powers.flat_map(|power| factors.iter().map(move |factor| factor * 10_f64.powi(power)));
    let mut marks = vec![Tick { share: 0.0, label: short(range[0]) }];
    for value in round {
        let share = Scale::Log.u(range, value);
        let free = marks.last().is_none_or(|mark| share - f64::from(mark.share) >= APART);
        if free && share <= 1.0 - APART {
            marks.push(Tick { share: share as f32, label: short(value) });
        }
    }
    marks.push(Tick { share: 1.0, label: short(range[1]) });
    marks
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `length`, which is positive.
pub fn round_below(length: f64) -> f64 {
    let power = 10_f64.powf(length.log10().floor());
    let factor = [5.0, 2.0].into_iter().find(|factor| factor * power <= length * (1.0 + 1e-9));
    factor.unwrap_or(1.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: [f64; 2]) -> Vec<String> {
        ticks(range, Scale::Linear).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn ends_are_exact_and_values_between_are_round() {
        assert_eq!(labels([0.0, 1.0]), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(labels([0.0123, 0.987]), ["0.0123", "0.2", "0.4", "0.6", "0.8", "0.987"]);
        assert_eq!(labels([-3.0, 3.0]), ["-3", "-2", "0", "2", "3"]);
        assert_eq!(labels([1000.0, 1030.0]), ["1000", "1010", "1020", "1030"]);
        assert_eq!(labels([1e4, 1e4 + 0.03]), ["10000", "10000.01", "10000.02", "10000.03"]);
        assert_eq!(labels([7.0, 7.0]), ["7"]);
        assert_eq!(labels([0.0, 3e-12]), ["0", "1e-12", "2e-12", "3e-12"]);
    }

    #[test]
    fn no_mark_touches_another_one() {
        for i in 0..500 {
            let low = -3.0 + 0.0137 * f64::from(i);
            let marks = ticks([low, low + 1.1_f64.powi(i % 120) * 1e-3], Scale::Linear);
            assert!((2..=13).contains(&marks.len()), "{marks:?}");
            assert!(marks.windows(2).all(|pair| pair[1].share - pair[0].share > 0.07), "{marks:?}");
        }
    }

    #[test]
    fn logarithmic_scales_are_marked_by_decades() {
        let labels = |range| ticks(range, Scale::Log).into_iter().map(|tick| tick.label).collect::<Vec<_>>();
        assert_eq!(labels([1e-3, 100.0]), ["0.001", "0.01", "0.1", "1", "10", "100"]);
        assert_eq!(labels([3.0, 4e3]), ["3", "10", "100", "1000", "4000"]);
        assert_eq!(labels([1.0, 10.0]), ["1", "2", "5", "10"]);
        assert_eq!(labels([1e-12, 1e12]), ["1e-12", "1e-5", "1", "100000", "1e12"]);
        assert_eq!(labels([4.0, 4.0]), ["4"]);
        assert_eq!(labels([1000.0, 1030.0]), ["1000", "1010", "1020", "1030"]);
        assert_eq!(labels([1.0, 4.0]), ["1", "2", "3", "4"]);
        for i in 0..400 {
            let marks = ticks([0.3, 0.3 * 1.2_f64.powi(i + 1)], Scale::Log);
            assert!((2..=13).contains(&marks.len()), "{marks:?}");
            assert!(marks.windows(2).all(|pair| pair[1].share - pair[0].share > 0.07), "{marks:?}");
        }
    }

    #[test]
    fn lengths_are_rounded_down() {
        assert_eq!(
            [0.99, 1.0, 1.99, 2.0, 4.9, 5.0, 73.0].map(round_below),
            [0.5, 1.0, 1.0, 2.0, 2.0, 5.0, 50.0]
        );
    }
}
