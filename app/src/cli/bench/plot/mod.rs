//! The figures: error and time over the frames (11 and 12 of the paper), and time against error.

mod axis;
mod chart;

use super::report::{FrameRow, Report};
use super::summary::Summary;
use axis::Axis;
use chart::{Chart, Style, X_ENDS, Y_ENDS};

/// One colour for each tolerance (Okabe and Ito: told apart by everyone), in turn.
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const FULL_COLOUR: &str = "#444";
/// One pattern for each ablation, in turn.
const DASHES: [&str; 4] = ["7 4", "2 3", "9 3 2 3", "4 2"];
/// With more frames than this, dots would hide the line.
const DOTTED: usize = 60;

pub fn error_over_frames(report: &Report) -> String {
    let adaptive = || series(report).into_iter().skip(1);
    let errors = report.by_frame.iter().filter(|row| row.summary.tolerance.is_some());
    let values = errors.flat_map(|row| [row.summary.error.max, row.summary.tolerance.unwrap_or(0.0)]);
    let y = Axis::log("largest error of the frame", values, Y_ENDS);
    let note = "against full sampling, any channel of any pixel; dotted: the tolerance";
    let mut chart = Chart::new("Error over the frames", note, frame_axis(report), y);
    for Series { summary, style, rows } in adaptive() {
        if let Some(tolerance) = summary.tolerance.filter(|_| summary.ablation.is_none()) {
            let [first, last] = [0, rows.len() - 1].map(|row| rows[row].frame as f64);
            let margin = if rows.len() == 1 { 1.0 } else { 0.02 * (last - first) };
            chart.thin([first - margin, tolerance], [last + margin, tolerance], style.colour, true);
        }
        draw(&mut chart, &summary.setting, style, &rows, |summary| summary.error.max);
    }
    chart.svg()
}

pub fn time_over_frames(report: &Report) -> String {
    let time = |summary: &Summary| summary.milliseconds.total.median;
    let values = report.by_frame.iter().map(|row| time(&row.summary));
    let y = Axis::from_zero("milliseconds", values, Y_ENDS);
    let note = "grid, analysis, merge and ray cast, median over the rounds";
    let mut chart = Chart::new("Time over the frames", note, frame_axis(report), y);
    for Series { summary, style, rows } in series(report) {
        draw(&mut chart, &summary.setting, style, &rows, time);
    }
    chart.svg()
}

pub fn time_against_error(report: &Report) -> String {
    let adaptive = report.settings.iter().filter(|summary| summary.tolerance.is_some());
    let values = adaptive.flat_map(|summary| [summary.error.max, summary.tolerance.unwrap_or(0.0)]);
    let x = Axis::log("largest error over all frames", values, X_ENDS);
    let times = report.settings.iter().map(|summary| summary.milliseconds.total.upper);
    let y = Axis::from_zero("milliseconds", times, Y_ENDS);
    let note = "dots: median time, with its quartiles; dotted: from the error up to the tolerance";
    let mut chart = Chart::new("Time against error", note, x, y);
    for Series { summary, style, .. } in series(report) {
        let time = summary.milliseconds.total;
        if summary.tolerance.is_none() {
            chart.thin([0.0, time.median], [f64::MAX, time.median], style.colour, false);
        }
        if let Some(tolerance) = summary.tolerance {
            let at = |y| [summary.error.max, y];
            chart.thin(at(time.median), [tolerance, time.median], style.colour, true);
            chart.tick([tolerance, time.median], style.colour);
            chart.thin(at(time.lower), at(time.upper), style.colour, false);
            chart.dot(at(time.median), 4.5, style);
        }
        chart.label(time.median, summary.setting.clone(), style);
    }
    chart.svg()
}

/// A setting, and how it looks in every figure.
struct Series<'a> {
    summary: &'a Summary,
    style: Style,
    rows: Vec<&'a FrameRow>,
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
        .map(|(index, style)| Series {
            summary: &report.settings[index],
            style,
            rows: report.by_frame.iter().skip(index).step_by(settings).collect(),
        })
        .collect()
}

fn frame_axis(report: &Report) -> Axis {
    Axis::whole("frame", report.by_frame.iter().map(|row| row.frame), X_ENDS)
}

/// A line over the frames, with its name where it ends.
fn draw(chart: &mut Chart, name: &str, style: Style, rows: &[&FrameRow], value: impl Fn(&Summary) -> f64) {
    let points: Vec<[f64; 2]> = rows.iter().map(|row| [row.frame as f64, value(&row.summary)]).collect();
    chart.line(&points, style, points.len() <= DOTTED);
    if let Some([_, last]) = points.last() {
        chart.label(*last, name.to_owned(), style);
    }
}
