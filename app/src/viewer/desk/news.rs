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
use crate::viewer::render_thread::Report;

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
    /// Gives frames the numbers that they have by now.
    fn renumber(&mut self, moved: impl Fn(usize) -> usize) {
        let index = match self {
            Done::Counted(analysis) => &mut analysis.index,
            Done::Pointed(pointed) => &mut pointed.shot.index,
            Done::Located(located) => &mut located.search.index,
            Done::Statistics(answer) => {
                if let Ok(statistics) = &mut answer.statistics {
                    statistics.frame = moved(statistics.frame);
                }
                &mut answer.question.index
            }
            _ => return,
        };
        *index = moved(*index);
    }
}

/// The same with the numbering of the frames when it was begun.
pub(super) type Dated = (usize, Done);

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
            self.session.note(&report);
            if let Report::Picture(shown) = report {
                self.picture.layers.set(*shown);
            }
        }
    }

    pub(super) fn take_done(&mut self) {
        while let Ok((numbering, mut done)) = self.done.1.try_recv() {
            done.renumber(|index| self.session.moved_since(numbering, index));
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
                Done::Counted(analysis) => {
                    self.counting = false;
                    self.session.answer(*analysis);
                }
                Done::Pooled(answer) => self.take_pooled(*answer),
                Done::Ranged(ranges) => self.take_field_ranges(ranges),
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
                Done::Pointed(pointed) => self.take_pointed(*pointed),
                Done::Located(located) => self.take_located(&located),
                Done::Statistics(answer) => self.take_statistics(*answer),
            }
        }
    }

    pub(super) fn take_outcomes(&mut self) {
        match self.dialogs.poll() {
            Some(dialogs::Outcome::Chosen(purpose, paths)) => self.chosen(purpose, paths),
            Some(dialogs::Outcome::Unavailable) => self.session.complain(
                "No file dialog could be opened: install xdg-desktop-portal or zenity, drop files on the \
                 window, name them on the command line, or save with Ctrl+Shift+E",
            ),
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
