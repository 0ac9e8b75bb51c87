//! All settings of one picture, as numbers of the twin's own.

use renderer::{Scale, View};

use crate::camera::Camera;
use crate::kernels::Kernel;
use crate::quantity::Range;
use crate::slices::Slices;
use crate::transfer::Transfer;

/// What a picture depends on besides its particles. Lengths in the unit of the run.
#[derive(Clone, Debug)]
pub struct Setup {
    pub camera: Camera,
    pub slices: Slices,
    pub kernel: Kernel,
    pub range: Range,
    /// Of the field that decides the opacity, where that is another one.
    pub opacity_range: Option<Range>,
    pub transfer: Transfer,
    pub reference_length: f64,
    /// Where in its slab, from front (0) to back (1), a sample is taken: ½ by the contract. Any
    /// other value makes a twin that is wrong on purpose.
    pub place_in_slab: f64,
}

impl Setup {
    /// The setup of a `view` that leaves nothing open: camera with near and far, range of the
    /// quantity, reference length.
    pub fn new(view: &View) -> Setup {
        let camera_view = view.camera.as_ref().expect("the twin takes the camera as given");
        let camera = Camera::new(camera_view, view.image.width, view.image.height);
        let range = |range: Option<[f64; 2]>, scale: Scale| {
            let [min, max] = range.expect("the twin takes the range as given");
            Range { min, max, logarithmic: scale == Scale::Log }
        };
        let quantity = &view.quantity;
        Setup {
            camera,
            slices: Slices::new(&camera, view.sampling.rate),
            kernel: view.particles.kernel.into(),
            range: range(quantity.range, quantity.scale),
            opacity_range: quantity.opacity.as_ref().map(|opacity| range(opacity.range, opacity.scale)),
            transfer: Transfer::new(&view.transfer.points),
            reference_length: view
                .transfer
                .reference_length
                .expect("the twin takes the reference length as given"),
            place_in_slab: 0.5,
        }
    }
}
