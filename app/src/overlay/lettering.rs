//! Text as pixels, in the window's own letters.

use egui::FontId;
use egui::epaint::text::{FontDefinitions, Fonts, TextOptions};
use egui::{Color32, epaint::Vertex};

/// Side of the picture that the letters are kept in: there is room for those of the largest pictures.
const ATLAS: usize = 8192;

/// Letters, made when they are first needed.
#[derive(Default)]
pub struct Lettering {
    fonts: Option<Fonts>,
}

/// A line of text: how much of each pixel it covers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    pub width: usize,
    pub height: usize,
    /// 0 to 1, row after row.
    pub cover: Vec<f32>,
}

impl Lettering {
    /// `text` in letters of `size` pixels.
    pub fn line(&mut self, text: &str, size: f32) -> Line {
        let options = TextOptions { max_texture_side: ATLAS, ..TextOptions::default() };
        let fonts = self.fonts.get_or_insert_with(|| Fonts::new(options, FontDefinitions::default()));
        let mut view = fonts.with_pixels_per_point(1.0);
        let galley = view.layout_no_wrap(text.to_owned(), FontId::proportional(size), Color32::WHITE);
        let atlas = view.image();
        let [width, height] = [galley.size().x, galley.size().y].map(|side| side.ceil() as usize);
        let mut line = Line { width, height, cover: vec![0.0; width * height] };
        for row in &galley.rows {
            // A letter is a quad: left top, right top, left bottom, right bottom.
            for letter in row.visuals.mesh.vertices.chunks_exact(4) {
                line.stamp(letter, row.pos.to_vec2(), &atlas);
            }
        }
        line
    }
}

impl Line {
    /// Copies a letter from the atlas to its place.
    fn stamp(&mut self, letter: &[Vertex], offset: egui::Vec2, atlas: &egui::ColorImage) {
        let place = letter[0].pos + offset;
        let [left, top] = [place.x, place.y].map(|place| place.round() as i64);
        let [first, last] = [letter[0].uv, letter[3].uv].map(|uv| [uv.x, uv.y].map(|t| t.round() as usize));
        for (y, v) in (top..).zip(first[1]..last[1].min(atlas.height())) {
            for (x, u) in (left..).zip(first[0]..last[0].min(atlas.width())) {
                let inside = (0..self.width as i64).contains(&x) && (0..self.height as i64).contains(&y);
                if inside {
                    let cover = f32::from(atlas[(u, v)].a()) / 255.0;
                    let pixel = &mut self.cover[y as usize * self.width + x as usize];
                    *pixel = pixel.max(cover);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_have_their_shape() {
        let mut lettering = Lettering::default();
        let line = lettering.line("l -", 20.0);
        assert!(line.width > 8 && line.height >= 18, "{} x {}", line.width, line.height);
        let column = |x: usize| (0..line.height).map(|y| line.cover[y * line.width + x]).sum::<f32>();
        let stem = (0..line.width / 2).map(column).fold(0.0, f32::max);
        let dash = (line.width - 4..line.width).map(column).fold(0.0, f32::max);
        assert!(stem > 10.0 && dash > 0.5 && dash < 5.0, "stem {stem}, dash {dash}");
        assert_eq!(lettering.line("l -", 20.0), line);
    }
}
