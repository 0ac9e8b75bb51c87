//! Opening runs and views, saving views and pictures.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::{Desk, Done, Opening};
use crate::frames::Sequence;
use crate::view_file;
use crate::viewer::dialogs::Purpose;
use crate::viewer::exports::Plan;
use crate::viewer::kept::Left;
use crate::viewer::run::{self, Run};
use crate::whole_file::write_whole;

impl Desk {
    pub(super) fn chosen(&mut self, purpose: Purpose, paths: Vec<PathBuf>) {
        let Some(first) = paths.first().cloned() else { return };
        let endings: &[&str] = match purpose {
            Purpose::ExportColours | Purpose::SaveView => &["json"],
            Purpose::SavePicture => &["png", "exr"],
            _ => &[],
        };
        let named = if endings.is_empty() { Ok(first) } else { with_ending(first, endings) };
        let first = match named {
            Ok(first) => first,
            Err(text) => return self.session.complain(text),
        };
        match purpose {
            Purpose::OpenFiles | Purpose::OpenFolder => self.find(paths),
            Purpose::LoadView => self.load_view(first),
            Purpose::ImportColours => self.import_colours(first),
            Purpose::ExportColours => self.export_colours(first),
            Purpose::SaveView => self.save_view(first),
            Purpose::ExportFolder => self.exporting.folder_chosen(&first),
            Purpose::SavePicture => self.save_picture(first),
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

    /// The same, for a run that is to look as it did when it was left behind.
    pub(super) fn find_for(&mut self, paths: Vec<PathBuf>, left: Option<Box<Left>>) {
        self.finding = true;
        self.searches += 1;
        let search = self.searches;
        self.work(move || {
            let found = run::find(&paths);
            Done::Found(Opening { search, paths, left }, found)
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
            let saved = write_whole(&path, view.to_json().as_bytes());
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
        let queue = &self.exporting.queue;
        match free_name(&stem, |path| path.exists() || queue.will_write(path)) {
            Some(name) => {
                self.save_view(format!("{name}.json").into());
                self.save_picture(format!("{name}.png").into());
            }
            None => self.session.complain(format!(
                "{stem}.png: so is every name up to {stem}-{MOST_NAMES}.png taken; move some of them, or choose \
                 a name with Save picture"
            )),
        }
    }

    pub(super) fn file_stem(&self) -> String {
        let index = self.session.frame().map_or(0, |(index, _)| *index);
        format!("sphcast-{index:04}")
    }
}

/// Names that are tried for a picture.
const MOST_NAMES: usize = 10_000;

/// A name, made of `stem`, under which neither a picture nor a view is `taken`.
fn free_name(stem: &str, taken: impl Fn(&Path) -> bool) -> Option<String> {
    let names = (1..=MOST_NAMES).map(|number| match number {
        1 => stem.to_owned(),
        number => format!("{stem}-{number}"),
    });
    let free = |name: &String| [".png", ".json"].iter().all(|end| !taken(Path::new(&format!("{name}{end}"))));
    names.into_iter().find(free)
}

/// A file name that ends in one of `endings`, the first unless it has another of them.
///
/// # Errors
/// A name that is another file's with its ending: nobody was asked whether that may be replaced.
fn with_ending(path: PathBuf, endings: &[&str]) -> Result<PathBuf, String> {
    let fits = |ending: &OsStr| endings.iter().any(|known| ending.eq_ignore_ascii_case(known));
    if path.extension().is_some_and(fits) {
        return Ok(path);
    }
    let mut name = path.into_os_string();
    name.push(".");
    name.push(endings[0]);
    let path = PathBuf::from(name);
    match path.exists() {
        true => Err(format!("{}: exists already: save with its whole name to replace it", path.display())),
        false => Ok(path),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_free_for_picture_and_view() {
        let taken = ["a.png", "a-2.json", "a-4.png"];
        let free = |stem: &str| free_name(stem, |path| taken.iter().any(|name| path == Path::new(name)));
        assert_eq!((free("a").as_deref(), free("b").as_deref()), (Some("a-3"), Some("b")));
        assert_eq!(free_name("a", |_| true), None);
    }

    #[test]
    fn an_ending_that_is_added_replaces_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("a.png"), "").unwrap();
        let endings = ["png", "exr"];
        assert_eq!(with_ending(path("b"), &endings), Ok(path("b.png")));
        assert_eq!(with_ending(path("b.EXR"), &endings), Ok(path("b.EXR")));
        assert_eq!(with_ending(path("a.png"), &endings), Ok(path("a.png")), "the dialog has asked");
        assert!(with_ending(path("a"), &endings).unwrap_err().contains("a.png: exists already"));
    }
}
