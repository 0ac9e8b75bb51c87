//! What is written and drawn over a picture: the same in the window and in saved pictures.
//!
//! Each item is a file that turns what is known of a picture into simple shapes ([`Drawing`]). The
//! window draws those by egui; [`raster`] turns them into pixels, and [`onto`] lays these over a
//! finished picture.

mod axes;
mod bars;
mod colour_bar;
mod drawing;
mod onto;
mod opacity_bar;
mod raster;
mod scale_bar;
mod stamp;
mod ticks;

use renderer::{AnnotationsView, Scale, Scene, TransferFunction, View};

use crate::camera_path;
use crate::frames::Frame;
use crate::image_file::{Format, Pixels};
use crate::projection::Projection;
use crate::scene::Selection;
use drawing::{MIDDLE, Palette, START, Sheet};

pub use drawing::{Drawing, Shape};
pub use ticks::ticks;

/// What is known of a picture.
pub struct Subject<'a> {
    /// The quantity's name, where there is one.
    pub quantity: Option<String>,
    /// The values at both ends of the transfer function, where they are known.
    pub range: Option<[f64; 2]>,
    pub scale: Scale,
    /// Of the field that decides the opacity, where that is another one.
    pub opacity: Option<OpacityAxis>,
    /// Over u, from the low end of the range to the high one.
    pub transfer: &'a TransferFunction,
    pub time: Option<f64>,
    /// The frame's number in the run.
    pub frame: usize,
    /// Of the picture, in its pixels.
    pub projection: Projection,
    /// View depth of the camera's target, in the unit of the run.
    pub target_depth: f64,
    /// Behind the picture, in linear light.
    pub background: Option<[f32; 3]>,
}

/// The field at which opacities are read, and the values at both ends of the transfer function.
pub struct OpacityAxis {
    pub name: String,
    pub range: [f64; 2],
    pub scale: Scale,
}

/// The annotations of one saved picture.
pub struct Annotations {
    drawing: Drawing,
    background: Option<[f32; 3]>,
}

impl Annotations {
    /// What `view` asks for over its picture of `scene`: frame `number` of the run. `None` where pictures
    /// have none.
    pub fn new(view: &View, scene: &Scene, frame: &Frame, number: usize) -> Option<Annotations> {
        let look = view.annotations.as_ref().filter(|look| look.in_pictures)?;
        let size = [scene.width, scene.height].map(f64::from);
        let camera = camera_path::settled(view, &scene.particles);
        let transfer = view.transfer.function().ok()?;
        let quantity = view.quantity.name.clone().or_else(|| Selection::default_of(frame).name());
        let opacity = view.quantity.opacity.as_ref().zip(scene.quantity.opacity_placement());
        let opacity = opacity.map(|(opacity, placement)| OpacityAxis {
            name: opacity.name.clone().or_else(|| quantity.clone()).unwrap_or_default(),
            range: placement.range(),
            scale: placement.scale(),
        });
        let subject = Subject {
            quantity,
            range: Some(scene.quantity.range()),
            scale: scene.quantity.placement().scale(),
            opacity,
            transfer: &transfer,
            time: frame.metadata.time,
            frame: number,
            projection: Projection::of(&scene.camera, size),
            target_depth: camera.target.distance(camera.eye),
            background: view.image.background,
        };
        Some(Annotations { drawing: drawing(look, &subject), background: subject.background })
    }

    /// Draws them over a finished picture that is to be written in `format`.
    pub fn draw_onto(&self, pixels: &mut Pixels, format: Format) {
        onto::lay(pixels, &self.drawing, self.background, format);
    }

    /// The same over some rows of a picture of `size`, the first of which is row `first_row`.
    pub fn draw_onto_rows(&self, rows: &mut [[f32; 4]], first_row: u32, size: [u32; 2], format: Format) {
        let size = size.map(|side| side as usize);
        onto::lay_on_rows(rows, first_row as usize, size, &self.drawing, self.background, format);
    }
}

/// The annotations that `look` asks for over a picture of `subject`.
pub fn drawing(look: &AnnotationsView, subject: &Subject) -> Drawing {
    let size = [subject.projection.width as f32, subject.projection.height as f32];
    let sheet = Sheet::new(size, look.size);
    let mut drawing = Drawing::new(sheet, Palette::new(look.ink, subject.background));
    bars::draw(&mut drawing, subject, look);
    if look.axes {
        axes::draw(&mut drawing, subject);
    }
    if look.scale_bar {
        scale_bar::draw(&mut drawing, subject, look);
    }
    stamp::draw(&mut drawing, subject, look);
    let beside = if look.time || look.frame_number { stamp::ROOM * drawing.sheet.em } else { 0.0 };
    title(&mut drawing, look.title.trim(), beside);
    drawing
}

/// The title above the scene, with `beside` pixels left free on both sides; in smaller letters where it
/// would be too long.
fn title(drawing: &mut Drawing, text: &str, beside: f32) {
    /// Usual size, and the width of a letter at a generous guess, both in letters.
    const SIZE: f32 = 1.35;
    const WIDTH: f32 = 0.55;
    if text.is_empty() {
        return;
    }
    let sheet = drawing.sheet;
    let room = (0.95 * sheet.width - 2.0 * beside).max(0.2 * sheet.width);
    let size = SIZE.min(room / (WIDTH * sheet.em * text.chars().count() as f32));
    let letters = drawing.palette().letters;
    drawing.text([0.5 * sheet.width, 1.1 * sheet.em], [MIDDLE, START], size, text, letters);
}
