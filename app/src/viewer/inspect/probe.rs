//! One bundle of the picture in view, and the pixel by which it was asked for.

use renderer::{
    BUNDLE_SIDE, BundleDetail, Placement, Progress, RenderError, Renderer, Scene, bundle_of, column_of,
};

#[derive(Clone, Debug, PartialEq)]
pub struct Probed {
    /// The pixel of the full-size picture.
    pub asked: [u32; 2],
    /// The same of the picture that was drawn, at 1/`divisor`.
    pub pixel: [u32; 2],
    pub divisor: u32,
    pub bundle: BundleDetail,
    /// Where the values in the bundle's cells, which are those that decide the opacity, are on the axis of the
    /// transfer function.
    pub placement: Placement,
}

impl Probed {
    /// Looks at the bundle of the full-size picture's pixel `asked`; `scene` is at 1/`divisor` of that
    /// size. `None` where the picture has no such pixel.
    pub fn find(
        renderer: &mut Renderer,
        scene: &Scene,
        asked: [u32; 2],
        divisor: u32,
        progress: &mut Progress,
    ) -> Result<Option<Probed>, RenderError> {
        let pixel = asked.map(|place| place / divisor);
        if pixel[0] >= scene.width || pixel[1] >= scene.height {
            return Ok(None);
        }
        let bundle = renderer.inspect_bundle(scene, bundle_of(pixel), progress)?;
        let quantity = &scene.quantity;
        let placement = *quantity.opacity_placement().unwrap_or(quantity.placement());
        Ok(Some(Probed { asked, pixel, divisor, bundle, placement }))
    }

    /// Number of the column of 2 × 2 rays in its bundle that the pixel belongs to.
    pub fn column(&self) -> usize {
        column_of(self.pixel)
    }

    /// Corner and side of its bundle, in pixels of the full-size picture.
    pub fn bundle_area(&self) -> ([u32; 2], u32) {
        let side = BUNDLE_SIDE * self.divisor;
        (self.bundle.bundle.map(|place| place * side), side)
    }

    /// Corner and side of its column.
    pub fn column_area(&self) -> ([u32; 2], u32) {
        let side = 2 * self.divisor;
        (self.pixel.map(|place| place / 2 * side), side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coarser_picture_has_larger_bundles() {
        let bundle = BundleDetail {
            bundle: [2, 1],
            layers: 0,
            end_layer: 0,
            bound: Default::default(),
            budget: None,
            charged: [0.0; 16],
            cells: Vec::new(),
        };
        let placement = Placement::default();
        let probed = Probed { asked: [70, 45], pixel: [23, 15], divisor: 3, bundle, placement };
        assert_eq!(probed.bundle_area(), ([48, 24], 24));
        assert_eq!(probed.column_area(), ([66, 42], 6));
        assert_eq!(probed.column(), column_of([23, 15]));
    }
}
