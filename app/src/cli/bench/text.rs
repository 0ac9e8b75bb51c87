//! The tables for the eye, on standard output.

use super::quartiles::Quartiles;
use super::report::Report;
use super::summary::Summary;

/// Times (the paper's table 2), errors (its table 3), and classes of cells.
pub fn tables(report: &Report) -> String {
    let mut text = format!("{}\n", report.title());
    for (title, table) in [
        (TIMES, times(&report.settings)),
        (ERRORS, errors(&report.settings)),
        (CELLS, cells(&report.settings)),
    ] {
        text += &format!("\n{title}\n{}", aligned(&table));
    }
    text + &full_sampling(&report.settings[0])
}

const TIMES: &str = "\
Milliseconds: medians over frames and rounds, quartiles of the total; speed-up against full sampling;
kernel evaluations in % of those of full sampling, the analysis counted in";
const ERRORS: &str = "Error against full sampling; rays above the tolerance in the frame with the most";
const CELLS: &str = "Cells by class in %";

type Row = Vec<String>;

fn header(names: &[&str]) -> Row {
    names.iter().map(|&name| name.to_owned()).collect()
}

fn times(settings: &[Summary]) -> Vec<Row> {
    let names = [
        "setting",
        "grid",
        "analysis",
        "merge",
        "cast",
        "total",
        "quartiles",
        "cast x",
        "total x",
        "eval. %",
    ];
    let row = |summary: &Summary| {
        let times = &summary.milliseconds;
        let stages = [times.grid, times.analysis, times.merge, times.ray_cast, times.total];
        let medians = stages.map(|time| milliseconds(time.median));
        let Quartiles { lower, upper, .. } = times.total;
        let spread = format!("{} - {}", milliseconds(lower), milliseconds(upper));
        let speed_up = [summary.speed_up.ray_cast, summary.speed_up.total];
        let speed_up = speed_up.map(|ratio| number(ratio.median, |x| format!("{x:.2}")));
        let evaluations = percent(summary.evaluations.share, 1);
        let (name, rest) = (summary.setting.clone(), [spread]);
        [name].into_iter().chain(medians).chain(rest).chain(speed_up).chain([evaluations]).collect()
    };
    [header(&names)].into_iter().chain(settings.iter().map(row)).collect()
}

fn errors(settings: &[Summary]) -> Vec<Row> {
    let names = ["setting", "largest", "mean", "predicted", "rays above %", "frames above", ""];
    let row = |summary: &Summary| {
        let error = &summary.error;
        let verdict = if summary.is_above() { "ABOVE THE TOLERANCE" } else { "" };
        vec![
            summary.setting.clone(),
            number(error.max, scientific),
            number(error.mean, scientific),
            number(error.predicted, scientific),
            percent(error.rays_above.unwrap_or(f64::NAN), 4),
            error.frames_above.map_or("-".to_owned(), |above| format!("{above} of {}", summary.frames)),
            verdict.to_owned(),
        ]
    };
    [header(&names)].into_iter().chain(settings.iter().map(row)).collect()
}

fn cells(settings: &[Summary]) -> Vec<Row> {
    let names = ["setting", "full", "mixed", "z-adaptive", "super-pixel", "transparent", "occluded"];
    let row = |summary: &Summary| {
        let cells = &summary.cells;
        let shares =
            [cells.full, cells.mixed, cells.z_adaptive, cells.super_pixel, cells.transparent, cells.occluded];
        [summary.setting.clone()].into_iter().chain(shares.map(|share| percent(share, 1))).collect()
    };
    [header(&names)].into_iter().chain(settings.iter().map(row)).collect()
}

/// What is known of full sampling only.
fn full_sampling(full: &Summary) -> String {
    let rate = number(full.evaluations.per_second, scientific);
    let mut text = format!("\nFull sampling: {rate} evaluations a second");
    if full.evaluations.inside.is_finite() {
        text += &format!(", {} % of them with a weight above zero", percent(full.evaluations.inside, 1));
    }
    text += "\n";
    if full.discretisation.max.is_finite() {
        text += &format!(
            "Discretisation: sampled {} times as fine, the picture changes by {} at most and {} on average\n",
            super::measure::FINER,
            scientific(full.discretisation.max),
            scientific(full.discretisation.mean),
        );
    }
    text
}

/// Columns as wide as they must be, two blanks apart; the first to the left, numbers to the right.
fn aligned(rows: &[Row]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let line = |row: &Row| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| match column {
            0 => format!("{cell:<width$}"),
            _ => format!("  {cell:>width$}"),
        });
        cells.collect::<String>().trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

/// A dash for what was not measured.
fn number(value: f64, shown: impl Fn(f64) -> String) -> String {
    if value.is_nan() { "-".to_owned() } else { shown(value) }
}

/// Three digits that tell, down to the microsecond.
fn milliseconds(value: f64) -> String {
    number(value, |x| match x {
        x if x >= 99.95 => format!("{x:.0}"),
        x if x >= 9.995 => format!("{x:.1}"),
        x if x >= 0.9995 || x == 0.0 => format!("{x:.2}"),
        x => format!("{x:.3}"),
    })
}

fn percent(share: f64, digits: usize) -> String {
    number(100.0 * share, |x| format!("{x:.digits$}"))
}

fn scientific(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.2e}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::bench::settings::Setting;
    use crate::cli::view::Tolerance;

    #[test]
    fn columns_stand_under_each_other() {
        let row = |cells: [&str; 3]| header(&cells);
        let table = [row(["setting", "grid", ""]), row(["full", "123.4", "!"]), row(["0.001 x", "7", ""])];
        assert_eq!(aligned(&table), "setting   grid\nfull     123.4  !\n0.001 x      7\n");
    }

    #[test]
    fn an_error_above_the_tolerance_stands_out() {
        let [full, adaptive] = &Setting::list(&[Tolerance(Some(0.004))], false)[..] else { panic!() };
        let mut summaries = [full, adaptive].map(|setting| Summary::new(&[], setting, 0));
        let loud = |summaries: &[Summary]| aligned(&errors(summaries)).contains("ABOVE THE TOLERANCE");
        assert!(!loud(&summaries));
        summaries[1].error.frames_above = Some(1);
        assert!(loud(&summaries));
    }

    #[test]
    fn numbers_have_the_digits_that_tell() {
        let shown = [f64::NAN, 0.0, 0.01234, 1.0, 12.345, 1234.5].map(milliseconds);
        assert_eq!(shown, ["-", "0.00", "0.012", "1.00", "12.3", "1234"]);
        assert_eq!([percent(0.12345, 1), scientific(0.00123), scientific(0.0)], ["12.3", "1.23e-3", "0"]);
    }
}
