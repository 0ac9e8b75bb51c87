//! Output of PySPH: one group of one-dimensional arrays for every kind of particle.

use super::store::Store;
use crate::frames::readers::error::{Fault, Place};
use crate::frames::readers::layout::from_columns;
use crate::frames::{Frame, Metadata};

/// Names that PySPH's users give to what flows.
const FLUIDS: [&str; 4] = ["fluid", "water", "liquid", "gas"];

/// Kernels of PySPH reach two smoothing lengths.
const SUPPORT_PER_SMOOTHING_LENGTH: f64 = 2.0;

pub fn parse(store: &Store, kinds: &[String]) -> Result<Frame, Fault> {
    let is_fluid = |kind: &&String| FLUIDS.iter().any(|name| kind.to_ascii_lowercase().contains(name));
    let kind = kinds.iter().find(is_fluid).or(kinds.first()).ok_or_else(|| {
        Fault::at("expected xyz (Phantom) or groups with arrays (PySPH)", Place::Part("particles".into()))
    })?;
    let group = format!("particles/{kind}/arrays");
    let (_, names) = store.members(&group)?;
    let mut columns = Vec::new();
    let mut warnings = Vec::new();
    let mut rows = None;
    for name in names {
        match store.column(&format!("{group}/{name}"), rows)? {
            Some(column) => {
                rows = Some(column.len());
                columns.push((name, column));
            }
            None => warnings.push(format!("`{group}/{name}` does not hold numbers and is left out")),
        }
    }
    let others: Vec<&str> = kinds.iter().filter(|other| *other != kind).map(String::as_str).collect();
    if !others.is_empty() {
        warnings.push(format!("only the particles `{kind}` are read; left out: {}", others.join(", ")));
    }
    let time = store.attribute("solver_data", "t").and_then(|values| values.first().copied());
    let metadata = Metadata {
        time,
        support_per_smoothing_length: Some(SUPPORT_PER_SMOOTHING_LENGTH),
        ..Metadata::default()
    };
    let mut frame =
        from_columns(columns, metadata).map_err(|fault| Fault::at(fault.what, Place::Part(group)))?;
    frame.warnings = warnings;
    Ok(frame)
}
