//! What lies over the picture: the user's choice. Knows no egui.

use renderer::CellClass;

use crate::overlay::{self, Depth};

/// The kinds of overlays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Off,
    /// What became of the cells.
    Classes,
    /// What is charged to the rays.
    Predicted,
    /// The error against full sampling.
    Measured,
}

/// Which cells of those along a ray count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Which {
    FrontMost,
    Share,
    Slice,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlay {
    pub kind: Kind,
    pub which: Which,
    /// Of which the share is shown.
    pub class: CellClass,
    /// Of which the slice is shown, as a share of the way from front to back: it stays in its place when
    /// another picture has another number of layers.
    pub slice: f32,
    /// Of classes and of errors.
    opacity: [f32; 2],
}

impl Default for Overlay {
    fn default() -> Overlay {
        Overlay {
            kind: Kind::Off,
            which: Which::FrontMost,
            class: CellClass::Full,
            slice: 0.5,
            opacity: [overlay::OPACITY, 1.0],
        }
    }
}

impl Overlay {
    /// Whether it needs to know what became of the cells.
    pub fn needs_cells(&self) -> bool {
        matches!(self.kind, Kind::Classes | Kind::Predicted)
    }

    /// The opacity of the kind that is chosen, 0 to 1.
    pub fn opacity(&self) -> f32 {
        self.opacity[usize::from(self.kind != Kind::Classes)]
    }

    pub fn opacity_mut(&mut self) -> &mut f32 {
        &mut self.opacity[usize::from(self.kind != Kind::Classes)]
    }

    /// The layer of the slice, of so many.
    pub fn layer(&self, layers: u32) -> u32 {
        (self.slice * layers.saturating_sub(1) as f32).round() as u32
    }

    pub fn set_layer(&mut self, layer: u32, layers: u32) {
        self.slice = layer as f32 / layers.saturating_sub(1).max(1) as f32;
    }

    /// The cells that are shown of a picture with so many layers.
    pub fn depth(&self, layers: u32) -> Depth {
        match self.which {
            Which::FrontMost => Depth::FrontMost,
            Which::Share => Depth::Share(self.class),
            Which::Slice => Depth::Layer(self.layer(layers)),
        }
    }

    /// Turns the classes on, or off where they are on.
    pub fn toggle_classes(&mut self) {
        self.kind = if self.kind == Kind::Classes { Kind::Off } else { Kind::Classes };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slice_is_where_it_was_set() {
        let mut overlay = Overlay { which: Which::Slice, ..Overlay::default() };
        for layers in [1, 2, 77, 4000] {
            for layer in [0, layers / 3, layers - 1] {
                overlay.set_layer(layer, layers);
                assert_eq!(overlay.depth(layers), Depth::Layer(layer));
            }
        }
        assert_eq!(overlay.layer(0), 0);
    }

    #[test]
    fn classes_and_errors_have_an_opacity_each() {
        let mut overlay = Overlay { kind: Kind::Classes, ..Overlay::default() };
        *overlay.opacity_mut() = 0.25;
        overlay.kind = Kind::Predicted;
        assert_eq!((overlay.opacity(), overlay.needs_cells()), (1.0, true));
        overlay.toggle_classes();
        assert_eq!(overlay.opacity(), 0.25);
        overlay.toggle_classes();
        assert_eq!((overlay.kind, overlay.needs_cells()), (Kind::Off, false));
    }
}
