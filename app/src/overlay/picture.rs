//! The classes of the cells over a picture, as a picture.

use renderer::{CellMap, bundle_of};

use super::legend::Legend;
use super::lettering::Lettering;
use super::looks::look;
use super::marks::{Depth, Mark};
use super::{OPACITY, counts};
use crate::image_file::{Pixels, to_linear, to_srgb};

/// The picture with the class of each bundle's front-most visible cell over it, and a legend in the
/// lower left corner where there is room.
pub fn drawn_over(picture: &Pixels, map: &CellMap, lettering: &mut Lettering) -> Pixels {
    let mut drawn = picture.clone();
    let marks = Mark::all(map, Depth::FrontMost);
    let width = drawn.width;
    for (index, pixel) in (0..).zip(&mut drawn.data) {
        let [x, y] = bundle_of([index % width, index / width]);
        if let Mark::Class(class) = marks[(y * map.count[0] + x) as usize] {
            to_grey(pixel);
            cover(pixel, look(class).rgb, OPACITY);
        }
    }
    Legend::new(&counts(&marks), lettering, [drawn.width, drawn.height]).draw(&mut drawn);
    drawn
}

/// Puts an sRGB colour over a pixel that is premultiplied linear light. They mix as they do on a screen,
/// and in the viewer: in sRGB.
pub fn cover(pixel: &mut [f32; 4], rgb: [u8; 3], opacity: f32) {
    let mix = |below: f32, above: f32| below + opacity * (above - below);
    let [r, g, b, alpha] = pixel;
    for (below, above) in [r, g, b].into_iter().zip(rgb) {
        *below = to_linear(mix(to_srgb(*below), f32::from(above) / 255.0));
    }
    *alpha = mix(*alpha, 1.0);
}

/// Takes away a pixel's own colour, which would make another one of that over it.
fn to_grey([r, g, b, _]: &mut [f32; 4]) {
    let luminance = 0.2126 * *r + 0.7152 * *g + 0.0722 * *b;
    (*r, *g, *b) = (luminance, luminance, luminance);
}

#[cfg(test)]
mod tests {
    use super::*;
    use renderer::{BrickMask, BundleCells, CellClass, MapCell};

    /// Two bundles side by side, of which the right one is empty.
    fn map(class: CellClass) -> CellMap {
        let (sampled, coarse) = (BrickMask::default(), BrickMask::default());
        let cell = MapCell { layer: 2, particles: 3, class, sampled, coarse };
        let bundles = vec![BundleCells { cells: vec![cell], ..Default::default() }, BundleCells::default()];
        CellMap { size: [12, 8], count: [2, 1], layers: 4, bundles }
    }

    #[test]
    fn a_bundle_has_the_colour_of_its_cell_and_no_bundle_none() {
        let picture = Pixels { width: 12, height: 8, data: vec![[0.4, 0.1, 0.1, 0.5]; 96] };
        let drawn = drawn_over(&picture, &map(CellClass::Full), &mut Lettering::default());
        let mut expected = [0.163_78, 0.163_78, 0.163_78, 0.5];
        cover(&mut expected, look(CellClass::Full).rgb, OPACITY);
        for (index, pixel) in drawn.data.iter().enumerate() {
            let covered = index % 12 < 8;
            let expected = if covered { expected } else { picture.data[0] };
            let off = pixel.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(off < 1e-5, "{index}: {pixel:?}");
        }
        assert!(expected[0] > 0.4 && expected[3] > 0.8, "{expected:?}");
    }

    #[test]
    fn a_large_picture_has_a_legend_in_its_corner() {
        let (width, height) = (400, 300);
        let picture = Pixels { width, height, data: vec![[0.0; 4]; (width * height) as usize] };
        let count = [50, 38];
        let empty =
            CellMap { size: [width, height], count, layers: 4, bundles: vec![Default::default(); 1900] };
        let mut full = empty.clone();
        full.bundles.fill(map(CellClass::Full).bundles[0].clone());
        let mut lettering = Lettering::default();
        assert_eq!(drawn_over(&picture, &empty, &mut lettering), picture, "nothing to explain");
        let drawn = drawn_over(&picture, &full, &mut lettering);
        let bright = |pixel: &&[f32; 4]| pixel[..3].iter().all(|channel| *channel > 0.7);
        let letters = drawn.data.iter().filter(bright).count();
        assert!(letters > 50, "{letters} pixels of letters");
        assert_eq!((drawn.width, drawn.height), (width, height));
        let above = &drawn.data[..(width * height / 2) as usize];
        assert!(above.iter().all(|pixel| *pixel == above[0]), "it is below");
    }
}
