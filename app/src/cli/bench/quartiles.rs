//! The middle of what was measured, and how far it spreads.

use serde::Serialize;

/// Quartiles; not-a-number where there is no value.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Quartiles {
    pub lower: f64,
    pub median: f64,
    pub upper: f64,
}

impl Quartiles {
    /// Of the finite ones among `values`.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Quartiles {
        let mut values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        let [lower, median, upper] = [0.25, 0.5, 0.75].map(|share| quantile(&values, share));
        Quartiles { lower, median, upper }
    }
}

/// Between the two sorted values next to the `share`, in proportion (type 7 of Hyndman and Fan 1996).
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = share * last as f64;
    let (below, above) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    below + (above - below) * place.fract()
}

/// a/b; not-a-number where there is nothing to divide by.
pub fn ratio(a: f64, b: f64) -> f64 {
    if b > 0.0 { a / b } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_few_and_many() {
        let of = |values: &[f64]| {
            let Quartiles { lower, median, upper } = Quartiles::of(values.iter().copied());
            [lower, median, upper]
        };
        assert_eq!(of(&[3.0]), [3.0; 3]);
        assert_eq!(of(&[2.0, 1.0]), [1.25, 1.5, 1.75]);
        assert_eq!(of(&[5.0, 1.0, 4.0, 2.0, 3.0]), [2.0, 3.0, 4.0]);
        assert_eq!(of(&[4.0, 1.0, 3.0, 2.0]), [1.75, 2.5, 3.25]);
        // One wild picture moves neither the middle nor the spread.
        assert_eq!(of(&[5.0, 1.0, 1e9, 2.0, 3.0]), [2.0, 3.0, 5.0]);
    }

    #[test]
    fn what_is_no_number_does_not_count() {
        assert_eq!(Quartiles::of([f64::NAN, 2.0, f64::INFINITY]).median, 2.0);
        assert!(Quartiles::of([]).median.is_nan());
        assert!(ratio(0.0, 0.0).is_nan() && ratio(1.0, 0.0).is_nan());
        assert_eq!(ratio(3.0, 2.0), 1.5);
    }
}
