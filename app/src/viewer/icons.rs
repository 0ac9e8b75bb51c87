//! Signs on buttons, drawn as shapes so that they are sharp and of one weight.

use egui::{Color32, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, StrokeKind, Ui, pos2, vec2};

use super::{accessible, theme};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Icon {
    Play,
    Pause,
    StepBack,
    StepForward,
    First,
    Last,
    Loop,
    Cross,
    Undo,
    Redo,
    Reverse,
}

/// Width of a button.
pub const WIDTH: f32 = theme::ROW_HEIGHT + 4.0;

/// A square button with a sign on it.
pub fn button(ui: &mut Ui, icon: Icon, name: &str, enabled: bool) -> Response {
    hinted_button(ui, icon, name, name, enabled)
}

/// The same with another tooltip than its name.
pub fn hinted_button(ui: &mut Ui, icon: Icon, name: &str, hint: &str, enabled: bool) -> Response {
    ui.add_enabled_ui(enabled, |ui| {
        let response = sign(ui, icon, false);
        accessible::button(ui, &response, name);
        response.on_hover_text(hint)
    })
    .inner
}

/// A square switch with a sign on it.
pub fn switch(ui: &mut Ui, icon: Icon, name: &str, on: bool) -> Response {
    hinted_switch(ui, icon, name, name, on)
}

/// The same with another tooltip than its name.
pub fn hinted_switch(ui: &mut Ui, icon: Icon, name: &str, hint: &str, on: bool) -> Response {
    let response = sign(ui, icon, on);
    accessible::switch(ui, &response, name, on);
    response.on_hover_text(hint)
}

fn sign(ui: &mut Ui, icon: Icon, on: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(WIDTH, theme::ROW_HEIGHT), Sense::click());
    let fill = match () {
        () if response.is_pointer_button_down_on() => theme::colours().raised_press,
        () if response.hovered() && ui.is_enabled() => theme::colours().raised_hover,
        () if on => theme::colours().accent_deep,
        () => Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(rect, 4, fill);
    let colour = match (ui.is_enabled(), on) {
        (false, _) => theme::colours().line,
        (true, true) => theme::colours().accent,
        (true, false) => theme::colours().text,
    };
    draw(ui.painter(), icon, rect.center(), colour);
    response
}

fn draw(painter: &Painter, icon: Icon, centre: Pos2, colour: Color32) {
    let at = |x: f32, y: f32| centre + vec2(x, y);
    let bar = |x: f32| {
        painter.rect_filled(Rect::from_center_size(at(x, 0.0), vec2(2.6, 11.0)), 0, colour);
    };
    let triangle = |x: f32, to: f32| {
        let points = vec![at(x, -5.5), at(x + to, 0.0), at(x, 5.5)];
        painter.add(Shape::convex_polygon(points, colour, Stroke::NONE));
    };
    match icon {
        Icon::Play => triangle(-3.5, 9.0),
        Icon::Pause => {
            bar(-3.0);
            bar(3.0);
        }
        Icon::StepForward => {
            triangle(-4.5, 7.0);
            bar(4.0);
        }
        Icon::StepBack => {
            triangle(4.5, -7.0);
            bar(-4.0);
        }
        Icon::Last => {
            triangle(-6.5, 5.5);
            triangle(-1.0, 5.5);
            bar(6.0);
        }
        Icon::First => {
            triangle(6.5, -5.5);
            triangle(1.0, -5.5);
            bar(-6.0);
        }
        Icon::Loop => {
            let frame = Rect::from_center_size(centre, vec2(13.0, 8.0));
            painter.rect_stroke(frame, 3, Stroke::new(1.4, colour), StrokeKind::Middle);
            let tip = pos2(centre.x + 2.4, frame.top());
            let points = vec![tip + vec2(-3.6, -3.2), tip, tip + vec2(-3.6, 3.2)];
            painter.add(Shape::convex_polygon(points, colour, Stroke::NONE));
        }
        Icon::Cross => {
            let stroke = Stroke::new(1.4, colour);
            painter.line_segment([at(-3.5, -3.5), at(3.5, 3.5)], stroke);
            painter.line_segment([at(-3.5, 3.5), at(3.5, -3.5)], stroke);
        }
        Icon::Undo => turn_back(painter, centre, -1.0, colour),
        Icon::Redo => turn_back(painter, centre, 1.0, colour),
        Icon::Reverse => {
            for (y, side) in [(-3.0, 1.0), (3.0, -1.0)] {
                painter.line_segment([at(-side * 6.0, y), at(side * 3.0, y)], Stroke::new(1.4, colour));
                let head = vec![at(side * 2.0, y - 2.8), at(side * 6.5, y), at(side * 2.0, y + 2.8)];
                painter.add(Shape::convex_polygon(head, colour, Stroke::NONE));
            }
        }
    }
}

/// An arrow that comes round from below; its head points to the left for −1, to the right for 1.
fn turn_back(painter: &Painter, centre: Pos2, side: f32, colour: Color32) {
    let at = |x: f32, y: f32| centre + vec2(side * x, y);
    let arc = (0..=12).map(|part| {
        let (sin, cos) = (std::f32::consts::PI * part as f32 / 12.0).sin_cos();
        at(-1.5 - 3.5 * sin, 1.0 - 3.5 * cos)
    });
    let line = [at(1.5, -2.5)].into_iter().chain(arc).chain([at(2.5, 4.5)]).collect();
    painter.line(line, Stroke::new(1.4, colour));
    let head = vec![at(1.5, -5.7), at(6.0, -2.5), at(1.5, 0.7)];
    painter.add(Shape::convex_polygon(head, colour, Stroke::NONE));
}
