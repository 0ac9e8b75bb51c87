//! The scene: the app's `demo:radial:N`, or one as like it as the sorts can tell.

use std::sync::Arc;

use renderer::{ParticleSet, Quantity, RawParticle, Scene, View};

/// Largest move of a particle from its lattice point, and its support radius, in spacings.
const JITTER: f64 = 0.15;
const REACH: f64 = 2.0;

/// About `count` particles in a jittered lattice over [−1, 1]³, all of it in view. They are stored
/// along a Morton curve, as solvers store them that sort for their neighbour search.
pub fn scene(count: u64, [width, height]: [u32; 2]) -> Scene {
    let side = (count as f64).cbrt().round().max(1.0) as u64;
    let spacing = 2.0 / side as f64;
    let mut points: Vec<[u64; 3]> =
        (0..side.pow(3)).map(|i| [i % side, i / side % side, i / (side * side)]).collect();
    points.sort_by_cached_key(|&point| morton(point));
    let particles = ParticleSet::new(points.len(), |row| RawParticle {
        position: std::array::from_fn(|axis| {
            let move_by = JITTER * (2.0 * uniform(3 * row as u64 + axis as u64) - 1.0);
            -1.0 + (points[row][axis] as f64 + 0.5 + move_by) * spacing
        }),
        support_radius: REACH * spacing,
        volume: spacing.powi(3),
    });
    let quantity = Quantity::new(&particles, Some([0.0, 1.0]), |_| 0.5);
    let mut view = View::default();
    (view.image.width, view.image.height) = (width, height);
    Scene::new(Arc::new(particles), Arc::new(quantity), &view).expect("the view is valid")
}

/// Interleaves the low 16 bits of three numbers.
fn morton(point: [u64; 3]) -> u64 {
    let spread = |p: u64| (0..16).fold(0, |code, bit| code | (p >> bit & 1) << (3 * bit));
    spread(point[0]) | spread(point[1]) << 1 | spread(point[2]) << 2
}

/// A number in [0, 1) for each index: splitmix64 (Steele, Lea and Flood 2014) as a hash.
fn uniform(index: u64) -> f64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 * (0.5_f64).powi(53)
}
