//! A stream over sources that count, wait and fail on demand.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use super::*;
use crate::frames::{Column, Metadata};

/// A frame of `rows` particles: 12 bytes each.
struct Fake {
    rows: usize,
    fault: Option<&'static str>,
    loads: AtomicUsize,
    /// Held by a test to keep the reading from ending.
    gate: Arc<Mutex<()>>,
}

impl Fake {
    fn new(rows: usize) -> Fake {
        Fake { rows, fault: None, loads: AtomicUsize::new(0), gate: Arc::default() }
    }
}

impl FrameSource for Fake {
    fn load(&self, loading: &Arc<Loading>) -> anyhow::Result<Arc<Frame>> {
        loading.begin(self.rows as u64);
        self.loads.fetch_add(1, Ordering::SeqCst);
        drop(self.gate.lock().unwrap());
        match self.fault {
            Some("panic") => panic!("a reader's mistake"),
            Some(fault) => anyhow::bail!(fault),
            None => {
                let positions = Column::new(3, vec![0.0_f32; 3 * self.rows]).unwrap();
                Ok(Arc::new(Frame::new(positions, Vec::new(), Metadata::default())?))
            }
        }
    }
}

fn stream(fakes: &[Arc<Fake>], budget: usize) -> FrameStream {
    let sources = fakes.iter().map(|fake| Arc::clone(fake) as Arc<dyn FrameSource>).collect();
    FrameStream::new(sources, budget, || {})
}

fn fakes(count: usize, rows: usize) -> Vec<Arc<Fake>> {
    (0..count).map(|_| Arc::new(Fake::new(rows))).collect()
}

/// Waits until `holds`, or fails the test.
fn eventually(what: &str, holds: impl Fn() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < Duration::from_secs(10), "{what} did not come about");
        thread::sleep(Duration::from_millis(1));
    }
}

fn loaded(stream: &FrameStream) -> Vec<usize> {
    let cached = stream.cached();
    (0..cached.len()).filter(|&index| cached[index] == Cached::Yes).collect()
}

#[test]
fn everything_is_read_where_it_fits() {
    let fakes = fakes(10, 100);
    let stream = stream(&fakes, 12_000);
    eventually("all frames", || loaded(&stream).len() == 10);
    assert!(matches!(stream.get(3), FrameState::Ready(_)));
    assert!(matches!(stream.get(10), FrameState::NotLoaded));
    assert!(fakes.iter().all(|fake| fake.loads.load(Ordering::SeqCst) == 1));
}

#[test]
fn the_budget_holds_and_follows_the_playhead() {
    let fakes = fakes(50, 100);
    let stream = stream(&fakes, 4 * 1200 + 100);
    // The loop's last frame is the one behind the first.
    eventually("four frames round 0", || loaded(&stream) == [0, 1, 2, 3, 49]);
    for playhead in 0..40 {
        stream.wait(playhead).unwrap();
        assert!(stream.bytes() <= 5 * 1200, "{} bytes", stream.bytes());
    }
    // One behind is as near as three ahead, and a little nearer.
    eventually("frames round 39", || loaded(&stream) == [38, 39, 40, 41, 42]);
    stream.request(38);
    eventually("frames before 38", || loaded(&stream) == [35, 36, 37, 38, 39]);
}

#[test]
fn reading_ahead_goes_round_the_end() {
    let fakes = fakes(20, 100);
    let stream = stream(&fakes, 3 * 1200);
    for index in [17, 18, 19] {
        stream.wait(index).unwrap();
    }
    eventually("the start of the loop", || loaded(&stream) == [0, 1, 18, 19]);
    stream.wait(0).unwrap();
    eventually("onwards from the start", || loaded(&stream) == [0, 1, 2, 19]);
}

#[test]
fn a_bad_frame_is_marked_once_and_skipped() {
    let mut fakes = fakes(4, 10);
    fakes[1] = Arc::new(Fake { fault: Some("cut short"), ..Fake::new(10) });
    fakes[2] = Arc::new(Fake { fault: Some("panic"), ..Fake::new(10) });
    let stream = stream(&fakes, 1 << 20);
    assert_eq!(stream.wait(1).unwrap_err().as_ref(), "cut short");
    assert!(stream.wait(2).is_err());
    assert!(stream.wait(3).is_ok() && stream.wait(0).is_ok());
    assert_eq!(stream.cached()[1], Cached::Failed);
    stream.request(1);
    assert!(stream.wait(1).is_err());
    assert_eq!(fakes[1].loads.load(Ordering::SeqCst), 1);
}

#[test]
fn reading_that_is_cancelled_fails_at_once_and_is_not_taken_up_again() {
    let fakes = fakes(1, 100);
    let gate = Arc::clone(&fakes[0].gate);
    let held = gate.lock().unwrap();
    let stream = stream(&fakes, 12_000);
    eventually("the reading", || stream.progress(0) == Some([0, 100]));
    stream.cancel(0);
    assert!(matches!(stream.get(0), FrameState::Failed(why) if why.contains("cancelled")));
    drop(held);
    thread::sleep(Duration::from_millis(30));
    assert!(matches!(stream.get(0), FrameState::Failed(_)), "what comes late is not wanted");
    assert_eq!(fakes[0].loads.load(Ordering::SeqCst), 1);
}

#[test]
fn a_smaller_budget_drops_frames_at_once_and_a_larger_one_reads_on() {
    let fakes = fakes(10, 100);
    let stream = stream(&fakes, 12_000);
    eventually("all frames", || loaded(&stream).len() == 10);
    stream.limit(2_400);
    assert_eq!(loaded(&stream).len(), 3, "the current one, and two beside it");
    stream.limit(12_000);
    eventually("all frames again", || loaded(&stream).len() == 10);
}

#[test]
fn a_frame_larger_than_the_budget_is_shown_but_not_kept() {
    let mut fakes = fakes(5, 10);
    fakes[2] = Arc::new(Fake::new(10_000));
    let stream = stream(&fakes, 1000);
    assert_eq!(stream.wait(2).unwrap().len(), 10_000);
    stream.wait(3).unwrap();
    assert!(stream.bytes() <= 1000 + 120);
    eventually("the others", || loaded(&stream) == [0, 1, 3, 4]);
    let loads = fakes[2].loads.load(Ordering::SeqCst);
    thread::sleep(Duration::from_millis(20));
    assert_eq!(fakes[2].loads.load(Ordering::SeqCst), loads, "read again and again");
}

#[test]
fn a_frame_that_the_playhead_left_is_not_kept_at_the_cost_of_nearer_ones() {
    let fakes = fakes(100, 100);
    let gate = Arc::clone(&fakes[0].gate);
    let held = gate.lock().unwrap();
    let stream = stream(&fakes, 3 * 1200);
    eventually("the reading of frame 0", || fakes[0].loads.load(Ordering::SeqCst) == 1);
    stream.wait(50).unwrap();
    eventually("frames round 50", || loaded(&stream) == [49, 50, 51, 52]);
    drop(held);
    eventually("the end of the stale reading", || stream.cached()[0] == Cached::No);
    assert_eq!(loaded(&stream), [49, 50, 51, 52]);
}

#[test]
fn dropping_the_stream_waits_for_nothing_and_ends_the_threads() {
    let fakes = fakes(3, 10);
    let gate = Arc::clone(&fakes[0].gate);
    let held = gate.lock().unwrap();
    let woken = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&woken);
    let sources = fakes.iter().map(|fake| Arc::clone(fake) as Arc<dyn FrameSource>).collect();
    let stream = FrameStream::new(sources, 1 << 20, move || {
        count.fetch_add(1, Ordering::SeqCst);
    });
    eventually("the reading of frame 0", || fakes[0].loads.load(Ordering::SeqCst) == 1);
    drop(stream);
    drop(held);
    eventually("the threads' end", || Arc::strong_count(&fakes[0]) == 1);
    assert_eq!(woken.load(Ordering::SeqCst), 0);
}

#[test]
fn no_frames_at_all_are_fine() {
    let stream = stream(&[], 1000);
    stream.request(0);
    assert!(stream.is_empty() && stream.cached().is_empty());
}

#[test]
fn frames_that_come_between_others_move_what_is_being_read() {
    let fakes = fakes(3, 10);
    let gate = fakes[0].gate.lock().unwrap();
    let stream = stream(&fakes, 1 << 20);
    eventually("frame 0 being read", || fakes[0].loads.load(Ordering::SeqCst) == 1);
    // While frame 0 is read, two come before it and one behind it.
    let new: Vec<Arc<Fake>> = [1, 2, 3].map(|rows| Arc::new(Fake::new(rows))).into();
    let added = [(0, 0), (1, 1), (3, 2)]
        .map(|(place, new_one): (usize, usize)| (place, Arc::clone(&new[new_one]) as Arc<dyn FrameSource>));
    stream.insert(added.into_iter());
    drop(gate);
    assert_eq!(stream.len(), 6);
    let rows: Vec<usize> = [2, 0, 1, 3, 4, 5].map(|index| stream.wait(index).unwrap().len()).into();
    assert_eq!(rows, [10, 1, 2, 3, 10, 10]);
    assert_eq!(fakes[0].loads.load(Ordering::SeqCst), 1, "it was not read twice");
}
