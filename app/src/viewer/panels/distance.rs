//! The card of a distance: how far its ends are apart, and along which axes.

use egui::{Align, Layout, Rect, RichText, Ui, vec2};

use crate::viewer::icons::{self, Icon};
use crate::viewer::session::{End, Session, Tool};
use crate::viewer::theme;
use crate::viewer::widgets;

const WIDTH: f32 = 220.0;

/// Shows the card over the picture, while distances are measured or one is in view.
pub fn show(ui: &Ui, session: &mut Session, picture: Rect) {
    if !session.looking.holds(Tool::Measure) && session.looking.distance.ends.is_empty() {
        return;
    }
    let corner = picture.right_top() + vec2(-WIDTH - 44.0, 16.0);
    widgets::card(ui, ["Distance", "distance"], corner, WIDTH, |ui| card(ui, session));
}

/// What is on the card.
pub fn card(ui: &mut Ui, session: &mut Session) {
    let open = ui
        .horizontal(|ui| {
            ui.label(RichText::new("Distance").heading().strong());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                !icons::button(ui, Icon::Cross, "Close (Escape)", true).clicked()
            })
            .inner
        })
        .inner;
    let distance = &mut session.looking.distance;
    let choices = [
        (
            true,
            "Particles",
            "From the particle nearest to what is seen under the mouse, wherever it goes in other frames",
        ),
        (false, "Places", "From what is seen under the mouse itself; the place stays where it is"),
    ];
    ui.horizontal(|ui| widgets::choice(ui, &mut distance.at_particles, &choices));
    match &distance.ends[..] {
        ends if ends.iter().any(End::is_lost) => {
            hint(ui, "This frame lacks a particle that the distance was measured from.");
        }
        [from, to] => {
            let way = to.position() - from.position();
            widgets::fact(ui, "length", widgets::short(way.length()));
            for (axis, x) in ["dx", "dy", "dz"].into_iter().zip(way.to_array()) {
                widgets::fact(ui, axis, widgets::on_axis(x, way.length()));
            }
        }
        [_] => hint(ui, "Click on the other end."),
        _ => hint(ui, "Click on one end, and then on the other."),
    }
    if !open {
        session.looking.distance.ends.clear();
        if session.looking.holds(Tool::Measure) {
            session.take_tool(Tool::Measure);
        }
    }
}

fn hint(ui: &mut Ui, text: &str) {
    ui.label(RichText::new(text).color(theme::colours().muted));
}
