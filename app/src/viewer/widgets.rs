//! The few shapes that every panel is made of.

use egui::collapsing_header::CollapsingState;
use egui::{Align, Align2, Color32, Layout, Response, RichText, Sense, Stroke, Ui, pos2, vec2};

use super::{accessible, theme};
pub use crate::numbers::{on_axis, on_scale, short};

/// Where the parts of the window are that scripts drive it by, for `--log-events`.
#[derive(Clone, Default, PartialEq)]
pub struct Areas(pub Vec<(&'static str, egui::Rect)>);

impl Areas {
    fn id() -> egui::Id {
        egui::Id::unique("areas")
    }

    /// Takes note that `name` is at `rect`.
    pub fn mark(ui: &Ui, name: &'static str, rect: egui::Rect) {
        ui.ctx().data_mut(|data| data.get_temp_mut_or_default::<Areas>(Areas::id()).0.push((name, rect)));
    }

    /// The areas of this frame.
    pub fn take(context: &egui::Context) -> Areas {
        context.data_mut(|data| data.remove_temp(Areas::id())).unwrap_or_default()
    }
}

/// A card over the picture that can be dragged; screen readers call it `name`, scripts `area`.
pub fn card(
    ui: &Ui,
    [name, area]: [&'static str; 2],
    corner: egui::Pos2,
    width: f32,
    contents: impl FnOnce(&mut Ui),
) {
    let window = egui::Window::new(name).id(egui::Id::unique(area)).default_pos(corner);
    let window = window.constrain_to(ui.ctx().content_rect()).title_bar(false).resizable(false);
    window.frame(egui::Frame::window(ui.style())).show(ui.ctx(), |ui| {
        ui.set_width(width);
        contents(ui);
        Areas::mark(ui, area, ui.min_rect());
    });
}

/// A titled part of the side panel that folds away.
pub fn section(ui: &mut Ui, title: &'static str, open: bool, contents: impl FnOnce(&mut Ui)) {
    let id = ui.make_persistent_id(("section", title));
    let mut state = CollapsingState::load_with_default_open(ui.ctx(), id, open);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 30.0), Sense::click());
    accessible::title(ui, &response, title, state.is_open());
    Areas::mark(ui, title, rect);
    if response.clicked() {
        state.toggle(ui);
    }
    let colour = if response.hovered() { theme::colours().strong } else { theme::colours().text };
    let painter = ui.painter();
    let text = RichText::new(title).size(14.0).color(colour);
    let galley = egui::WidgetText::from(text).into_galley(
        ui,
        Some(egui::TextWrapMode::Extend),
        f32::INFINITY,
        egui::TextStyle::Body,
    );
    let place = pos2(rect.left() + 18.0, rect.center().y - 0.5 * galley.size().y);
    painter.galley(place, galley, colour);
    chevron(painter, pos2(rect.left() + 5.0, rect.center().y), state.openness(ui.ctx()), colour);
    state.show_body_unindented(ui, |ui| {
        contents(ui);
        ui.add_space(theme::GAP);
    });
    let line = ui.cursor().top();
    ui.painter().hline(
        rect.x_range().expand(f32::from(theme::MARGIN)),
        line,
        Stroke::new(1.0, theme::colours().line),
    );
    ui.add_space(1.0);
}

/// A mark that points right when closed and down when open.
fn chevron(painter: &egui::Painter, centre: egui::Pos2, openness: f32, colour: Color32) {
    let turn = egui::emath::Rot2::from_angle(openness * std::f32::consts::FRAC_PI_2);
    let points = [vec2(-1.8, -3.6), vec2(1.8, 0.0), vec2(-1.8, 3.6)].map(|p| centre + turn * p);
    painter.line(points.to_vec(), Stroke::new(1.4, colour));
}

/// A label and, in a column of their own, the things that it labels.
pub fn row<R>(ui: &mut Ui, label: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        ui.set_min_height(theme::ROW_HEIGHT);
        let size = vec2(theme::LABEL_WIDTH, theme::ROW_HEIGHT);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        let font = egui::TextStyle::Body.resolve(ui.style());
        ui.painter().text(rect.left_center(), Align2::LEFT_CENTER, label, font, theme::colours().muted);
        contents(ui)
    })
    .inner
}

/// A label, and a value that stands at the right edge.
pub fn fact(ui: &mut Ui, label: &str, value: impl Into<String>) -> Response {
    ui.spacing_mut().item_spacing.y = 2.0;
    ui.spacing_mut().interact_size.y = 20.0;
    ui.horizontal(|ui| {
        ui.label(RichText::new(label).color(theme::colours().muted));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let text = RichText::new(value.into()).font(theme::number_font());
            ui.add(egui::Label::new(text).truncate());
        });
    })
    .response
}

/// Choices side by side, of which one holds. Returns whether another one was chosen.
pub fn choice<T: PartialEq + Copy>(ui: &mut Ui, chosen: &mut T, choices: &[(T, &str, &str)]) -> bool {
    let gap = 2.0;
    let width = (ui.available_width() - gap * (choices.len() as f32 - 1.0)) / choices.len() as f32;
    let before = *chosen;
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.x = gap;
        ui.spacing_mut().button_padding.x = 2.0;
        for (value, label, hint) in choices {
            let here = *chosen == *value;
            let text = RichText::new(*label).color(if here {
                theme::colours().strong
            } else {
                theme::colours().muted
            });
            let fill = if here { theme::colours().accent_deep } else { theme::colours().raised };
            let button = egui::Button::new(text).fill(fill).min_size(vec2(width, theme::ROW_HEIGHT));
            let response = ui.add(button.selected(here)).accessible_name(*label);
            let response = if hint.is_empty() { response } else { response.on_hover_text(*hint) };
            if response.clicked() {
                *chosen = *value;
            }
        }
    });
    *chosen != before
}

/// A button of a width.
pub fn wide_button(ui: &mut Ui, label: &str, width: f32) -> Response {
    ui.add(egui::Button::new(label).min_size(vec2(width, theme::ROW_HEIGHT)))
}

/// A number in an unbounded unit: as many digits as tell something, dragged in proportion to its size.
pub fn number<'a>(value: &'a mut f64, scale: f64) -> egui::DragValue<'a> {
    let speed = (value.abs().max(scale.abs()) * 0.005).max(f64::MIN_POSITIVE);
    egui::DragValue::new(value).speed(speed).custom_formatter(move |value, _| on_axis(value, scale))
}

/// A count with its thousands apart.
pub fn count(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// A count in thousands, millions or billions.
pub fn large(value: u64) -> String {
    match value as f64 {
        v if v >= 1e12 => format!("{:.2} T", v / 1e12),
        v if v >= 1e9 => format!("{:.2} G", v / 1e9),
        v if v >= 1e6 => format!("{:.2} M", v / 1e6),
        v if v >= 1e4 => format!("{:.1} k", v / 1e3),
        v => format!("{v:.0}"),
    }
}

/// A share in percent. One that is not quite nothing, or not quite everything, is shown to be so.
pub fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".into(),
        p if p < 0.1 => "< 0.1 %".into(),
        p if (99.9..100.0).contains(&p) => "> 99.9 %".into(),
        p if p >= 100.0 => "100 %".into(),
        p => format!("{p:.1} %"),
    }
}

/// Bytes in the unit that suits them.
pub fn bytes(value: u64) -> String {
    match value as f64 {
        v if v >= 1024.0 * 1024.0 * 1024.0 => format!("{:.2} GiB", v / (1024.0 * 1024.0 * 1024.0)),
        v if v >= 1024.0 * 1024.0 => format!("{:.1} MiB", v / (1024.0 * 1024.0)),
        v => format!("{:.1} KiB", v / 1024.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped() {
        assert_eq!(count(7), "7");
        assert_eq!(count(1234), "1\u{202f}234");
        assert_eq!(large(1_400_000_000), "1.40 G");
        assert_eq!(bytes(3 << 20), "3.0 MiB");
    }

    #[test]
    fn shares_never_pass_for_none_or_all() {
        assert_eq!([0.0, 1.0, 0.25].map(percent), ["0 %", "100 %", "25.0 %"]);
        assert_eq!([1e-9, 0.999_999].map(percent), ["< 0.1 %", "> 99.9 %"]);
    }
}
