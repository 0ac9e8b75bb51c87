//! A drawing as pixels.

use crate::overlay::{Lettering, Line as Letters};

use super::drawing::{Drawing, Shape};

/// Calls `cover` for each pixel (x, y) of a picture of `width` × `height` that the drawing covers, from
/// back to front, with an sRGB colour and an opacity above 0 and up to 1.
pub fn raster(drawing: &Drawing, size: [usize; 2], mut cover: impl FnMut([usize; 2], [u8; 3], f32)) {
    let mut lettering = Lettering::default();
    // The same text is drawn several times for its halo.
    let mut last: Option<(&str, f32, Letters)> = None;
    for shape in &drawing.shapes {
        match shape {
            Shape::Text { at, align, size: letter, text, colour } => {
                if last.as_ref().is_none_or(|(known, of, _)| known != text || of != letter) {
                    last = Some((text, *letter, lettering.line(text, *letter)));
                }
                if let Some((_, _, line)) = &last {
                    write(line, *at, *align, size, |place, share| paint(&mut cover, place, *colour, share));
                }
            }
            Shape::Line { from, to, width, colour } => {
                stroke(*from, *to, *width, size, |place, share| paint(&mut cover, place, *colour, share));
            }
            Shape::Gradient { min, max, colours } => fill(*min, *max, size, |place, up| {
                cover(place, at(colours, up), 1.0);
            }),
            Shape::Area { min, max, shares, colour } => fill(*min, *max, size, |place, up| {
                let end = min[0] + share_at(shares, up) * (max[0] - min[0]);
                paint(&mut cover, place, *colour, (end - place[0] as f32).clamp(0.0, 1.0));
            }),
        }
    }
}

fn paint(
    cover: &mut impl FnMut([usize; 2], [u8; 3], f32),
    place: [usize; 2],
    [r, g, b, alpha]: [u8; 4],
    share: f32,
) {
    let opacity = share * f32::from(alpha) / 255.0;
    if opacity > 0.0 {
        cover(place, [r, g, b], opacity);
    }
}

/// The pixels that letters cover, and how much of each.
fn write(
    line: &Letters,
    at: [f32; 2],
    align: [f32; 2],
    [width, height]: [usize; 2],
    mut cover: impl FnMut([usize; 2], f32),
) {
    let left = (at[0] - align[0] * line.width as f32).round() as i64;
    let top = (at[1] - align[1] * line.height as f32).round() as i64;
    for (index, share) in line.cover.iter().enumerate().filter(|(_, share)| **share > 0.0) {
        let x = left + (index % line.width) as i64;
        let y = top + (index / line.width) as i64;
        if (0..width as i64).contains(&x) && (0..height as i64).contains(&y) {
            cover([x as usize, y as usize], *share);
        }
    }
}

/// The pixels of a stroke. At its edges a pixel is covered by as much as the stroke reaches beyond its
/// near side.
fn stroke(
    from: [f32; 2],
    to: [f32; 2],
    width: f32,
    size: [usize; 2],
    mut cover: impl FnMut([usize; 2], f32),
) {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    let along = along.map(|part| part / length.max(f32::MIN_POSITIVE));
    let reach = 0.5 * width + 1.0;
    let [columns, rows] = [0, 1].map(|axis| {
        let (low, high) = (from[axis].min(to[axis]) - reach, from[axis].max(to[axis]) + reach);
        let within = |place: f32| place.clamp(0.0, size[axis] as f32) as usize;
        within(low.floor())..within(high.ceil())
    });
    for y in rows {
        for x in columns.clone() {
            let to_here = [x as f32 + 0.5 - from[0], y as f32 + 0.5 - from[1]];
            let forward = to_here[0] * along[0] + to_here[1] * along[1];
            let aside = (to_here[1] * along[0] - to_here[0] * along[1]).abs();
            let across = (0.5 * width - aside + 0.5).clamp(0.0, width.min(1.0));
            let share = across * (forward + 0.5).clamp(0.0, 1.0) * (length - forward + 0.5).clamp(0.0, 1.0);
            if share > 0.0 {
                cover([x, y], share);
            }
        }
    }
}

/// The pixels whose centres lie in a rectangle, and their height in it, 0 at its lower end to 1.
fn fill(min: [f32; 2], max: [f32; 2], size: [usize; 2], mut cover: impl FnMut([usize; 2], f32)) {
    let [columns, rows] = [0, 1].map(|axis| {
        let within = |place: f32| place.round().clamp(0.0, size[axis] as f32) as usize;
        within(min[axis])..within(max[axis])
    });
    for y in rows {
        let up = ((max[1] - y as f32 - 0.5) / (max[1] - min[1])).clamp(0.0, 1.0);
        columns.clone().for_each(|x| cover([x, y], up));
    }
}

/// The value at a share of the way from the first of `shares` to the last.
fn share_at(shares: &[f32], up: f32) -> f32 {
    let last = shares.len().saturating_sub(1);
    let place = up * last as f32;
    let below = (place as usize).min(last.saturating_sub(1));
    match (shares.get(below), shares.get(below + 1)) {
        (Some(low), Some(high)) => low + (place - below as f32) * (high - low),
        (Some(only), None) => *only,
        _ => 0.0,
    }
}

/// The colour at a share of the way from the first of `colours` to the last.
fn at(colours: &[[u8; 3]], share: f32) -> [u8; 3] {
    let last = colours.len().saturating_sub(1);
    let place = share * last as f32;
    let below = (place as usize).min(last.saturating_sub(1));
    let mix =
        |a: u8, b: u8| (f32::from(a) + (place - below as f32) * (f32::from(b) - f32::from(a))).round() as u8;
    match (colours.get(below), colours.get(below + 1)) {
        (Some(low), Some(high)) => std::array::from_fn(|c| mix(low[c], high[c])),
        (Some(only), None) => *only,
        _ => [0; 3],
    }
}

#[cfg(test)]
mod tests {
    use renderer::Ink;

    use super::*;
    use crate::annotate::drawing::{Palette, Sheet};

    /// How much of each pixel of 8 × 6 a stroke covers.
    fn covered(from: [f32; 2], to: [f32; 2], width: f32) -> [[f32; 8]; 6] {
        let mut shares = [[0.0; 8]; 6];
        stroke(from, to, width, [8, 6], |[x, y], share| shares[y][x] = share);
        shares
    }

    #[test]
    fn a_stroke_covers_its_length_times_its_width() {
        for (from, to, width) in
            [([1.0, 3.0], [6.0, 3.0], 2.0), ([2.0, 1.0], [5.5, 4.0], 1.0), ([3.5, 1.0], [3.5, 5.0], 1.0)]
        {
            let area: f32 = covered(from, to, width).as_flattened().iter().sum();
            let expected = width * (to[0] - from[0]).hypot(to[1] - from[1]);
            assert!((area / expected - 1.0).abs() < 0.12, "{from:?} {to:?}: {area} and not {expected}");
        }
        // What lies outside the picture is left out.
        assert_eq!(covered([-9.0, 2.5], [99.0, 2.5], 1.0)[2], [1.0; 8]);
    }

    #[test]
    fn an_area_ends_at_its_curve() {
        let mut drawing = Drawing::new(Sheet::new([8.0, 4.0], 1.0), Palette::new(Ink::Light, None));
        let (min, max, colour) = ([1.0, 0.0], [7.0, 4.0], [9, 9, 9, 255]);
        drawing.shapes.push(Shape::Area { min, max, shares: vec![0.0, 1.0], colour });
        let mut covered = [[0.0; 8]; 4];
        raster(&drawing, [8, 4], |[x, y], _, share| covered[y][x] = share);
        let rows = covered.map(|row| row.iter().sum::<f32>());
        assert_eq!(rows, [5.25, 3.75, 2.25, 0.75]);
        assert_eq!((covered[0][0], covered[0][1], covered[0][6], covered[0][7]), (0.0, 1.0, 0.25, 0.0));
    }

    #[test]
    fn a_gradient_runs_from_below_to_above() {
        let mut rows = [[9; 3]; 4];
        let colours = [[0, 0, 0], [80, 80, 160]];
        fill([0.0, 0.0], [2.0, 4.0], [2, 4], |[_, y], up| rows[y] = at(&colours, up));
        assert_eq!(rows, [[70, 70, 140], [50, 50, 100], [30, 30, 60], [10, 10, 20]]);
    }
}
