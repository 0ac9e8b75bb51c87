//! One thread that writes what is kept, in the order in which it was given: the last value is the last write.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use anyhow::Result;

type Write = Box<dyn FnOnce() -> Result<()> + Send>;

/// What waits to be written, by name.
#[derive(Default)]
struct Waiting {
    list: Vec<(&'static str, Write)>,
    ended: bool,
}

#[derive(Default)]
struct Shared {
    waiting: Mutex<Waiting>,
    changed: Condvar,
}

impl Shared {
    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next to write; `None` at the end, when all is written.
    fn next(&self) -> Option<(&'static str, Write)> {
        let idle = |waiting: &mut Waiting| waiting.list.is_empty() && !waiting.ended;
        let waiting = self.changed.wait_while(self.waiting(), idle);
        let mut waiting = waiting.unwrap_or_else(PoisonError::into_inner);
        (!waiting.list.is_empty()).then(|| waiting.list.remove(0))
    }
}

pub struct Writer {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
}

impl Writer {
    /// A writer that gives `told` the name and the result of each write, on its thread.
    pub fn new(told: impl Fn(&'static str, Result<()>) + Send + 'static) -> Writer {
        let shared = Arc::new(Shared::default());
        let own = Arc::clone(&shared);
        let thread = std::thread::spawn(move || {
            while let Some((name, write)) = own.next() {
                told(name, write());
            }
        });
        Writer { shared, thread: Some(thread) }
    }

    /// Writes a value, in the place of one of the same name that still waits.
    pub fn put(&self, name: &'static str, write: impl FnOnce() -> Result<()> + Send + 'static) {
        self.shared.waiting().list.retain(|waiting| waiting.0 != name);
        self.change(name, write);
    }

    /// Makes a change to what is in a file by then, after all that were given before.
    pub fn change(&self, name: &'static str, write: impl FnOnce() -> Result<()> + Send + 'static) {
        self.shared.waiting().list.push((name, Box::new(write)));
        self.shared.changed.notify_one();
    }

    /// Waits until all is written, and writes nothing any more.
    pub fn end(&mut self) {
        self.shared.waiting().ended = true;
        self.shared.changed.notify_one();
        if let Some(thread) = self.thread.take() {
            // What could not be written was told.
            let _ = thread.join();
        }
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.end();
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;
    use std::time::Duration;

    use super::*;

    #[test]
    fn the_last_value_is_the_last_write_and_the_end_waits_for_it() {
        let written = Arc::new(Mutex::new(Vec::new()));
        let (told, heard) = mpsc::channel();
        let mut writer = Writer::new(move |name, result| told.send((name, result.is_ok())).unwrap());
        let write = |value: u32| {
            let written = Arc::clone(&written);
            move || {
                std::thread::sleep(Duration::from_millis(20));
                written.lock().unwrap().push(value);
                Ok(())
            }
        };
        writer.put("slow", write(0));
        std::thread::sleep(Duration::from_millis(10));
        (1..5).for_each(|value| writer.put("settings", write(value)));
        (5..8).for_each(|value| writer.change("runs", write(value)));
        writer.change("failing", || anyhow::bail!("full"));
        writer.end();
        assert_eq!(*written.lock().unwrap(), [0, 4, 5, 6, 7]);
        let results: Vec<_> = heard.try_iter().collect();
        let [first, .., last] = results.as_slice() else { panic!("{results:?}") };
        assert_eq!((*first, *last), (("slow", true), ("failing", false)));
    }
}
