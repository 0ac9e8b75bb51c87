//! Keeps looking at the files of an open run, on a thread of its own.

use std::path::PathBuf;
use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use crate::frames::{Changes, Sequence, Watcher};

use super::Wake;

/// The window's end. Once it is gone, nobody looks any more.
pub struct Live {
    changes: mpsc::Receiver<Changes>,
}

/// Between two looks; longer where looking itself takes long, as on a slow file system.
const PAUSE: Duration = Duration::from_secs(2);
const PAUSE_PER_LOOK: u32 = 20;

impl Live {
    /// Looks after what `arguments` name. `None` where that is no file.
    pub fn start(arguments: &[PathBuf], known: &Sequence, wake: &Wake) -> Option<Live> {
        let mut watcher = Watcher::new(arguments.to_vec(), known);
        if watcher.is_idle() {
            return None;
        }
        let (sender, changes) = mpsc::channel();
        let wake = Wake::clone(wake);
        thread::spawn(move || {
            let mut unsettled = None;
            loop {
                let begin = Instant::now();
                let changes = watcher.look(SystemTime::now());
                let pause = PAUSE.max(PAUSE_PER_LOOK * begin.elapsed());
                let same = unsettled.as_ref() == Some(&changes.unsettled);
                unsettled = Some(changes.unsettled.clone());
                let news = Changes { unsettled: Default::default(), ..changes.clone() } != Changes::default();
                if sender.send(changes).is_err() {
                    return;
                }
                if news || !same {
                    wake();
                }
                thread::sleep(pause);
            }
        });
        Some(Live { changes })
    }

    /// What was found since the last call.
    pub fn take(&self) -> Vec<Changes> {
        self.changes.try_iter().collect()
    }
}
