//! Progress, lines and Ctrl-C in a terminal.

use std::sync::Arc;

use indicatif::{ProgressBar, ProgressStyle};

use super::interrupt::Interrupt;
use crate::export::{Listener, Stage};

/// Standard error with a progress bar, if that is a terminal.
pub struct Console {
    bar: ProgressBar,
    interrupt: Interrupt,
}

/// Steps of the progress bar for one frame.
const STEPS: u64 = 1000;

impl Console {
    /// Listens for Ctrl-C from now on.
    pub fn listen() -> anyhow::Result<Arc<Console>> {
        let bar = ProgressBar::new(STEPS);
        let template = "{bar:40} {percent:>3} %  {elapsed} gone, {eta} to go  {msg}";
        bar.set_style(ProgressStyle::with_template(template)?);
        Ok(Arc::new(Console { bar, interrupt: Interrupt::listen() }))
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

impl Listener for Console {
    fn show(&self, stage: Stage, index: usize, share: f32, count: usize) {
        self.bar.set_message(match stage {
            Stage::Survey => "looking through the frames",
            Stage::Pictures => "",
        });
        self.bar.set_length(count as u64 * STEPS);
        self.bar.set_position(index as u64 * STEPS + (share * STEPS as f32) as u64);
    }

    /// A line on standard error that does not tear the bar.
    fn say(&self, line: &str) {
        self.bar.suspend(|| eprintln!("{line}"));
    }

    fn wants_end(&self) -> bool {
        self.interrupt.asked()
    }
}
