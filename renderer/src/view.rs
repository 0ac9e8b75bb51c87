//! `View`: everything that defines a picture, as `view.json` holds it (contract, section 2).

mod annotations;
mod cameras;
mod select;
mod transfer;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::kernel::Kernel;
use crate::placement::{Scale, Spread};
use crate::sampling::{Bound, BrickWidth};
pub use annotations::{AnnotationsView, Ink};
pub use cameras::{Bookmark, Keyframe, PathView};
pub use select::{ClipBox, ClipPlane, Filter, SelectView};
pub use transfer::{MapView, OutsideView, TransferView};

mod opacity;

pub use opacity::OpacityView;

/// The settings of a picture. Every key of the file is optional; unknown keys are errors.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct View {
    /// Without one, the whole run is in view.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub camera: Option<CameraView>,
    pub image: ImageView,
    pub quantity: QuantityView,
    pub particles: ParticleView,
    #[serde(skip_serializing_if = "SelectView::is_empty")]
    pub select: SelectView,
    pub transfer: TransferView,
    pub sampling: SamplingView,
    /// Over the picture; without them, saved pictures have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub annotations: Option<AnnotationsView>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub bookmarks: Vec<Bookmark>,
    /// What moves the camera from frame to frame.
    #[serde(skip_serializing_if = "PathView::is_empty")]
    pub path: PathView,
}

/// Perspective camera. Lengths in the unit of the run, world space right-handed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraView {
    /// [`CameraView::OPEN`] where it is left open: away from the target, so that the whole run is in view.
    #[serde(default = "open", skip_serializing_if = "is_open")]
    pub eye: DVec3,
    /// [`CameraView::OPEN`] where it is left open: the middle of the run.
    #[serde(default = "open", skip_serializing_if = "is_open")]
    pub target: DVec3,
    #[serde(default = "default_up")]
    pub up: DVec3,
    /// Vertical field of view in degrees, in (0, 180).
    #[serde(default = "default_fov")]
    pub fov_y_degrees: f64,
    /// View depth where the slices begin; fitted to the particles where it is absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub near: Option<f64>,
    /// View depth where the slices end; fitted to the particles where it is absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub far: Option<f64>,
}

fn open() -> DVec3 {
    CameraView::OPEN
}

fn is_open(point: &DVec3) -> bool {
    *point == CameraView::OPEN
}

fn default_up() -> DVec3 {
    DVec3::Y
}

fn default_fov() -> f64 {
    45.0
}

/// Size in pixels, and the linear-light colour behind the fluid (none: transparent).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ImageView {
    pub width: u32,
    pub height: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub background: Option<[f32; 3]>,
}

impl ImageView {
    /// The largest side of a picture, in pixels.
    pub const MAX_SIDE: u32 = 32_768;
}

impl Default for ImageView {
    fn default() -> Self {
        ImageView { width: 512, height: 512, background: None }
    }
}

/// Which field is shown, and which of its values are u = 0 and u = 1 of the transfer function.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct QuantityView {
    /// A field's name, `field.x` for a component; the first scalar field where it is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The finite extremes over the frame where it is absent; on a logarithmic scale, those of what is
    /// positive, its upper 30 decades at most.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    /// Another field that decides the opacity; the same one where it is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub opacity: Option<OpacityView>,
    #[serde(skip_serializing_if = "is_linear")]
    pub scale: Scale,
    /// What values below and above the range look like; as those at its ends where it is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub below: Option<OutsideView>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub above: Option<OutsideView>,
}

fn is_linear(scale: &Scale) -> bool {
    *scale == Scale::Linear
}

impl QuantityView {
    /// Which values are the ends of the transfer function.
    pub fn spread(&self) -> Spread {
        Spread { range: self.range, scale: self.scale, outside: self.below.is_some() || self.above.is_some() }
    }

    fn validate(&self) -> Result<(), ViewError> {
        check_range(self.range, self.scale, "quantity.range")?;
        self.opacity.as_ref().map_or(Ok(()), OpacityView::validate)?;
        OutsideView::validate(&self.below, "quantity.below")?;
        OutsideView::validate(&self.above, "quantity.above")
    }
}

/// How particles become a continuous field.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ParticleView {
    /// Radius at which the kernel reaches zero, one for all particles, in the unit of the run; the
    /// file's own, or an estimate from the particle spacing, where it is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub support_radius: Option<f64>,
    pub kernel: Kernel,
}

/// How finely the volume is sampled, and how much of that may be saved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SamplingView {
    /// E_I: the largest error of any channel of any pixel against full sampling; `null` for full sampling.
    pub tolerance: Option<f64>,
    /// E_relax in [0, 1]; 0 is a guarantee.
    pub relaxation: f64,
    /// Slices per pixel size along the ray, 1 unless asked otherwise.
    pub rate: f64,
    pub z_adaptive: bool,
    pub super_pixels: bool,
    pub bound: Bound,
    /// Rays across a brick: 2 or 4.
    pub brick_width: BrickWidth,
    /// Whether what may be left out is found out even where that probably takes longer than full sampling.
    pub always_adaptive: bool,
}

impl Default for SamplingView {
    fn default() -> Self {
        SamplingView {
            tolerance: Some(0.004),
            relaxation: 0.0,
            rate: 1.0,
            z_adaptive: true,
            super_pixels: true,
            bound: Bound::default(),
            brick_width: BrickWidth::default(),
            always_adaptive: false,
        }
    }
}

/// A setting outside its range, by its key in `view.json`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{key}: {what}")]
pub struct ViewError {
    pub key: &'static str,
    pub what: String,
}

impl ViewError {
    pub(crate) fn new(key: &'static str, what: impl Into<String>) -> Self {
        ViewError { key, what: what.into() }
    }
}

impl View {
    /// Reads `view.json`; errors name the key, or line and column where it is not JSON.
    pub fn from_json(text: &str) -> Result<View, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// The file's text, indented.
    pub fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("a view has only string keys")
    }

    /// Checks every setting's range.
    pub fn validate(&self) -> Result<(), ViewError> {
        if let Some(camera) = &self.camera {
            camera.validate()?;
        }
        self.image.validate()?;
        self.quantity.validate()?;
        if let Some(h) = self.particles.support_radius {
            check(positive(h), "particles.support_radius", || format!("{h} is not a positive length"))?;
        }
        self.select.validate()?;
        self.sampling.validate()?;
        if let Some(annotations) = &self.annotations {
            annotations.validate()?;
        }
        cameras::validate_bookmarks(&self.bookmarks)?;
        self.path.validate()?;
        self.transfer.validate()
    }
}

/// Checks that a range, where there is one, is one that its scale can have.
fn check_range(range: Option<[f64; 2]>, scale: Scale, key: &'static str) -> Result<(), ViewError> {
    let Some([low, high]) = range else { return Ok(()) };
    check(low.is_finite() && high.is_finite() && low <= high, key, || {
        format!("[{low}, {high}] is not an ascending pair of finite numbers")
    })?;
    check(scale == Scale::Linear || low > 0.0, key, || {
        format!("[{low}, {high}] does not begin above 0, as a logarithmic scale needs it")
    })?;
    check(scale.holds([low, high]), key, || {
        format!("[{low:e}, {high:e}] is wider than the 30 decades of a logarithmic scale")
    })
}

impl CameraView {
    /// A point that is to be settled once the run is known: one where no camera can stand. (Not a
    /// NaN, which would make a view unequal to itself.)
    pub const OPEN: DVec3 = DVec3::MAX;

    /// Whether eye and target are both given.
    pub fn is_settled(&self) -> bool {
        !is_open(&self.eye) && !is_open(&self.target)
    }

    /// Checks every setting's range; keys are those of the view's own camera.
    pub fn validate(&self) -> Result<(), ViewError> {
        for (key, point) in [("camera.eye", self.eye), ("camera.target", self.target)] {
            check(is_open(&point) || point.is_finite(), key, || "is not finite".into())?;
        }
        check(self.up.is_finite(), "camera.up", || "is not finite".into())?;
        let up = self.up.try_normalize().unwrap_or(DVec3::ZERO);
        check(up != DVec3::ZERO, "camera.up", || "is zero".into())?;
        if self.is_settled() {
            let Some(forward) = (self.target - self.eye).try_normalize() else {
                return Err(ViewError::new("camera.target", "is the same point as camera.eye"));
            };
            check(forward.cross(up).length() > 1e-9, "camera.up", || {
                "is parallel to the viewing direction".into()
            })?;
        }
        check(self.fov_y_degrees > 0.0 && self.fov_y_degrees < 180.0, "camera.fov_y_degrees", || {
            format!("{} is not between 0 and 180", self.fov_y_degrees)
        })?;
        if let Some(near) = self.near {
            check(positive(near), "camera.near", || format!("{near} is not a positive length"))?;
        }
        if let Some(far) = self.far {
            let near = self.near.unwrap_or(0.0);
            check(far.is_finite() && far > near, "camera.far", || {
                format!("{far} is not a finite length beyond camera.near")
            })?;
        }
        Ok(())
    }
}

impl ImageView {
    fn validate(&self) -> Result<(), ViewError> {
        let side = |pixels: u32| (1..=ImageView::MAX_SIDE).contains(&pixels);
        let what = |pixels: u32| format!("{pixels} is not between 1 and {}", ImageView::MAX_SIDE);
        check(side(self.width), "image.width", || what(self.width))?;
        check(side(self.height), "image.height", || what(self.height))?;
        let channels = self.background.unwrap_or_default();
        check(channels.iter().all(|c| (0.0..=1.0).contains(c)), "image.background", || {
            format!("{channels:?} is not three numbers between 0 and 1")
        })
    }
}

impl SamplingView {
    fn validate(&self) -> Result<(), ViewError> {
        if let Some(e) = self.tolerance {
            check((0.0..=1.0).contains(&e), "sampling.tolerance", || format!("{e} is not between 0 and 1"))?;
        }
        check((0.0..=1.0).contains(&self.relaxation), "sampling.relaxation", || {
            format!("{} is not between 0 and 1", self.relaxation)
        })?;
        check(self.rate > 0.0 && self.rate <= 64.0, "sampling.rate", || {
            format!("{} is not between 0 and 64", self.rate)
        })
    }
}

fn positive(length: f64) -> bool {
    length.is_finite() && length > 0.0
}

pub(crate) fn check(holds: bool, key: &'static str, what: impl FnOnce() -> String) -> Result<(), ViewError> {
    if holds { Ok(()) } else { Err(ViewError::new(key, what())) }
}
