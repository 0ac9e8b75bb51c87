//! What is on its way to files: the queue, the export window, and what closing the window does to them.

use std::path::Path;

use egui::{RichText, Ui};

use super::{Desk, Done, Order};
use crate::export::video;
use crate::viewer::Wake;
use crate::viewer::dialogs::Purpose;
use crate::viewer::exports::{Exports, News};
use crate::viewer::panels::export::{ExportForm, Wish};
use crate::viewer::session::{Numbering, Session};

/// All that is to be saved, and the export window.
pub struct Exporting {
    /// The open window.
    form: Option<ExportForm>,
    pub queue: Exports,
    folder_wanted: bool,
    /// That of the frames which the window names.
    numbering: Numbering,
    /// Whether it is being asked if exports may be lost.
    quitting: bool,
}

impl Exporting {
    pub fn new(wake: &Wake) -> Exporting {
        let queue = Exports::new(Wake::clone(wake));
        Exporting {
            form: None,
            queue,
            folder_wanted: false,
            numbering: Numbering::default(),
            quitting: false,
        }
    }

    pub fn videos_possible(&mut self, possible: bool) {
        if let Some(form) = &mut self.form {
            form.ffmpeg = Some(possible);
        }
    }

    /// Gives the frames that the window names the numbers that they have in `session` by now; of another
    /// run, it names all.
    fn renumber(&mut self, session: &Session) {
        let before = std::mem::replace(&mut self.numbering, session.numbering());
        let Some(form) = &mut self.form else { return };
        if !session.bring_up_to_date(before, [&mut form.first, &mut form.last]) {
            (form.first, form.last) = (0, session.playback.count().saturating_sub(1));
        }
    }

    /// Whether the queue is to be seen.
    pub fn shows_queue(&self) -> bool {
        self.form.is_some()
    }

    pub fn folder_chosen(&mut self, folder: &Path) {
        if let Some(form) = &mut self.form {
            form.folder = folder.display().to_string();
        }
    }
}

impl Desk {
    /// Opens the export window, or closes it.
    pub(super) fn toggle_export(&mut self) {
        self.exporting.form = match self.exporting.form {
            Some(_) => None,
            None => Some(ExportForm::new(&self.session)),
        };
        if self.exporting.form.is_some() {
            self.work(|| Done::VideosPossible(video::is_there()));
        }
    }

    /// Shows the export window while it is open.
    pub(in crate::viewer) fn show_export(&mut self, ui: &Ui) {
        let Exporting { form, queue, .. } = &mut self.exporting;
        let wishes = ExportForm::show(ui, form, &self.session, queue);
        self.exporting.folder_wanted |= wishes.contains(&Wish::ChooseFolder);
        self.ask_before_quitting(ui);
    }

    /// Opens the dialog that the export window asks for.
    pub(super) fn follow_export(&mut self, window: &winit::window::Window) {
        self.exporting.renumber(&self.session);
        if std::mem::take(&mut self.exporting.folder_wanted) {
            self.dialogs.ask(Purpose::ExportFolder, "", window);
        }
        for news in self.exporting.queue.poll(&self.gpu) {
            match news {
                News::Warning(text) => self.session.messages.warn(text),
                News::Note(text) => self.session.messages.note(text),
                News::Failed(text) => self.session.complain(text),
                News::Done(path) => {
                    self.session.messages.note(format!("Saved {}", path.display()));
                    self.session.log(format!("saved {}", path.display()));
                }
            }
        }
    }

    /// Quits, or asks whether to where exports would be lost.
    pub(in crate::viewer) fn quit(&mut self) {
        match self.exporting.queue.pending() {
            0 => self.orders.push(Order::Quit),
            _ => self.exporting.quitting = true,
        }
    }

    fn ask_before_quitting(&mut self, ui: &Ui) {
        if !self.exporting.quitting {
            return;
        }
        let pending = self.exporting.queue.pending();
        let frame = egui::Frame::window(ui.style()).inner_margin(20);
        let response = egui::Modal::new(egui::Id::unique("quit")).frame(frame).show(ui.ctx(), |ui| {
            ui.set_width(380.0);
            ui.label(RichText::new("Exports are not done").heading().strong());
            ui.add_space(6.0);
            let what = if pending == 1 { "An export is".into() } else { format!("{pending} exports are") };
            ui.label(format!(
                "{what} still at work. Pictures that are done stay, and can be kept when the export is \
                 started again; a video is lost."
            ));
            ui.add_space(10.0);
            ui.horizontal(|ui| {
                let go_on = ui.button("Go on exporting").clicked();
                let quit = ui.button("Cancel them and quit").clicked();
                (go_on, quit)
            })
            .inner
        });
        let (go_on, quit) = response.inner;
        if quit || pending == 0 {
            self.exporting.queue.cancel_all();
            self.orders.push(Order::Quit);
        }
        if go_on || quit || response.should_close() || pending == 0 {
            self.exporting.quitting = false;
        }
    }
}
