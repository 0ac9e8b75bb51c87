//! The timeline: where the playhead is, what is in memory, and the transport buttons.

use egui::{Align, Color32, Layout, Pos2, Rect, RichText, Sense, Stroke, Ui, pos2, vec2};

use crate::frames::Cached;
use crate::viewer::icons::{self, Icon};
use crate::viewer::keys::shortcuts::{Action, with_keys};
use crate::viewer::playback::Playback;
use crate::viewer::session::Session;
use crate::viewer::{accessible, theme, widgets};

pub const HEIGHT: f32 = 64.0;
const TRACK_HEIGHT: f32 = 8.0;

pub fn show(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    track(ui, session);
    ui.horizontal(|ui| {
        ui.scope(|ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            transport(ui, session, actions);
        });
        ui.add_space(6.0);
        speed(ui, session);
        follow(ui, session);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 14.0;
            position(ui, session);
        });
    });
}

fn transport(ui: &mut Ui, session: &mut Session, actions: &mut Vec<Action>) {
    let playing = session.playback.playing();
    let (sign, name) = if playing { (Icon::Pause, "Pause") } else { (Icon::Play, "Play") };
    for (icon, name, action) in [
        (Icon::First, "First frame", Action::First),
        (Icon::StepBack, "Previous frame", Action::StepBack),
        (sign, name, Action::PlayPause),
        (Icon::StepForward, "Next frame", Action::StepForward),
        (Icon::Last, "Last frame", Action::Last),
    ] {
        let hint = with_keys(ui.ctx(), name, action);
        let pressed = match action {
            Action::PlayPause => icons::hinted_switch(ui, icon, name, &hint, playing),
            _ => icons::hinted_button(ui, icon, name, &hint, true),
        };
        if pressed.clicked() {
            actions.push(action);
        }
    }
    ui.add_space(6.0);
    let looping = &mut session.playback.looping;
    if icons::switch(ui, Icon::Loop, "Play in a loop", *looping).clicked() {
        *looping = !*looping;
    }
}

fn speed(ui: &mut Ui, session: &mut Session) {
    let speed = &mut session.playback.speed;
    let label = |speed: f64| format!("{speed} fps");
    let shown = egui::ComboBox::from_id_salt("speed").width(76.0).selected_text(label(*speed));
    let response = shown.show_ui(ui, |ui| {
        for choice in Playback::SPEEDS {
            ui.selectable_value(speed, choice, label(choice));
        }
    });
    let response = response.response.accessible_name("Speed");
    response.on_hover_text("Frames a second while playing; never faster than pictures are drawn");
}

/// Whether to go along with a run that is being written.
fn follow(ui: &mut Ui, session: &mut Session) {
    if !session.may_grow() {
        return;
    }
    let on = session.is_following();
    let button = egui::Button::new("Follow").selected(on);
    let button = if on { button.fill(theme::colours().accent_deep) } else { button };
    let response = ui.add(button).accessible_name("Follow the newest").on_hover_text(
        "Shows the newest frame, and every new one as soon as the solver has written it. Ends where you go to \
         another frame",
    );
    if response.clicked() {
        session.follow(!on);
    }
}

/// Which frame this is, in words, from right to left.
fn position(ui: &mut Ui, session: &Session) {
    let index = session.playback.index();
    // Counted from 0, as `--frames` does.
    let last = (session.playback.count() - 1).to_string();
    let text = format!("{index:>width$} / {last}", width = last.len());
    ui.label(RichText::new(text).font(theme::number_font()).color(theme::colours().text));
    let here = session.frame().filter(|(frame, _)| *frame == index);
    if let Some(time) = here.and_then(|(_, frame)| frame.metadata.time) {
        let text = format!("t = {}", widgets::short(time));
        ui.label(RichText::new(text).font(theme::number_font()).color(theme::colours().muted));
    }
    if session.trouble().is_some() {
        ui.label(RichText::new("cannot be read").color(theme::colours().error));
    } else if session.waiting() {
        ui.label(RichText::new("reading…").color(theme::colours().warning));
    }
    if let Some(run) = session.run() {
        let name = RichText::new(run.name(index)).color(theme::colours().muted);
        ui.add(egui::Label::new(name).truncate());
    }
}

/// Places of the frames along the track.
struct Track {
    rect: Rect,
    count: usize,
}

impl Track {
    /// The part of the track that stands for frame `index`.
    fn cell(&self, index: usize) -> Rect {
        let width = self.rect.width() / self.count as f32;
        let left = self.rect.left() + index as f32 * width;
        Rect::from_min_max(pos2(left, self.rect.top()), pos2(left + width, self.rect.bottom()))
    }

    fn at(&self, cursor: Pos2) -> usize {
        let share = ((cursor.x - self.rect.left()) / self.rect.width()).clamp(0.0, 1.0);
        ((share * self.count as f32) as usize).min(self.count - 1)
    }
}

fn track(ui: &mut Ui, session: &mut Session) {
    let size = vec2(ui.available_width(), 22.0);
    let (outer, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let count = session.playback.count();
    if count == 0 {
        return;
    }
    let rect = Rect::from_center_size(outer.center(), vec2(outer.width() - 12.0, TRACK_HEIGHT));
    widgets::Areas::mark(ui, "timeline", rect);
    let track = Track { rect, count };
    let told = accessible::slider(ui, &response, "Timeline", session.playback.index(), count - 1);
    let pulled = response.dragged() || response.clicked();
    let pointed = response.interact_pointer_pos().filter(|_| pulled).map(|cursor| track.at(cursor));
    if let Some(index) = told.or(pointed)
        && index != session.playback.index()
    {
        session.playback.pause();
        session.jump(index);
        session.touch(std::time::Instant::now());
    }
    paint(ui, session, &track);
    if let Some(cursor) = response.hover_pos() {
        let index = track.at(cursor);
        let name = session.run().map_or("", |run| run.name(index)).to_owned();
        response.on_hover_text_at_pointer(format!("{index}  {name}"));
    }
}

fn paint(ui: &Ui, session: &Session, track: &Track) {
    let painter = ui.painter();
    painter.rect_filled(track.rect, 3, theme::colours().well);
    let cached = session.run().map(|run| run.stream.cached()).unwrap_or_default();
    // Neighbours of one kind are one shape: a sequence may have many thousand frames.
    let mut first = 0;
    while first < cached.len() {
        let kind = cached[first];
        let same = cached[first..].iter().take_while(|other| **other == kind).count();
        let last = first + same - 1;
        let mut rect = track.cell(first).union(track.cell(last));
        let colour = match kind {
            Cached::No => Color32::TRANSPARENT,
            Cached::Loading => theme::colours().loading,
            Cached::Yes => theme::colours().cached,
            Cached::Failed => theme::colours().error,
        };
        if kind == Cached::Failed {
            // Visible, however many frames there are.
            rect = rect.expand2(vec2((1.5 - 0.5 * rect.width()).max(0.0), 0.0));
        }
        painter.rect_filled(rect, 2, colour);
        first += same;
    }
    ticks(ui, track);
    keyframes(ui, session, track);
    let cell = track.cell(session.playback.index());
    let head = Rect::from_center_size(cell.center(), vec2(cell.width().clamp(4.0, 10.0), 18.0));
    painter.rect_filled(head, 3, theme::colours().strong);
}

/// Marks of the camera's keyframes; bright while the camera follows them.
fn keyframes(ui: &Ui, session: &Session, track: &Track) {
    let colour = if session.follows_path() { theme::colours().warning } else { theme::colours().muted };
    let shown = session.view.path.keyframes.iter().filter(|key| key.frame < track.count as f64);
    for key in shown {
        let cell = track.cell(key.frame as usize);
        let x = cell.center().x + key.frame.fract() as f32 * cell.width();
        let centre = pos2(x, track.rect.top() - 3.5);
        let points = [vec2(0.0, -3.5), vec2(3.5, 0.0), vec2(0.0, 3.5), vec2(-3.5, 0.0)].map(|p| centre + p);
        ui.painter().add(egui::Shape::convex_polygon(points.to_vec(), colour, Stroke::NONE));
    }
}

/// Marks between frames, where they are far enough apart to be told from one another.
fn ticks(ui: &Ui, track: &Track) {
    if track.rect.width() / (track.count as f32) < 8.0 {
        return;
    }
    for index in 1..track.count {
        let x = track.cell(index).left();
        let stroke = Stroke::new(1.0, theme::colours().panel);
        ui.painter().line_segment([pos2(x, track.rect.top()), pos2(x, track.rect.bottom())], stroke);
    }
}
