//! The performance display over the picture: what the last pictures took, and what that brought.

use egui::{Align, Align2, Color32, Layout, Rect, RichText, Sense, Stroke, Ui, pos2, vec2};

use crate::viewer::icons::{self, Icon};
use crate::viewer::inspect::measurement::State;
use crate::viewer::session::{Entry, Session, Stage};
use crate::viewer::theme;
use crate::viewer::widgets::{self, Areas};

use super::hud_chart;
use super::sampling::plain;

/// What the display remembers between frames.
#[derive(Default)]
pub struct Hud {
    pub open: bool,
    /// Number of the picture under the mouse.
    hovered: Option<usize>,
}

const WIDTH: f32 = 392.0;
const MARGIN: f32 = 12.0;
/// The axes in the corner of the picture stay in sight.
const ABOVE_AXES: f32 = 104.0;
/// Where the numbers of the headline begin.
const HEADLINE: [f32; 4] = [0.0, 112.0, 196.0, 266.0];
/// Lines of the legend and of the facts.
const LINE: f32 = 16.0;

impl Hud {
    /// Shows the display, at first at the left of the picture: colours are explained at the right.
    pub fn show(&mut self, ui: &Ui, session: &Session, measurement: Option<&State>, picture: Rect) {
        if !self.open {
            return;
        }
        // Dark over any picture, and what lies below is still there.
        let frame = egui::Frame::new()
            .fill(Color32::from_rgba_unmultiplied(0x11, 0x13, 0x16, 232))
            .stroke(Stroke::new(1.0, theme::DARK.line))
            .corner_radius(8)
            .inner_margin(MARGIN);
        egui::Window::new("Performance over the picture")
            .id(egui::Id::unique("hud"))
            .pivot(Align2::LEFT_BOTTOM)
            .default_pos(picture.left_bottom() + vec2(MARGIN, -ABOVE_AXES))
            .constrain_to(ui.ctx().content_rect())
            .title_bar(false)
            .resizable(false)
            .frame(frame)
            .show(ui.ctx(), |ui| {
                ui.set_width(WIDTH);
                ui.spacing_mut().item_spacing.y = 4.0;
                self.header(ui, session);
                self.contents(ui, session, measurement);
                Areas::mark(ui, "hud", ui.min_rect());
            });
    }

    fn header(&mut self, ui: &mut Ui, session: &Session) {
        ui.horizontal(|ui| {
            ui.label(RichText::new("Performance").strong());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if icons::button(ui, Icon::Cross, "Close", true).clicked() {
                    self.open = false;
                }
                let hint = "The pictures shown below as a table, to paste into a spreadsheet";
                if ui.small_button("Copy as CSV").on_hover_text(hint).clicked() {
                    ui.ctx().copy_text(session.costs.to_csv());
                }
            });
        });
    }

    fn contents(&mut self, ui: &mut Ui, session: &Session, measurement: Option<&State>) {
        let costs = &session.costs;
        let Some(last) = costs.last() else {
            ui.add_sized(
                vec2(WIDTH, 60.0),
                egui::Label::new(RichText::new("No picture yet.").color(theme::DARK.muted)),
            );
            return;
        };
        let number = self.hovered.filter(|number| *number < costs.entries().len());
        let entry = number.and_then(|number| costs.entries().nth(number)).unwrap_or(last);
        let ago = number.map_or(0, |number| costs.entries().len() - 1 - number);
        headline(ui, entry, ago, costs.rate());
        let limit = session.budget.on.then_some(session.budget.milliseconds);
        let hovered = hud_chart::show(ui, costs, limit, number);
        if hovered != self.hovered {
            self.hovered = hovered;
            ui.ctx().request_repaint();
        }
        legend(ui, entry);
        let measured = measurement.filter(|_| ago == 0 && !entry.moving);
        facts(ui, session, entry, measured);
    }
}

/// The most important numbers, side by side: of the last picture, or the one so many before it.
fn headline(ui: &mut Ui, entry: &Entry, ago: usize, rate: Option<f64>) {
    let which = match ago {
        0 => "Last picture".to_owned(),
        ago => format!("{ago} before, frame {}", entry.frame),
    };
    let rate = rate.filter(|_| ago == 0).map_or_else(|| "–".into(), |rate| format!("{rate:.1} fps"));
    let resolution = match entry.divisor {
        1 => "full".into(),
        divisor => format!("1/{divisor}"),
    };
    let tolerance = entry.tolerance.map_or_else(|| "none".into(), plain);
    let wished = match entry.wished {
        Some(wished) if entry.is_raised() => format!("Tolerance, yours {wished}"),
        _ => "Tolerance".into(),
    };
    let cells = [
        (which.as_str(), in_milliseconds(entry.total()), theme::DARK.text),
        ("While moving", rate, theme::DARK.text),
        ("Resolution", resolution, theme::DARK.text),
        (wished.as_str(), tolerance, if entry.is_raised() { theme::DARK.warning } else { theme::DARK.text }),
    ];
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 40.0), Sense::hover());
    for ((caption, value, ink), left) in cells.into_iter().zip(HEADLINE) {
        let place = rect.left_top() + vec2(left, 0.0);
        ui.painter().text(
            place,
            Align2::LEFT_TOP,
            caption,
            egui::FontId::proportional(10.5),
            theme::DARK.muted,
        );
        let place = place + vec2(0.0, 15.0);
        ui.painter().text(place, Align2::LEFT_TOP, value, egui::FontId::proportional(16.0), ink);
    }
}

/// The colours of the stages with the times of a picture.
fn legend(ui: &mut Ui, entry: &Entry) {
    let columns = 3;
    let rows = Stage::ALL.len().div_ceil(columns);
    let gap = 16.0;
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), LINE * rows as f32), Sense::hover());
    let width = (rect.width() - gap * (columns as f32 - 1.0)) / columns as f32;
    for (number, stage) in Stage::ALL.into_iter().enumerate() {
        let corner =
            rect.left_top() + vec2((number / rows) as f32 * (width + gap), (number % rows) as f32 * LINE);
        let cell = Rect::from_min_size(corner, vec2(width, LINE));
        let swatch = Rect::from_center_size(cell.left_center() + vec2(4.0, 0.0), vec2(8.0, 8.0));
        let painter = ui.painter();
        painter.rect_filled(swatch, 2, hud_chart::colour(stage));
        let name_at = cell.left_center() + vec2(14.0, 0.0);
        painter.text(name_at, Align2::LEFT_CENTER, stage.name(), theme::small_font(), theme::DARK.muted);
        let (text, ink) = match entry.of(stage) {
            0.0 => ("–".to_owned(), theme::DARK.faint),
            milliseconds => (in_milliseconds(milliseconds), theme::DARK.text),
        };
        painter.text(cell.right_center(), Align2::RIGHT_CENTER, text, theme::number_font(), ink);
        ui.interact(cell, ui.scope_id().with(stage.name()), Sense::hover()).on_hover_text(meaning(stage));
    }
}

fn meaning(stage: Stage) -> &'static str {
    match stage {
        Stage::Upload => "Particles and settings brought to the device",
        Stage::Grid => "Particles sorted into the cells along the rays",
        Stage::Analysis => "Finding out what need not be sampled",
        Stage::RayCast => "Sampling what is left, and putting it together",
        Stage::Prepare => "Particles and quantity made ready on the processor: once a frame",
        Stage::Other => "Waiting for the device and fetching the picture from it",
        Stage::Read => "Reading the frame, in the background and ahead of the picture: not part of its time",
    }
}

/// What was saved and what is held in memory, in two columns.
fn facts(ui: &mut Ui, session: &Session, entry: &Entry, measured: Option<&State>) {
    let predicted = match (entry.predicted, entry.tolerance) {
        (Some(predicted), Some(tolerance)) => format!("{} of {}", plain(predicted), plain(tolerance)),
        _ => "0, in full".into(),
    };
    let (held, limit) = session.run().map_or((0, 0), |run| (run.stream.bytes(), run.stream.budget()));
    let frames = format!("{} of {}", widgets::bytes(held as u64), widgets::bytes(limit as u64));
    let lines = [
        (
            "Predicted error",
            predicted,
            "The largest that any pixel may have, of the tolerance of this picture",
        ),
        (
            "Evaluations",
            evaluations(entry, measured),
            "Kernel weights computed; the share of full sampling is \
          known where all is sampled, or once the error was measured",
        ),
        (
            "Frames",
            frames,
            "Memory of the frames read ahead and kept, of what they may take beside the current one",
        ),
        (
            "Device",
            widgets::bytes(entry.gpu_bytes),
            "The most device memory that the picture needed at a time",
        ),
    ];
    let rows = lines.len() / 2;
    let gap = 16.0;
    ui.add_space(2.0);
    let (rect, _) =
        ui.allocate_exact_size(vec2(ui.available_width(), LINE * rows as f32 + 5.0), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.top(), Stroke::new(1.0, theme::DARK.line));
    let width = 0.5 * (rect.width() - gap);
    for (number, (caption, value, hint)) in lines.into_iter().enumerate() {
        let left = rect.left() + (number % 2) as f32 * (width + gap);
        let top = rect.top() + 5.0 + (number / 2) as f32 * LINE;
        let cell = Rect::from_min_size(pos2(left, top), vec2(width, LINE));
        let painter = ui.painter();
        painter.text(
            cell.left_center(),
            Align2::LEFT_CENTER,
            caption,
            theme::small_font(),
            theme::DARK.muted,
        );
        painter.text(cell.right_center(), Align2::RIGHT_CENTER, value, theme::small_font(), theme::DARK.text);
        ui.interact(cell, ui.scope_id().with(caption), Sense::hover()).on_hover_text(hint);
    }
}

/// Evaluations of a picture, with their share of full sampling where that is known.
fn evaluations(entry: &Entry, measured: Option<&State>) -> String {
    let count = widgets::large(entry.evaluations);
    match (entry.predicted, measured) {
        (None, _) => format!("{count}, all"),
        (Some(_), Some(State::Done(measured))) if measured.speed_up.evaluations > 0.0 => {
            format!("{count}, {} of full", widgets::percent(1.0 / measured.speed_up.evaluations))
        }
        _ => count,
    }
}

fn in_milliseconds(value: f64) -> String {
    match value {
        v if v >= 9999.5 => format!("{:.1} s", v / 1e3),
        v if v >= 99.5 => format!("{v:.0} ms"),
        v => format!("{v:.1} ms"),
    }
}
