//! The figures: error and time over the frames (11 and 12 of the paper), time against error, and time over
//! the number of particles.

mod axis;
mod chart;

use super::report::{FrameRow, Report};
use super::summary::Summary;
use axis::Axis;
use chart::{Chart, Key, Style, X_ENDS, Y_ENDS};

/// One colour for each tolerance (Okabe and Ito: told apart by everyone), in turn.
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const FULL_COLOUR: &str = "#444";
/// One pattern for each ablation, in turn.
const DASHES: [&str; 4] = ["7 4", "2 3", "9 3 2 3", "4 2"];
/// With more frames than this, dots would hide the line.
const DOTTED: usize = 60;

pub fn error_over_frames(report: &Report) -> String {
    let errors = report.by_frame.iter().map(|row| &row.summary);
    let y = error_axis("largest error of the frame", errors, Y_ENDS);
    let note = "against full sampling, any channel of any pixel; dotted: the tolerance";
    let mut chart = Chart::new(["Error over the frames", note, &report.title()], frame_axis(report), y);
    for Series { summary, style, rows } in series(report).into_iter().skip(1) {
        if let Some(tolerance) = summary.tolerance.filter(|_| summary.ablation.is_none()) {
            chart.thin([f64::MIN, tolerance], [f64::MAX, tolerance], style.colour, true);
        }
        draw(&mut chart, &summary.setting, style, &rows, |summary| summary.error.max);
    }
    chart.svg()
}

pub fn time_over_frames(report: &Report) -> String {
    let time = |summary: &Summary| summary.milliseconds.total.median;
    let values = report.by_frame.iter().map(|row| &row.summary).filter(has_place).map(time);
    let y = Axis::from_zero("milliseconds", values, Y_ENDS);
    let note = "grid, analysis, merge and ray cast, median over the rounds";
    let mut chart = Chart::new(["Time over the frames", note, &report.title()], frame_axis(report), y);
    for Series { summary, style, rows } in series(report) {
        draw(&mut chart, &summary.setting, style, &rows, time);
    }
    chart.svg()
}

/// For frames that differ in their numbers of particles; else `None`.
pub fn time_over_particles(report: &Report) -> Option<String> {
    let time = |row: &FrameRow| row.summary.milliseconds.total.median;
    let particles = || report.by_frame.iter().map(|row| row.particles as f64);
    let [least, most] = [particles().fold(f64::MAX, f64::min), particles().fold(0.0, f64::max)];
    if least < 1.0 || most < 2.0 * least {
        return None;
    }
    let x = Axis::log("particles", particles(), 1.0, X_ENDS);
    let times = report.by_frame.iter().filter(|row| has_place(&&row.summary)).map(time);
    let y = Axis::from_zero("milliseconds", times, Y_ENDS);
    let note = "grid, analysis, merge and ray cast, median over the rounds";
    let mut chart = Chart::new(["Time over the number of particles", note, &report.title()], x, y);
    for Series { summary, style, mut rows } in series(report) {
        rows.sort_by_key(|row| row.particles);
        let points: Vec<[f64; 2]> = rows.iter().map(|row| [row.particles as f64, time(row)]).collect();
        chart.line(&points, style, points.len() <= DOTTED);
        if let Some([_, last]) = points.last() {
            chart.label(*last, &summary.setting, style, Key::Stroke);
        }
    }
    Some(chart.svg())
}

pub fn time_against_error(report: &Report) -> String {
    let x = error_axis("largest error over all frames", report.settings.iter(), X_ENDS);
    let times = report.settings.iter().filter(has_place).map(|summary| summary.milliseconds.total.upper);
    let y = Axis::from_zero("milliseconds", times, Y_ENDS);
    let note = "dot: median time, with its quartiles; dotted: from the error up to the tolerance";
    let mut chart = Chart::new(["Time against error", note, &report.title()], x, y);
    for Series { summary, style, .. } in series(report) {
        let (time, error) = (summary.milliseconds.total, summary.error.max);
        match (summary.tolerance, summary.ablation) {
            // Exact by definition, so that it has a time but no place on the axis of errors.
            (None, _) => {
                chart.thin([0.0, time.median], [f64::MAX, time.median], style.colour, false);
                chart.label(time.median, &summary.setting, style, Key::Stroke);
                continue;
            }
            (Some(tolerance), None) => {
                chart.thin([error, time.median], [tolerance, time.median], style.colour, true);
                chart.tick([tolerance, time.median], style.colour);
            }
            (Some(_), Some(_)) => {}
        }
        chart.thin([error, time.lower], [error, time.upper], style.colour, false);
        chart.dot([error, time.median], 4.5, style);
        chart.label(time.median, &summary.setting, style, Key::Dot);
    }
    chart.svg()
}

/// A setting, and how it looks in every figure.
struct Series<'a> {
    summary: &'a Summary,
    style: Style,
    rows: Vec<&'a FrameRow>,
}

/// Whether a setting is drawn. Another way to sample in full takes so long that no other would be told apart.
fn has_place(summary: &&Summary) -> bool {
    summary.tolerance.is_some() || summary.ablation.is_none()
}

fn series(report: &Report) -> Vec<Series<'_>> {
    // Where a tolerance comes, its ablations follow.
    let (mut tolerances, mut ablations) = (0, 0);
    let of = |(index, summary): (usize, &'_ Summary)| {
        let style = match (summary.tolerance, summary.ablation) {
            (None, _) => Style { colour: FULL_COLOUR, dashes: "" },
            (Some(_), None) => {
                (tolerances, ablations) = (tolerances + 1, 0);
                Style { colour: COLOURS[(tolerances - 1) % COLOURS.len()], dashes: "" }
            }
            (Some(_), Some(_)) => {
                ablations += 1;
                let dashes = DASHES[(ablations - 1) % DASHES.len()];
                Style { colour: COLOURS[(tolerances - 1) % COLOURS.len()], dashes }
            }
        };
        (index, style)
    };
    let styles: Vec<(usize, Style)> = report.settings.iter().enumerate().map(of).collect();
    let settings = report.settings.len();
    styles
        .into_iter()
        .filter(|(index, _)| has_place(&&report.settings[*index]))
        .map(|(index, style)| Series {
            summary: &report.settings[index],
            style,
            rows: report.by_frame.iter().skip(index).step_by(settings).collect(),
        })
        .collect()
}

/// Errors a hundred times below the smallest tolerance are rounding, and no finer told apart.
const ROUNDING: f64 = 0.01;

/// For the errors of adaptive sampling, and their tolerances.
fn error_axis<'a>(title: &'static str, summaries: impl Iterator<Item = &'a Summary>, ends: [f64; 2]) -> Axis {
    let shown = summaries.filter_map(|summary| Some([summary.tolerance?, summary.error.max]));
    let values: Vec<[f64; 2]> = shown.collect();
    let least = values.iter().map(|[tolerance, _]| *tolerance).fold(1.0, f64::min);
    let floor = ROUNDING * if least > 0.0 { least } else { 1e-5 };
    Axis::log(title, values.into_iter().flatten(), floor, ends)
}

fn frame_axis(report: &Report) -> Axis {
    Axis::whole("frame", report.by_frame.iter().map(|row| row.frame), X_ENDS)
}

/// A line over the frames, with its name where it ends.
fn draw(chart: &mut Chart, name: &str, style: Style, rows: &[&FrameRow], value: impl Fn(&Summary) -> f64) {
    let points: Vec<[f64; 2]> = rows.iter().map(|row| [row.frame as f64, value(&row.summary)]).collect();
    chart.line(&points, style, points.len() <= DOTTED);
    if let Some([_, last]) = points.last() {
        chart.label(*last, name, style, Key::Stroke);
    }
}
