//! Simple shapes that the window and a raster of pixels draw alike.

use renderer::Ink;

/// What is drawn over a picture, from back to front. Places and lengths are in pixels of the picture,
/// from its upper left corner; colours are sRGB with straight alpha.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    pub shapes: Vec<Shape>,
    pub sheet: Sheet,
    palette: Palette,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One line of text; `align` is the share of its size that lies before `at`.
    Text { at: [f32; 2], align: [f32; 2], size: f32, text: String, colour: [u8; 4] },
    /// A stroke with straight ends.
    Line { from: [f32; 2], to: [f32; 2], width: f32, colour: [u8; 4] },
    /// A rectangle whose colours run, evenly spaced, from its lower end to its upper one.
    Gradient { min: [f32; 2], max: [f32; 2], colours: Vec<[u8; 3]> },
    /// What lies between the left side of a rectangle and a curve, which goes through these shares of its width,
    /// evenly spaced from its lower end to its upper one.
    Area { min: [f32; 2], max: [f32; 2], shares: Vec<f32>, colour: [u8; 4] },
}

/// The picture's size in pixels, and the size of its letters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    pub width: f32,
    pub height: f32,
    /// Size of letters in pixels; all else is in proportion.
    pub em: f32,
}

impl Sheet {
    /// Letters are a share of the picture's shorter side, so that pictures of all sizes look alike.
    const LETTER: f32 = 1.0 / 48.0;
    /// Smallest and largest letters, in pixels.
    const LIMITS: [f32; 2] = [11.0, 400.0];

    pub fn new([width, height]: [f32; 2], factor: f32) -> Sheet {
        let [least, most] = Sheet::LIMITS;
        let em = (width.min(height) * Sheet::LETTER).max(least) * factor;
        Sheet { width, height, em: em.min(most) }
    }
}

/// Alignment in one direction.
pub const START: f32 = 0.0;
pub const MIDDLE: f32 = 0.5;
pub const END: f32 = 1.0;

/// Colours that can be read on a light or a dark ground; with a halo of the opposite, on any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palette {
    pub letters: [u8; 4],
    halo: [u8; 4],
    /// Of X, Y and Z.
    pub axes: [[u8; 4]; 3],
}

impl Palette {
    const LIGHT: Palette = Palette {
        letters: [0xf2, 0xf4, 0xf6, 0xff],
        halo: [0x08, 0x0a, 0x0c, 0x60],
        axes: [[0xff, 0x7b, 0x70, 0xff], [0x85, 0xd6, 0x74, 0xff], [0x6d, 0xae, 0xff, 0xff]],
    };
    const DARK: Palette = Palette {
        letters: [0x12, 0x15, 0x19, 0xff],
        halo: [0xff, 0xff, 0xff, 0x60],
        axes: [[0xb8, 0x22, 0x1a, 0xff], [0x1d, 0x74, 0x1c, 0xff], [0x1a, 0x4f, 0xc0, 0xff]],
    };

    /// The palette of `ink` on a background in linear light.
    pub fn new(ink: Ink, background: Option<[f32; 3]>) -> Palette {
        let [r, g, b] = background.unwrap_or_default();
        // Above this luminance, dark letters have the greater contrast (WCAG 2).
        let light_ground = 0.2126 * r + 0.7152 * g + 0.0722 * b > 0.179;
        match ink {
            Ink::Dark => Palette::DARK,
            Ink::Automatic if light_ground => Palette::DARK,
            Ink::Light | Ink::Automatic => Palette::LIGHT,
        }
    }
}

/// Directions in which the halo of a letter is drawn.
const AROUND: [[f32; 2]; 8] = [
    [1.0, 0.0],
    [-1.0, 0.0],
    [0.0, 1.0],
    [0.0, -1.0],
    [0.71, 0.71],
    [-0.71, 0.71],
    [0.71, -0.71],
    [-0.71, -0.71],
];

impl Drawing {
    pub fn new(sheet: Sheet, palette: Palette) -> Drawing {
        Drawing { shapes: Vec::new(), sheet, palette }
    }

    pub fn palette(&self) -> Palette {
        self.palette
    }

    /// Width of the halo around letters and lines, in pixels.
    fn halo(&self) -> f32 {
        (self.sheet.em / 14.0).max(1.0)
    }

    /// A line of text in letters `size` times the usual, with a halo.
    pub fn text(&mut self, at: [f32; 2], align: [f32; 2], size: f32, text: &str, colour: [u8; 4]) {
        let (halo, size) = (self.halo(), size * self.sheet.em);
        let text_at = |at, colour| Shape::Text { at, align, size, text: text.to_owned(), colour };
        let ground = self.palette.halo;
        let around = AROUND.map(|[x, y]| text_at([at[0] + halo * x, at[1] + halo * y], ground));
        self.shapes.extend(around);
        self.shapes.push(text_at(at, colour));
    }

    /// A stroke `width` times the usual, with a halo.
    pub fn line(&mut self, from: [f32; 2], to: [f32; 2], width: f32, colour: [u8; 4]) {
        let width = width * (self.sheet.em / 8.0).max(1.0);
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        let stretch = 0.7 * self.halo() / x.hypot(y).max(f32::MIN_POSITIVE);
        let beyond = [stretch * x, stretch * y];
        let [r, g, b, _] = self.palette.halo;
        self.shapes.push(Shape::Line {
            from: [from[0] - beyond[0], from[1] - beyond[1]],
            to: [to[0] + beyond[0], to[1] + beyond[1]],
            width: width + 1.4 * self.halo(),
            colour: [r, g, b, 0xa0],
        });
        self.shapes.push(Shape::Line { from, to, width, colour });
    }

    /// A rectangle of colours with a thin edge.
    pub fn gradient(&mut self, min: [f32; 2], max: [f32; 2], colours: Vec<[u8; 3]>) {
        self.edge(min, max);
        self.shapes.push(Shape::Gradient { min, max, colours });
    }

    /// What lies left of a curve, on a ground with a thin edge.
    pub fn area(&mut self, min: [f32; 2], max: [f32; 2], shares: Vec<f32>) {
        self.edge(min, max);
        let [r, g, b, _] = self.palette.halo;
        self.shapes.push(Shape::Area { min, max, shares: vec![1.0; 2], colour: [r, g, b, 0x90] });
        let [r, g, b, _] = self.palette.letters;
        self.shapes.push(Shape::Area { min, max, shares, colour: [r, g, b, 0xd0] });
    }

    fn edge(&mut self, min: [f32; 2], max: [f32; 2]) {
        let edge = 0.5 * (self.sheet.em / 10.0).max(1.0);
        let [r, g, b, _] = self.palette.halo;
        let [left, top, right, bottom] = [min[0] - edge, min[1] - edge, max[0] + edge, max[1] + edge];
        for (from, to) in [
            ([left - edge, top], [right + edge, top]),
            ([left - edge, bottom], [right + edge, bottom]),
            ([left, top + edge], [left, bottom - edge]),
            ([right, top + edge], [right, bottom - edge]),
        ] {
            self.shapes.push(Shape::Line { from, to, width: 2.0 * edge, colour: [r, g, b, 0xb0] });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_grow_with_the_picture() {
        let em = |size| Sheet::new(size, 1.0).em;
        assert_eq!(em([3840.0, 2160.0]) / em([1920.0, 1080.0]), 2.0);
        assert_eq!(em([1080.0, 1920.0]), em([1920.0, 1080.0]));
        assert!(em([64.0, 64.0]) >= 11.0 && em([32768.0; 2]) <= 400.0);
    }

    #[test]
    fn letters_stand_out_from_the_background() {
        let letters = |ink, background| Palette::new(ink, background).letters;
        assert_eq!(letters(Ink::Automatic, None), Palette::LIGHT.letters);
        assert_eq!(letters(Ink::Automatic, Some([0.0, 0.0, 1.0])), Palette::LIGHT.letters);
        assert_eq!(letters(Ink::Automatic, Some([0.3, 0.3, 0.3])), Palette::DARK.letters);
        assert_eq!(letters(Ink::Light, Some([1.0; 3])), Palette::LIGHT.letters);
    }
}
