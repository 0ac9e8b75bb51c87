//! The bundle in the picture that is looked into: chosen by a click, and marked.

use egui::{Color32, CursorIcon, PointerButton, Rect, Response, Stroke, StrokeKind, Ui, pos2, vec2};

use crate::viewer::session::Session;

/// Takes the pixel that was clicked on.
pub fn pick(ui: &Ui, response: &Response, picture: Rect, session: &mut Session) {
    if response.hovered() && !response.dragged() {
        ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
    }
    let place = response.interact_pointer_pos().filter(|place| picture.contains(*place));
    if let Some(place) = place.filter(|_| response.clicked_by(PointerButton::Primary)) {
        let scale = ui.ctx().pixels_per_point();
        let [width, height] = session.fitted();
        let pixel = ((place - picture.min) * scale).floor();
        session.probe = Some([(pixel.x as u32).min(width - 1), (pixel.y as u32).min(height - 1)]);
    }
}

/// Frames the bundle that is looked into, and the rays of the pixel in it.
pub fn mark(ui: &Ui, picture: Rect, session: &Session) {
    let Some(asked) = session.probe else { return };
    let probed = session.picture.as_ref().and_then(|picture| picture.probed.as_ref());
    let Some(probed) = probed.filter(|probed| probed.asked == asked) else { return };
    let scale = ui.ctx().pixels_per_point();
    let painter = ui.painter().with_clip_rect(picture.expand(3.0));
    let frame = |([x, y], side): ([u32; 2], u32), width: f32| {
        let corner = picture.min + vec2(x as f32, y as f32) / scale;
        let area = Rect::from_min_size(pos2(corner.x, corner.y), vec2(side as f32, side as f32) / scale);
        // A light line in a dark one is seen on any ground.
        painter.rect_stroke(
            area,
            1,
            Stroke::new(width + 2.0, Color32::from_black_alpha(190)),
            StrokeKind::Outside,
        );
        painter.rect_stroke(area, 1, Stroke::new(width, Color32::WHITE), StrokeKind::Outside);
    };
    frame(probed.bundle_area(), 1.5);
    frame(probed.column_area(), 0.75);
}
