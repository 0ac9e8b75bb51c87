//! The view-aligned grid (Sec. 6.1 of the HPG 2016 paper): which cells a particle reaches.
//!
//! A cell holds the samples of a bundle of 8 × 8 pixels in a layer of 16 slabs. Two sets enclose
//! what a right grid may hold: [`must`] ⊆ grid ⊆ [`may`].

use std::collections::BTreeSet;

use glam::DVec3;

use crate::camera::Camera;
use crate::neighbours::Neighbours;
use crate::particle::Particle;
use crate::setup::Setup;
use crate::slices::CELL_SLABS;

/// D_xy: side of a bundle in pixels.
pub const BUNDLE_SIDE: u32 = 8;

/// (bundle x, bundle y, layer, particle): a reference of a cell to a particle. Bundle (0, 0) is at
/// the upper left, layer 0 in front; particles count in the order of their slice.
pub type Reference = (u32, u32, u32, u32);

/// References without which the picture is wrong: some level-0 sample of the cell has w_j > 0.
/// By brute force over every sample of every pixel.
pub fn must(setup: &Setup, particles: &[Particle]) -> BTreeSet<Reference> {
    let neighbours = Neighbours::new(particles);
    let camera = &setup.camera;
    let mut references = BTreeSet::new();
    for y in 0..camera.height {
        for x in 0..camera.width {
            let d = camera.ray(x, y);
            for i in 0..setup.slices.count {
                let point = camera.eye + setup.slices.depth(f64::from(i) + 0.5) * d;
                for index in neighbours.around(point) {
                    let Particle { position, support_radius, .. } = particles[index];
                    if (point - position).length() < support_radius {
                        references.insert((x / BUNDLE_SIDE, y / BUNDLE_SIDE, i / CELL_SLABS, index as u32));
                    }
                }
            }
        }
    }
    references
}

/// References that a grid of tight geometric tests may hold: the distance from the particle to the
/// cell's samples' convex hull is at most h·(1 + `slack`), where `slack` leaves room for rounding.
/// Bundles at the right and lower edge count with all their 8 × 8 rays.
pub fn may(setup: &Setup, particles: &[Particle], slack: f64) -> BTreeSet<Reference> {
    let camera = &setup.camera;
    let bundles = [camera.width, camera.height].map(|pixels| pixels.div_ceil(BUNDLE_SIDE));
    let mut references = BTreeSet::new();
    for (index, particle) in particles.iter().enumerate() {
        let point = camera.to_view(particle.position);
        let reach = particle.support_radius * (1.0 + slack);
        for layer in 0..setup.slices.layers() {
            let depths = layer_depths(setup, layer);
            if point.z + reach < depths[0] || point.z - reach > depths[1] {
                continue;
            }
            for bundle_y in 0..bundles[1] {
                for bundle_x in 0..bundles[0] {
                    if Hull::new(camera, [bundle_x, bundle_y], depths).distance(point) <= reach {
                        references.insert((bundle_x, bundle_y, layer, index as u32));
                    }
                }
            }
        }
    }
    references
}

/// View depths of the first and the last level-0 sample of a layer.
fn layer_depths(setup: &Setup, layer: u32) -> [f64; 2] {
    let first = f64::from(layer * CELL_SLABS) + 0.5;
    [setup.slices.depth(first), setup.slices.depth(first + f64::from(CELL_SLABS - 1))]
}

/// Convex hull of a cell's samples in view space: the pyramid of the bundle's outermost rays between
/// two depths.
#[derive(Clone, Copy, Debug)]
pub struct Hull {
    /// Slopes nx of the leftmost and rightmost ray.
    across: [f64; 2],
    /// Slopes ny of the lowest and highest ray.
    upward: [f64; 2],
    depths: [f64; 2],
}

impl Hull {
    fn new(camera: &Camera, [x, y]: [u32; 2], depths: [f64; 2]) -> Hull {
        let first = [x, y].map(|bundle| f64::from(bundle * BUNDLE_SIDE) + 0.5);
        let last = first.map(|centre| centre + f64::from(BUNDLE_SIDE - 1));
        let [left, top] = camera.slopes(first[0], first[1]);
        let [right, bottom] = camera.slopes(last[0], last[1]);
        Hull { across: [left, right], upward: [bottom, top], depths }
    }

    /// Distance from `point` (right, up, depth) to the hull; 0 inside.
    ///
    /// The squared distance to the hull's cross-section at depth z, (z − p_z)² + gap_x(z)² +
    /// gap_y(z)², is convex in z, so that bisection of its slope finds the nearest cross-section.
    pub fn distance(&self, point: DVec3) -> f64 {
        let [mut front, mut back] = self.depths;
        while front < back {
            let z = 0.5 * (front + back);
            if z <= front || z >= back {
                break;
            }
            let (x, slope_x) = gap(point.x, self.across, z);
            let (y, slope_y) = gap(point.y, self.upward, z);
            match (z - point.z) + x * slope_x + y * slope_y > 0.0 {
                true => back = z,
                false => front = z,
            }
        }
        // Where the slope keeps its sign the nearest cross-section is an end, which bisection only nears.
        let at = |z: f64| {
            let (x, y) = (gap(point.x, self.across, z).0, gap(point.y, self.upward, z).0);
            (z - point.z).hypot(x).hypot(y)
        };
        at(front).min(at(back))
    }
}

/// Distance from `p` to the interval [low·z, high·z], and its derivative by z.
fn gap(p: f64, [low, high]: [f64; 2], z: f64) -> (f64, f64) {
    if p < low * z {
        (low * z - p, low)
    } else if p > high * z {
        (p - high * z, -high)
    } else {
        (0.0, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// From (−1, 0) to (2, 1) times depth, between depths 2 and 4.
    const HULL: Hull = Hull { across: [-1.0, 2.0], upward: [0.0, 1.0], depths: [2.0, 4.0] };

    #[test]
    fn distances_by_hand() {
        let half = 0.5_f64.sqrt();
        for (point, expected) in [
            (DVec3::new(0.0, 1.0, 3.0), 0.0),
            (DVec3::new(0.0, 1.0, 5.5), 1.5),
            (DVec3::new(0.0, 1.0, -1.0), 3.0),
            // Below the plane y = 0.
            (DVec3::new(0.0, -2.0, 3.0), 2.0),
            // Beyond the slanted side x = −z, whose foot lies inside the depths.
            (DVec3::new(-4.0, 1.0, 2.0), 2.0 * half),
            // In front of the corner edge x = −2, z = 2.
            (DVec3::new(-5.0, 1.0, -2.0), 5.0),
            // Nearest to the corner (8, 4, 4).
            (DVec3::new(9.0, 6.0, 6.0), 3.0),
        ] {
            let distance = HULL.distance(point);
            assert!((distance - expected).abs() < 1e-9, "{point}: {distance}, expected {expected}");
        }
    }

    #[test]
    fn no_point_of_the_hull_is_nearer_than_its_distance() {
        // A lattice over the hull, edges included, with steps of 0.15 at most.
        let share = |i: u32, steps: u32| f64::from(i) / f64::from(steps);
        let mut inside = Vec::new();
        for (z, y) in (0..=40).flat_map(|z| (0..=30).map(move |y| (z, y))) {
            let z = 2.0 + 2.0 * share(z, 40);
            inside.extend((0..=80).map(|x| DVec3::new(z * (3.0 * share(x, 80) - 1.0), z * share(y, 30), z)));
        }
        let mut random = Random::new(5);
        for _ in 0..100 {
            let point = 8.0 * random.in_cube();
            let distance = HULL.distance(point);
            let nearest = inside.iter().map(|p| p.distance(point)).fold(f64::INFINITY, f64::min);
            assert!(
                distance <= nearest + 1e-9 && nearest < distance + 0.12,
                "{point}: {distance}, {nearest}"
            );
        }
    }
}
