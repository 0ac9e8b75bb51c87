//! Colour maps by name: tables of 256 colours (`assets/colour maps`), and those that are computed.

use std::sync::LazyLock;

use crate::colour_space::{diverging, to_linear};

/// What a map is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapKind {
    /// From dark to light, or the other way round.
    Sequential,
    /// Two hues that meet in a pale or dark middle.
    Diverging,
}

/// A colour map.
pub struct ColourMap {
    /// As `transfer.map.name` of `view.json` has it.
    pub name: &'static str,
    pub kind: MapKind,
    /// Linear light, from u = 0 to u = 1 in equal steps, linear in between.
    colours: Vec<[f32; 3]>,
}

/// Entries of a map.
const ENTRIES: usize = 256;

impl ColourMap {
    /// All maps, those of one kind together.
    pub fn all() -> &'static [ColourMap] {
        &MAPS
    }

    pub fn by_name(name: &str) -> Option<&'static ColourMap> {
        MAPS.iter().find(|map| map.name == name)
    }

    pub fn colours(&self) -> &[[f32; 3]] {
        &self.colours
    }

    fn from_table(name: &'static str, kind: MapKind, table: &str) -> ColourMap {
        let numbers = table.split_ascii_whitespace().map(|word| word.parse().expect("a table holds numbers"));
        let channels: Vec<f64> = numbers.collect();
        let colours = channels.as_chunks().0.iter().map(|srgb| linear(*srgb)).collect();
        ColourMap { name, kind, colours }
    }

    fn computed(name: &'static str, kind: MapKind, srgb: impl Fn(f64) -> [f64; 3]) -> ColourMap {
        let colour = |entry: usize| linear(srgb(entry as f64 / (ENTRIES - 1) as f64));
        ColourMap { name, kind, colours: (0..ENTRIES).map(colour).collect() }
    }
}

fn linear(srgb: [f64; 3]) -> [f32; 3] {
    srgb.map(|channel| to_linear(channel.clamp(0.0, 1.0)) as f32)
}

/// Ends of Moreland's map from cool to warm, in sRGB.
const COOL: [f64; 3] = [0.229_805_7, 0.298_717_966, 0.753_683_153];
const WARM: [f64; 3] = [0.705_673_158, 0.015_556_16, 0.150_232_812];

static MAPS: LazyLock<Vec<ColourMap>> = LazyLock::new(|| {
    macro_rules! table {
        ($name:literal, $kind:ident) => {
            ColourMap::from_table(
                $name,
                MapKind::$kind,
                include_str!(concat!("../../assets/colour maps/", $name, ".txt")),
            )
        };
    }
    vec![
        table!("viridis", Sequential),
        table!("cividis", Sequential),
        table!("magma", Sequential),
        table!("inferno", Sequential),
        table!("plasma", Sequential),
        table!("batlow", Sequential),
        table!("lajolla", Sequential),
        table!("oslo", Sequential),
        ColourMap::computed("grey", MapKind::Sequential, |u| [u; 3]),
        ColourMap::computed("cool-warm", MapKind::Diverging, |u| diverging(COOL, WARM, u)),
        table!("vik", Diverging),
        table!("roma", Diverging),
    ]
});

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_map_is_complete() {
        for map in ColourMap::all() {
            assert_eq!(map.colours.len(), ENTRIES, "{}", map.name);
            let valid = map.colours.iter().flatten().all(|channel| (0.0..=1.0).contains(channel));
            assert!(valid, "{}", map.name);
            assert!(std::ptr::eq(ColourMap::by_name(map.name).unwrap(), map));
        }
    }

    /// Lightness as the eye has it, roughly.
    fn lightness([r, g, b]: [f32; 3]) -> f32 {
        (0.2126 * r + 0.7152 * g + 0.0722 * b).cbrt()
    }

    #[test]
    fn sequential_maps_grow_lighter_or_darker_all_along() {
        for map in ColourMap::all().iter().filter(|map| map.kind == MapKind::Sequential) {
            let of: Vec<f32> = map.colours.iter().map(|colour| lightness(*colour)).collect();
            let rises = of[ENTRIES - 1] > of[0];
            // A table's digits make tiny steps back.
            let along = of
                .windows(2)
                .all(|pair| if rises { pair[1] > pair[0] - 2e-3 } else { pair[1] < pair[0] + 2e-3 });
            assert!(along && (of[ENTRIES - 1] - of[0]).abs() > 0.3, "{}", map.name);
        }
    }
}
