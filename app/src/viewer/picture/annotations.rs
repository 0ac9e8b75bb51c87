//! The annotations over the picture in the window: the same shapes that saved pictures have.

use egui::epaint::Mesh;
use egui::{Color32, FontId, Painter, Pos2, Rect, Shape as Painted, Stroke, Ui, pos2, vec2};
use renderer::AnnotationsView;

use crate::annotate::{self, Drawing, Shape, Subject};
use crate::scene::Selection;

use crate::viewer::orbit_camera::Screen;
use crate::viewer::session::Session;

/// Draws what the session's view asks for over the picture at `rect`; without a colour bar where
/// something else is explained in its place.
pub fn show(ui: &Ui, session: &Session, rect: Rect, colour_bar: bool) {
    let scale = ui.pixels_per_point();
    let mut look = session.annotations();
    look.colour_bar &= colour_bar && session.picture.is_some();
    if let Some(drawing) = drawing(session, &look, rect.size() * scale) {
        paint(&ui.painter().with_clip_rect(rect), &drawing, rect.min, scale);
    }
}

fn drawing(session: &Session, look: &AnnotationsView, size: egui::Vec2) -> Option<Drawing> {
    let camera = session.camera?;
    let (index, frame) = session.frame()?;
    let transfer = session.view.transfer.function().ok()?;
    let name = session.view.quantity.name.clone();
    let [width, height] = [size.x, size.y].map(f64::from);
    let subject = Subject {
        quantity: name.or_else(|| Selection::default_of(frame).name()),
        range: session.range(),
        scale: session.view.quantity.scale,
        transfer: &transfer,
        time: frame.metadata.time,
        frame: *index,
        projection: camera.projection(Screen { width, height }),
        target_depth: camera.distance(),
        background: session.view.image.background,
    };
    (width >= 1.0 && height >= 1.0).then(|| annotate::drawing(look, &subject))
}

/// Paints a drawing whose pixels are `scale` to a point, its upper left corner at `corner`.
fn paint(painter: &Painter, drawing: &Drawing, corner: Pos2, scale: f32) {
    let place = |[x, y]: [f32; 2]| corner + vec2(x, y) / scale;
    for shape in &drawing.shapes {
        match shape {
            Shape::Text { at, align, size, text, colour } => {
                let font = FontId::proportional(size / scale);
                let colour = srgba(*colour);
                let galley = painter.layout_no_wrap(text.clone(), font, colour);
                let before = vec2(align[0], align[1]) * galley.size();
                painter.galley(place(*at) - before, galley, colour);
            }
            Shape::Line { from, to, width, colour } => {
                let stroke = Stroke::new(width / scale, srgba(*colour));
                painter.line_segment([place(*from), place(*to)], stroke);
            }
            Shape::Gradient { min, max, colours } => {
                painter.add(Painted::mesh(gradient(Rect::from_min_max(place(*min), place(*max)), colours)));
            }
        }
    }
}

/// Colours that run from the lower end of `bar` to its upper one.
fn gradient(bar: Rect, colours: &[[u8; 3]]) -> Mesh {
    let mut mesh = Mesh::default();
    let last = colours.len().saturating_sub(1).max(1) as f32;
    for (step, [r, g, b]) in (0_u32..).zip(colours) {
        let y = bar.bottom() - step as f32 / last * bar.height();
        let colour = Color32::from_rgb(*r, *g, *b);
        mesh.colored_vertex(pos2(bar.left(), y), colour);
        mesh.colored_vertex(pos2(bar.right(), y), colour);
        if step > 0 {
            let next = 2 * step;
            mesh.add_triangle(next - 2, next - 1, next);
            mesh.add_triangle(next - 1, next, next + 1);
        }
    }
    mesh
}

fn srgba([r, g, b, alpha]: [u8; 4]) -> Color32 {
    Color32::from_rgba_unmultiplied(r, g, b, alpha)
}
