//! Work in the background that says how far it is and can be cancelled, while the window goes on.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, mpsc};

use super::Wake;

/// The window's end of the work. Whoever lets go of it cancels the work.
pub struct Task<T> {
    /// Thousandths done.
    share: Arc<AtomicU32>,
    cancelled: Arc<AtomicBool>,
    result: mpsc::Receiver<anyhow::Result<T>>,
}

/// What became of the work.
#[derive(Debug, PartialEq)]
pub enum Outcome<T> {
    Done(T),
    Cancelled,
    Failed(String),
}

impl<T: Send + 'static> Task<T> {
    /// Starts `work` on a thread of its own. It tells its progress, and learns whether to go on.
    pub fn start(
        wake: Wake,
        work: impl FnOnce(&mut renderer::Progress) -> anyhow::Result<T> + Send + 'static,
    ) -> Task<T> {
        let (sender, result) = mpsc::channel();
        let task = Task { share: Arc::default(), cancelled: Arc::default(), result };
        let (share, cancelled) = (Arc::clone(&task.share), Arc::clone(&task.cancelled));
        std::thread::spawn(move || {
            let mut told = 0;
            let mut progress = |done: f32| {
                let thousandths = (done.clamp(0.0, 1.0) * 1000.0) as u32;
                share.store(thousandths, Ordering::Relaxed);
                if thousandths >= told + 5 {
                    told = thousandths;
                    wake();
                }
                match cancelled.load(Ordering::Relaxed) {
                    true => ControlFlow::Break(()),
                    false => ControlFlow::Continue(()),
                }
            };
            // The window is gone when nobody listens.
            let _ = sender.send(work(&mut progress));
            wake();
        });
        task
    }

    /// Share done, 0 to 1.
    pub fn share(&self) -> f32 {
        self.share.load(Ordering::Relaxed) as f32 / 1000.0
    }

    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// What became of it, once that is known.
    pub fn poll(&self) -> Option<Outcome<T>> {
        Some(match self.result.try_recv() {
            Ok(Ok(result)) => Outcome::Done(result),
            Ok(Err(_)) if self.cancelled.load(Ordering::Relaxed) => Outcome::Cancelled,
            Ok(Err(error)) => Outcome::Failed(format!("{error:#}")),
            Err(mpsc::TryRecvError::Empty) => return None,
            Err(mpsc::TryRecvError::Disconnected) => {
                Outcome::Failed("drawing failed in an unforeseen way".into())
            }
        })
    }
}

impl<T> Drop for Task<T> {
    fn drop(&mut self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    fn outcome<T: Send + 'static>(task: &Task<T>) -> Outcome<T> {
        loop {
            if let Some(outcome) = task.poll() {
                return outcome;
            }
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn work_ends_with_a_result_or_says_why_not() {
        let start = |result: anyhow::Result<u32>| Task::start(Arc::new(|| {}), move |_| result);
        assert_eq!(outcome(&start(Ok(7))), Outcome::Done(7));
        assert_eq!(outcome(&start(Err(anyhow::anyhow!("no")))), Outcome::Failed("no".into()));
        let panics = Task::<u32>::start(Arc::new(|| {}), |_| panic!("on purpose"));
        assert!(matches!(outcome(&panics), Outcome::Failed(_)));
    }

    #[test]
    fn work_that_is_cancelled_ends() {
        let task = Task::<()>::start(Arc::new(|| {}), |progress| {
            while progress(0.5).is_continue() {
                std::thread::yield_now();
            }
            anyhow::bail!("cancelled")
        });
        while task.share() < 0.5 {
            std::thread::yield_now();
        }
        task.cancel();
        assert_eq!(outcome(&task), Outcome::Cancelled);
    }
}
