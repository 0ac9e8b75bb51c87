//! Session, threads, dialogs and panels at work together: one call a frame.

use std::path::{Path, PathBuf};
use std::sync::{Arc, mpsc};
use std::time::Instant;

use egui::Ui;
use renderer::{GpuOptions, View};
use winit::window::Window;

use crate::frames::Sequence;
use crate::{image_file, view_file};

use super::analysis::Analysis;
use super::dialogs::{self, Dialogs, Purpose};
use super::error_map;
use super::export::Export;
use super::measurement::{Measurement, State};
use super::panels::sampling::SamplingPanel;
use super::panels::transfer_editor::TransferEditor;
use super::picture_view::PictureView;
use super::render_thread::{RenderThread, Report};
use super::run::{self, Run};
use super::session::Session;
use super::shortcuts::Action;
use super::task::Outcome;
use super::widgets::Areas;
use super::{Options, Wake};

/// What was done on another thread.
enum Done {
    Found(Result<Sequence, String>),
    ViewRead(PathBuf, anyhow::Result<Box<View>>),
    ViewSaved(PathBuf, anyhow::Result<()>),
    Counted(Analysis),
}

/// What only the window can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    FullScreen,
    Quit,
}

pub struct Desk {
    pub session: Session,
    pub(super) picture: PictureView,
    pub(super) editor: TransferEditor,
    pub(super) sampling: SamplingPanel,
    pub(super) exports: Vec<Export>,
    /// Of the picture in view.
    pub(super) measurement: Option<Measurement>,
    pub(super) legend: bool,
    pub(super) help: bool,
    pub(super) side_panel: bool,
    pub(super) render: RenderThread,
    pub orders: Vec<Order>,
    /// When to draw the next frame although nothing happens.
    pub due: Option<Instant>,
    dialogs: Dialogs,
    done: (mpsc::Sender<Done>, mpsc::Receiver<Done>),
    counting: bool,
    finding: bool,
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
        let mut desk = Desk {
            session,
            picture: PictureView::new(),
            editor: TransferEditor::default(),
            sampling: SamplingPanel::new(),
            exports: Vec::new(),
            measurement: None,
            legend: true,
            help: false,
            side_panel: true,
            render: RenderThread::spawn(options.gpu.clone(), Wake::clone(&wake)),
            orders: Vec::new(),
            due: None,
            dialogs: Dialogs::new(Wake::clone(&wake)),
            done: mpsc::channel(),
            counting: false,
            finding: false,
            gpu: options.gpu,
            wake,
            log_events: options.log_events,
            areas: Areas::default(),
        };
        desk.open(&options.sequence);
        if options.playing {
            desk.session.toggle_playing();
        }
        desk
    }

    /// One frame of the window: takes in what has happened, shows everything, asks for what is missing.
    pub fn frame(&mut self, ui: &mut Ui, window: &Window) {
        let now = Instant::now();
        self.take_reports(ui.ctx());
        self.take_done();
        self.take_outcomes();
        self.take_drops(ui.ctx());
        let before = self.session.view.clone();
        let mut actions = super::shortcuts::pressed(ui.ctx());
        let room = super::layout::show(ui, self, &mut actions);
        for action in actions {
            self.act(action, window);
        }
        // A hand on the mouse will change it again; after a click, the picture may take its time.
        if self.session.view != before && ui.input(|input| input.pointer.any_down()) {
            self.session.touch(now);
        }
        self.session.poll(now);
        if let Some(job) = self.session.job(now, room) {
            self.render.submit(job);
        }
        self.follow_measurement(ui.ctx());
        self.count();
        // Of the same moment as the job: one that is drawn for a moving picture is followed by another.
        self.due = self.session.due(now);
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
            Action::MeasureError => self.measure_error(),
            Action::PlayPause => session.toggle_playing(),
            Action::StepForward | Action::StepBack => {
                session.playback.pause();
                session.step(action == Action::StepForward);
            }
            Action::First => session.jump(0),
            Action::Last => session.jump(usize::MAX),
            Action::Reset => session.reset_camera(),
            Action::Look(side) => {
                if let Some(camera) = &mut session.camera {
                    camera.look_from(side);
                }
            }
            Action::ZoomIn | Action::ZoomOut => self.picture.zoom(session, action == Action::ZoomIn),
            Action::Fly => self.picture.flying = !self.picture.flying,
            Action::Panels => self.side_panel = !self.side_panel,
            Action::FullScreen => self.orders.push(Order::FullScreen),
            Action::Help => self.help = !self.help,
            Action::Quit => self.orders.push(Order::Quit),
        }
    }

    fn take_reports(&mut self, context: &egui::Context) {
        for report in self.render.reports() {
            if let Report::Picture(shown) = &report {
                self.picture.set(context, shown);
            }
            self.session.note(&report);
        }
    }

    fn take_done(&mut self) {
        while let Ok(done) = self.done.1.try_recv() {
            match done {
                Done::Found(Ok(sequence)) => {
                    self.finding = false;
                    self.open(&sequence);
                }
                Done::Found(Err(text)) => {
                    self.finding = false;
                    self.session.complain(text);
                }
                Done::ViewRead(path, Ok(view)) => {
                    self.session.adopt(*view);
                    self.session.messages.note(format!("View loaded from {}", path.display()));
                    self.session.log(format!("loaded {}", path.display()));
                }
                Done::ViewSaved(path, Ok(())) => {
                    self.session.messages.note(format!("View saved as {}", path.display()));
                    self.session.log(format!("saved {}", path.display()));
                }
                Done::ViewRead(_, Err(error)) | Done::ViewSaved(_, Err(error)) => {
                    self.session.complain(format!("{error:#}"));
                }
                Done::Counted(analysis) => {
                    self.counting = false;
                    self.session.answer(analysis);
                }
            }
        }
    }

    fn take_outcomes(&mut self) {
        match self.dialogs.poll() {
            Some(dialogs::Outcome::Chosen(purpose, paths)) => self.chosen(purpose, paths),
            Some(dialogs::Outcome::Unavailable) => self.session.complain(
                "No file dialog could be opened: install xdg-desktop-portal or zenity, drop files on the \
                 window, name them on the command line, or save with Ctrl+Shift+E",
            ),
            Some(dialogs::Outcome::Dismissed) => self.session.log("dialog closed"),
            None => {}
        }
        let session = &mut self.session;
        self.exports.retain(|export| {
            let Some(outcome) = export.task.poll() else { return true };
            let path = export.path.display();
            match outcome {
                Outcome::Done(()) => {
                    session.messages.note(format!("Picture saved as {path}"));
                    session.log(format!("saved {path}"));
                }
                Outcome::Cancelled => session.messages.note(format!("{path} was not saved")),
                Outcome::Failed(text) => session.complain(text),
            }
            false
        });
    }

    fn chosen(&mut self, purpose: Purpose, paths: Vec<PathBuf>) {
        let Some(first) = paths.first().cloned() else { return };
        match purpose {
            Purpose::OpenFiles | Purpose::OpenFolder => self.find(paths),
            Purpose::LoadView => self.load_view(first),
            Purpose::SaveView => self.save_view(with_ending(first, &["json"])),
            Purpose::SavePicture => self.save_picture(with_ending(first, &["png", "exr"])),
        }
    }

    fn take_drops(&mut self, context: &egui::Context) {
        let dropped = context.input(|input| input.raw.dropped_files.clone());
        let paths: Vec<PathBuf> = dropped.iter().map(|file| file.path().to_owned()).collect();
        match paths.as_slice() {
            [] => {}
            [only] if only.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json")) => {
                self.load_view(only.clone())
            }
            _ => self.find(paths),
        }
    }

    /// Looks for frames and opens them as a run.
    fn find(&mut self, paths: Vec<PathBuf>) {
        self.finding = true;
        self.work(move || Done::Found(run::find(&paths)));
    }

    fn open(&mut self, sequence: &Sequence) {
        for note in sequence.notes() {
            self.session.messages.note(note.clone());
        }
        self.session.open(Run::new(sequence, &self.wake));
        self.picture.clear();
    }

    fn load_view(&mut self, path: PathBuf) {
        self.work(move || {
            let view = view_file::read(&path);
            Done::ViewRead(path, view.map(Box::new))
        });
    }

    fn save_view(&self, path: PathBuf) {
        let view = self.session.complete_view();
        self.work(move || {
            let saved = image_file::write_whole(&path, view.to_json().as_bytes());
            Done::ViewSaved(path, saved)
        });
    }

    fn save_picture(&mut self, path: PathBuf) {
        let Some((_, frame)) = self.session.frame().cloned() else {
            self.session.complain("There is no frame to save a picture of: open files first");
            return;
        };
        let view = self.session.complete_view();
        let wake = Wake::clone(&self.wake);
        self.exports.push(Export::start(frame, view, path, self.gpu.clone(), wake));
    }

    /// Starts to measure the error of the picture in view.
    fn measure_error(&mut self) {
        let session = &self.session;
        if let (Some((_, frame)), Some(tolerance)) = (session.frame(), session.view.sampling.tolerance) {
            let (frame, view) = (Arc::clone(frame), session.drawn_view());
            let wake = Wake::clone(&self.wake);
            self.measurement = Some(Measurement::start(frame, &view, tolerance, self.gpu.clone(), wake));
        }
    }

    /// Takes in what was measured, and forgets it with the picture that it is about.
    fn follow_measurement(&mut self, context: &egui::Context) {
        let view = self.session.drawn_view();
        let session = &mut self.session;
        let Some(measurement) = &mut self.measurement else { return };
        let in_view = session.frame().is_some_and(|(_, frame)| measurement.is_of(frame, &view));
        let outcome = if in_view { measurement.poll() } else { Some(Outcome::Cancelled) };
        match outcome {
            None => return,
            Some(Outcome::Done(())) => {
                if let State::Done(measured) = &measurement.state {
                    session
                        .log(format!("measured max={:e} above={}", measured.error.max, measured.error.above));
                    self.picture.set_errors(context, Some(error_map::image(measured)));
                }
                return;
            }
            Some(Outcome::Failed(text)) => session.complain(text),
            Some(Outcome::Cancelled) => session.log("no measurement"),
        }
        self.measurement = None;
        self.picture.set_errors(context, None);
    }

    /// Saves picture and view in the working directory, under names that are free.
    fn quick_save(&mut self) {
        let stem = self.file_stem();
        let names = (1..).map(|number| match number {
            1 => stem.clone(),
            number => format!("{stem}-{number}"),
        });
        let free = |name: &String| !Path::new(&format!("{name}.png")).exists();
        if let Some(name) = names.take(10_000).find(free) {
            self.save_view(format!("{name}.json").into());
            self.save_picture(format!("{name}.png").into());
        }
    }

    fn file_stem(&self) -> String {
        let index = self.session.frame().map_or(0, |(index, _)| *index);
        format!("sphcast-{index:04}")
    }

    /// Counts values for the histogram, one frame at a time.
    fn count(&mut self) {
        if self.counting {
            return;
        }
        if let Some(question) = self.session.question() {
            self.counting = true;
            self.work(move || Done::Counted(question.answer()));
        }
    }

    fn work(&self, task: impl FnOnce() -> Done + Send + 'static) {
        let (sender, wake) = (self.done.0.clone(), Wake::clone(&self.wake));
        std::thread::spawn(move || {
            // The window is gone when nobody listens.
            let _ = sender.send(task());
            wake();
        });
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

/// A file name that ends in one of `endings`, the first unless it has another of them.
fn with_ending(path: PathBuf, endings: &[&str]) -> PathBuf {
    let fits = |ending: &std::ffi::OsStr| endings.iter().any(|known| ending.eq_ignore_ascii_case(known));
    if path.extension().is_some_and(fits) {
        return path;
    }
    let mut name = path.into_os_string();
    name.push(".");
    name.push(endings[0]);
    name.into()
}
