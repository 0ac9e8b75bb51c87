//! Numbers as people write them.

/// Four significant digits, with an exponent where that is shorter.
pub fn short(value: f64) -> String {
    with_digits(value, 4)
}

/// So many significant digits, with an exponent where that is shorter, and no zeros behind them.
pub fn with_digits(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let exponent = value.abs().log10().floor();
    if !(-3.0..6.0).contains(&exponent) {
        let text = format!("{value:.0$e}", digits - 1);
        return match text.split_once('e') {
            Some((mantissa, exponent)) => format!("{}e{exponent}", without_zeros(mantissa)),
            None => text,
        };
    }
    let decimals = (digits as f64 - 1.0 - exponent).clamp(0.0, 12.0) as usize;
    without_zeros(&format!("{value:.decimals$}")).to_owned()
}

/// A number without zeros at the end of its decimals.
fn without_zeros(text: &str) -> &str {
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => text,
    }
}

/// A value on an axis of length `span`, on which what is too small to be seen is zero.
pub fn on_axis(value: f64, span: f64) -> String {
    if value.abs() < 1e-6 * span.abs() { "0".into() } else { short(value) }
}

/// A coordinate in a scene of size `scale`, to four digits of that.
pub fn on_scale(value: f64, scale: f64) -> String {
    let step = 10_f64.powf(scale.abs().max(f64::MIN_POSITIVE).log10().floor() - 3.0);
    let rounded = (value / step).round() * step;
    short(if rounded.is_finite() { rounded } else { value })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_short_as_they_can_be() {
        assert_eq!(short(0.0), "0");
        assert_eq!(short(1.0), "1");
        assert_eq!(short(-0.05), "-0.05");
        assert_eq!(short(1234.5), "1234");
        assert_eq!(short(123_456.0), "123456");
        assert_eq!(short(1.234_56e-8), "1.235e-8");
        assert_eq!(short(120.0), "120");
        assert_eq!(short(2e-9), "2e-9");
        assert_eq!(short(0.00123456), "0.001235");
        assert_eq!(with_digits(1000.0125, 7), "1000.013");
        assert_eq!(with_digits(-2.5e12, 2), "-2.5e12");
        assert_eq!([3.066e-4, -0.123_456, 1.5].map(|x| on_scale(x, 2.0)), ["0", "-0.123", "1.5"]);
        assert_eq!(on_axis(8.859e-15, 1.0), "0");
        assert_eq!(on_axis(8.859e-15, 2e-14), "8.859e-15");
    }
}
