//! One mark for each bundle of a picture: its cells, seen at one depth.

use renderer::{BundleCells, CellClass, CellMap};

/// Which cells of the many along a ray are meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Depth {
    /// The first in which anything is to be seen.
    FrontMost,
    /// All of them: how many are of this class.
    Share(CellClass),
    /// Those of one layer.
    Layer(u32),
}

/// What is shown of a bundle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mark {
    /// No cell holds a particle.
    Nothing,
    Class(CellClass),
    /// Share of the bundle's filled cells, 0 to 1.
    Share(f32),
}

impl Mark {
    /// What `depth` shows of a bundle.
    pub fn new(bundle: &BundleCells, depth: Depth) -> Mark {
        let cells = &bundle.cells;
        match depth {
            _ if cells.is_empty() => Mark::Nothing,
            Depth::FrontMost => {
                let seen = cells.iter().find(|cell| cell.class != CellClass::Transparent);
                Mark::Class(seen.map_or(CellClass::Transparent, |cell| cell.class))
            }
            Depth::Share(class) => {
                let count = cells.iter().filter(|cell| cell.class == class).count();
                Mark::Share(count as f32 / cells.len() as f32)
            }
            Depth::Layer(layer) => match cells.binary_search_by_key(&layer, |cell| cell.layer) {
                Ok(place) => Mark::Class(cells[place].class),
                Err(_) => Mark::Nothing,
            },
        }
    }

    /// Of all bundles, row after row.
    pub fn all(map: &CellMap, depth: Depth) -> Vec<Mark> {
        map.bundles.iter().map(|bundle| Mark::new(bundle, depth)).collect()
    }
}

/// Bundles by the class that they are marked with, in the order of [`CellClass::ALL`].
pub fn counts(marks: &[Mark]) -> [u64; CellClass::ALL.len()] {
    let mut counts = [0; CellClass::ALL.len()];
    for mark in marks {
        if let Mark::Class(class) = mark {
            counts[class.index()] += 1;
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use renderer::{BrickMask, MapCell};

    fn bundle(classes: &[(u32, CellClass)]) -> BundleCells {
        let cell = |&(layer, class)| {
            let (sampled, coarse) = (BrickMask::default(), BrickMask::default());
            MapCell { layer, particles: 1, class, sampled, coarse }
        };
        BundleCells { cells: classes.iter().map(cell).collect(), ..BundleCells::default() }
    }

    #[test]
    fn a_bundle_is_seen_from_the_front_along_the_ray_and_in_a_slice() {
        use CellClass::{Full, Mixed, Transparent};
        let bundle = bundle(&[(3, Transparent), (5, Mixed), (6, Full), (9, Mixed)]);
        assert_eq!(Mark::new(&bundle, Depth::FrontMost), Mark::Class(Mixed));
        assert_eq!(Mark::new(&bundle, Depth::Share(Mixed)), Mark::Share(0.5));
        assert_eq!(Mark::new(&bundle, Depth::Share(CellClass::Occluded)), Mark::Share(0.0));
        let layers = [3, 4, 6].map(|layer| Mark::new(&bundle, Depth::Layer(layer)));
        assert_eq!(layers, [Mark::Class(Transparent), Mark::Nothing, Mark::Class(Full)]);
        assert_eq!(counts(&layers)[Full.index()], 1);
    }

    #[test]
    fn where_nothing_is_nothing_is_marked() {
        let clear = bundle(&[(1, CellClass::Transparent)]);
        assert_eq!(Mark::new(&clear, Depth::FrontMost), Mark::Class(CellClass::Transparent));
        for depth in [Depth::FrontMost, Depth::Share(CellClass::Full), Depth::Layer(1)] {
            assert_eq!(Mark::new(&BundleCells::default(), depth), Mark::Nothing);
        }
    }
}
