//! Dumps of Phantom. They hold no density and no masses: both follow from the smoothing length and
//! the mass of the particle's type (Price et al. 2018, equation 6).

use super::store::Store;
use crate::frames::readers::error::{Fault, Place};
use crate::frames::{Column, Field, Frame, Metadata, Numbers};

/// Phantom's default kernel, the cubic spline, reaches two smoothing lengths.
const SUPPORT_PER_SMOOTHING_LENGTH: f64 = 2.0;

pub fn parse(store: &Store, names: &[String]) -> Result<Frame, Fault> {
    let positions = store
        .column("particles/xyz", None)?
        .filter(|column| column.components() == 3)
        .ok_or_else(|| Fault::at("expected numbers of shape (N, 3)", Place::Part("particles/xyz".into())))?;
    let mut fields = Vec::new();
    let mut warnings = Vec::new();
    for name in names.iter().filter(|name| *name != "xyz") {
        match store.column(&format!("particles/{name}"), Some(positions.len()))? {
            Some(column) => fields.push(Field { name: name.clone(), column }),
            None => warnings.push(format!("`particles/{name}` does not hold numbers and is left out")),
        }
    }
    let mut metadata = Metadata {
        time: header(store, "time")?.and_then(|values| values.first().copied()),
        support_per_smoothing_length: Some(SUPPORT_PER_SMOOTHING_LENGTH),
        ..Metadata::default()
    };
    add_mass_and_density(store, positions.len(), &mut fields, &mut metadata)?;
    let mut frame = Frame::new(positions, fields, metadata).map_err(|error| Fault::new(error.to_string()))?;
    frame.warnings = warnings;
    Ok(frame)
}

/// The numbers of `header/<name>`; `None` where there are none.
fn header(store: &Store, name: &str) -> Result<Option<Vec<f64>>, Fault> {
    let (groups, _) = store.members("/")?;
    if !groups.iter().any(|group| group == "header") {
        return Ok(None);
    }
    let (_, names) = store.members("header")?;
    if !names.iter().any(|other| other == name) {
        return Ok(None);
    }
    store.numbers(&format!("header/{name}"))
}

fn add_mass_and_density(
    store: &Store,
    rows: usize,
    fields: &mut Vec<Field>,
    metadata: &mut Metadata,
) -> Result<(), Fault> {
    let find = |fields: &[Field], name: &str| fields.iter().position(|field| field.name == name);
    let Some(masses) = header(store, "massoftype")? else { return Ok(()) };
    let mut mass = vec![0.0; rows];
    match find(fields, "itype") {
        Some(itype) => {
            for (particle, mass) in mass.iter_mut().enumerate() {
                // A negative type is a particle that rests on its time step.
                let kind = fields[itype].column.get(particle, 0).abs();
                *mass = masses.get((kind as usize).wrapping_sub(1)).copied().ok_or_else(|| {
                    let what = format!("particle {particle} has type {kind}, expected 1 to {}", masses.len());
                    Fault::at(what, Place::Part("particles/itype".into()))
                })?;
            }
        }
        None => mass.fill(masses.first().copied().unwrap_or(0.0)),
    }
    let has_density = ["rho", "density"].iter().any(|name| find(fields, name).is_some());
    if let (false, Some(h), Some(hfact)) = (has_density, find(fields, "h"), header(store, "hfact")?) {
        let hfact = hfact.first().copied().unwrap_or(1.0);
        let h = &fields[h].column;
        let density = mass.iter().enumerate().map(|(particle, m)| m * (hfact / h.get(particle, 0)).powi(3));
        let density: Vec<f64> = density.collect();
        fields.push(Field { name: "density".into(), column: Column::scalars(density) });
    }
    let first = mass.first().copied();
    if mass.iter().all(|&other| Some(other) == first) {
        metadata.particle_mass = first.filter(|mass| *mass > 0.0);
    } else {
        fields.push(Field { name: "mass".into(), column: Column::scalars(Numbers::F64(mass)) });
    }
    Ok(())
}
