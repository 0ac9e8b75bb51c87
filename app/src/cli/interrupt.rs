//! Ctrl-C ends the work at the next safe point, so that no half file is left.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the user wants the program to end.
pub struct Interrupt(Arc<AtomicBool>);

/// What a shell expects of a program that Ctrl-C ended.
const STATUS: i32 = 130;

impl Interrupt {
    /// Listens from now on. A second Ctrl-C ends the program at once, for work that has no safe
    /// point in sight.
    pub fn listen() -> Interrupt {
        let asked = Arc::new(AtomicBool::new(false));
        let flag = Arc::clone(&asked);
        let handler = move || {
            if flag.swap(true, Ordering::SeqCst) {
                std::process::exit(STATUS);
            }
        };
        if let Err(error) = ctrlc::set_handler(handler) {
            // Without it Ctrl-C still ends the program, only less tidily.
            eprintln!("warning: Ctrl-C is not listened to: {error}");
        }
        Interrupt(asked)
    }

    pub fn asked(&self) -> bool {
        self.0.load(Ordering::SeqCst)
    }
}
