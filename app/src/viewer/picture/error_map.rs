//! Errors as colours: from dark to bright in one hue up to the tolerance, red above it.

use egui::Color32;

use crate::overlay::Sheet;
use crate::viewer::inspect::measurement::Measured;
use crate::viewer::picture::tone::srgb_byte;

pub const ABOVE: Color32 = Color32::from_rgb(0xf0, 0x3e, 0x3e);

/// Lightness of no error and of the tolerance.
const LIGHTNESS: [f32; 2] = [0.18, 0.96];
/// Where the colour is strongest, and the direction of its hue: cyan.
const CHROMA: f32 = 0.10;
const HUE_DEGREES: f32 = 215.0;

/// The errors of each pixel.
pub fn sheet(measured: &Measured) -> Sheet {
    let colours = measured.errors.iter().map(|error| match *error {
        error if error > measured.tolerance => ABOVE,
        error => colour((error / measured.tolerance) as f32),
    });
    Sheet::of_pixels(measured.size, colours.map(rgb))
}

/// The colour of a share, as bytes.
pub fn ramp(share: f32) -> [u8; 3] {
    rgb(colour(share))
}

fn rgb(colour: Color32) -> [u8; 3] {
    [colour.r(), colour.g(), colour.b()]
}

/// The colour of an error that is `share` of the tolerance: even steps of the error are even steps
/// of lightness.
pub fn colour(share: f32) -> Color32 {
    let share = share.clamp(0.0, 1.0);
    let lightness = LIGHTNESS[0] + share * (LIGHTNESS[1] - LIGHTNESS[0]);
    // Near black and white, a screen has less colour to give.
    let chroma = CHROMA * 4.0 * (0.1 + 0.8 * share) * (0.9 - 0.8 * share);
    let (sin, cos) = HUE_DEGREES.to_radians().sin_cos();
    let [r, g, b] = from_oklab([lightness, chroma * cos, chroma * sin]).map(srgb_byte);
    Color32::from_rgb(r, g, b)
}

/// Oklab (Ottosson 2020) to linear sRGB.
fn from_oklab([lightness, a, b]: [f32; 3]) -> [f32; 3] {
    let l = (lightness + 0.396_337_78 * a + 0.215_803_76 * b).powi(3);
    let m = (lightness - 0.105_561_346 * a - 0.063_854_17 * b).powi(3);
    let s = (lightness - 0.089_484_18 * a - 1.291_485_5 * b).powi(3);
    [
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_4 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_white() {
        let white = from_oklab([1.0, 0.0, 0.0]);
        assert!(white.iter().all(|channel| (channel - 1.0).abs() < 1e-4), "{white:?}");
    }

    #[test]
    fn larger_errors_are_brighter_and_never_red() {
        let shades: Vec<Color32> = (0..=20).map(|step| colour(step as f32 / 20.0)).collect();
        let sum = |c: &Color32| u32::from(c.r()) + u32::from(c.g()) + u32::from(c.b());
        assert!(shades.windows(2).all(|pair| sum(&pair[0]) < sum(&pair[1])), "{shades:?}");
        assert!(shades.iter().all(|shade| shade.r() <= shade.b()), "{shades:?}");
    }
}
