//! Where everything is in the window.

use egui::{Align2, Color32, Frame, Margin, Panel, Rect, RichText, ScrollArea, Stroke, Ui, vec2};

use super::desk::Desk;
use super::panels::palette::Palette;
use super::panels::preferences::Preferences;
use super::panels::sampling::plain;
use super::panels::toolbar::Modes;
use super::panels::{
    annotations, bookmarks, camera, camera_path, cells, distance, help, image, measured_error, messages,
    overlay_legend, particles, performance, picked, quantity, saved, selection, start, statistics, timeline,
    toolbar,
};
use super::session::PictureFacts;
use super::{theme, widgets};
use crate::viewer::inspect::measurement::{Measurement, State};
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::picture::picture_view::{Motion, PictureView};

/// Shows the window's contents. Returns the room for the picture, in physical pixels.
pub fn show(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) -> [u32; 2] {
    let bar = Frame::new().fill(theme::colours().panel).inner_margin(Margin::symmetric(10, 0));
    Panel::top("toolbar").exact_size(40.0).frame(bar).show(ui, |ui| {
        let modes = Modes {
            flying: desk.picture.motion != Motion::Orbit,
            tool: desk.session.looking.tool,
            panels: desk.side_panel,
        };
        toolbar::show(ui, &desk.session, modes, actions);
    });
    let frames = desk.session.playback.count();
    if frames > 1 || (frames == 1 && desk.session.may_grow()) {
        let bar = Frame::new().fill(theme::colours().panel).inner_margin(Margin::symmetric(10, 6));
        Panel::bottom("timeline").exact_size(timeline::HEIGHT).frame(bar).show(ui, |ui| {
            timeline::show(ui, &mut desk.session, actions);
        });
    }
    if desk.start {
        let side = Frame::new().fill(theme::colours().panel);
        Panel::left("start").exact_size(start::WIDTH).resizable(false).frame(side).show(ui, |ui| {
            start::show(ui, desk, actions);
        });
    }
    if desk.side_panel {
        let side = Frame::new().fill(theme::colours().panel);
        Panel::right("side").exact_size(theme::SIDE_WIDTH).resizable(false).frame(side).show(ui, |ui| {
            // In a place of its own: contents that are too wide are cut off, and leave the panel's width alone.
            let place = ui.max_rect();
            let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(place));
            inside.set_clip_rect(place);
            ScrollArea::vertical().auto_shrink(false).show(&mut inside, |ui| {
                let margin = Margin { left: theme::MARGIN, right: theme::MARGIN, top: 4, bottom: 4 };
                Frame::new().inner_margin(margin).show(ui, |ui| sections(ui, desk, actions));
            });
            ui.allocate_rect(place, egui::Sense::hover());
        });
    }
    let outer = ui.available_rect_before_wrap();
    let room = PictureView::room(outer, ui.pixels_per_point());
    let rect = desk.picture.show(ui, &mut desk.session);
    over_picture(ui, desk, rect, outer);
    let measurement = desk.measurement.as_ref().map(|measurement| &measurement.state);
    desk.hud.show(ui, &desk.session, measurement, rect);
    desk.inspector.show(ui, &mut desk.session, rect);
    picked::show(ui, &mut desk.session, rect);
    distance::show(ui, &mut desk.session, rect);
    help::show(ui, &mut desk.help);
    Palette::show(&mut desk.palette, ui, actions);
    Preferences::show(ui, desk);
    desk.show_export(ui);
    drop_target(ui);
    room
}

fn sections(ui: &mut Ui, desk: &mut Desk, actions: &mut Vec<Action>) {
    let Desk { session, editor, sampling, hud, measurement, picture, .. } = desk;
    let measurement = measurement.as_ref().map(|measurement| &measurement.state);
    widgets::section(ui, "Quantity", true, |ui| quantity::show(ui, session));
    widgets::section(ui, "Transfer function", true, |ui| editor.show(ui, session));
    widgets::section(ui, "Clip and filter", false, |ui| {
        selection::show(ui, session, &mut picture.handles.shown);
    });
    widgets::section(ui, "Statistics", false, |ui| statistics::show(ui, session));
    widgets::section(ui, "Sampling", true, |ui| {
        sampling.show(ui, session);
        saved::show(ui, session);
        measured_error::show(ui, session, measurement, actions);
    });
    widgets::section(ui, "Cells", true, |ui| cells::show(ui, session, measurement, actions));
    widgets::section(ui, "Picture", false, |ui| image::show(ui, session, actions));
    widgets::section(ui, "Annotations", false, |ui| annotations::show(ui, session));
    widgets::section(ui, "Camera", false, |ui| camera::show(ui, session, &mut picture.motion, actions));
    widgets::section(ui, "Bookmarks", false, |ui| bookmarks::show(ui, session, actions));
    widgets::section(ui, "Camera path", false, |ui| camera_path::show(ui, session, actions));
    widgets::section(ui, "Particles", false, |ui| particles::show(ui, session));
    widgets::section(ui, "Performance", true, |ui| performance::show(ui, session, hud.open, actions));
}

fn over_picture(ui: &mut Ui, desk: &mut Desk, rect: Rect, outer: Rect) {
    let measurement = desk.measurement.as_ref().map(|measurement| &measurement.state);
    let overlaid = overlay_legend::show(ui, &desk.session, &desk.picture.layers, measurement, rect);
    crate::viewer::picture::annotations::show(ui, &desk.session, rect, !overlaid);
    status(ui, desk, outer);
    tasks(ui, desk, outer);
    messages::show(ui, &mut desk.session, outer);
}

/// What the picture is and what is being done about it, at the lower edge.
fn status(ui: &Ui, desk: &Desk, outer: Rect) {
    let picture = desk.session.picture.as_ref();
    let mut parts = Vec::new();
    if let Some(moving) = match desk.picture.motion {
        Motion::Orbit => None,
        Motion::Fly => Some("Flying"),
        Motion::Walk => Some("Walking"),
    } {
        parts.push(format!(
            "{moving}: W A S D Q E, drag to look, wheel for speed ({:.2})",
            desk.picture.speed()
        ));
    }
    if let Some(picture) = picture {
        parts.extend(cut(desk, picture));
    }
    match (desk.busy(), picture) {
        (Some(text), _) => parts.push(text.to_owned()),
        (None, Some(picture)) if picture.divisor > 1 => {
            let refining = match desk.render.share().filter(|_| !desk.session.playback.playing()) {
                Some(share) => format!(", refining {:.0} %", 100.0 * share),
                None => String::new(),
            };
            parts.push(format!("1/{} resolution{refining}", picture.divisor));
        }
        (None, Some(picture))
            if picture.raised().is_none() && picture.sampling != desk.session.view.sampling =>
        {
            let share = desk.render.share().unwrap_or(0.0);
            parts.push(format!("Sampling anew, {:.0} %", 100.0 * share));
        }
        (None, None) if desk.render.share().is_some() => parts.push("Drawing…".to_owned()),
        (None, None) if desk.session.awaits_picture() => parts.push("Preparing the particles…".to_owned()),
        _ => {}
    }
    if let Some((raised, own)) = picture.and_then(|picture| picture.raised().zip(picture.wished)) {
        parts.push(format!("Tolerance {} while moving, {own} at rest", plain(raised)));
    }
    if let Some(text) = nothing(desk) {
        let galley = ui.painter().layout(
            text,
            egui::FontId::proportional(15.0),
            theme::colours().muted,
            (outer.width() - 48.0).max(80.0),
        );
        ui.painter().galley(outer.center() - 0.5 * galley.size(), galley, theme::colours().muted);
    }
    if parts.is_empty() {
        return;
    }
    let text = parts.join("   ·   ");
    let galley = ui.painter().layout_no_wrap(text, theme::small_font(), theme::DARK.text);
    let size = galley.size() + vec2(18.0, 8.0);
    let place = egui::pos2(outer.center().x, outer.bottom() - 22.0);
    let chip = Rect::from_center_size(place, size);
    ui.painter().rect_filled(chip, 10, Color32::from_black_alpha(170));
    ui.painter().galley(chip.min + vec2(9.0, 4.0), galley, theme::DARK.text);
}

/// Says that a near or far that is fixed cuts off what would be in the picture.
fn cut(desk: &Desk, picture: &PictureFacts) -> Option<String> {
    let camera = desk.session.camera?;
    let near = camera.near.and(picture.facts.cut[0]).map(|_| "near");
    let far = camera.far.and(picture.facts.cut[1]).map(|_| "far");
    let which: Vec<&str> = [near, far].into_iter().flatten().collect();
    (!which.is_empty()).then(|| format!("Cut off by a fixed {}: see Camera", which.join(" and ")))
}

/// Why nothing is to be seen, where that is so.
fn nothing(desk: &Desk) -> Option<String> {
    let index = desk.session.playback.index();
    match &desk.session.picture {
        Some(picture) if picture.facts.particles == 0 && picture.facts.whole > 0 => {
            Some("No particle is selected: see Clip and filter".to_owned())
        }
        Some(picture) if picture.facts.particles == 0 => {
            Some(format!("Frame {} holds no particles", picture.index))
        }
        Some(_) => None,
        None if let Some(folder) = desk.session.waits_in() => {
            Some(format!("Waiting for the first frame in {folder}"))
        }
        None => desk.session.trouble().map(|_| format!("Frame {index} cannot be read; open another file")),
    }
}

/// What is drawn in the background: pictures on their way to files, and a measurement.
fn tasks(ui: &mut Ui, desk: &mut Desk, outer: Rect) {
    let mut row = 0;
    if let Some([read, total]) = desk.session.reading() {
        let title = format!("Reading {} of {}", widgets::bytes(read.min(total)), widgets::bytes(total));
        if card(ui, outer, row, &title, read as f32 / total as f32) {
            desk.session.cancel_reading();
        }
        row += 1;
    }
    let pending = desk.exporting.queue.pending();
    if let (false, Some(export)) = (desk.exporting.shows_queue(), desk.exporting.queue.first_pending()) {
        let name = export.plan.path.file_name().unwrap_or_default().to_string_lossy();
        let more = if pending > 1 { format!(", {} more to come", pending - 1) } else { String::new() };
        if card(ui, outer, row, &format!("Saving {name}{more}"), export.progress().whole()) {
            export.cancel();
        }
        row += 1;
    }
    if let Some(Measurement { state: State::Running(task), .. }) = &desk.measurement
        && card(ui, outer, row, "Measuring the error", task.share())
    {
        task.cancel();
    }
}

/// How far something is, and a button to cancel it. Returns whether that was pressed.
fn card(ui: &mut Ui, outer: Rect, row: usize, title: &str, share: f32) -> bool {
    let width = 300.0_f32.min(outer.width() - 24.0);
    let top = outer.top() + 12.0 + 58.0 * row as f32;
    let corner = egui::pos2(outer.right() - width - 12.0, top);
    let place = Rect::from_min_size(corner, vec2(width, 50.0));
    ui.painter().rect(
        place,
        6,
        theme::colours().panel,
        Stroke::new(1.0, theme::colours().line),
        egui::StrokeKind::Inside,
    );
    ui.scope_builder(egui::UiBuilder::new().max_rect(place.shrink(8.0)), |ui| {
        ui.add(egui::Label::new(RichText::new(title).small()).truncate());
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Min), |ui| {
            let cancelled = ui.small_button("Cancel").clicked();
            let bar = egui::ProgressBar::new(share.min(1.0)).desired_height(8.0);
            ui.centered_and_justified(|ui| ui.add(bar.fill(theme::colours().accent)));
            cancelled
        })
        .inner
    })
    .inner
}

/// Says what happens to files that hover over the window.
fn drop_target(ui: &Ui) {
    if ui.ctx().input(|input| input.raw.hovered_files.is_empty()) {
        return;
    }
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop"));
    let painter = ui.ctx().layer_painter(layer);
    let rect = ui.ctx().content_rect();
    painter.rect_filled(rect, 0, Color32::from_black_alpha(150));
    let frame = rect.shrink(24.0);
    painter.rect_stroke(frame, 12, Stroke::new(2.0, theme::DARK.accent), egui::StrokeKind::Inside);
    let text = "Drop particle files or a folder to open them, or a view.json to load it";
    painter.text(
        rect.center(),
        Align2::CENTER_CENTER,
        text,
        egui::FontId::proportional(18.0),
        theme::DARK.text,
    );
}
