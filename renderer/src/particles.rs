//! The host's particle set: validated, recentred and rescaled in f64 before it becomes f32.

mod verdicts;

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use crate::placement::{Placement, Scale, Spread};

pub use verdicts::Extent;
use verdicts::judge;

/// One particle as a file gives it. Lengths in the unit of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RawParticle {
    pub position: [f64; 3],
    /// Radius at which the kernel reaches zero.
    pub support_radius: f64,
    /// V_j = m_j/ρ_j, in any unit: only ratios between particles matter. One that is not above 0 gives the
    /// particle no weight, and it is left out.
    pub volume: f64,
}

/// How many particles were left out, and why (contract, section 5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Rejected {
    /// Position, volume or quantity is not finite.
    pub non_finite: u64,
    /// Support radius is not positive and finite.
    pub bad_radius: u64,
}

impl Rejected {
    pub fn total(self) -> u64 {
        self.non_finite + self.bad_radius
    }
}

/// Axis-aligned box around particle centres, in the unit of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub min: DVec3,
    pub max: DVec3,
}

impl Bounds {
    pub fn centre(&self) -> DVec3 {
        // Halves first: the sum of two huge coordinates may overflow.
        self.min * 0.5 + self.max * 0.5
    }

    pub fn diagonal(&self) -> f64 {
        let size = self.max - self.min;
        size.x.hypot(size.y).hypot(size.z)
    }

    pub fn union(&self, other: &Bounds) -> Bounds {
        Bounds { min: self.min.min(other.min), max: self.max.max(other.max) }
    }
}

/// What the grid needs of a particle set, ready for upload.
///
/// A position is (hi + lo)·unit + origin with two f32 each, so that neither the unit of the run nor
/// its place in the world costs precision, nor does a close look at one end of a huge domain.
pub struct ParticleSet {
    id: u64,
    origin: DVec3,
    unit: f64,
    bounds: Option<Bounds>,
    radii: [f64; 2],
    whole: Extent,
    rejected: Rejected,
    weightless: u64,
    /// Rows in the source, and those of them that make no particle, in ascending order.
    rows: usize,
    bad: Vec<u32>,
    /// Row in the source of each kept particle; `None` where every row was kept.
    source: Option<Vec<u32>>,
    pub(crate) high: Vec<[f32; 4]>,
    pub(crate) low: Vec<[f32; 4]>,
}

/// Cube roots of weights V_j/h_j³ are kept within this distance of 1.
const ROOT_LIMIT: f64 = 1e10;

impl ParticleSet {
    /// The most particles that one set may hold.
    pub const MAX_PARTICLES: usize = u32::MAX as usize / 2;

    /// Takes `count` particles from `particle(row)`, which is called from several threads.
    /// Rows beyond [`ParticleSet::MAX_PARTICLES`] are the caller's error.
    pub fn new(count: usize, particle: impl Fn(usize) -> RawParticle + Sync) -> ParticleSet {
        ParticleSet::selected(count, particle, |_| true)
    }

    /// The same, of which only those rows are kept that `selects` names. The others are not rejected.
    pub fn selected(
        count: usize,
        particle: impl Fn(usize) -> RawParticle + Sync,
        selects: impl Fn(usize) -> bool + Sync,
    ) -> ParticleSet {
        assert!(count <= Self::MAX_PARTICLES, "{count} particles are more than a set can hold");
        let verdicts = judge(count, &particle, &selects);
        let source = (verdicts.rows.len() < count).then_some(verdicts.rows);
        let kept = source.as_ref().map_or(count, Vec::len);
        let row = |index: usize| source.as_ref().map_or(index, |rows| rows[index] as usize);

        let Extent { bounds, support_radii: radii, .. } = verdicts.selected;
        let origin = bounds.map_or(DVec3::ZERO, |bounds| bounds.centre());
        // A length of the run itself, so that the same run in another unit is the same to the device: f64
        // rounds its positions far below their f32 parts.
        let unit = if kept == 0 { 1.0 } else { radii[0].sqrt() * radii[1].sqrt() };
        let middle_weight = geometric_mean(verdicts.weights);

        let (high, low) = (0..kept)
            .into_par_iter()
            .map(|index| {
                let raw = particle(row(index));
                let position = (DVec3::from_array(raw.position) - origin) / unit;
                let high = position.as_vec3();
                let low = (position - high.as_dvec3()).as_vec3();
                let radius = (raw.support_radius / unit) as f32;
                // The root: the projection scales it by h/h' before it takes the cube, which might
                // leave the range of f32 on the way.
                let root = ((weight_of(&raw) - middle_weight) / 3.0).exp();
                let root = root.clamp(1.0 / ROOT_LIMIT, ROOT_LIMIT) as f32;
                ([high.x, high.y, high.z, radius], [low.x, low.y, low.z, root])
            })
            .unzip();
        ParticleSet {
            id: next_id(),
            origin,
            unit,
            bounds,
            radii,
            whole: verdicts.whole,
            rejected: verdicts.rejected,
            weightless: verdicts.weightless,
            rows: count,
            bad: verdicts.bad,
            source,
            high,
            low,
        }
    }

    /// Number of particles kept.
    pub fn len(&self) -> usize {
        self.high.len()
    }

    pub fn is_empty(&self) -> bool {
        self.high.is_empty()
    }

    /// What the particles take up together with those that were not selected.
    pub fn whole(&self) -> Extent {
        self.whole
    }

    /// Particles left out for their position, volume or radius.
    pub fn rejected(&self) -> Rejected {
        self.rejected
    }

    /// Particles left out because their volume is not above 0: they are no part of any sum.
    pub fn weightless(&self) -> u64 {
        self.weightless
    }

    /// Box around the centres of the kept particles; `None` without particles.
    pub fn bounds(&self) -> Option<Bounds> {
        self.bounds
    }

    /// Smallest and largest support radius, in the unit of the run; zeros without particles.
    pub fn support_radii(&self) -> [f64; 2] {
        self.radii
    }

    /// Row in the source of the kept particle `index`.
    pub fn source_row(&self, index: usize) -> usize {
        self.source.as_ref().map_or(index, |rows| rows[index] as usize)
    }

    /// Whether a row in the source makes no particle.
    fn is_bad(&self, row: usize) -> bool {
        self.bad.binary_search(&(row as u32)).is_ok()
    }

    /// Position of the kept particle `index`, in the unit of the run.
    pub fn position(&self, index: usize) -> DVec3 {
        let [x, y, z, _] = self.high[index].map(f64::from);
        let [dx, dy, dz, _] = self.low[index].map(f64::from);
        self.origin + DVec3::new(x + dx, y + dy, z + dz) * self.unit
    }

    /// Support radius of the kept particle `index`, in the unit of the run.
    pub fn support_radius(&self, index: usize) -> f64 {
        f64::from(self.high[index][3]) * self.unit
    }

    /// Cube root of the weight V/h³ of the kept particle `index`, in a unit that all of them share.
    pub(crate) fn weight_root(&self, index: usize) -> f64 {
        f64::from(self.low[index][3])
    }

    /// Nearest and farthest depth along `forward` (a unit vector) from `eye` that the support of a
    /// kept particle reaches; nearest is below zero where the eye is inside one. `None` where
    /// nothing lies in front.
    pub(crate) fn depth_extremes(
        &self,
        eye: DVec3,
        forward: DVec3,
        skip: impl Fn(usize) -> bool + Sync,
    ) -> Option<[f64; 2]> {
        let eye = self.to_device(eye);
        let [near, far] = self
            .balls()
            .enumerate()
            .filter(|(index, _)| !skip(*index))
            .map(|(_, (position, radius))| {
                let depth = (position - eye).dot(forward);
                [depth - radius, depth + radius]
            })
            .filter(|[_, farthest]| *farthest > 0.0)
            .reduce(|| EMPTY, join);
        (near <= far).then_some([near * self.unit, far * self.unit])
    }

    /// Position, in device units, and support radius of every kept particle.
    pub(crate) fn balls(&self) -> impl IndexedParallelIterator<Item = (DVec3, f64)> + '_ {
        self.high.par_iter().zip(&self.low).map(|(high, low)| {
            let [x, y, z, radius] = high.map(f64::from);
            let [dx, dy, dz, _] = low.map(f64::from);
            (DVec3::new(x + dx, y + dy, z + dz), radius)
        })
    }

    /// Length of the device's unit in the unit of the run.
    pub(crate) fn unit(&self) -> f64 {
        self.unit
    }

    /// A point of the world in the device's frame.
    pub(crate) fn to_device(&self, point: DVec3) -> DVec3 {
        (point - self.origin) / self.unit
    }

    /// Distinguishes this set from every other one of the process.
    pub(crate) fn id(&self) -> u64 {
        self.id
    }
}

/// The quantity of each kept particle, normalised so that the view's range becomes [0, 1]; or two, one
/// for the colour and one for the opacity.
pub struct Quantity {
    pub(crate) id: u64,
    pub(crate) placement: Placement,
    pub(crate) opacity_placement: Option<Placement>,
    pub(crate) rejected: u64,
    /// One number a particle, or two where there is a placement of the opacity.
    pub(crate) values: Vec<f32>,
}

impl Quantity {
    /// Stands for a quantity that is not finite: the shaders leave such a particle out.
    pub(crate) const REJECTED: f32 = 3.0e38;
    /// Normalised values are kept within this distance of zero, so that sums stay finite.
    const LIMIT: f64 = 1e15;

    /// Takes the quantity of each source row of `particles` from `value(row)`. The range of `spread` is
    /// u = 0 and u = 1; the finite minimum and maximum over the whole frame, selected or not, where it is
    /// `None`, on a logarithmic scale those of what is positive, its upper 30 decades at most. A range of no width is a threshold: its
    /// own value is u = ½, interpolated values below it are 0 and those above it 1.
    pub fn new(
        particles: &ParticleSet,
        spread: impl Into<Spread>,
        value: impl Fn(usize) -> f64 + Sync,
    ) -> Quantity {
        let spread = spread.into();
        let whole = |row: usize| if particles.is_bad(row) { f64::NAN } else { value(row) };
        let range = spread.range.unwrap_or_else(|| finite_range(particles.rows, spread.scale, whole));
        let value = |index: usize| value(particles.source_row(index));
        let placement = Placement::new(range, spread.scale, spread.outside);
        let [low, high] = range;
        // Halves first: high − low of two huge values of opposite sign may overflow.
        let half_width = high * 0.5 - low * 0.5;
        // A threshold is a range so narrow that nothing but the value itself falls inside it.
        let farthest = || {
            let [least, most] = finite_range(particles.len(), Scale::Linear, value);
            (most * 0.5 - low * 0.5).abs().max((least * 0.5 - low * 0.5).abs())
        };
        let (scale, offset, origin) = match (placement.scale(), half_width > 0.0) {
            // As many digits for the smallest values as for the largest.
            (Scale::Log, _) => (high * 0.5, 0.0, 0.0),
            (Scale::Linear, true) => (half_width, 0.0, low),
            (Scale::Linear, false) => ((farthest() / Self::LIMIT).max(f64::MIN_POSITIVE), 0.5, low),
        };
        let normalise = |q: f64| placement.margined((q * 0.5 - origin * 0.5) / scale + offset);
        let values: Vec<f32> = (0..particles.len())
            .into_par_iter()
            .map(|index| match value(index) {
                q if q.is_finite() => normalise(q).clamp(-Self::LIMIT, Self::LIMIT) as f32,
                _ => Self::REJECTED,
            })
            .collect();
        let rejected = values.par_iter().filter(|&&u| u == Self::REJECTED).count() as u64;
        Quantity { id: next_id(), placement, opacity_placement: None, rejected, values }
    }

    /// The values that u = 0 and u = 1 stand for.
    pub fn range(&self) -> [f64; 2] {
        self.placement.range()
    }

    /// Where values lie on the device's axis.
    pub fn placement(&self) -> &Placement {
        &self.placement
    }

    /// Particles left out because their quantity, or one of the two, is not finite.
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    pub(crate) fn is_rejected(&self, index: usize) -> bool {
        self.values[index * self.fields().count() as usize] == Self::REJECTED
    }

    pub(crate) fn id(&self) -> u64 {
        self.id
    }
}

pub(crate) fn next_id() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Finite minimum and maximum, on a logarithmic scale the upper 30 decades of what is positive; [0, 1] or
/// [1, 10] of nothing.
fn finite_range(count: usize, scale: Scale, value: impl Fn(usize) -> f64 + Sync + Send) -> [f64; 2] {
    let counts = |q: &f64| q.is_finite() && (scale == Scale::Linear || *q > 0.0);
    let [low, high] = (0..count)
        .into_par_iter()
        .map(value)
        .filter(counts)
        .fold(|| EMPTY, |[low, high], q| [low.min(q), high.max(q)])
        .reduce(|| EMPTY, join);
    match scale {
        _ if low <= high => scale.fitted([low, high]),
        Scale::Linear => [0.0, 1.0],
        Scale::Log => [1.0, 10.0],
    }
}

/// The range of nothing.
const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn join(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

/// ln(V/h³) of a volume above 0: logarithms, since h³ of a run in metres of the cosmos overflows.
fn weight_of(raw: &RawParticle) -> f64 {
    raw.volume.ln() - 3.0 * raw.support_radius.ln()
}

/// The middle of two logarithms.
fn geometric_mean([low, high]: [f64; 2]) -> f64 {
    if low <= high { 0.5 * (low + high) } else { 0.0 }
}
