//! The picture that the renderer drew and what lies over it, put together for the screen.

use std::sync::Arc;

use renderer::{CellClass, CellMap};

use crate::overlay::{Mark, Sheet, counts};

use super::error_map;
use super::overlay::{Kind, Overlay, Which};
use super::render_thread::Shown;

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
