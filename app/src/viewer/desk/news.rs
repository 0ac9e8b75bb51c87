//! What threads and dialogs have to tell.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

use renderer::View;

use super::Desk;
use super::functions;
use crate::frames::Sequence;
use crate::viewer::Wake;
use crate::viewer::analysis::distribution::Analysis;
use crate::viewer::analysis::field_ranges::FieldRanges;
use crate::viewer::analysis::pool;
use crate::viewer::analysis::statistics::Answer;
use crate::viewer::dialogs;
use crate::viewer::inspect::pointing::Pointed;
use crate::viewer::inspect::tracked::Located;
use crate::viewer::kept::Left;
use crate::viewer::keys::shortcuts::{Action, with_keys};
use crate::viewer::render_thread::Report;
use crate::viewer::session::Numbering;

/// What was done on another thread.
pub(super) enum Done {
    Found(Opening, Result<Sequence, String>),
    ViewRead(PathBuf, anyhow::Result<Box<View>>),
    ViewSaved(PathBuf, anyhow::Result<()>),
    Counted(Box<Analysis>),
    Function(functions::Filed),
    Pooled(Box<pool::Answer>),
    Ranged(FieldRanges),
    Pointed(Box<Pointed>),
    Located(Located),
    Statistics(Box<Answer>),
    Kept(&'static str, anyhow::Result<()>),
    Adapters(Vec<String>),
    VideosPossible(bool),
    /// A panic.
    Broken,
}

impl Done {
    /// The numbers of frames in it; `None` of what is about no run.
    fn frames(&mut self) -> Option<Vec<&mut usize>> {
        Some(match self {
            Done::Counted(analysis) => vec![&mut analysis.index],
            Done::Pointed(pointed) => vec![&mut pointed.shot.index],
            Done::Located(located) => vec![&mut located.search.index],
            Done::Statistics(answer) => {
                let counted = answer.statistics.iter_mut().map(|statistics| &mut statistics.frame);
                counted.chain([&mut answer.question.index]).collect()
            }
            // They know their frames by themselves.
            Done::Pooled(_) | Done::Ranged(_) => Vec::new(),
            _ => return None,
        })
    }
}

/// The same with the numbering of the frames when it was begun.
pub(super) type Dated = (Numbering, Done);

/// A run that is looked for.
pub(super) struct Opening {
    /// Number of the search.
    pub search: usize,
    pub paths: Vec<PathBuf>,
    /// How it is to look; as its first frame does without any.
    pub left: Option<Box<Left>>,
}

impl Desk {
    pub(super) fn take_reports(&mut self) {
        for report in self.render.reports() {
            let Some(report) = self.session.current(report) else { continue };
            self.session.note(&report);
            if let Report::Picture(shown) = report {
                self.picture.layers.set(*shown);
            }
        }
    }

    pub(super) fn take_done(&mut self) {
        while let Ok((numbering, mut done)) = self.done.1.try_recv() {
            self.is_free_again(&done);
            if done.frames().is_some_and(|frames| !self.session.bring_up_to_date(numbering, frames)) {
                continue;
            }
            match done {
                // Something else was opened since.
                Done::Found(opening, _) if opening.search != self.searches => {}
                Done::Found(opening, Ok(sequence)) => {
                    self.finding = false;
                    self.open(&sequence, &opening.paths);
                    if let Some(left) = opening.left {
                        self.keeping.sessions.take_over(&left);
                        self.session.restore(left.session);
                    }
                }
                Done::Found(_, Err(text)) => {
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
                Done::Function(filed) => self.take_function(filed),
                Done::Counted(analysis) => self.session.answer(*analysis),
                Done::Pooled(answer) => self.session.pool.take(*answer),
                Done::Ranged(ranges) => self.session.field_ranges = Some(ranges),
                Done::Kept(file, result) => self.written(file, result),
                Done::VideosPossible(possible) => self.exporting.videos_possible(possible),
                Done::Adapters(names) => {
                    if let Some(preferences) = &mut self.preferences {
                        preferences.adapters = Some(names);
                    }
                }
                Done::Broken => {
                    // Only a search can be begun again: what is counted would fail in the same way.
                    self.finding = false;
                    self.session.complain(
                        "Something failed in the background in an unforeseen way: save the view and restart \
                         the program if anything does not go on",
                    );
                }
                Done::Pointed(pointed) => self.session.take_pointed(*pointed),
                Done::Located(located) => self.session.take_located(&located),
                Done::Statistics(answer) => self.session.statistics = Some(*answer),
            }
        }
    }

    /// Takes note that the next work of this kind may begin.
    fn is_free_again(&mut self, done: &Done) {
        let inquiries = &mut self.inquiries;
        match done {
            Done::Counted(_) => self.counting = false,
            Done::Pooled(_) => inquiries.pool = false,
            Done::Ranged(_) => inquiries.ranges = false,
            Done::Pointed(_) => inquiries.pointing = false,
            Done::Located(_) => inquiries.search = false,
            Done::Statistics(_) => inquiries.statistics = false,
            _ => {}
        }
    }

    pub(super) fn take_outcomes(&mut self, context: &egui::Context) {
        match self.dialogs.poll() {
            Some(dialogs::Outcome::Chosen(purpose, paths)) => self.chosen(purpose, paths),
            Some(dialogs::Outcome::Unavailable) => {
                let saving = with_keys(context, "or save in this folder", Action::QuickSave);
                self.session.complain(format!(
                    "No file dialog could be opened: install xdg-desktop-portal or zenity, drop files on the window, \
                     name them on the command line, {saving}",
                ));
            }
            Some(dialogs::Outcome::Dismissed) => self.session.log("dialog closed"),
            None => {}
        }
    }

    pub(super) fn work(&self, task: impl FnOnce() -> Done + Send + 'static) {
        let (sender, wake) = (self.done.0.clone(), Wake::clone(&self.wake));
        let numbering = self.session.numbering();
        std::thread::spawn(move || {
            // The window is gone when nobody listens.
            let _ = sender.send((numbering, caught(task)));
            wake();
        });
    }
}

/// Does `task`, whatever happens in it: the window waits for an answer.
fn caught(task: impl FnOnce() -> Done) -> Done {
    catch_unwind(AssertUnwindSafe(task)).unwrap_or(Done::Broken)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_answer() {
        assert!(matches!(caught(|| panic!("on purpose")), Done::Broken));
    }
}
