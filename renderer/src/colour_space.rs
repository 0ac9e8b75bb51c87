//! Colours in the spaces in which colour maps are written down and interpolated.
//!
//! sRGB and linear light are red, green and blue from 0 to 1; Lab is CIELAB with the white of sRGB (D65).

use std::f64::consts::FRAC_PI_3;

/// One channel of sRGB as linear light.
pub fn to_linear(channel: f64) -> f64 {
    if channel <= 0.040_45 { channel / 12.92 } else { ((channel + 0.055) / 1.055).powf(2.4) }
}

/// One channel of linear light as sRGB.
pub fn to_srgb(channel: f64) -> f64 {
    if channel <= 0.003_130_8 { channel * 12.92 } else { 1.055 * channel.powf(1.0 / 2.4) - 0.055 }
}

/// X, Y and Z of white.
const WHITE: [f64; 3] = [0.950_47, 1.0, 1.088_83];
/// Where the cube root of CIELAB gives way to a line.
const EDGE: f64 = 6.0 / 29.0;

/// L, a and b of a colour in sRGB.
pub fn to_lab(srgb: [f64; 3]) -> [f64; 3] {
    let [r, g, b] = srgb.map(to_linear);
    let xyz = [
        0.412_456_4 * r + 0.357_576_1 * g + 0.180_437_5 * b,
        0.212_672_9 * r + 0.715_152_2 * g + 0.072_175_0 * b,
        0.019_333_9 * r + 0.119_192_0 * g + 0.950_304_1 * b,
    ];
    let root = |t: f64| if t > EDGE.powi(3) { t.cbrt() } else { t / (3.0 * EDGE * EDGE) + 4.0 / 29.0 };
    let [x, y, z] = [0, 1, 2].map(|i| root(xyz[i] / WHITE[i]));
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The colour in sRGB of L, a and b; the nearest one in each channel where there is none.
pub fn from_lab([l, a, b]: [f64; 3]) -> [f64; 3] {
    let y = (l + 16.0) / 116.0;
    let power = |t: f64| if t > EDGE { t.powi(3) } else { 3.0 * EDGE * EDGE * (t - 4.0 / 29.0) };
    let roots = [y + a / 500.0, y, y - b / 200.0];
    let [x, y, z] = [0, 1, 2].map(|i| WHITE[i] * power(roots[i]));
    [
        3.240_454_2 * x - 1.537_138_5 * y - 0.498_531_4 * z,
        -0.969_266_0 * x + 1.876_010_8 * y + 0.041_556_0 * z,
        0.055_643_4 * x - 0.204_025_9 * y + 1.057_225_2 * z,
    ]
    .map(|channel| to_srgb(channel.clamp(0.0, 1.0)))
}

/// Polar coordinates of Lab: magnitude, saturation and hue, angles in radians.
#[derive(Clone, Copy)]
struct Msh {
    m: f64,
    s: f64,
    h: f64,
}

impl Msh {
    /// Less saturated than this is grey.
    const GREY: f64 = 0.05;

    fn of(srgb: [f64; 3]) -> Msh {
        let [l, a, b] = to_lab(srgb);
        let m = (l * l + a * a + b * b).sqrt();
        let s = if m > 1e-9 { (l / m).clamp(-1.0, 1.0).acos() } else { 0.0 };
        Msh { m, s, h: b.atan2(a) }
    }

    fn to_srgb(self) -> [f64; 3] {
        let Msh { m, s, h } = self;
        from_lab([m * s.cos(), m * s.sin() * h.cos(), m * s.sin() * h.sin()])
    }

    /// The hue that a grey of magnitude `m` takes on its way to this colour.
    fn hue_towards(self, m: f64) -> f64 {
        if self.m >= m {
            return self.h;
        }
        let spin = self.s * (m * m - self.m * self.m).sqrt() / (self.m * self.s.sin());
        if self.h > -FRAC_PI_3 { self.h + spin } else { self.h - spin }
    }
}

/// Between two colours in sRGB, over white where their hues are far apart: Kenneth Moreland, *Diverging
/// Color Maps for Scientific Visualization* (2009), section 5. `share`: 0 is `from`, 1 is `to`.
pub fn diverging(from: [f64; 3], to: [f64; 3], share: f64) -> [f64; 3] {
    let (mut a, mut b, mut share) = (Msh::of(from), Msh::of(to), share);
    let apart = (a.h - b.h).abs();
    let apart = apart.min(std::f64::consts::TAU - apart);
    if a.s > Msh::GREY && b.s > Msh::GREY && apart > FRAC_PI_3 {
        let white = Msh { m: a.m.max(b.m).max(88.0), s: 0.0, h: 0.0 };
        if share < 0.5 {
            (b, share) = (white, 2.0 * share);
        } else {
            (a, share) = (white, 2.0 * share - 1.0);
        }
    }
    if a.s < Msh::GREY && b.s > Msh::GREY {
        a.h = b.hue_towards(a.m);
    } else if b.s < Msh::GREY && a.s > Msh::GREY {
        b.h = a.hue_towards(b.m);
    }
    let mix = |a: f64, b: f64| a + share * (b - a);
    Msh { m: mix(a.m, b.m), s: mix(a.s, b.s), h: mix(a.h, b.h) }.to_srgb()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: [f64; 3], b: [f64; 3], distance: f64) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < distance)
    }

    #[test]
    fn colours_go_there_and_back() {
        for colour in [[0.0; 3], [1.0; 3], [0.2, 0.7, 0.1], [0.9, 0.01, 0.4]] {
            assert!(near(from_lab(to_lab(colour)), colour, 1e-5), "{colour:?}");
            assert!(near(Msh::of(colour).to_srgb(), colour, 1e-5), "{colour:?}");
            assert!(near(colour.map(to_linear).map(to_srgb), colour, 1e-12), "{colour:?}");
        }
        assert!(near(to_lab([1.0; 3]), [100.0, 0.0, 0.0], 0.01));
    }

    #[test]
    fn diverging_colours_are_those_of_the_paper() {
        let [cool, warm] =
            [[0.229_805_7, 0.298_717_966, 0.753_683_153], [0.705_673_158, 0.015_556_16, 0.150_232_812]];
        // From the table that its author publishes beside the paper.
        for (share, expected) in [
            (0.0, cool),
            (0.25, [0.552_953_156, 0.688_929_332, 0.995_375_608]),
            (0.5, [0.865_395_197, 0.865_395_197, 0.865_395_197]),
            (0.75, [0.958_003_065, 0.602_842_431, 0.481_775_914]),
            (1.0, warm),
        ] {
            let found = diverging(cool, warm, share);
            assert!(near(found, expected, 1e-4), "{share}: {found:?}");
        }
    }
}
