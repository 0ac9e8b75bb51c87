//! The export window: pictures or a video of the run, and what becomes of them.

use std::path::{Path, PathBuf};

use egui::{DragValue, RichText, TextEdit, Ui};

use crate::export::video::{MISSING, USUAL_RATE, VideoFormat};
use crate::image_file::Format;
use crate::viewer::exports::{Exports, Plan};
use crate::viewer::session::Session;
use crate::viewer::widgets::Areas;
use crate::viewer::{theme, widgets};

use super::export_layers::LayerChoice;
use super::export_queue;
use super::image::SIZES;

/// The largest side of an exported picture, in pixels.
const LARGEST: u32 = 16_384;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Picture,
    Sequence,
    Video,
}

/// What the fields of the window say.
pub struct ExportForm {
    pub kind: Kind,
    /// Frames of a sequence or a video.
    pub first: usize,
    pub last: usize,
    pub every: usize,
    pub size: [u32; 2],
    pub format: Format,
    /// What an EXR holds beside its colour.
    pub layers: LayerChoice,
    pub video: VideoFormat,
    pub rate: f64,
    pub folder: String,
    pub name: String,
    pub view_beside: bool,
    pub stats_beside: bool,
    pub keep_done: bool,
    /// Whether videos can be made; `None` until that is known.
    pub ffmpeg: Option<bool>,
}

/// What is asked of the window beside what it holds itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wish {
    ChooseFolder,
}

impl ExportForm {
    /// For the run of `session`, as its picture is.
    pub fn new(session: &Session) -> ExportForm {
        let image = session.complete_view().image;
        let count = session.playback.count();
        let folder = std::env::current_dir().unwrap_or_default();
        let kind = if count > 1 { Kind::Sequence } else { Kind::Picture };
        let mut form = ExportForm {
            kind,
            first: 0,
            last: count.saturating_sub(1),
            every: 1,
            size: [image.width, image.height].map(|side| side.clamp(1, LARGEST)),
            format: Format::Png,
            layers: LayerChoice::default(),
            video: VideoFormat::Mp4,
            rate: USUAL_RATE,
            folder: folder.display().to_string(),
            name: String::new(),
            view_beside: false,
            stats_beside: false,
            keep_done: true,
            ffmpeg: None,
        };
        form.name = form.usual_name(session);
        form
    }

    fn usual_name(&self, session: &Session) -> String {
        match self.kind {
            Kind::Picture => format!("sphcast-{:04}", session.frame().map_or(0, |(index, _)| *index)),
            Kind::Sequence => "frame-{:04}".into(),
            Kind::Video => "film".into(),
        }
    }

    fn ending(&self) -> &'static str {
        match self.kind {
            Kind::Video => self.video.ending(),
            Kind::Picture | Kind::Sequence => self.format.ending(),
        }
    }

    /// The file, pattern or video that the fields name. An ending is added where the name has not this one.
    fn path(&self) -> PathBuf {
        let mut name = self.name.trim().to_owned();
        if self.kind == Kind::Sequence && !name.contains('{') {
            let stem = name.strip_suffix(self.ending()).unwrap_or(&name);
            name = format!("{stem}-{{:04}}");
        }
        if !name.to_lowercase().ends_with(self.ending()) {
            name += self.ending();
        }
        Path::new(self.folder.trim()).join(name)
    }

    /// What the fields say of the run of `session`; `None` where they say nothing that could be done.
    pub fn plan(&self, session: &Session) -> Option<Plan> {
        if self.name.trim().is_empty() || self.folder.trim().is_empty() {
            return None;
        }
        let path = self.path();
        let mut plan = match self.kind {
            Kind::Picture => Plan::in_view(session, path.clone())?,
            Kind::Sequence | Kind::Video => Plan::of_run(session, [self.first, self.last], path.clone())?,
        };
        (plan.every, plan.numbered) = (self.every, true);
        [plan.view.image.width, plan.view.image.height] = self.size;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let stem = stem.split('{').next().unwrap_or_default().trim_end_matches(['-', '_', '.']).to_owned();
        let stem = if stem.is_empty() { "export" } else { &stem };
        let beside = |wanted: bool, ending| wanted.then(|| path.with_file_name(format!("{stem}.{ending}")));
        let is_exr = self.kind != Kind::Video && self.format == Format::Exr;
        plan.rate = self.rate;
        plan.layers = if is_exr { self.layers.chosen() } else { Vec::new() };
        plan.view_file = beside(self.view_beside, "view.json");
        plan.stats_file = beside(self.stats_beside, "stats.json");
        plan.resumes = self.keep_done && self.kind == Kind::Sequence;
        Some(plan)
    }

    /// Shows the window as long as `form` is there.
    pub fn show(
        ui: &Ui,
        form: &mut Option<ExportForm>,
        session: &Session,
        exports: &mut Exports,
    ) -> Vec<Wish> {
        let mut wishes = Vec::new();
        let Some(fields) = form else { return wishes };
        let mut open = true;
        let window = egui::Window::new("Export").id(egui::Id::unique("export")).open(&mut open);
        let place = ui.ctx().content_rect().left_top() + egui::vec2(24.0, 150.0);
        window.collapsible(false).resizable(false).default_pos(place).show(ui.ctx(), |ui| {
            ui.set_width(400.0);
            fields.fields(ui, session, &mut wishes);
            ui.add_space(4.0);
            fields.start(ui, session, exports);
            export_queue::show(ui, exports);
        });
        if !open {
            *form = None;
        }
        wishes
    }

    pub fn fields(&mut self, ui: &mut Ui, session: &Session, wishes: &mut Vec<Wish>) {
        let usual = self.usual_name(session);
        let kinds = [
            (Kind::Picture, "Picture", "The frame in view"),
            (Kind::Sequence, "Sequence", "A picture for each frame"),
            (Kind::Video, "Video", "All frames in one file, made by ffmpeg"),
        ];
        let changed = widgets::row(ui, "Export", |ui| widgets::choice(ui, &mut self.kind, &kinds));
        if changed && self.name == usual {
            self.name = self.usual_name(session);
        }
        if self.kind != Kind::Picture {
            self.frames(ui, session);
        }
        self.pixels(ui);
        self.formats(ui);
        self.files(ui, wishes);
        self.beside(ui);
    }

    fn frames(&mut self, ui: &mut Ui, session: &Session) {
        let end = session.playback.count().saturating_sub(1);
        widgets::row(ui, "Frames", |ui| {
            ui.add(DragValue::new(&mut self.first).range(0..=end)).accessible_name("First frame");
            ui.label("to");
            ui.add(DragValue::new(&mut self.last).range(0..=end)).accessible_name("Last frame");
            ui.label("every");
            ui.add(DragValue::new(&mut self.every).range(1..=end.max(1)).speed(0.1))
                .accessible_name("Every")
                .on_hover_text("1 for all of them, 2 for every other one");
        });
        self.last = self.last.max(self.first);
    }

    fn pixels(&mut self, ui: &mut Ui) {
        widgets::row(ui, "Size", |ui| {
            let [width, height] = &mut self.size;
            let field = |side| DragValue::new(side).range(1..=LARGEST).speed(2.0);
            ui.add(field(width)).accessible_name("Width");
            ui.label("×");
            ui.add(field(height)).accessible_name("Height");
            ui.menu_button("Sizes", |ui| {
                let largest = ("Largest  16384 × 16384", [LARGEST; 2]);
                for (name, size) in SIZES.into_iter().chain([largest]) {
                    if ui.button(name).clicked() {
                        self.size = size;
                        ui.close();
                    }
                }
            });
        });
    }

    fn formats(&mut self, ui: &mut Ui) {
        if self.kind == Kind::Video {
            let formats = [
                (VideoFormat::Mp4, "MP4", "H.264: plays everywhere"),
                (VideoFormat::WebM, "WebM", "VP9: for web pages"),
            ];
            widgets::row(ui, "Format", |ui| widgets::choice(ui, &mut self.video, &formats));
            widgets::row(ui, "Frame rate", |ui| {
                let field = DragValue::new(&mut self.rate).range(0.1..=240.0).speed(0.1).suffix(" fps");
                ui.add(field).accessible_name("Frame rate");
            });
            if self.ffmpeg == Some(false) {
                ui.label(RichText::new(MISSING).color(theme::colours().warning));
            }
            return;
        }
        let formats = [
            (Format::Png, "PNG", "8 bits, sRGB; transparent where there is no background"),
            (Format::Exr, "EXR", "32-bit floats, linear, with alpha"),
        ];
        widgets::row(ui, "Format", |ui| widgets::choice(ui, &mut self.format, &formats));
        if self.format == Format::Exr {
            self.layers.show(ui);
        }
    }

    fn files(&mut self, ui: &mut Ui, wishes: &mut Vec<Wish>) {
        widgets::row(ui, "Folder", |ui| {
            let width = ui.available_width() - 82.0;
            ui.add(TextEdit::singleline(&mut self.folder).desired_width(width)).accessible_name("Folder");
            if ui.button("Choose…").clicked() {
                wishes.push(Wish::ChooseFolder);
            }
        });
        widgets::row(ui, "Name", |ui| {
            let width = ui.available_width() - 58.0;
            let name = ui.add(TextEdit::singleline(&mut self.name).desired_width(width));
            let name = name.accessible_name("Name");
            if self.kind == Kind::Sequence {
                name.on_hover_text("{:04} stands for the number of the frame, in four digits");
            }
            ui.label(RichText::new(self.ending()).color(theme::colours().muted));
        });
    }

    fn beside(&mut self, ui: &mut Ui) {
        widgets::row(ui, "With it", |ui| {
            ui.checkbox(&mut self.view_beside, "view.json")
                .on_hover_text("All settings, for `sphcast render --view`");
            ui.checkbox(&mut self.stats_beside, "stats.json").on_hover_text(
                "What the pictures cost. Takes longer: each is drawn once more in full, to count",
            );
        });
        if self.kind == Kind::Sequence {
            widgets::row(ui, "", |ui| {
                ui.checkbox(&mut self.keep_done, "Keep pictures that are done").on_hover_text(
                    "Files that were made from these very settings and frames are left as they are; others are \
                     written over",
                );
            });
        }
    }

    fn start(&self, ui: &mut Ui, session: &Session, exports: &mut Exports) {
        let plan = self.plan(session);
        let possible = plan.is_some() && !(self.kind == Kind::Video && self.ffmpeg == Some(false));
        let label = if exports.pending() > 0 { "Add to the queue" } else { "Export" };
        ui.add_enabled_ui(possible, |ui| {
            let button = ui.vertical_centered_justified(|ui| ui.button(label)).inner;
            Areas::mark(ui, "export", button.rect);
            let button = button.on_disabled_hover_text("There must be a run, a folder and a name");
            if let (true, Some(plan)) = (button.clicked(), plan) {
                exports.add(plan);
            }
        });
    }
}
