use std::path::PathBuf;

use renderer::{OpacityView, Scale};

use super::*;
use crate::frames::Sequence;

fn job(frame: &Arc<Frame>, width: u32) -> Job {
    let mut view = View::default();
    // So high that supports are wide enough for adaptive sampling to pay.
    (view.image.width, view.image.height) = (width, 64);
    Job {
        frame: Arc::clone(frame),
        index: 0,
        numbering: Default::default(),
        view,
        moving: false,
        budget: Budget::default(),
        looks: Looks::default(),
    }
}

/// A worker on a small frame, where there is a device.
fn worker() -> Option<(Worker, Arc<Frame>, mpsc::Receiver<Report>)> {
    if let Err(error) = Gpu::new(&GpuOptions::default()) {
        eprintln!("skipped: {error}");
        return None;
    }
    let sequence = Sequence::open(&[PathBuf::from("demo:radial:27")]).unwrap();
    let frame = Arc::new(sequence.sources()[0].load(&Default::default()).unwrap());
    let (sender, reports) = mpsc::channel();
    let worker = Worker::new(Arc::default(), sender, Arc::new(|| {}), GpuOptions::default());
    Some((worker, frame, reports))
}

/// All pictures that `job` makes.
fn pictures_of(worker: &mut Worker, reports: &mpsc::Receiver<Report>, job: &Job) -> Vec<Shown> {
    assert!(worker.serve(job).is_ok());
    let shown = |report| match report {
        Report::Picture(shown) => Some(*shown),
        _ => None,
    };
    reports.try_iter().filter_map(shown).collect()
}

#[test]
fn another_tolerance_is_drawn_on_the_same_grid() {
    let Some((mut worker, frame, reports)) = worker() else { return };
    let mut pictures = |job: &Job| pictures_of(&mut worker, &reports, job);
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

#[test]
fn a_look_into_the_picture_costs_no_other_picture() {
    let Some((mut worker, frame, reports)) = worker() else { return };
    let mut draw = |job: &Job| {
        assert!(worker.serve(job).is_ok());
        let shown = |report| match report {
            Report::Picture(shown) => Some(shown),
            _ => None,
        };
        reports.try_iter().filter_map(shown).last().expect("a picture")
    };
    let mut job = job(&frame, 40);
    let plain = draw(&job);
    assert!(plain.cells.is_none() && plain.probed.is_none());

    job.looks = Looks { cells: true, probe: Some([20, 32]), shot: false };
    let looked = draw(&job);
    assert!(looked.pixels == plain.pixels && looked.stats == plain.stats, "it is the same picture");
    let (cells, probed) = (looked.cells.unwrap(), looked.probed.unwrap());
    assert_eq!((cells.size, cells.classes()), ([40, 64], looked.stats.cells_by_class));
    assert_eq!((probed.pixel, probed.bundle.bundle), ([20, 32], [2, 4]));
    let listed: Vec<_> = probed.bundle.cells.iter().map(|cell| cell.cell).collect();
    assert_eq!(listed, cells.bundle([2, 4]).cells);

    // Of another pixel; of one that is not there; and of a picture that is quick to be had.
    job.looks.probe = Some([0, 0]);
    let other = draw(&job);
    assert!(Arc::ptr_eq(other.cells.as_ref().unwrap(), &cells));
    assert_eq!(other.probed.unwrap().asked, [0, 0]);
    job.looks.probe = Some([40, 0]);
    assert!(draw(&job).probed.is_none());
    (job.looks.probe, job.moving, job.view.image.width) = (Some([20, 32]), true, 400);
    let moving = draw(&job);
    let probed = moving.probed.unwrap();
    assert_eq!(
        (probed.divisor, probed.pixel),
        (moving.divisor, [20, 32].map(|place| place / moving.divisor))
    );
    assert_eq!(moving.cells.unwrap().size, [moving.width, moving.height]);

    // Nobody asks any more.
    job.looks = Looks::default();
    let plain = draw(&job);
    assert!(plain.cells.is_none() && plain.probed.is_none());
}

#[test]
fn what_is_known_of_cells_is_on_the_axis_of_the_opacity() {
    let Some((mut worker, frame, reports)) = worker() else { return };
    let mut job = job(&frame, 40);
    let log = OpacityView { range: Some([0.2, 0.9]), scale: Scale::Log, name: None };
    (job.view.quantity.range, job.view.quantity.opacity) = (Some([0.0, 1.0]), Some(log));
    job.looks = Looks { cells: true, probe: Some([20, 32]), shot: false };
    let probed = pictures_of(&mut worker, &reports, &job).pop().unwrap().probed.unwrap();
    assert_eq!((probed.placement.range(), probed.placement.scale()), ([0.2, 0.9], Scale::Log));
}

#[test]
fn a_moving_picture_that_is_late_has_a_larger_tolerance_and_one_at_rest_the_users() {
    let Some((mut worker, frame, reports)) = worker() else { return };
    let mut draw = |job: &Job| pictures_of(&mut worker, &reports, job);
    let mut job = job(&frame, 24);
    job.moving = true;
    job.budget = Budget { on: true, milliseconds: 1e-6, most: 0.05 };
    let tolerances: Vec<f64> = (1..5)
        .map(|step| {
            job.view.transfer.reference_length = Some(0.1 * f64::from(step));
            let pictures = draw(&job);
            let [shown] = pictures.as_slice() else { panic!("one picture a job") };
            assert_eq!(shown.wished, Some(0.004));
            shown.sampling.tolerance.unwrap()
        })
        .collect();
    assert_eq!(tolerances[0], 0.004, "the first has taken no time yet");
    assert!(tolerances.is_sorted() && tolerances[3] > 0.02 && tolerances[3] <= 0.05, "{tolerances:?}");
    assert!(draw(&job).iter().all(|shown| shown.drawn.is_none()), "nothing has moved");

    job.moving = false;
    let last = draw(&job).pop().unwrap();
    assert_eq!((last.divisor, last.sampling.tolerance, last.wished), (1, Some(0.004), Some(0.004)));
}

#[test]
fn a_field_that_is_not_there_comes_with_advice() {
    let sequence = Sequence::open(&[PathBuf::from("demo:radial:27")]).unwrap();
    let frame = Arc::new(sequence.sources()[0].load(&Default::default()).unwrap());
    let mut view = View::default();
    view.quantity.name = Some("dye".into());
    let Err(error) = Preparation::default().scene(&frame, &view) else { panic!("there is no such field") };
    let text = "there is no field `dye`; there are: radius: choose another under Quantity";
    assert_eq!(with_advice(&error), text);
    assert_eq!(with_advice(&anyhow::anyhow!("no")), "no");
}
