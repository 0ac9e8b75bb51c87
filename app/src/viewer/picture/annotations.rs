//! The annotations over the picture in the window: the same shapes that saved pictures have.

use egui::epaint::Mesh;
use egui::{Color32, FontId, Painter, Pos2, Rect, Shape as Painted, Stroke, Ui, pos2, vec2};
use renderer::AnnotationsView;

use crate::annotate::{self, Drawing, OpacityAxis, Shape, Subject};

use crate::viewer::orbit_camera::Screen;
use crate::viewer::session::{Role, Session};

/// Draws what the session's view asks for over the picture at `rect`; without `bars` where something else is
/// explained in their place.
pub fn show(ui: &Ui, session: &Session, rect: Rect, bars: bool) {
    let scale = ui.pixels_per_point();
    let mut look = session.annotations();
    let bars = bars && session.picture.is_some();
    (look.colour_bar, look.opacity_bar) = (look.colour_bar && bars, look.opacity_bar && bars);
    if let Some(drawing) = drawing(session, &look, rect.size() * scale) {
        paint(&ui.painter().with_clip_rect(rect), &drawing, rect.min, scale);
    }
}

fn drawing(session: &Session, look: &AnnotationsView, size: egui::Vec2) -> Option<Drawing> {
    let camera = session.camera?;
    let (index, frame) = session.frame()?;
    let transfer = session.view.transfer.function().ok()?;
    let name = session.opacity_field().map(|name| name.or_else(|| session.shown_quantity()));
    let opacity = name.zip(session.range_of(Role::Opacity)).map(|(name, range)| OpacityAxis {
        name: name.unwrap_or_default(),
        range,
        scale: session.scale(Role::Opacity),
    });
    let [width, height] = [size.x, size.y].map(f64::from);
    let subject = Subject {
        quantity: session.shown_quantity(),
        range: session.range(),
        scale: session.view.quantity.scale,
        opacity,
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
                let colours = colours.iter().map(|[r, g, b]| (1.0, Color32::from_rgb(*r, *g, *b)));
                painter.add(Painted::mesh(bar(Rect::from_min_max(place(*min), place(*max)), colours)));
            }
            Shape::Area { min, max, shares, colour } => {
                let shares = shares.iter().map(|share| (*share, srgba(*colour)));
                painter.add(Painted::mesh(bar(Rect::from_min_max(place(*min), place(*max)), shares)));
            }
        }
    }
}

/// Shares of a rectangle's width and colours that run, evenly spaced, from its lower end to its upper one.
fn bar(rect: Rect, steps: impl ExactSizeIterator<Item = (f32, Color32)>) -> Mesh {
    let mut mesh = Mesh::default();
    let last = steps.len().saturating_sub(1).max(1) as f32;
    for (step, (share, colour)) in (0_u32..).zip(steps) {
        let y = rect.bottom() - step as f32 / last * rect.height();
        mesh.colored_vertex(pos2(rect.left(), y), colour);
        mesh.colored_vertex(pos2(rect.left() + share * rect.width(), y), colour);
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
