//! What the colours of a class picture mean, in its corner.

use renderer::CellClass;

use super::lettering::{Lettering, Line};
use super::looks::look;
use super::picture::cover;
use crate::image_file::Pixels;

/// Classes in view, each with its colour, its name, and its share of what is covered.
#[derive(Default)]
pub struct Legend {
    entries: Vec<([u8; 3], Line)>,
    /// Size of the letters, in pixels; all else is in proportion.
    size: usize,
}

/// Letters are a fortieth of the picture's height, within these.
const SIZES: [usize; 2] = [11, 26];
/// Ground behind the letters: its colour and opacity.
const GROUND: ([u8; 3], f32) = ([0x11, 0x13, 0x16], 0.85);
const INK: [u8; 3] = [0xee; 3];

impl Legend {
    /// `counts`: bundles by class. A picture without room for it has none.
    pub fn new(
        counts: &[u64; CellClass::ALL.len()],
        lettering: &mut Lettering,
        [width, height]: [u32; 2],
    ) -> Legend {
        let size = (height as usize / 40).clamp(SIZES[0], SIZES[1]);
        let all = counts.iter().sum::<u64>().max(1) as f64;
        let in_view = CellClass::ALL.into_iter().zip(counts).filter(|(_, count)| **count > 0);
        let entries = in_view.map(|(class, count)| {
            let look = look(class);
            let text = format!("{}  {}", look.name, percent(*count as f64 / all));
            (look.rgb, lettering.line(&text, size as f32))
        });
        let legend = Legend { entries: entries.collect(), size };
        let [across, down] = legend.extent();
        let room = |side: u32| side as usize * 3 / 5;
        if across <= room(width) && down <= room(height) { legend } else { Legend::default() }
    }

    /// Width and height, in pixels.
    fn extent(&self) -> [usize; 2] {
        let widest = self.entries.iter().map(|(_, line)| line.width).max().unwrap_or(0);
        [widest + 3 * self.size, self.entries.len() * self.step() + self.size]
    }

    fn step(&self) -> usize {
        self.size * 3 / 2
    }

    pub fn draw(&self, picture: &mut Pixels) {
        if self.entries.is_empty() {
            return;
        }
        let [across, down] = self.extent();
        let (left, top) = (self.size, picture.height as usize - self.size - down);
        fill(picture, [left, top, across, down], GROUND);
        for (row, (colour, line)) in self.entries.iter().enumerate() {
            let middle = top + self.size / 2 + row * self.step() + self.step() / 2;
            let swatch = [left + self.size / 2, middle - self.size / 2, self.size, self.size];
            fill(picture, swatch, (*colour, 1.0));
            let corner = [left + self.size * 2, middle - line.height / 2];
            for (index, &share) in line.cover.iter().enumerate() {
                let [x, y] = [corner[0] + index % line.width, corner[1] + index / line.width];
                cover(&mut picture.data[y * picture.width as usize + x], INK, share);
            }
        }
    }
}

/// Covers x, y, width, height of a picture.
fn fill(picture: &mut Pixels, [x, y, width, height]: [usize; 4], (colour, opacity): ([u8; 3], f32)) {
    for row in picture.data.chunks_mut(picture.width as usize).skip(y).take(height) {
        row[x..x + width].iter_mut().for_each(|pixel| cover(pixel, colour, opacity));
    }
}

fn percent(share: f64) -> String {
    if share < 0.001 { "< 0.1 %".into() } else { format!("{:.1} %", 100.0 * share) }
}
