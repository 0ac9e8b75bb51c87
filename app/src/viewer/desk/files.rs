//! Opening runs and views, saving views and pictures.

use std::path::PathBuf;

use super::{Desk, Done, Opening};
use crate::frames::Sequence;
use crate::viewer::dialogs::Purpose;
use crate::viewer::exports::Plan;
use crate::viewer::kept::LastSession;
use crate::viewer::run::{self, Run};
use crate::{image_file, view_file};

impl Desk {
    pub(super) fn chosen(&mut self, purpose: Purpose, paths: Vec<PathBuf>) {
        let Some(first) = paths.first().cloned() else { return };
        match purpose {
            Purpose::OpenFiles | Purpose::OpenFolder => self.find(paths),
            Purpose::LoadView => self.load_view(first),
            Purpose::ImportColours => self.import_colours(first),
            Purpose::ExportColours => self.export_colours(with_ending(first, &["json"])),
            Purpose::SaveView => self.save_view(with_ending(first, &["json"])),
            Purpose::ExportFolder => self.exporting.folder_chosen(&first),
            Purpose::SavePicture => self.save_picture(with_ending(first, &["png", "exr"])),
        }
    }

    pub(super) fn take_drops(&mut self, context: &egui::Context) {
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
    pub(in crate::viewer) fn find(&mut self, paths: Vec<PathBuf>) {
        self.find_for(paths, None);
    }

    /// The same, for a run that is to look as it did in `session`.
    pub(super) fn find_for(&mut self, paths: Vec<PathBuf>, session: Option<Box<LastSession>>) {
        self.finding = true;
        self.work(move || {
            let found = run::find(&paths);
            Done::Found(Opening { paths, session }, found)
        });
    }

    /// Shows the run that `paths` name.
    pub(super) fn open(&mut self, sequence: &Sequence, paths: &[PathBuf]) {
        for note in sequence.notes() {
            self.session.messages.note(note.clone());
        }
        let mut run = Run::new(sequence, self.keeping.settings.frame_cache(), &self.wake);
        run.watch(paths, &self.wake);
        self.session.open(run);
        self.picture.clear();
        self.opened(paths);
    }

    pub(super) fn load_view(&mut self, path: PathBuf) {
        self.work(move || {
            let view = view_file::read(&path);
            Done::ViewRead(path, view.map(Box::new))
        });
    }

    pub(super) fn save_view(&self, path: PathBuf) {
        let view = self.session.saved_view();
        self.work(move || {
            let saved = image_file::write_whole(&path, view.to_json().as_bytes());
            Done::ViewSaved(path, saved)
        });
    }

    pub(super) fn save_picture(&mut self, path: PathBuf) {
        match Plan::in_view(&self.session, path) {
            Some(plan) => self.exporting.queue.add(plan),
            None => self.session.complain("There is no frame to save a picture of: open files first"),
        }
    }

    /// Saves picture and view in the working directory, under names that are free.
    pub(super) fn quick_save(&mut self) {
        let stem = self.file_stem();
        let names = (1..).map(|number| match number {
            1 => stem.clone(),
            number => format!("{stem}-{number}"),
        });
        let queue = &self.exporting.queue;
        let free = |name: &String| {
            let path = PathBuf::from(format!("{name}.png"));
            !path.exists() && !queue.will_write(&path)
        };
        if let Some(name) = names.take(10_000).find(free) {
            self.save_view(format!("{name}.json").into());
            self.save_picture(format!("{name}.png").into());
        }
    }

    pub(super) fn file_stem(&self) -> String {
        let index = self.session.frame().map_or(0, |(index, _)| *index);
        format!("sphcast-{index:04}")
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
