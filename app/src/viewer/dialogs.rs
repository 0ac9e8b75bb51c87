//! The system's file dialogs, on threads of their own: the window never waits for one.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;

use rfd::{AsyncFileDialog, FileHandle};
use winit::window::Window;

use super::Wake;

/// What a file is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    OpenFiles,
    OpenFolder,
    LoadView,
    SaveView,
    SavePicture,
    ExportFolder,
    ImportColours,
    ExportColours,
}

/// What became of a dialog.
pub enum Outcome {
    Chosen(Purpose, Vec<PathBuf>),
    /// Closed without a choice.
    Dismissed,
    /// There is nothing here that could show one.
    Unavailable,
}

/// At most one dialog at a time.
pub struct Dialogs {
    open: bool,
    sender: mpsc::Sender<(Purpose, Vec<PathBuf>)>,
    receiver: mpsc::Receiver<(Purpose, Vec<PathBuf>)>,
    wake: Wake,
}

const FRAMES: [&str; 12] =
    ["vtk", "vtu", "vtp", "pvd", "bgeo", "ply", "xyz", "csv", "npz", "npy", "hdf5", "h5"];

impl Dialogs {
    pub fn new(wake: Wake) -> Dialogs {
        let (sender, receiver) = mpsc::channel();
        // Whoever else listens to the log can do so: then no dialog is a dialog that was closed.
        if log::set_logger(&Ear).is_ok() {
            log::set_max_level(log::LevelFilter::Error);
        }
        Dialogs { open: false, sender, receiver, wake }
    }

    /// Opens a dialog, unless one is open; `name` is the suggested file name.
    pub fn ask(&mut self, purpose: Purpose, name: &str, parent: &Window) {
        if self.open {
            return;
        }
        self.open = true;
        UNAVAILABLE.store(false, Ordering::Relaxed);
        let dialog = AsyncFileDialog::new().set_parent(parent);
        // Some systems want the dialog made on the window's thread; the waiting is done on another.
        type Choice = std::pin::Pin<Box<dyn Future<Output = Vec<PathBuf>> + Send>>;
        let many = |files: Option<Vec<FileHandle>>| files.unwrap_or_default().into_iter().map(path).collect();
        let one = |file: Option<FileHandle>| file.into_iter().map(path).collect();
        let choice: Choice = match purpose {
            Purpose::OpenFiles => {
                let dialog = dialog.set_title("Open particle files");
                let files =
                    dialog.add_filter("Particle files", &FRAMES).add_filter("All files", &["*"]).pick_files();
                Box::pin(async move { many(files.await) })
            }
            Purpose::OpenFolder => {
                let folder = dialog.set_title("Open a folder as a sequence").pick_folder();
                Box::pin(async move { one(folder.await) })
            }
            Purpose::ExportFolder => {
                let folder = dialog.set_title("Where exported files go").pick_folder();
                Box::pin(async move { one(folder.await) })
            }
            Purpose::LoadView => {
                let file = dialog.set_title("Load a view").add_filter("View", &["json"]).pick_file();
                Box::pin(async move { one(file.await) })
            }
            Purpose::ImportColours => {
                let dialog = dialog.set_title("Import a colour map of ParaView");
                let file = dialog.add_filter("Colour map", &["json"]).pick_file();
                Box::pin(async move { one(file.await) })
            }
            Purpose::ExportColours => {
                let dialog = dialog.set_title("Export as a colour map of ParaView");
                let file = dialog.add_filter("Colour map", &["json"]).set_file_name(name).save_file();
                Box::pin(async move { one(file.await) })
            }
            Purpose::SaveView => {
                let dialog = dialog.set_title("Save the view").add_filter("View", &["json"]);
                let file = dialog.set_file_name(name).save_file();
                Box::pin(async move { one(file.await) })
            }
            Purpose::SavePicture => {
                let dialog = dialog.set_title("Save the picture").set_file_name(name);
                // Nobody tells which of two filters was chosen: the name's ending says what is written.
                let kinds = "Picture: .png (8 bits, sRGB) or .exr (32 bits, linear)";
                let file = dialog.add_filter(kinds, &["png", "exr"]).save_file();
                Box::pin(async move { one(file.await) })
            }
        };
        let (sender, wake) = (self.sender.clone(), Wake::clone(&self.wake));
        std::thread::spawn(move || {
            // The window is gone when nobody listens.
            let _ = sender.send((purpose, pollster::block_on(choice)));
            wake();
        });
    }

    /// The outcome of the dialog, once there is one.
    pub fn poll(&mut self) -> Option<Outcome> {
        let (purpose, paths) = self.receiver.try_recv().ok()?;
        self.open = false;
        Some(match paths.is_empty() {
            false => Outcome::Chosen(purpose, paths),
            true if UNAVAILABLE.load(Ordering::Relaxed) => Outcome::Unavailable,
            true => Outcome::Dismissed,
        })
    }
}

/// Whether the last dialog could not be opened.
static UNAVAILABLE: AtomicBool = AtomicBool::new(false);

/// Listens for what rfd tells nobody but the log: that there was neither a portal nor zenity.
struct Ear;

impl log::Log for Ear {
    fn enabled(&self, about: &log::Metadata) -> bool {
        // Below this module lie the portal's errors, after which zenity is tried.
        about.level() == log::Level::Error && about.target() == "rfd::backend::xdg_desktop_portal"
    }

    fn log(&self, record: &log::Record) {
        if self.enabled(record.metadata()) {
            UNAVAILABLE.store(true, Ordering::Relaxed);
        }
    }

    fn flush(&self) {}
}

fn path(file: FileHandle) -> PathBuf {
    file.path().to_owned()
}
