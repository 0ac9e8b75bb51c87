//! `sphcast info`: what is in a frame.

use anyhow::{Context, bail};
use serde::Serialize;

use super::SequenceArguments;
use crate::export::one_line;
use crate::frames::{Column, Frame, median_spacing};
use crate::say::say;
use crate::scene::{Selection, Support};

/// Tell what is in a frame: fields and their ranges, particles, bounding box, spacing, support radius.
#[derive(clap::Args)]
#[command(after_help = "\
Of a run, every frame is told; --frames picks some.

Examples:
  sphcast info frame.vtu
  sphcast info run/ --frames 0 --json")]
pub struct InfoArguments {
    #[command(flatten)]
    sequence: SequenceArguments,
    /// As JSON: an object, or an array of them for several frames
    #[arg(long)]
    json: bool,
}

/// What there is to know about a frame. Lengths in the unit of the run.
#[derive(Debug, Serialize)]
struct Info {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<f64>,
    particles: usize,
    non_finite_positions: usize,
    /// Least and greatest corner of the box round the finite positions.
    #[serde(skip_serializing_if = "Option::is_none")]
    bounding_box: Option<[[f64; 3]; 2]>,
    /// Median distance to the nearest neighbour.
    #[serde(skip_serializing_if = "Option::is_none")]
    spacing: Option<f64>,
    support_radius: SupportInfo,
    /// What is shown where nothing else is asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    default_quantity: Option<String>,
    fields: Vec<FieldInfo>,
    warnings: Vec<String>,
}

#[derive(Debug, Serialize)]
struct SupportInfo {
    /// Least and greatest valid one.
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f64; 2]>,
    invalid: usize,
    source: String,
}

#[derive(Debug, Serialize)]
struct FieldInfo {
    name: String,
    components: usize,
    /// Least and greatest finite value; of vectors the length.
    #[serde(skip_serializing_if = "Option::is_none")]
    range: Option<[f64; 2]>,
    /// Rows with a value that is not finite.
    non_finite: usize,
}

pub fn run(arguments: &InfoArguments) -> anyhow::Result<()> {
    let run = arguments.sequence.open()?;
    let sources = run.sequence.sources();
    let several = sources.len() > 1;
    let (mut infos, mut failed) = (Vec::new(), Vec::new());
    for source in sources {
        match source.load(&Default::default()).with_context(|| source.name.clone()) {
            Ok(frame) => {
                let info = Info::new(&source.name, &frame);
                match arguments.json {
                    true => infos.push(info),
                    false => say(info)?,
                }
            }
            Err(error) if !several => return Err(error),
            Err(error) => {
                eprintln!("warning: {}", one_line(&error));
                failed.push(&source.name);
            }
        }
    }
    match infos.as_slice() {
        _ if !arguments.json => {}
        [only] if !several => say(serde_json::to_string_pretty(only)? + "\n")?,
        all => say(serde_json::to_string_pretty(all)? + "\n")?,
    }
    match failed.as_slice() {
        [] => Ok(()),
        [first, ..] => bail!("{first}: cannot be read: {} of {} frames failed", failed.len(), sources.len()),
    }
}

impl Info {
    fn new(name: &str, frame: &Frame) -> Info {
        let rows = 0..frame.len();
        let positions = rows.clone().map(|row| frame.position(row));
        let finite = positions.filter(|position| position.iter().all(|x| x.is_finite()));
        let (mut finite_positions, mut bounds) = (0, [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]]);
        for position in finite {
            finite_positions += 1;
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(position[axis]);
                bounds[1][axis] = bounds[1][axis].max(position[axis]);
            }
        }
        let support = Support::new(frame, None);
        let radii = rows.map(|row| support.radius(row)).map(|h| if h > 0.0 { h } else { f64::NAN });
        let (range, invalid) = finite_range(radii);
        Info {
            name: name.to_owned(),
            time: frame.metadata.time,
            particles: frame.len(),
            non_finite_positions: frame.len() - finite_positions,
            bounding_box: (finite_positions > 0).then_some(bounds),
            spacing: median_spacing(frame),
            support_radius: SupportInfo { range, invalid, source: support.source.to_string() },
            default_quantity: Selection::default_of(frame).name(),
            fields: frame.fields().iter().map(|field| FieldInfo::new(&field.name, &field.column)).collect(),
            warnings: frame.warnings.clone(),
        }
    }
}

impl FieldInfo {
    fn new(name: &str, column: &Column) -> FieldInfo {
        let (range, non_finite) = finite_range((0..column.len()).map(|row| column.magnitude(row)));
        FieldInfo { name: name.to_owned(), components: column.components(), range, non_finite }
    }
}

/// Least and greatest finite value, and how many are not finite.
fn finite_range(values: impl Iterator<Item = f64>) -> (Option<[f64; 2]>, usize) {
    let (mut range, mut others) = (None::<[f64; 2]>, 0);
    for value in values {
        match range {
            _ if !value.is_finite() => others += 1,
            None => range = Some([value, value]),
            Some([low, high]) => range = Some([value.min(low), value.max(high)]),
        }
    }
    (range, others)
}

impl std::fmt::Display for Info {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        writeln!(f, "{}", self.name)?;
        if let Some(time) = self.time {
            writeln!(f, "  time            {}", Number(time))?;
        }
        writeln!(f, "  particles       {}", self.particles)?;
        if self.non_finite_positions > 0 {
            writeln!(f, "                  {} have no finite position", self.non_finite_positions)?;
        }
        if let Some([low, high]) = self.bounding_box {
            // Enough digits to tell the corners of a small run far from the origin apart.
            let corner = |corner: [f64; 3]| corner.map(|x| digits(x, 9)).join(", ");
            writeln!(f, "  bounding box    ({}) to ({})", corner(low), corner(high))?;
        }
        if let Some(spacing) = self.spacing {
            writeln!(f, "  spacing         {} (median to the nearest neighbour)", Number(spacing))?;
        }
        if self.particles > 0 {
            self.support_radius.write(f)?;
        }
        for (index, field) in self.fields.iter().enumerate() {
            let title = if index == 0 { "fields" } else { "" };
            let shown =
                self.default_quantity.as_deref() == Some(&crate::frames::names::canonical(&field.name));
            writeln!(f, "  {title:<16}{field}{}", if shown { ", shown first" } else { "" })?;
        }
        if self.fields.is_empty() {
            writeln!(f, "  fields          none")?;
        }
        for warning in &self.warnings {
            writeln!(f, "  warning         {warning}")?;
        }
        Ok(())
    }
}

impl SupportInfo {
    fn write(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let range = match self.range {
            Some([low, high]) if low == high => Number(low).to_string(),
            Some([low, high]) => format!("{} to {}", Number(low), Number(high)),
            None => "none".to_owned(),
        };
        writeln!(f, "  support radius  {range} ({})", self.source)?;
        if self.invalid > 0 {
            writeln!(f, "                  {} are not positive and finite", self.invalid)?;
        }
        Ok(())
    }
}

impl std::fmt::Display for FieldInfo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.name)?;
        if self.components > 1 {
            write!(f, ", {} components, length", self.components)?;
        }
        match self.range {
            Some([low, high]) => write!(f, " {} to {}", Number(low), Number(high))?,
            None => f.write_str(", no finite value")?,
        }
        match self.non_finite {
            0 => Ok(()),
            count => write!(f, ", {count} not finite"),
        }
    }
}

/// A number with six significant digits, as people write them.
struct Number(f64);

impl std::fmt::Display for Number {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&digits(self.0, 6))
    }
}

/// A number rounded to `count` significant digits.
fn digits(number: f64, count: usize) -> String {
    // Rounded first: what is left prints without a tail.
    let rounded: f64 = format!("{number:.*e}", count - 1).parse().unwrap_or(number);
    // Nobody needs to know of a zero's sign.
    let rounded = rounded + 0.0;
    match rounded.abs() {
        0.0 | 1e-4..1e7 => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits() {
        let text = |x: f64| Number(x).to_string();
        assert_eq!(text(f64::from(0.025_f32)), "0.025");
        assert_eq!(text(-1234567.8), "-1234570");
        assert_eq!(text(1.0 / 3.0 * 1e-9), "3.33333e-10");
        assert_eq!(text(0.0), "0");
    }

    #[test]
    fn a_frame_is_told_whole() {
        let frame = crate::frames::Generated::parse("radial:1000").unwrap().frame();
        let text = Info::new("demo:radial:1000", &frame).to_string();
        for part in
            ["particles       1000", "support radius  0.4 (from the file)", "radius 0.", "bounding box"]
        {
            assert!(text.contains(part), "{part} in {text}");
        }
    }
}
