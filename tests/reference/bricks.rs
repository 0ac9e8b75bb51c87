//! Bricks of 2 × 2 rays × 4 slabs, by the contract's formulas alone: what the bounds of the analysis are
//! to hold.
//!
//! A bundle of 8 × 8 pixels has 16 columns of 2 × 2, numbered along a Morton curve; a cell of 16 slabs
//! has 4 bricks in each, from front to back.

use crate::composite::Ray;
use crate::floor;
use crate::grid::BUNDLE_SIDE;
use crate::neighbours::Neighbours;
use crate::particle::Particle;
use crate::picture::{self, Values};
use crate::scenes::Scene;
use crate::setup::Setup;
use crate::slices::CELL_SLABS;
use renderer::BrickWidth;

/// Slabs of a brick.
pub const BRICK_SLABS: u32 = 4;
/// Rays of a column, from the upper left one.
pub const RAYS: [[u32; 2]; 4] = [[0, 0], [1, 0], [0, 1], [1, 1]];

/// A brick of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Column and row of the bundle.
    pub bundle: [u32; 2],
    pub layer: u32,
    pub column: u32,
    /// From front to back.
    pub brick: u32,
}

impl Place {
    /// The pixel of the column's upper left ray.
    pub fn corner(&self) -> [u32; 2] {
        let Place { bundle, column, .. } = *self;
        let inside = [(column & 1) | (column >> 1 & 2), (column >> 1 & 1) | (column >> 2 & 2)];
        [0, 1].map(|axis| BUNDLE_SIDE * bundle[axis] + 2 * inside[axis])
    }

    /// Number of its first slab.
    pub fn first_slab(&self) -> u32 {
        CELL_SLABS * self.layer + BRICK_SLABS * self.brick
    }
}

/// The run of a scene, as seen from its camera.
pub struct Bricks {
    pub setup: Setup,
    particles: Vec<Particle>,
    neighbours: Neighbours,
}

impl Bricks {
    pub fn new(scene: &Scene) -> Bricks {
        let setup = Setup::new(&scene.view);
        let sound = scene.particles.iter().filter(|particle| particle.is_sound());
        let particles: Vec<Particle> = sound.map(|particle| floor::raise(particle, &setup)).collect();
        let neighbours = Neighbours::new(&particles);
        Bricks { setup, particles, neighbours }
    }

    /// u of the colour and of the opacity, at a point of the image, in pixels from its corner, and a real number
    /// of slices deep; `None` where no particle reaches.
    pub fn values(&self, [column, row]: [f64; 2], slice: f64) -> Option<Values> {
        let camera = &self.setup.camera;
        let [nx, ny] = camera.slopes(column, row);
        let direction = camera.forward + nx * camera.right + ny * camera.up;
        let point = camera.eye + self.setup.slices.depth(slice) * direction;
        picture::values(&self.setup, point, || {
            self.neighbours.around(point).map(|index| &self.particles[index])
        })
    }

    /// The rays of a column that belong to the picture, by their numbers.
    pub fn rays(&self, place: &Place) -> Vec<usize> {
        let ([x, y], camera) = (place.corner(), &self.setup.camera);
        let inside = |[right, down]: [u32; 2]| x + right < camera.width && y + down < camera.height;
        (0..RAYS.len()).filter(|ray| inside(RAYS[*ray])).collect()
    }

    /// Both at a ray's full samples in a brick, `shift` slices behind where they are.
    pub fn samples(&self, place: &Place, ray: usize, shift: f64) -> [Option<Values>; 4] {
        let ([x, y], [right, down]) = (place.corner(), RAYS[ray]);
        let pixel = [x + right, y + down].map(|pixel| f64::from(pixel) + 0.5);
        let slab = |k: usize| f64::from(place.first_slab()) + k as f64 + 0.5;
        std::array::from_fn(|k| self.values(pixel, slab(k) + shift))
    }

    /// Where a ray's full samples lie in a brick so wide: to the right, up and back, from −1 to 1.
    pub fn places(&self, place: &Place, ray: usize, width: BrickWidth) -> [[f64; 3]; 4] {
        let depth = |k: f64| self.setup.slices.depth(f64::from(place.first_slab()) + k + 0.5);
        let ([x, y], [right, down]) = (place.corner(), RAYS[ray]);
        let last_ray = f64::from(width.rays() - 1);
        let [right, down] =
            [x + right, y + down].map(|pixel| 2.0 * f64::from(pixel % width.rays()) / last_ray - 1.0);
        std::array::from_fn(|k| {
            let (depth, first, last) = (depth(k as f64), depth(0.0), depth(3.0));
            let aside = depth / last;
            [right * aside, -down * aside, (2.0 * depth - first - last) / (last - first)]
        })
    }

    /// Premultiplied colour and opacity of one ray's samples in a brick.
    pub fn response(&self, place: &Place, ray: usize, samples: &[Option<Values>; 4]) -> [f64; 4] {
        let mut passed = Ray::default();
        for (slab, values) in (place.first_slab()..).zip(samples) {
            if let Some(values) = *values {
                passed.add(picture::shade(&self.setup, values), self.path(place, ray, slab));
            }
        }
        passed.pixel()
    }

    /// Length of a ray in a slab, in reference lengths.
    fn path(&self, place: &Place, ray: usize, slab: u32) -> f64 {
        let ([x, y], [right, down]) = (place.corner(), RAYS[ray]);
        let s = |i: u32| self.setup.slices.depth(f64::from(i));
        let along = self.setup.camera.ray(x + right, y + down).length();
        (s(slab + 1) - s(slab)) * along / self.setup.reference_length
    }
}

/// Light from behind: `light` in all three colours, and opaque by as much.
pub fn lit([r, g, b, alpha]: [f64; 4], light: f64) -> [f64; 4] {
    [r, g, b, alpha].map(|channel| channel + (1.0 - alpha) * light)
}

/// The largest difference of any channel.
pub fn difference(a: [f64; 4], b: [f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture;
    use crate::scenes;

    #[test]
    fn columns_follow_a_morton_curve() {
        let corner = |column| Place { bundle: [1, 2], layer: 0, column, brick: 0 }.corner();
        assert_eq!(corner(0), [8, 16]);
        assert_eq!([1, 2, 3, 4].map(corner), [[10, 16], [8, 18], [10, 18], [12, 16]]);
        assert_eq!(corner(15), [14, 22]);
    }

    #[test]
    fn all_bricks_of_a_ray_make_its_pixel() {
        let scene = scenes::plain(70, 10, 9);
        let bricks = Bricks::new(&scene);
        let picture = picture::render_with_floor(&bricks.setup, &scene.particles);
        // Ray 2 of column 3 of the first bundle: pixel (2, 3).
        let mut pixel = [0.0; 4];
        for (layer, brick) in (0..bricks.setup.slices.layers()).flat_map(|l| (0..4).map(move |b| (l, b))) {
            let place = Place { bundle: [0, 0], layer, column: 3, brick };
            let response = bricks.response(&place, 2, &bricks.samples(&place, 2, 0.0));
            let open = 1.0 - pixel[3];
            pixel = std::array::from_fn(|channel| pixel[channel] + open * response[channel]);
        }
        assert!(difference(pixel, picture.pixels[3 * 10 + 2]) < 1e-12, "{pixel:?}");
        assert!(pixel[3] > 0.1);
    }

    #[test]
    fn light_from_behind_shines_through() {
        assert_eq!(lit([0.125, 0.25, 0.0, 0.5], 0.0), [0.125, 0.25, 0.0, 0.5]);
        assert_eq!(lit([0.125, 0.25, 0.0, 0.5], 1.0), [0.625, 0.75, 0.5, 1.0]);
    }
}
