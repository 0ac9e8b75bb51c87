use renderer::Stats;

use super::*;
use crate::cli::view::Tolerance;
use crate::difference::Difference;

const TOLERANCE: f64 = 0.004;

fn settings() -> Vec<Setting> {
    Setting::list(&[Tolerance(Some(TOLERANCE))], false)
}

/// A picture with one millisecond of grid and `ray_cast` of casting, `max` away from full sampling.
fn sample(ray_cast: f64, done: u64, max: f64) -> Sample {
    let milliseconds = Milliseconds { grid: 1.0, ray_cast, upload: 50.0, ..Milliseconds::default() };
    let mut stats = Stats { milliseconds, ..Stats::default() };
    stats.evaluations.done = done;
    stats.cells_by_class.full = done;
    let above = if max > TOLERANCE { 0.25 } else { 0.0 };
    Sample { stats, error: Difference { max, place: [0, 0], mean: max / 2.0, above } }
}

fn frame(rounds: Vec<Vec<Sample>>) -> Measured {
    Measured { number: 0, name: "made up".to_owned(), rounds, inside: Some(0.5), discretisation: None }
}

/// Two frames in two rounds; the second round was four times slower, as on a machine that grew busy.
fn frames(errors: [f64; 2]) -> Vec<Measured> {
    let of = |error| {
        let round = |slower| vec![sample(9.0 * slower, 1000, 0.0), sample(4.0 * slower, 400, error)];
        frame(vec![round(1.0), round(4.0)])
    };
    errors.into_iter().map(of).collect()
}

fn adaptive(frames: &[Measured]) -> Summary {
    Summary::new(frames, &settings()[1], 1)
}

#[test]
fn times_are_medians_and_ratios_are_taken_within_a_round() {
    let summary = adaptive(&frames([0.001, 0.002]));
    assert_eq!(summary.pictures, 4);
    // 4, 4, 16, 16, and with the grid 5, 5, 17, 17. The upload is no part of it.
    let Quartiles { lower, median, upper } = summary.milliseconds.total;
    assert_eq!([lower, median, upper], [5.0, 11.0, 17.0]);
    assert_eq!(summary.milliseconds.upload.median, 50.0);
    // However slow the round: 9/4 = 36/16; and 10/5 and 37/17.
    assert_eq!(summary.speed_up.ray_cast, Quartiles { lower: 2.25, median: 2.25, upper: 2.25 });
    let expected = Quartiles::of([2.0, 2.0, 37.0 / 17.0, 37.0 / 17.0]);
    assert_eq!(summary.speed_up.total, expected);
    assert_eq!(summary.evaluations.share, 0.4);
}

#[test]
fn full_sampling_is_as_fast_as_itself() {
    let full = Summary::new(&frames([0.0, 0.0]), &settings()[0], 0);
    assert_eq!(full.speed_up.total.median, 1.0);
    assert_eq!((full.evaluations.share, full.evaluations.inside), (1.0, 0.5));
    assert_eq!(full.error.frames_above, None);
    assert!(!full.is_above() && full.discretisation.max.is_nan());
}

#[test]
fn an_error_above_the_tolerance_is_reported() {
    let within = adaptive(&frames([TOLERANCE, 0.001]));
    assert_eq!((within.error.max, within.error.frames_above), (TOLERANCE, Some(0)));
    assert!(!within.is_above());

    let above = adaptive(&frames([0.0041, 0.001]));
    assert_eq!((above.error.max, above.error.frames_above), (0.0041, Some(1)));
    assert_eq!(above.error.rays_above, Some(0.25));
    assert!(above.is_above());
}

#[test]
fn an_error_in_a_single_round_is_not_lost() {
    let mut frames = frames([0.001, 0.001]);
    frames[1].rounds[1][1].error.max = f64::INFINITY;
    let summary = adaptive(&frames);
    assert_eq!((summary.error.max, summary.error.frames_above), (f64::INFINITY, Some(1)));
    assert!(summary.is_above());
}

#[test]
fn a_run_without_particles_has_no_ratios() {
    let mut empty = sample(0.0, 0, 0.0);
    empty.stats.milliseconds = Milliseconds::default();
    let summary = adaptive(&[frame(vec![vec![empty.clone(), empty]])]);
    assert!(summary.speed_up.total.median.is_nan() && summary.evaluations.share.is_nan());
    assert!(summary.cells.full.is_nan());
    assert!(!summary.is_above());
}

#[test]
fn discretisation_is_the_worst_of_the_frames() {
    let mut frames = frames([0.0, 0.0]);
    for (frame, max) in frames.iter_mut().zip([0.1, 0.3]) {
        frame.discretisation = Some(Difference { max, place: [0, 0], mean: max / 10.0, above: 0.0 });
    }
    let full = Summary::new(&frames, &settings()[0], 0).discretisation;
    assert_eq!(full.max, 0.3);
    assert!((full.mean - 0.02).abs() < 1e-12);
    assert!(adaptive(&frames).discretisation.max.is_nan(), "it is not an error of adaptive sampling");
}
