//! Looking through all frames for their extremes, when that is asked for.

use super::Desk;
use crate::viewer::Wake;
use crate::viewer::analysis::survey;
use crate::viewer::session::Survey;
use crate::viewer::task::{Outcome, Task};

impl Desk {
    pub(super) fn follow_survey(&mut self) {
        match (self.session.ranges.survey, self.session.run()) {
            (Survey::Wanted, Some(run)) => {
                let sources = run.sequence.frame_sources();
                self.survey = Some(Task::start(Wake::clone(&self.wake), move |progress| {
                    survey::look_through(&sources, progress)
                }));
            }
            (Survey::Unwanted, _) => self.survey = None,
            _ => {}
        }
        let Some(task) = &self.survey else {
            self.session.ranges.survey = Survey::Idle;
            return;
        };
        let outcome = task.poll();
        self.session.ranges.survey = Survey::Running(task.share());
        match outcome {
            None => return,
            Some(Outcome::Done(found)) => {
                self.session.learn(found);
                self.session.log("all frames looked through");
            }
            Some(Outcome::Failed(text)) => self.session.complain(text),
            Some(Outcome::Cancelled) => {}
        }
        self.survey = None;
        self.session.ranges.survey = Survey::Idle;
    }
}
