//! Session, threads, dialogs and panels at work together: one call a frame.

mod cameras;
mod exporting;
mod files;
mod functions;
mod keeping;
mod looking;
mod measuring;
mod news;
mod surveying;

use std::sync::mpsc;
use std::time::Instant;

use egui::Ui;
use renderer::GpuOptions;
use winit::window::Window;

use super::dialogs::{Dialogs, Purpose};
use super::panels::hud::Hud;
use super::panels::inspector::Inspector;
use super::panels::palette::Palette;
use super::panels::preferences::Preferences;
use super::panels::sampling::SamplingPanel;
use super::panels::transfer_editor::TransferEditor;
use super::render_thread::RenderThread;
use super::session::{Numbering, Session, Tool};
use super::task::Task;
use super::widgets::Areas;
use super::{Options, Wake};
use crate::viewer::analysis::survey::Found;
use crate::viewer::inspect::measurement::Measurement;
use crate::viewer::kept::Writer;
use crate::viewer::keys::escape::Escape;
use crate::viewer::keys::shortcuts::Action;
use crate::viewer::picture::picture_view::PictureView;

use exporting::Exporting;
use keeping::Keeping;
use news::{Dated, Done, Opening};

/// What only the window can do.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Order {
    FullScreen,
    /// Gives the clipboard's text to [`Desk::paste_camera`].
    PasteCamera,
    /// Puts a text on the clipboard.
    Copy(String),
    Quit,
}

pub struct Desk {
    pub session: Session,
    pub(super) picture: PictureView,
    pub(super) editor: TransferEditor,
    pub(super) sampling: SamplingPanel,
    /// Pictures and videos that are being saved.
    pub(super) exporting: Exporting,
    /// Of the picture in view.
    pub(super) measurement: Option<Measurement>,
    /// Of all frames, for their range.
    survey: Option<Task<Found>>,
    pub(super) inspector: Inspector,
    pub(super) hud: Hud,
    pub(super) help: bool,
    pub(super) side_panel: bool,
    /// Whether the start page is shown.
    pub(super) start: bool,
    pub(super) palette: Option<Palette>,
    pub(super) preferences: Option<Preferences>,
    pub(super) keeping: Keeping,
    pub(super) render: RenderThread,
    pub orders: Vec<Order>,
    /// When to draw the next frame although nothing happens.
    pub due: Option<Instant>,
    dialogs: Dialogs,
    done: (mpsc::Sender<Dated>, mpsc::Receiver<Dated>),
    counting: bool,
    finding: bool,
    /// Number of searches for frames so far: the latest one counts.
    searches: usize,
    escape: Escape,
    inquiries: looking::Inquiries,
    /// Which device the command line asks for, and which one is asked for in the end.
    given_gpu: GpuOptions,
    gpu: GpuOptions,
    wake: Wake,
    /// Whether a script follows what happens.
    pub log_events: bool,
    areas: Areas,
}

impl Desk {
    pub fn new(options: Options, wake: Wake) -> Desk {
        let mut session = Session::new(options.view);
        session.fits_window = !options.fixed_size;
        let done = mpsc::channel();
        let (keeping, troubles) = Keeping::read(writer(mpsc::Sender::clone(&done.0), &wake));
        session.budget = keeping.settings.budget.sound();
        let gpu = keeping.settings.gpu(&options.gpu);
        let crashed = keeping.sessions.left.iter().any(|left| !left.session.ended);
        let mut desk = Desk {
            session,
            picture: PictureView::new(),
            editor: TransferEditor::default(),
            sampling: SamplingPanel::new(),
            exporting: Exporting::new(&wake),
            measurement: None,
            survey: None,
            inspector: Inspector::default(),
            hud: Hud::default(),
            help: false,
            side_panel: true,
            start: false,
            palette: None,
            preferences: None,
            keeping,
            render: RenderThread::spawn(gpu.clone(), Wake::clone(&wake)),
            orders: Vec::new(),
            due: None,
            dialogs: Dialogs::new(Wake::clone(&wake)),
            done,
            counting: false,
            finding: false,
            searches: 0,
            escape: Escape::default(),
            inquiries: looking::Inquiries::default(),
            given_gpu: options.gpu,
            gpu,
            wake,
            log_events: options.log_events,
            areas: Areas::default(),
        };
        troubles.into_iter().for_each(|trouble| desk.session.complain(trouble));
        desk.open(&options.sequence, &options.files);
        desk.session.follow(options.follow);
        desk.list_functions();
        if options.files.is_empty() {
            // Who names no run wants to see what this is, or to go on.
            desk.session.toggle_playing();
            desk.start = desk.keeping.settings.start_page || crashed;
        }
        desk
    }

    /// One frame of the window: takes in what has happened, shows everything, asks for what is missing.
    pub fn frame(&mut self, ui: &mut Ui, window: &Window) {
        let now = Instant::now();
        self.take_reports();
        self.take_done();
        self.take_outcomes(ui.ctx());
        self.take_drops(ui.ctx());
        let before = self.session.view.clone();
        self.keeping.settings.keymap().install(ui.ctx());
        self.keeping.follow_scale(ui.ctx());
        super::theme::choose(ui.ctx(), self.keeping.settings.appearance);
        // These take keys for themselves.
        let takes_keys = self.palette.is_some() || self.preferences.is_some();
        let escaped = !takes_keys && !self.help && self.escape.pressed(ui.ctx());
        let mut actions =
            if takes_keys { Vec::new() } else { crate::viewer::keys::shortcuts::pressed(ui.ctx()) };
        let room = super::layout::show(ui, self, &mut actions);
        for action in actions {
            self.act(action, window);
        }
        // A hand on the mouse will change it again; after a click, the picture may take its time.
        if self.session.view != before && ui.input(|input| input.pointer.any_down()) {
            self.session.touch(now);
        }
        let held = ui.input(|input| input.pointer.any_down()) || ui.ctx().text_edit_focused();
        self.session.remember(now, held);
        self.session.poll(now);
        if let Some(job) = self.session.job(now, room) {
            self.render.submit(job);
        }
        self.follow_measurement();
        self.follow_survey();
        self.follow_presets(window);
        self.follow_export(window);
        if escaped {
            // Closes what a tool has opened, and then puts the tool away.
            self.session.put_away();
        }
        self.count();
        self.look_closer();
        // Of the same moment as the job: one that is drawn for a moving picture is followed by another.
        self.due = self.session.due(now);
        // Once, and not at every step of a drag.
        if !ui.input(|input| input.pointer.any_down()) {
            self.keeping.settings.budget = self.session.budget;
        }
        self.keep(now);
        self.escape.remember(ui.ctx());
        self.tell(ui.ctx());
    }

    /// Writes down what happened, and where things are, for scripts that drive the window.
    fn tell(&mut self, context: &egui::Context) {
        let areas = Areas::take(context);
        if areas != self.areas {
            let scale = context.pixels_per_point();
            for (name, rect) in &areas.0 {
                let [x, y] = [rect.left(), rect.top()].map(|place| (place * scale).round());
                let [width, height] = [rect.width(), rect.height()].map(|side| (side * scale).round());
                self.session.log(format!("area {name} {x} {y} {width} {height}"));
            }
            self.areas = areas;
        }
        for event in self.session.take_events() {
            if self.log_events {
                eprintln!("event: {event}");
            }
        }
    }

    pub fn title(&self) -> String {
        let run = self.session.run().map_or("", |run| run.title.as_str());
        format!("{run} – sphcast")
    }

    pub fn act(&mut self, action: Action, window: &Window) {
        let session = &mut self.session;
        match action {
            Action::OpenFiles => self.dialogs.ask(Purpose::OpenFiles, "", window),
            Action::OpenFolder => self.dialogs.ask(Purpose::OpenFolder, "", window),
            Action::OpenDemo => self.find(vec!["demo".into()]),
            Action::LoadView => self.dialogs.ask(Purpose::LoadView, "", window),
            Action::SaveView => self.dialogs.ask(Purpose::SaveView, "view.json", window),
            Action::SavePicture => {
                let name = format!("{}.png", self.file_stem());
                self.dialogs.ask(Purpose::SavePicture, &name, window);
            }
            Action::QuickSave => self.quick_save(),
            Action::Export => self.toggle_export(),
            Action::MeasureError => self.measure_error(),
            Action::Undo => session.undo(),
            Action::Redo => session.redo(),
            Action::PlayPause => session.toggle_playing(),
            Action::StepForward | Action::StepBack => {
                session.playback.pause();
                session.follow(false);
                session.step(action == Action::StepForward);
            }
            Action::First => session.jump(0),
            Action::Last => session.jump(usize::MAX),
            Action::Reset
            | Action::Look(_)
            | Action::ZoomIn
            | Action::ZoomOut
            | Action::Fly
            | Action::Walk
            | Action::CopyCamera
            | Action::PasteCamera
            | Action::Bookmark
            | Action::GoTo(_)
            | Action::Keyframe
            | Action::FollowPath => self.move_camera(action),
            Action::Inspect => session.take_tool(Tool::Inspect),
            Action::Pick => session.take_tool(Tool::Pick),
            Action::Measure => session.take_tool(Tool::Measure),
            Action::CellClasses => session.overlay.toggle_classes(),
            Action::Palette => self.palette = Some(Palette::default()),
            Action::Settings => self.open_preferences(),
            Action::Start => self.start = !self.start,
            Action::Panels => self.side_panel = !self.side_panel,
            Action::Performance => self.hud.open = !self.hud.open,
            Action::FullScreen => self.orders.push(Order::FullScreen),
            Action::Help => self.help = !self.help,
            Action::Quit => self.quit(),
        }
    }

    /// Counts values for the histogram, one frame at a time.
    fn count(&mut self) {
        if self.counting {
            return;
        }
        if let Some(question) = self.session.question() {
            self.counting = true;
            self.work(move || Done::Counted(Box::new(question.answer())));
        }
    }

    fn open_preferences(&mut self) {
        self.preferences = Some(Preferences::default());
        self.work(|| Done::Adapters(renderer::Gpu::adapters()));
    }

    /// Asks for the picture again, after the window's device was lost with all textures.
    pub fn picture_lost(&mut self) {
        self.picture.clear();
        self.session.ask_again();
        self.session.recovered("The window's graphics device was lost and has been opened again");
    }

    /// What is going on in the background, for the status line.
    pub(super) fn busy(&self) -> Option<&'static str> {
        match (&self.session, self.finding) {
            (_, true) => Some("Looking for frames…"),
            (session, _) if session.waiting() => Some("Reading…"),
            (session, _) if session.adapter.is_none() => Some("Preparing the graphics device…"),
            _ => None,
        }
    }
}

/// What writes settings and the like, and tells how that went.
fn writer(sender: mpsc::Sender<Dated>, wake: &Wake) -> Writer {
    let wake = Wake::clone(wake);
    Writer::new(move |file, result| {
        // No frame's number is in it, and the window is gone when nobody listens.
        let _ = sender.send((Numbering::default(), Done::Kept(file, result)));
        wake();
    })
}
