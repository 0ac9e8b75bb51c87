//! From the renderer's picture to what a screen shows.

use rayon::prelude::*;

/// What is shown behind a picture without a background: dark and neutral, linear light.
pub const BACKDROP: [f32; 3] = [0.0052, 0.0058, 0.0070];

/// Premultiplied linear RGBA over an opaque background, as opaque sRGB bytes.
pub fn to_screen(pixels: &[[f32; 4]], background: Option<[f32; 3]>) -> Vec<[u8; 4]> {
    let behind = background.unwrap_or(BACKDROP);
    let shown = |&[r, g, b, alpha]: &[f32; 4]| {
        let over = |colour: f32, c: usize| srgb_byte(colour + (1.0 - alpha) * behind[c]);
        [over(r, 0), over(g, 1), over(b, 2), 255]
    };
    pixels.par_iter().map(shown).collect()
}

/// The sRGB transfer curve (IEC 61966-2-1), in bytes.
pub fn srgb_byte(linear: f32) -> u8 {
    let linear = linear.clamp(0.0, 1.0);
    let curved = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    // A value that is not a number becomes 0 in the cast.
    (255.0 * curved + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_background_shows_through() {
        let clear = [0.0, 0.0, 0.0, 0.0];
        let half = [0.5, 0.0, 0.0, 0.5];
        let shown = to_screen(&[clear, half], Some([0.0, 1.0, 0.0]));
        assert_eq!(shown[0], [0, 255, 0, 255]);
        assert_eq!(shown[1], [188, 188, 0, 255]);
    }

    #[test]
    fn no_value_is_out_of_range() {
        let shown = to_screen(&[[f32::NAN, 7.0, -3.0, 1.0]], None);
        assert_eq!(shown[0], [0, 255, 0, 255]);
    }
}
