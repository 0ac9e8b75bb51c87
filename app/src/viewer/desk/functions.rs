//! Transfer functions that come from files and go to them: those of ParaView, and those saved under a name.

use std::path::PathBuf;

use renderer::TransferView;
use winit::window::Window;

use super::{Desk, Done};
use crate::paraview::{self, Imported};
use crate::viewer::dialogs::Purpose;
use crate::viewer::kept::library::{self, Saved};
use crate::viewer::panels::presets::Wish;

/// What was done with a file.
pub enum Filed {
    Listed(Vec<Saved>, Vec<String>),
    Imported(PathBuf, anyhow::Result<Imported>),
    Exported(PathBuf, anyhow::Result<()>),
}

impl Desk {
    /// Does what was chosen in the menu of presets.
    pub(super) fn follow_presets(&mut self, window: &Window) {
        for wish in std::mem::take(&mut self.editor.presets.wishes) {
            match wish {
                Wish::Import => self.dialogs.ask(Purpose::ImportColours, "", window),
                Wish::Export => self.dialogs.ask(Purpose::ExportColours, "colours.json", window),
                Wish::Save(name) => {
                    let transfer = self.session.view.transfer.clone();
                    self.file(move |folder| library::save(folder, &name, &transfer));
                }
                Wish::Delete(name) => self.file(move |folder| library::delete(folder, &name)),
            }
        }
    }

    /// Reads the saved functions.
    pub(super) fn list_functions(&self) {
        self.file(|_| Ok(()));
    }

    /// Changes something in the folder of saved functions, and lists what is there.
    fn file(&self, change: impl FnOnce(&std::path::Path) -> anyhow::Result<()> + Send + 'static) {
        let Some(folder) = library::folder() else { return };
        self.work(move || {
            let changed = change(&folder);
            let (saved, mut wrong) = library::list(&folder);
            wrong.extend(changed.err().map(|error| format!("{error:#}")));
            Done::Function(Filed::Listed(saved, wrong))
        });
    }

    pub(super) fn import_colours(&self, path: PathBuf) {
        self.work(move || {
            let imported = paraview::read(&path);
            Done::Function(Filed::Imported(path, imported))
        });
    }

    pub(super) fn export_colours(&self, path: PathBuf) {
        let (transfer, range) = (self.session.view.transfer.clone(), self.session.range());
        self.work(move || {
            let written = paraview::write(&path, &transfer, range.unwrap_or([0.0, 1.0]));
            Done::Function(Filed::Exported(path, written))
        });
    }

    pub(super) fn take_function(&mut self, filed: Filed) {
        let session = &mut self.session;
        match filed {
            Filed::Listed(saved, wrong) => {
                session.log(format!("functions {}", saved.len()));
                self.editor.presets.saved = saved;
                wrong.into_iter().for_each(|text| session.complain(text));
            }
            Filed::Imported(path, Ok(imported)) => {
                let mut transfer: TransferView = session.view.transfer.clone();
                paraview::adopt(&mut transfer, imported);
                match transfer.function() {
                    Ok(_) => {
                        session.view.transfer = transfer;
                        session.messages.note(format!("Colours imported from {}", path.display()));
                        session.log(format!("imported {}", path.display()));
                    }
                    Err(error) => session.complain(format!("{}: {error}", path.display())),
                }
            }
            Filed::Exported(path, Ok(())) => {
                session.messages.note(format!("Colours exported as {}", path.display()));
                session.log(format!("saved {}", path.display()));
            }
            Filed::Imported(_, Err(error)) | Filed::Exported(_, Err(error)) => {
                session.complain(format!("{error:#}"));
            }
        }
    }
}
