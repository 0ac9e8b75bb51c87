use std::path::PathBuf;

use super::*;
use crate::frames::Sequence;

fn job(frame: &Arc<Frame>, width: u32) -> Job {
    let mut view = View::default();
    (view.image.width, view.image.height) = (width, 16);
    Job { frame: Arc::clone(frame), index: 0, view, moving: false }
}

#[test]
fn a_lost_device_is_opened_again_and_the_same_picture_drawn() {
    if let Err(error) = Gpu::new(&GpuOptions::default()) {
        eprintln!("skipped: {error}");
        return;
    }
    let sequence = Sequence::open(&[PathBuf::from("demo:radial:27")]).unwrap();
    let frame = Arc::new(sequence.sources()[0].load().unwrap());
    let (sender, reports) = mpsc::channel();
    let mut worker = Worker::new(Arc::default(), sender, Arc::new(|| {}), GpuOptions::default());
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
