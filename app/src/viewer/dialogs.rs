//! The system's file dialogs, on threads of their own: the window never waits for one.

use std::path::PathBuf;
use std::sync::mpsc;
use std::time::{Duration, Instant};

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
}

/// What became of a dialog.
pub enum Outcome {
    Chosen(Purpose, Vec<PathBuf>),
    /// Closed without a choice.
    Dismissed,
    /// It closed before anyone can have seen it.
    Unavailable,
}

/// At most one dialog at a time.
pub struct Dialogs {
    open: Option<Instant>,
    sender: mpsc::Sender<(Purpose, Vec<PathBuf>)>,
    receiver: mpsc::Receiver<(Purpose, Vec<PathBuf>)>,
    wake: Wake,
}

/// A person takes longer than this to close a dialog.
const AT_ONCE: Duration = Duration::from_millis(600);
const FRAMES: [&str; 12] =
    ["vtk", "vtu", "vtp", "pvd", "bgeo", "ply", "xyz", "csv", "npz", "npy", "hdf5", "h5"];

impl Dialogs {
    pub fn new(wake: Wake) -> Dialogs {
        let (sender, receiver) = mpsc::channel();
        Dialogs { open: None, sender, receiver, wake }
    }

    /// Opens a dialog, unless one is open; `name` is the suggested file name.
    pub fn ask(&mut self, purpose: Purpose, name: &str, parent: &Window) {
        if self.open.is_some() {
            return;
        }
        self.open = Some(Instant::now());
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
            Purpose::LoadView => {
                let file = dialog.set_title("Load a view").add_filter("View", &["json"]).pick_file();
                Box::pin(async move { one(file.await) })
            }
            Purpose::SaveView => {
                let dialog = dialog.set_title("Save the view").add_filter("View", &["json"]);
                let file = dialog.set_file_name(name).save_file();
                Box::pin(async move { one(file.await) })
            }
            Purpose::SavePicture => {
                let dialog = dialog.set_title("Save the picture").set_file_name(name);
                let dialog = dialog.add_filter("PNG, 8 bits, sRGB", &["png"]);
                let file = dialog.add_filter("OpenEXR, 32 bits, linear", &["exr"]).save_file();
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
        let opened = self.open.take()?;
        Some(match paths.is_empty() {
            false => Outcome::Chosen(purpose, paths),
            true if opened.elapsed() < AT_ONCE => Outcome::Unavailable,
            true => Outcome::Dismissed,
        })
    }
}

fn path(file: FileHandle) -> PathBuf {
    file.path().to_owned()
}
