//! What the particles that clip and filter leave have in common.

use std::fmt::Write;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;
use renderer::{Bounds, SelectView};

use crate::frames::{Column, Frame};
use crate::numbers::with_digits;
use crate::scene::{SceneError, Selection, choice};

/// What is to be counted.
#[derive(Clone)]
pub struct Question {
    pub index: usize,
    pub frame: Arc<Frame>,
    pub select: SelectView,
    /// The quantity's name, as a view has it.
    pub quantity: Option<String>,
}

/// What was counted, of the particles that have a place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    pub frame: usize,
    /// Selected, and of how many.
    pub particles: usize,
    pub of: usize,
    /// Sum of the masses, where the file gives any; of m/ρ, where there are densities, too.
    pub mass: Option<f64>,
    pub volume: Option<f64>,
    /// Around the centres.
    pub bounds: Option<Bounds>,
    pub quantity: Option<String>,
    /// Of the values that are numbers; `None` without one.
    pub values: Option<Values>,
}

/// The distribution of a quantity, every particle counting alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Values {
    pub count: usize,
    pub min: f64,
    pub max: f64,
    pub mean: f64,
    /// Root of the mean square of the distances from the mean.
    pub deviation: f64,
    pub median: f64,
}

/// An answer to a question, or why there is none.
pub struct Answer {
    pub question: Question,
    pub statistics: Result<Statistics, SceneError>,
}

impl Question {
    pub fn is_same(&self, other: &Question) -> bool {
        Arc::ptr_eq(&self.frame, &other.frame)
            && self.select == other.select
            && self.quantity == other.quantity
    }

    /// Counts, on all threads.
    pub fn answer(self) -> Answer {
        let statistics = self.statistics();
        Answer { question: self, statistics }
    }

    fn statistics(&self) -> Result<Statistics, SceneError> {
        let Question { index, frame, select, quantity } = self;
        let (choice, selection) = (choice(frame, select)?, Selection::new(frame, quantity.as_deref())?);
        let placed = |row: &usize| frame.position(*row).iter().all(|x| x.is_finite());
        let rows: Vec<usize> =
            (0..frame.len()).into_par_iter().filter(placed).filter(|row| choice.keeps(*row)).collect();
        let of = (0..frame.len()).into_par_iter().filter(placed).count();
        let bounds = rows
            .par_iter()
            .map(|row| DVec3::from_array(frame.position(*row)))
            .map(|point| Bounds { min: point, max: point })
            .reduce_with(|a, b| a.union(&b));
        let values = rows.par_iter().map(|row| selection.value(*row)).filter(|value| value.is_finite());
        let (mass, volume) = amounts(frame, &rows);
        Ok(Statistics {
            frame: *index,
            particles: rows.len(),
            of,
            mass,
            volume,
            bounds,
            quantity: selection.name(),
            values: Values::of(values.collect()),
        })
    }
}

/// Mass and volume of some particles.
fn amounts(frame: &Frame, rows: &[usize]) -> (Option<f64>, Option<f64>) {
    let scalar =
        |name| frame.field(name).map(|field| &field.column).filter(|column| column.components() == 1);
    let (masses, densities): (Option<&Column>, _) = (scalar("mass"), scalar("density"));
    let one = frame.metadata.particle_mass;
    if masses.is_none() && one.is_none() {
        return (None, None);
    }
    let mass = |row: usize| masses.map_or(one.unwrap_or(0.0), |column| column.get(row, 0));
    let sum = |value: &(dyn Fn(usize) -> f64 + Sync)| {
        let total: f64 = rows.par_iter().map(|row| value(*row)).sum();
        total.is_finite().then_some(total)
    };
    let volume = densities.and_then(|rho| sum(&|row| mass(row) / rho.get(row, 0)));
    (sum(&mass), volume)
}

impl Values {
    /// `None` of no value.
    pub fn of(mut values: Vec<f64>) -> Option<Values> {
        let count = values.len();
        if count == 0 {
            return None;
        }
        // Shares first: a sum of huge values may overflow.
        let mean: f64 = values.par_iter().map(|value| value / count as f64).sum();
        let [min, max] = values
            .par_iter()
            .fold(|| [f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(*q), high.max(*q)])
            .reduce(|| [f64::INFINITY, f64::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        // Relative to the largest distance, whose square might overflow.
        let farthest = (max - mean).max(mean - min);
        let square = |value: &f64| ((value - mean) / farthest).powi(2) / count as f64;
        let deviation =
            if farthest > 0.0 { farthest * values.par_iter().map(square).sum::<f64>().sqrt() } else { 0.0 };
        let (below, middle, _) = values.select_nth_unstable_by(count / 2, f64::total_cmp);
        let median = match count % 2 {
            1 => *middle,
            _ => 0.5 * *middle + 0.5 * below.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        };
        Some(Values { count, min, max, mean, deviation, median })
    }
}

impl Statistics {
    /// Every number by its name, as a table for people and programs.
    pub fn rows(&self) -> Vec<(String, String)> {
        let number = |value: f64| with_digits(value, 9);
        let mut rows = vec![
            ("frame".to_owned(), self.frame.to_string()),
            ("particles".to_owned(), self.particles.to_string()),
            ("of".to_owned(), self.of.to_string()),
        ];
        let mut add = |name: &str, value: f64| rows.push((name.to_owned(), number(value)));
        self.mass.into_iter().for_each(|mass| add("mass", mass));
        self.volume.into_iter().for_each(|volume| add("volume", volume));
        if let Some(Bounds { min, max }) = self.bounds {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                add(&format!("{name} min"), min[axis]);
                add(&format!("{name} max"), max[axis]);
            }
        }
        if let (Some(name), Some(values)) = (&self.quantity, &self.values) {
            let Values { min, max, mean, deviation, median, .. } = *values;
            let named = [
                ("min", min),
                ("max", max),
                ("mean", mean),
                ("standard deviation", deviation),
                ("median", median),
            ];
            named.into_iter().for_each(|(what, value)| add(&format!("{name} {what}"), value));
        }
        rows
    }

    /// A line for each number.
    pub fn text(&self) -> String {
        self.rows().iter().fold(String::new(), |mut text, (name, value)| {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{name}: {value}");
            text
        })
    }

    /// A line of names and a line of numbers.
    pub fn csv(&self) -> String {
        let (names, values): (Vec<String>, Vec<String>) = self.rows().into_iter().unzip();
        let quoted = names.iter().map(|name| match name.contains([',', '"']) {
            true => format!("\"{}\"", name.replace('"', "\"\"")),
            false => name.clone(),
        });
        format!("{}\n{}\n", quoted.collect::<Vec<_>>().join(","), values.join(","))
    }
}

#[cfg(test)]
mod tests {
    use renderer::Filter;

    use super::*;
    use crate::frames::{Field, Metadata};

    fn frame() -> Arc<Frame> {
        let positions =
            (0..6).flat_map(|row| [f64::from(row), 2.0 * f64::from(row), 0.0]).collect::<Vec<_>>();
        let field = |name: &str, values: &[f64]| Field {
            name: name.into(),
            column: Column::scalars(values.to_vec()),
        };
        let fields = vec![
            field("heat", &[1.0, 2.0, 4.0, 9.0, f64::NAN, 100.0]),
            field("Masses", &[1.0; 6]),
            field("rho", &[2.0, 2.0, 2.0, 2.0, 2.0, 4.0]),
        ];
        Arc::new(Frame::new(Column::new(3, positions).unwrap(), fields, Metadata::default()).unwrap())
    }

    fn question(filters: Vec<Filter>) -> Question {
        let select = SelectView { filters, ..SelectView::default() };
        Question { index: 3, frame: frame(), select, quantity: Some("heat".into()) }
    }

    #[test]
    fn what_is_selected_is_counted_and_nothing_else() {
        let below = Filter { field: "heat".into(), range: [0.0, 10.0], invert: false, on: true };
        let statistics = question(vec![below]).answer().statistics.unwrap();
        assert_eq!((statistics.particles, statistics.of), (4, 6));
        assert_eq!((statistics.mass, statistics.volume), (Some(4.0), Some(2.0)));
        assert_eq!(statistics.bounds.unwrap().max, DVec3::new(3.0, 6.0, 0.0));
        let values = statistics.values.unwrap();
        assert_eq!((values.min, values.max, values.mean, values.median), (1.0, 9.0, 4.0, 3.0));
        assert!((values.deviation - 9.5_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn values_that_are_no_numbers_are_left_out_of_the_distribution() {
        let statistics = question(Vec::new()).answer().statistics.unwrap();
        let values = statistics.values.unwrap();
        assert_eq!((statistics.particles, values.count, values.median), (6, 5, 4.0));
        let nothing = Filter { field: "heat".into(), range: [-2.0, -1.0], invert: false, on: true };
        let statistics = question(vec![nothing]).answer().statistics.unwrap();
        assert_eq!((statistics.particles, statistics.values, statistics.bounds), (0, None, None));
    }

    #[test]
    fn extreme_values_do_no_harm() {
        let values = Values::of(vec![-1e308, 1e308, 1e308]).unwrap();
        assert!(values.deviation.is_finite() && values.mean.is_finite() && values.median == 1e308);
        assert_eq!(Values::of(vec![5.0; 4]).unwrap().deviation, 0.0);
    }

    #[test]
    fn it_can_be_copied_as_lines_and_as_a_table() {
        let statistics = question(Vec::new()).answer().statistics.unwrap();
        assert!(
            statistics.text().contains("particles: 6\n") && statistics.text().contains("heat median: 4\n")
        );
        let csv = statistics.csv();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines.len(), 2);
        assert_eq!(lines[0].split(',').count(), lines[1].split(',').count());
        assert!(lines[0].starts_with("frame,particles,of,mass,volume,x min"), "{}", lines[0]);
    }

    #[test]
    fn a_field_that_is_not_there_is_named() {
        let missing = Question { quantity: Some("dye".into()), ..question(Vec::new()) };
        assert!(missing.answer().statistics.unwrap_err().to_string().contains("`dye`"));
    }
}
