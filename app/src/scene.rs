//! From a frame and a view to what the renderer takes in: support radii and volumes make a
//! [`ParticleSet`], a field makes a [`Quantity`].
//!
//! The two are built apart, so that another field or range leaves the particles alone: particles
//! depend on the frame and the view's support radius, the quantity on the particles and the view's
//! `quantity`.

mod choice;
mod extremes;

use std::fmt;

use renderer::{ParticleSet, Quantity, QuantityView, RawParticle, Rejected, SelectView};

use crate::frames::{Column, Field, Frame, median_spacing, names};
pub use choice::choice;
pub use extremes::{extremes, is_shown, union};

/// Why a frame and a view make no scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SceneError {
    #[error("there is no field `{name}`; there are: {fields}")]
    NoSuchField { name: String, fields: String },
    #[error("field `{field}` has {components} components, there is no `{name}`")]
    NoSuchComponent { name: String, field: String, components: usize },
    #[error("select.filters: filter {number}: {why}")]
    Filter { number: usize, why: Box<SceneError> },
    #[error("{0} particles are more than the {max} that one picture can hold", max = ParticleSet::MAX_PARTICLES)]
    TooManyParticles(usize),
}

/// Where support radii come from; the first of these that there is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SupportSource {
    View,
    SmoothingLength,
    Metadata,
    RadiusField,
    ParticleRadius,
    Spacing,
    Unknown,
}

impl fmt::Display for SupportSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            SupportSource::View => "as asked for",
            SupportSource::SmoothingLength => "from the smoothing length of each particle",
            SupportSource::Metadata => "from the file",
            SupportSource::RadiusField => "4 times the radius of each particle",
            SupportSource::ParticleRadius => "4 times the particle radius from the file",
            SupportSource::Spacing => "estimated: twice the median distance to the nearest neighbour",
            SupportSource::Unknown => "a guess: particles in one place have no spacing",
        })
    }
}

/// The support radius of each particle of a frame, in the unit of the run.
#[derive(Clone, Copy, Debug)]
pub struct Support<'a> {
    pub source: SupportSource,
    /// Factor of the field, or the radius itself where there is no field.
    factor: f64,
    field: Option<&'a Column>,
    /// Particle radii that must be valid, although one radius for all is taken.
    checked: Option<&'a Column>,
}

impl<'a> Support<'a> {
    /// Settles where the support radii of `frame` come from: the view's, the smoothing length of
    /// each particle, the file's one support radius, four times a `radius` of each particle, four
    /// times the file's one particle radius (the spacing in a fluid at rest is two), or twice the
    /// median spacing. Particles all in one place get 1.
    ///
    /// A frame-wide radius that is not positive and finite is passed over; one of a single particle
    /// is kept, for [`ParticleSet`] to leave that particle out. A particle whose `radius` is invalid is
    /// left out where a radius of the frame is taken, too.
    pub fn new(frame: &'a Frame, view: Option<f64>) -> Support<'a> {
        let positive = |radius: &f64| radius.is_finite() && *radius > 0.0;
        let one = |source, factor| Support { source, factor, field: None, checked: None };
        let each = |source, factor, field: &'a Field| Support {
            source,
            factor,
            field: Some(&field.column),
            checked: None,
        };
        let scalar = |name| frame.field(name).filter(|field| field.column.components() == 1);

        if let Some(radius) = view {
            return one(SupportSource::View, radius);
        }
        if let Some(field) = scalar("smoothing_length") {
            let factor = frame.metadata.support_per_smoothing_length.filter(positive).unwrap_or(1.0);
            return each(SupportSource::SmoothingLength, factor, field);
        }
        // Before a field: what `demo:radial` calls radius is no radius of its particles.
        if let Some(radius) = frame.metadata.support_radius.filter(positive) {
            let checked = scalar("radius").map(|field| &field.column);
            return Support { checked, ..one(SupportSource::Metadata, radius) };
        }
        if let Some(field) = scalar("radius") {
            return each(SupportSource::RadiusField, 4.0, field);
        }
        if let Some(radius) = frame.metadata.particle_radius.filter(positive) {
            return one(SupportSource::ParticleRadius, 4.0 * radius);
        }
        match median_spacing(frame) {
            Some(spacing) => one(SupportSource::Spacing, 2.0 * spacing),
            None => one(SupportSource::Unknown, 1.0),
        }
    }

    /// The radius of all particles where nothing in the frame says it.
    pub fn estimate(&self) -> Option<f64> {
        matches!(self.source, SupportSource::Spacing | SupportSource::Unknown).then_some(self.factor)
    }

    /// Support radius of one particle, as given: it may be negative or not finite.
    pub fn radius(&self, row: usize) -> f64 {
        let checked = self.checked.map_or(1.0, |radii| radii.get(row, 0));
        match self.field {
            _ if !(checked > 0.0 && checked.is_finite()) => checked,
            Some(field) => self.factor * field.get(row, 0),
            None => self.factor,
        }
    }
}

/// The particles of a frame with their support radii ([`Support::new`]) and volumes.
///
/// V_j = m_j/ρ_j; masses that the frame does not give are taken as equal, and without a density
/// that is positive and finite everywhere V_j = 1 (contract, section 1).
pub fn particles(frame: &Frame, support_radius: Option<f64>) -> Result<ParticleSet, SceneError> {
    selected_particles(frame, support_radius, &SelectView::default())
}

/// The same, without those that `select` leaves out. Support radii and volumes are what they are in
/// the whole frame.
pub fn selected_particles(
    frame: &Frame,
    support_radius: Option<f64>,
    select: &SelectView,
) -> Result<ParticleSet, SceneError> {
    if frame.len() > ParticleSet::MAX_PARTICLES {
        return Err(SceneError::TooManyParticles(frame.len()));
    }
    let choice = choice(frame, select)?;
    let (support, volume) = (Support::new(frame, support_radius), volumes(frame));
    let particle = |row| RawParticle {
        position: frame.position(row),
        support_radius: support.radius(row),
        volume: volume(row),
    };
    Ok(ParticleSet::selected(frame.len(), particle, |row| choice.keeps(row)))
}

/// The volume of each particle, m/ρ or 1.
fn volumes(frame: &Frame) -> impl Fn(usize) -> f64 + Sync {
    let scalar =
        |name| frame.field(name).map(|field| &field.column).filter(|column| column.components() == 1);
    let density = scalar("density").filter(|column| all_positive(column));
    let mass = scalar("mass").filter(|_| density.is_some());
    move |row| mass.map_or(1.0, |m| m.get(row, 0)) / density.map_or(1.0, |rho| rho.get(row, 0))
}

/// The quantity of the kept particles: the one that the view names, or [`Selection::default_of`] the frame;
/// with that of their opacity, where the view has one.
pub fn quantity(frame: &Frame, particles: &ParticleSet, view: &QuantityView) -> Result<Quantity, SceneError> {
    let selection = Selection::new(frame, view.name.as_deref())?;
    let colour = Quantity::new(particles, view.spread(), |row| selection.value(row));
    let Some(opacity) = &view.opacity else { return Ok(colour) };
    let selection = match &opacity.name {
        Some(name) => Selection::new(frame, Some(name))?,
        None => selection,
    };
    Ok(colour.with_opacity(&Quantity::new(particles, opacity.spread(), |row| selection.value(row))))
}

/// One line on the particles of a frame that are left out of its picture; `None` where all are in it.
pub fn rejected_warning(frame: &Frame, particles: &ParticleSet, quantity: &Quantity) -> Option<String> {
    let Rejected { non_finite, bad_radius } = particles.rejected();
    let lacking = match quantity.opacity_placement() {
        None => "quantity not finite",
        Some(_) => "quantity of colour or opacity not finite",
    };
    let reasons = [
        (non_finite, "position or volume not finite"),
        (bad_radius, "support radius not positive and finite"),
        (particles.weightless(), "no weight, since mass/density is not above 0"),
        (quantity.rejected(), lacking),
    ];
    let left_out: u64 = reasons.iter().map(|(count, _)| count).sum();
    let told: Vec<String> = reasons
        .iter()
        .filter(|(count, _)| *count > 0)
        .map(|(count, reason)| format!("{reason} ({count})"))
        .collect();
    (left_out > 0)
        .then(|| format!("{left_out} of {} particles are left out: {}", frame.len(), told.join(", ")))
}

/// A scalar over the particles of a frame: a field, a component of one, or the length of its vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Selection<'a> {
    field: Option<&'a Field>,
    component: Option<usize>,
}

/// What a viewer most likely wants to see first.
const PREFERRED: [&str; 5] = ["concentration", "velocity", "density", "pressure", "temperature"];
/// What says nothing when it is coloured, or is used up for something else.
const LAST: [&str; 5] = ["id", "mass", "smoothing_length", "itype", "type"];
/// The value of each particle where the frame has no field.
const CONSTANT: f64 = 0.5;

impl<'a> Selection<'a> {
    /// The field `name`, `name.x` for a component; without a name the frame's default. A frame
    /// without particles has every field.
    pub fn new(frame: &'a Frame, name: Option<&str>) -> Result<Selection<'a>, SceneError> {
        let Some(name) = name.filter(|_| !frame.is_empty()) else {
            return Ok(Selection::default_of(frame));
        };
        if let Some(field) = frame.field(name) {
            return Ok(Selection { field: Some(field), component: None });
        }
        let component = names::split_component(name)
            .and_then(|(field, component)| Some((frame.field(field)?, component)));
        match component {
            Some((field, component)) if component < field.column.components() => {
                Ok(Selection { field: Some(field), component: Some(component) })
            }
            Some((field, _)) => Err(SceneError::NoSuchComponent {
                name: name.to_owned(),
                field: field.name.clone(),
                components: field.column.components(),
            }),
            None => Err(SceneError::NoSuchField { name: name.to_owned(), fields: list(frame) }),
        }
    }

    /// Concentration, velocity, density, pressure or temperature, the first that there is; else the
    /// first field that is not a number, a mass or a length of the method; else the constant ½. By
    /// names alone, so that all frames of a run show the same.
    pub fn default_of(frame: &'a Frame) -> Selection<'a> {
        let preferred = PREFERRED.iter().find_map(|name| frame.field(name));
        let telling = |field: &&Field| !LAST.contains(&names::canonical(&field.name).as_str());
        let field = preferred.or_else(|| frame.fields().iter().find(telling));
        Selection { field, component: None }
    }

    /// The value of one particle, not necessarily finite.
    pub fn value(&self, row: usize) -> f64 {
        match (self.field, self.component) {
            (Some(field), Some(component)) => field.column.get(row, component),
            (Some(field), None) => field.column.magnitude(row),
            (None, _) => CONSTANT,
        }
    }

    /// The name that selects this again, in this frame and others: `velocity`, `velocity.x`; `None`
    /// for the constant.
    pub fn name(&self) -> Option<String> {
        let name = names::canonical(&self.field?.name);
        Some(self.component.map_or(name.clone(), |c| format!("{name}.{}", component_name(c))))
    }
}

/// Names that select something in `frame`, for a menu: each field, and the components of vectors.
pub fn quantity_names(frame: &Frame) -> Vec<String> {
    frame.fields().iter().flat_map(|field| names_in(frame, field)).collect()
}

fn names_in(frame: &Frame, field: &Field) -> Vec<String> {
    let canonical = names::canonical(&field.name);
    // Of two fields with one canonical name, one answers to its own name only.
    let answers = frame.field(&canonical).is_some_and(|found| std::ptr::eq(found, field));
    let name = if answers { canonical } else { field.name.trim().to_owned() };
    let components = if field.column.components() > 1 { field.column.components() } else { 0 };
    let component = |c: usize| format!("{name}.{}", component_name(c));
    std::iter::once(name.clone()).chain((0..components).map(component)).collect()
}

fn component_name(component: usize) -> String {
    ["x", "y", "z"].get(component).map_or_else(|| component.to_string(), |&name| name.to_owned())
}

fn list(frame: &Frame) -> String {
    let names: Vec<&str> = frame.fields().iter().map(|field| field.name.as_str()).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

fn all_positive(column: &Column) -> bool {
    (0..column.len()).all(|row| {
        let value = column.get(row, 0);
        value.is_finite() && value > 0.0
    })
}

#[cfg(test)]
#[path = "scene_tests.rs"]
mod tests;
