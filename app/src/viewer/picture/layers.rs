//! The picture that the renderer drew and what lies over it, put together for the screen.

use std::sync::Arc;

use renderer::{CellClass, CellMap};

use crate::overlay::{Mark, Sheet, counts};

use crate::viewer::picture::error_map;
use crate::viewer::picture::overlay::{Kind, Overlay, Which};
use crate::viewer::render_thread::Shown;

/// Picture and overlay belong together: the cells came with the picture.
#[derive(Default)]
pub struct Layers {
    picture: Option<Drawn>,
    cells: Option<Arc<CellMap>>,
    /// Of the errors that are charged; `None` at full sampling.
    tolerance: Option<f64>,
    /// The measured errors of this picture.
    errors: Option<Sheet>,
    /// What was last put together; `None` where something came since.
    done: Option<Overlay>,
    /// Bundles by the class that covers them.
    covered: [u64; CellClass::ALL.len()],
}

/// Opaque sRGB pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    pub size: [usize; 2],
    /// What the full size was divided by.
    pub divisor: u32,
    pub pixels: Vec<[u8; 4]>,
}

impl Layers {
    /// Takes a new picture with its cells.
    pub fn set(&mut self, shown: Shown) {
        let Shown { width, height, pixels, divisor, cells, sampling, .. } = shown;
        let size = [width as usize, height as usize];
        self.picture = Some(Drawn { size, divisor, pixels });
        (self.cells, self.tolerance, self.done) = (cells, sampling.tolerance, None);
    }

    /// Takes the errors of the picture, or forgets them when it is no longer in view.
    pub fn set_errors(&mut self, errors: Option<Sheet>) {
        if self.errors.is_some() || errors.is_some() {
            (self.errors, self.done) = (errors, None);
        }
    }

    /// What is to be seen, where that is something else than before.
    pub fn refresh(&mut self, overlay: &Overlay) -> Option<Drawn> {
        if self.done.as_ref() == Some(overlay) {
            return None;
        }
        let sheet = self.sheet(overlay);
        let Drawn { size, divisor, pixels } = self.picture.as_ref()?;
        self.done = Some(*overlay);
        let pixels = match sheet {
            Some(sheet) => sheet.over(pixels, size[0], overlay.opacity()),
            None => pixels.clone(),
        };
        Some(Drawn { size: *size, divisor: *divisor, pixels })
    }

    fn sheet(&mut self, overlay: &Overlay) -> Option<Sheet> {
        let cells = self.cells.as_ref();
        match overlay.kind {
            Kind::Off => None,
            Kind::Classes => cells.map(|cells| {
                let marks = Mark::all(cells, overlay.depth(cells.layers));
                self.covered = counts(&marks);
                Sheet::of_marks(cells, &marks, error_map::ramp)
            }),
            Kind::Predicted => {
                cells.map(|cells| Sheet::of_charges(cells, self.tolerance.unwrap_or(1.0), error_map::ramp))
            }
            Kind::Measured => self.errors.clone(),
        }
    }

    /// Whether the overlay that is asked for is in view.
    pub fn is_over(&self, overlay: &Overlay) -> bool {
        match overlay.kind {
            Kind::Off => false,
            Kind::Classes | Kind::Predicted => self.cells.is_some(),
            Kind::Measured => self.errors.is_some(),
        }
    }

    /// Bundles by the class that covers them, where classes do.
    pub fn covered(&self, overlay: &Overlay) -> Option<&[u64; CellClass::ALL.len()]> {
        let by_class = overlay.kind == Kind::Classes && overlay.which != Which::Share;
        (by_class && self.is_over(overlay)).then_some(&self.covered)
    }

    /// The tolerance of the picture in view.
    pub fn tolerance(&self) -> Option<f64> {
        self.tolerance
    }
}

#[cfg(test)]
mod tests {
    use renderer::{BrickMask, BundleCells, MapCell, SamplingView, Stats};

    use super::*;
    use crate::viewer::render_thread::prepare::Facts;

    /// A picture of one bundle, grey, in which there is one cell.
    fn shown(cells: bool) -> Shown {
        let (sampled, coarse) = (BrickMask::default(), BrickMask::default());
        let cell = MapCell { layer: 0, particles: 1, class: CellClass::Full, sampled, coarse };
        let bundles = vec![BundleCells { end_layer: 1, charged: [0.004; 16], cells: vec![cell] }];
        let map = CellMap { size: [8, 8], count: [1, 1], layers: 1, bundles };
        Shown {
            index: 0,
            numbering: Default::default(),
            width: 8,
            height: 8,
            pixels: vec![[50, 50, 50, 255]; 64],
            full: [8, 8],
            divisor: 1,
            sampling: SamplingView { tolerance: Some(0.008), ..SamplingView::default() },
            wished: Some(0.008),
            stats: Stats::default(),
            facts: Facts::default(),
            drawn: None,
            cells: cells.then(|| Arc::new(map)),
            probed: None,
            shot: None,
        }
    }

    fn overlay(kind: Kind) -> Overlay {
        let mut overlay = Overlay::default();
        overlay.kind = kind;
        *overlay.opacity_mut() = 1.0;
        overlay
    }

    #[test]
    fn each_kind_has_its_colours() {
        let mut layers = Layers::default();
        layers.set(shown(true));
        let first = |drawn: Option<Drawn>| drawn.map(|drawn| drawn.pixels[0]);
        assert_eq!(first(layers.refresh(&overlay(Kind::Off))), Some([50, 50, 50, 255]));
        assert_eq!(first(layers.refresh(&overlay(Kind::Off))), None, "nothing has changed");
        let [r, g, b] = crate::overlay::look(CellClass::Full).rgb;
        assert_eq!(first(layers.refresh(&overlay(Kind::Classes))), Some([r, g, b, 255]));
        assert_eq!(layers.covered(&overlay(Kind::Classes)).unwrap()[0], 1);
        let [r, g, b] = error_map::ramp(0.5);
        assert_eq!(first(layers.refresh(&overlay(Kind::Predicted))), Some([r, g, b, 255]));
        assert!(layers.covered(&overlay(Kind::Predicted)).is_none());
    }

    #[test]
    fn nothing_lies_over_a_picture_that_it_is_not_about() {
        let mut layers = Layers::default();
        layers.set(shown(true));
        layers.refresh(&overlay(Kind::Classes));
        // The next picture comes without cells: so it is shown without them.
        layers.set(shown(false));
        let drawn = layers.refresh(&overlay(Kind::Classes)).expect("another picture");
        assert_eq!(drawn.pixels[0], [50, 50, 50, 255]);
        assert!(!layers.is_over(&overlay(Kind::Classes)));

        layers.set_errors(Some(Sheet::of_pixels([8, 8], [[9, 8, 7]; 64].into_iter())));
        let measured = overlay(Kind::Measured);
        assert_eq!(layers.refresh(&measured).unwrap().pixels[63], [9, 8, 7, 255]);
        layers.set_errors(None);
        assert_eq!(layers.refresh(&measured).unwrap().pixels[63], [50, 50, 50, 255]);
        assert!(!layers.is_over(&measured));
    }
}
