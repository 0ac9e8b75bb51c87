//! Snapshots of GADGET, SWIFT and AREPO: the gas in PartType0, the rest in attributes of the header.

use super::store::Store;
use crate::frames::readers::error::{Fault, Place};
use crate::frames::{Column, Field, Frame, Metadata};

const GAS: &str = "PartType0";

/// Support radius in units of SWIFT's smoothing length, which is a width of the kernel (Dehnen & Aly
/// 2012, table 1, three dimensions). GADGET's is the support radius itself.
const SWIFT_KERNELS: [(&str, f64); 6] = [
    ("cubic", 1.825742),
    ("quartic", 2.018932),
    ("quintic", 2.195775),
    ("wendland c2", 1.936492),
    ("wendland c4", 2.207940),
    ("wendland c6", 2.449490),
];

pub fn is_snapshot_without_gas(store: &Store, groups: &[String]) -> Result<bool, Fault> {
    Ok(groups.iter().any(|group| group == "Header")
        && store.attribute("Header", "NumPart_ThisFile").is_some_and(|counts| counts.first() == Some(&0.0)))
}

/// A file of a snapshot that has its gas in other files.
pub fn empty(store: &Store) -> Result<Frame, Fault> {
    let positions = Column::new(3, Vec::<f64>::new()).ok_or_else(|| Fault::new("no positions"))?;
    let mut frame = frame(positions, Vec::new(), metadata(store, &[]))?;
    frame.warnings = warnings(store);
    Ok(frame)
}

pub fn parse(store: &Store, groups: &[String]) -> Result<Frame, Fault> {
    if !groups.iter().any(|group| group == GAS) {
        if is_snapshot_without_gas(store, groups)? {
            return empty(store);
        }
        let what = format!("no gas: expected {GAS}, found {}", groups.join(", "));
        return Err(Fault::at(what, Place::Part("/".into())));
    }
    let (_, names) = store.members(GAS)?;
    let path = |name: &str| format!("{GAS}/{name}");
    let coordinates = names.iter().find(|name| name.as_str() == "Coordinates").ok_or_else(|| {
        Fault::at(format!("no Coordinates, found {}", names.join(", ")), Place::Part(GAS.into()))
    })?;
    let positions = store
        .column(&path(coordinates), None)?
        .filter(|column| column.components() == 3)
        .ok_or_else(|| Fault::at("expected numbers of shape (N, 3)", Place::Part(path(coordinates))))?;
    let mut fields = Vec::new();
    let mut warnings = warnings(store);
    for name in names.iter().filter(|name| *name != coordinates) {
        match store.column(&path(name), Some(positions.len()))? {
            Some(column) => fields.push(Field { name: name.clone(), column }),
            None => warnings.push(format!("`{GAS}/{name}` does not hold numbers and is left out")),
        }
    }
    let mut frame = frame(positions, fields, metadata(store, &names))?;
    frame.warnings = warnings;
    Ok(frame)
}

fn frame(positions: Column, fields: Vec<Field>, metadata: Metadata) -> Result<Frame, Fault> {
    Frame::new(positions, fields, metadata).map_err(|error| Fault::new(error.to_string()))
}

fn metadata(store: &Store, names: &[String]) -> Metadata {
    let first = |name: &str| store.attribute("Header", name).and_then(|values| values.first().copied());
    // The table counts where particles have no masses of their own.
    let own_masses = names.iter().any(|name| name.eq_ignore_ascii_case("masses"));
    let particle_mass = first("MassTable").filter(|&mass| mass > 0.0 && mass.is_finite() && !own_masses);
    Metadata {
        time: first("Time"),
        particle_mass,
        support_per_smoothing_length: Some(support_per_smoothing_length(store)),
        ..Metadata::default()
    }
}

fn support_per_smoothing_length(store: &Store) -> f64 {
    let code = store.attribute_text("Header", "Code").unwrap_or_default();
    if !code.to_ascii_lowercase().contains("swift") {
        return 1.0;
    }
    let kernel =
        store.attribute_text("HydroScheme", "Kernel function").unwrap_or_default().to_ascii_lowercase();
    SWIFT_KERNELS.iter().find(|(name, _)| kernel.contains(name)).map_or(1.0, |&(_, ratio)| ratio)
}

fn warnings(store: &Store) -> Vec<String> {
    let files = store.attribute("Header", "NumFilesPerSnapshot").and_then(|values| values.first().copied());
    match files {
        Some(files) if files > 1.0 => {
            vec![format!("one of {files} files of a snapshot; the others are not read with it")]
        }
        _ => Vec::new(),
    }
}
