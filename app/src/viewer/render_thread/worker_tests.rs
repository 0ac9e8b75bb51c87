use std::path::PathBuf;

use super::*;
use crate::frames::Sequence;

fn job(frame: &Arc<Frame>, width: u32) -> Job {
    let mut view = View::default();
    (view.image.width, view.image.height) = (width, 16);
    Job { frame: Arc::clone(frame), index: 0, view, moving: false, looks: Looks::default() }
}

/// A worker on a small frame, where there is a device.
fn worker() -> Option<(Worker, Arc<Frame>, mpsc::Receiver<Report>)> {
    if let Err(error) = Gpu::new(&GpuOptions::default()) {
        eprintln!("skipped: {error}");
        return None;
    }
    let sequence = Sequence::open(&[PathBuf::from("demo:radial:27")]).unwrap();
    let frame = Arc::new(sequence.sources()[0].load().unwrap());
    let (sender, reports) = mpsc::channel();
    let worker = Worker::new(Arc::default(), sender, Arc::new(|| {}), GpuOptions::default());
    Some((worker, frame, reports))
}

#[test]
fn another_tolerance_is_drawn_on_the_same_grid() {
    let Some((mut worker, frame, reports)) = worker() else { return };
    let mut pictures = |job: &Job| {
        assert!(worker.serve(job).is_ok());
        let shown = |report| match report {
            Report::Picture(shown) => Some(shown),
            _ => None,
        };
        reports.try_iter().filter_map(shown).collect::<Vec<Box<Shown>>>()
    };
    let mut job = job(&frame, 24);
    let first = pictures(&job);
    assert!(first.iter().all(|shown| shown.stats.milliseconds.grid > 0.0));

    job.view.sampling.tolerance = Some(0.05);
    let again = pictures(&job);
    let [shown] = again.as_slice() else { panic!("one picture, in the size of the last") };
    assert_eq!((shown.divisor, shown.sampling.tolerance), (1, Some(0.05)));
    assert_eq!(shown.stats.milliseconds.grid, 0.0, "the grid serves again");
    assert_eq!(shown.stats.evaluations.bounds, 0, "so do the bounds");
    assert!(shown.stats.milliseconds.analysis > 0.0 && shown.stats.milliseconds.ray_cast > 0.0);
}

#[test]
fn a_lost_device_is_opened_again_and_the_same_picture_drawn() {
    let Some((mut worker, frame, reports)) = worker() else { return };
    let draw = |worker: &mut Worker, width| {
        assert!(worker.serve(&job(&frame, width)).is_ok());
        reports.try_iter().collect::<Vec<Report>>()
    };
    let pixels = |reports: &[Report]| match reports.last() {
        Some(Report::Picture(shown)) if shown.divisor == 1 => shown.pixels.clone(),
        _ => panic!("no full picture"),
    };
    let before = pixels(&draw(&mut worker, 24));
    // An unchanged picture would need no device.
    draw(&mut worker, 32);
    worker.renderer.as_ref().unwrap().gpu().lose();
    let reports = draw(&mut worker, 24);
    assert!(reports.iter().any(|report| matches!(report, Report::Recovered(_))));
    assert_eq!(pixels(&reports), before);
}
