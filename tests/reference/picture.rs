//! The full picture by brute force: every sample of every ray.

use glam::DVec3;
use rayon::prelude::*;

use crate::composite::Ray;
use crate::depth::Sample;
use crate::floor;
use crate::neighbours::Neighbours;
use crate::particle::Particle;
use crate::quantity;
use crate::setup::Setup;
use crate::slices::CELL_SLABS;

/// Premultiplied linear RGBA, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image<T> {
    pub width: u32,
    pub height: u32,
    /// width·height pixels, row after row.
    pub pixels: Vec<[T; 4]>,
}

impl From<&renderer::Picture> for Image<f32> {
    fn from(picture: &renderer::Picture) -> Image<f32> {
        Image { width: picture.width, height: picture.height, pixels: picture.pixels.clone() }
    }
}

/// The picture of `particles` with the radii that they have.
pub fn render(setup: &Setup, particles: &[Particle]) -> Image<f64> {
    render_at_levels(setup, particles, &|_| 0)
}

/// The same, where the samples of layer k are of the level that `level_of` gives it.
pub fn render_at_levels(setup: &Setup, particles: &[Particle], level_of: &LevelOf) -> Image<f64> {
    let particles: Vec<Particle> = particles.iter().copied().filter(Particle::is_sound).collect();
    let neighbours = Neighbours::new(&particles);
    let (width, height) = (setup.camera.width, setup.camera.height);
    let pixels = (0..width * height)
        .into_par_iter()
        .map(|index| {
            let pixel = [index % width, index / width];
            trace(setup, &particles, &neighbours, pixel, level_of, &mut |_| {})
        })
        .collect();
    Image { width, height, pixels }
}

/// From a layer of cells to the level of its samples, each of which stands for 2^level slabs.
pub type LevelOf<'a> = dyn Fn(u32) -> u32 + Sync + 'a;

/// The picture of `particles` with radii raised to the sub-pixel floor, which the renderer is to match.
pub fn render_with_floor(setup: &Setup, particles: &[Particle]) -> Image<f64> {
    render(setup, &raised(setup, particles))
}

/// Particles with radii raised to the sub-pixel floor.
pub fn raised(setup: &Setup, particles: &[Particle]) -> Vec<Particle> {
    particles.iter().filter(|p| p.is_sound()).map(|p| floor::raise(p, setup)).collect()
}

/// Pixel (x, y). `see` is shown the samples that are not empty, from front to back.
pub(crate) fn trace(
    setup: &Setup,
    particles: &[Particle],
    neighbours: &Neighbours,
    [x, y]: [u32; 2],
    level_of: &LevelOf,
    see: &mut dyn FnMut(Sample),
) -> [f64; 4] {
    let d = setup.camera.ray(x, y);
    let mut ray = Ray::default();
    let mut i = 0;
    while i < setup.slices.count && !ray.is_opaque() {
        let slabs = 1 << level_of(i / CELL_SLABS);
        let s = |share: f64| setup.slices.depth(f64::from(i) + share * f64::from(slabs));
        let depth = s(setup.place_in_slab);
        let point = setup.camera.eye + depth * d;
        let around = || neighbours.around(point).map(|index| &particles[index]);
        if let Some(values) = values(setup, point, around) {
            let path = (s(1.0) - s(0.0)) * d.length();
            let weight = ray.add(shade(setup, values), path / setup.reference_length);
            see(Sample { slab: i, depth, weight });
        }
        i += slabs;
    }
    ray.pixel()
}

/// u of the colour and u of the opacity, which are one where one field decides both.
pub type Values = [f64; 2];

/// Both at a point with particles `around` it; `None` where no particle reaches.
pub fn values<'a, Around: Iterator<Item = &'a Particle>>(
    setup: &Setup,
    point: DVec3,
    around: impl Fn() -> Around,
) -> Option<Values> {
    let u = setup.range.normalise(quantity::at(point, around(), setup.kernel)?);
    let Some(range) = setup.opacity_range else { return Some([u, u]) };
    let opacity = quantity::field_at(point, around(), setup.kernel, |particle| particle.opacity)?;
    Some([u, range.normalise(opacity)])
}

/// Colour and opacity of a sample.
pub fn shade(setup: &Setup, [colour, opacity]: Values) -> [f64; 4] {
    let [r, g, b, _] = setup.transfer.at(colour);
    [r, g, b, setup.transfer.at(opacity)[3]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::Kernel;
    use crate::scenes::{grey, plain_view};
    use renderer::View;

    /// Looks along −z from the origin, from depth 1 to 3.
    fn view(width: u32, height: u32) -> View {
        let mut view = plain_view(width, height);
        let camera = view.camera.as_mut().unwrap();
        (camera.eye, camera.target, camera.fov_y_degrees) = (DVec3::ZERO, DVec3::NEG_Z, 60.0);
        (camera.near, camera.far) = (Some(1.0), Some(3.0));
        view.transfer.reference_length = Some(0.5);
        view
    }

    fn particle(z: f64, support_radius: f64, quantity: f64) -> Particle {
        Particle { position: DVec3::new(0.0, 0.0, z), support_radius, volume: 1.0, quantity, opacity: 0.0 }
    }

    #[test]
    fn a_constant_quantity_obeys_beer_and_lambert() {
        let mut view = view(9, 7);
        view.transfer.points = vec![grey(0.0, 0.0, 0.0), grey(1.0, 0.5, 0.75)];
        let everywhere = [particle(-2.0, 50.0, 0.6), particle(-1.0, 30.0, 0.6)];
        for kernel in Kernel::ALL {
            let setup = Setup { kernel, ..Setup::new(&view) };
            let image = render(&setup, &everywhere);
            for (index, pixel) in image.pixels.iter().enumerate() {
                let d = setup.camera.ray(index as u32 % 9, index as u32 / 9);
                let alpha = 1.0 - (1.0 - 0.45_f64).powf((3.0 - 1.0) * d.length() / 0.5);
                let expected = [0.3 * alpha, 0.3 * alpha, 0.3 * alpha, alpha];
                let error = pixel.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                assert!(error < 1e-12, "{kernel:?}, pixel {index}: {pixel:?}, expected {expected:?}");
            }
        }
    }

    #[test]
    fn a_lone_particle_dims_by_its_chord() {
        let mut view = view(5, 5);
        view.sampling.rate = 64.0;
        view.transfer.points = vec![grey(0.0, 1.0, 0.25)];
        let setup = Setup::new(&view);
        let image = render(&setup, &[particle(-2.0, 0.7, 0.0)]);
        for (index, pixel) in image.pixels.iter().enumerate() {
            let d = setup.camera.ray(index as u32 % 5, index as u32 / 5).normalize();
            let way = DVec3::new(0.0, 0.0, -2.0);
            let miss = way.cross(d).length();
            let chord = 2.0 * (0.49 - miss * miss).max(0.0).sqrt();
            let slab = 3.0 * setup.slices.relative_step() * 1.3;
            let [least, most] = [chord - slab, chord + slab].map(|l| 1.0 - 0.75_f64.powf(l / 0.5));
            assert!((least..=most).contains(&pixel[3]), "pixel {index}: {pixel:?}, chord {chord}");
            assert!((pixel[0] - pixel[3]).abs() < 1e-12, "white stays white");
        }
        assert!(image.pixels[12][3] > 0.5 && image.pixels[0] == [0.0; 4]);
    }

    #[test]
    fn opaque_and_clear_transfer_functions() {
        let mut view = view(1, 1);
        let blob = [particle(-2.0, 0.7, 0.5)];
        view.transfer.points = vec![grey(0.0, 0.25, 1.0)];
        assert_eq!(render(&Setup::new(&view), &blob).pixels, [[0.25, 0.25, 0.25, 1.0]]);
        view.transfer.points = vec![grey(0.0, 0.25, 0.0)];
        assert_eq!(render(&Setup::new(&view), &blob).pixels, [[0.0; 4]]);
    }

    #[test]
    fn nothing_and_unsound_particles_leave_an_empty_picture() {
        let setup = Setup::new(&view(3, 2));
        assert_eq!(render(&setup, &[]).pixels, [[0.0; 4]; 6]);
        let unsound =
            [particle(-2.0, f64::NAN, 0.5), particle(f64::NAN, 1.0, 0.5), particle(-2.0, 1.0, f64::NAN)];
        assert_eq!(render(&setup, &unsound).pixels, [[0.0; 4]; 6]);
    }

    #[test]
    fn the_midpoint_rule_converges_with_second_order() {
        let mut view = view(3, 2);
        // Log range and height such that a layer is a whole number at rate 16, 32 and 64.
        view.camera.as_mut().unwrap().fov_y_degrees = 90.0;
        let smooth = [particle(-0.5, 20.0, 0.0), particle(-3.0, 19.0, 1.0), particle(8.0, 15.0, 0.8)];
        let image = |rate: f64| {
            let mut view = view.clone();
            view.sampling.rate = rate;
            let setup = Setup::new(&view);
            (setup.slices.count, render(&setup, &smooth).pixels)
        };
        let (_, exact) = image(64.0 * 16.0);
        let error = |rate: f64| {
            let (count, pixels) = image(rate);
            let errors =
                pixels.iter().zip(&exact).flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()));
            (count, errors.fold(0.0, f64::max))
        };
        let ((coarse, a), (fine, b)) = (error(14.0), error(56.0));
        let order = (a / b).ln() / (f64::from(fine) / f64::from(coarse)).ln();
        assert!((1.9..2.1).contains(&order), "order {order}: {a} with {coarse} slices, {b} with {fine}");
    }
}
