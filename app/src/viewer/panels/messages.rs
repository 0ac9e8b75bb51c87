//! Messages over the upper left of the picture.

use egui::{Align, Frame, Layout, Margin, Rect, RichText, Stroke, Ui, UiBuilder, vec2};

use crate::viewer::icons::{self, Icon};
use crate::viewer::messages::{MOST, Message, Severity};
use crate::viewer::session::Session;
use crate::viewer::theme;

const WIDTH: f32 = 420.0;

pub fn show(ui: &mut Ui, session: &mut Session, picture: Rect) {
    let width = WIDTH.min(picture.width() - 24.0);
    if width < 120.0 {
        return;
    }
    let place = Rect::from_min_size(picture.min + vec2(12.0, 12.0), vec2(width, picture.height() - 24.0));
    let mut gone = None;
    ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
        let messages = session.messages.list();
        let earlier = messages.len().saturating_sub(MOST);
        for (index, message) in messages.iter().enumerate().skip(earlier) {
            if card(ui, message) {
                gone = Some(index);
            }
        }
        if earlier > 0 {
            ui.label(RichText::new(format!("and {earlier} earlier")).color(theme::colours().muted));
        }
    });
    if let Some(index) = gone {
        session.messages.dismiss(index);
    }
}

/// One message. Returns whether it is to go.
fn card(ui: &mut Ui, message: &Message) -> bool {
    let colour = match message.severity {
        Severity::Note => theme::colours().accent,
        Severity::Warning => theme::colours().warning,
        Severity::Error => theme::colours().error,
    };
    let frame = Frame::new()
        .fill(theme::colours().panel)
        .stroke(Stroke::new(1.0, theme::colours().line))
        .corner_radius(6)
        .inner_margin(Margin { left: 14, right: 6, top: 6, bottom: 6 });
    let shown = frame.show(ui, |ui| {
        ui.with_layout(Layout::right_to_left(Align::Min), |ui| {
            let dismissed = icons::button(ui, Icon::Cross, "Dismiss", true).clicked();
            ui.with_layout(Layout::top_down(Align::Min), |ui| {
                ui.add_space(3.0);
                let times = match message.times {
                    1 => String::new(),
                    times => format!("  (×{times})"),
                };
                ui.add(egui::Label::new(RichText::new(format!("{}{times}", message.text))).wrap());
            });
            dismissed
        })
        .inner
    });
    let mark = Rect::from_min_size(shown.response.rect.min, vec2(4.0, shown.response.rect.height()));
    ui.painter().rect_filled(mark, egui::CornerRadius { nw: 6, sw: 6, ne: 0, se: 0 }, colour);
    shown.inner
}
