//! Colours in blocks of pixels, to be laid over a picture.

use rayon::prelude::*;
use renderer::{BUNDLE_SIDE, CellMap, column_of};

use super::looks::look;
use super::marks::Mark;

/// An sRGB colour, or none, for each block of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Pixels of the picture that it belongs to.
    size: [u32; 2],
    /// Pixels of a block in x and y.
    side: u32,
    /// Blocks in x.
    across: u32,
    /// Row after row.
    colours: Vec<Option<[u8; 3]>>,
}

impl Sheet {
    /// Marks of bundles: classes in their colours, shares in those of `ramp`.
    pub fn of_marks(map: &CellMap, marks: &[Mark], ramp: impl Fn(f32) -> [u8; 3]) -> Sheet {
        let colour = |mark: &Mark| match *mark {
            Mark::Nothing => None,
            Mark::Class(class) => Some(look(class).rgb),
            Mark::Share(share) => Some(ramp(share)),
        };
        let colours = marks.iter().map(colour).collect();
        Sheet { size: map.size, side: BUNDLE_SIDE, across: map.count[0], colours }
    }

    /// What is charged to the rays of each column, as a share of `tolerance`, in the colours of `ramp`.
    /// Nothing where there are no cells.
    pub fn of_charges(map: &CellMap, tolerance: f64, ramp: impl Fn(f32) -> [u8; 3]) -> Sheet {
        const SIDE: u32 = 2;
        let [across, down] = map.size.map(|side| side.div_ceil(SIDE));
        let colour = |block: u32| {
            let pixel = [block % across * SIDE, block / across * SIDE];
            let bundle = map.bundle(renderer::bundle_of(pixel));
            let charged = f64::from(bundle.charged[column_of(pixel)]);
            (!bundle.cells.is_empty()).then(|| ramp((charged / tolerance) as f32))
        };
        Sheet { size: map.size, side: SIDE, across, colours: (0..across * down).map(colour).collect() }
    }

    /// A colour for each pixel of a picture of that size.
    pub fn of_pixels(size: [u32; 2], colours: impl Iterator<Item = [u8; 3]>) -> Sheet {
        Sheet { size, side: 1, across: size[0], colours: colours.map(Some).collect() }
    }

    /// The colour over a pixel of a picture of `size`, which may be a coarser one of the same view.
    fn at(&self, [x, y]: [usize; 2], size: [usize; 2]) -> Option<[u8; 3]> {
        let block =
            |place: usize, axis: usize| place * self.size[axis] as usize / size[axis] / self.side as usize;
        self.colours[block(y, 1) * self.across as usize + block(x, 0)]
    }

    /// The picture, `width` opaque sRGB pixels a row, with this over it. Below a colour, the picture is
    /// grey: its own colours would make another one of that.
    pub fn over(&self, pixels: &[[u8; 4]], width: usize, opacity: f32) -> Vec<[u8; 4]> {
        let size = [width, pixels.len() / width.max(1)];
        let mut drawn = pixels.to_vec();
        drawn.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                if let Some(colour) = self.at([x, y], size) {
                    let [r, g, b, alpha] = *pixel;
                    let grey = 0.2126 * f32::from(r) + 0.7152 * f32::from(g) + 0.0722 * f32::from(b);
                    let mix = |channel: u8| (grey + opacity * (f32::from(channel) - grey)).round() as u8;
                    let [r, g, b] = colour.map(mix);
                    *pixel = [r, g, b, alpha];
                }
            }
        });
        drawn
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use renderer::{BrickMask, BundleCells, CellClass, MapCell};

    const GREY: fn(f32) -> [u8; 3] = |share| [(255.0 * share) as u8; 3];

    /// Two bundles side by side, the right one empty.
    fn map() -> CellMap {
        let (sampled, coarse) = (BrickMask::default(), BrickMask::default());
        let cell = MapCell { layer: 0, particles: 3, class: CellClass::Mixed, sampled, coarse };
        let charged = std::array::from_fn(|column| column as f32 * 1e-3);
        let bundles = vec![BundleCells { end_layer: 1, charged, cells: vec![cell] }, BundleCells::default()];
        CellMap { size: [12, 8], count: [2, 1], layers: 1, bundles }
    }

    #[test]
    fn marks_cover_their_bundles_and_no_more() {
        let marks = [Mark::Class(CellClass::Mixed), Mark::Nothing];
        let drawn = Sheet::of_marks(&map(), &marks, GREY).over(&[[9, 9, 9, 255]; 96], 12, 1.0);
        let [r, g, b] = look(CellClass::Mixed).rgb;
        assert_eq!([drawn[7], drawn[8], drawn[84 + 7]], [[r, g, b, 255], [9, 9, 9, 255], [r, g, b, 255]]);
    }

    #[test]
    fn charges_are_those_of_each_column() {
        let drawn = Sheet::of_charges(&map(), 0.015, GREY).over(&[[0, 0, 0, 255]; 96], 12, 1.0);
        let at = |x: usize, y: usize| drawn[y * 12 + x][0];
        assert_eq!([at(0, 0), at(2, 1), at(7, 7), at(1, 2)], [0, 17, 255, 34]);
    }

    #[test]
    fn what_lies_below_shows_through_in_grey() {
        let sheet = Sheet::of_pixels([2, 1], [[200, 0, 0], [0; 3]].into_iter());
        let half = sheet.over(&[[0, 100, 0, 255]; 2], 2, 0.5);
        assert_eq!(half, [[136, 36, 36, 255], [36, 36, 36, 255]]);
        // Over a picture twice as coarse, and one twice as fine.
        assert_eq!(sheet.over(&[[0, 0, 0, 255]], 1, 1.0), [[200, 0, 0, 255]]);
        assert_eq!(sheet.over(&[[0, 0, 0, 255]; 8], 4, 1.0)[5], [200, 0, 0, 255]);
    }
}
