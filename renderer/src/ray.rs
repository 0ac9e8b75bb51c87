//! One ray of a picture, followed on the host in f64: where along it that lies which is to be seen
//! (contract, section 1). For looking at a place, not for pictures.

use glam::DVec3;
use rayon::prelude::*;

use crate::camera::Slices;
use crate::kernel::Kernel;
use crate::scene::Scene;
use crate::stages::shared::radius_floor;

/// What lies along a ray.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Glance {
    /// `None` where nothing is to be seen.
    pub sight: Option<Sight>,
    /// The particles whose supports the ray meets, from front to back.
    pub met: Vec<Met>,
    /// Of the pixel, 0 to 1.
    pub opacity: f64,
}

/// The place that a pixel shows: of the stretches of the ray without a gap in which something is to be
/// seen, the one that gives the pixel most of its opacity; in it, where half of that is reached.
#[derive(Clone, Debug, PartialEq)]
pub struct Sight {
    /// In the unit of the run.
    pub point: DVec3,
    pub depth: f64,
    /// What the stretch gives the pixel of its opacity.
    pub opacity: f64,
    /// The particles whose supports hold the place, and their weights w_j in a common unit.
    pub around: Vec<(usize, f64)>,
}

/// A particle whose support a ray meets. Lengths in the unit of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// Among the kept particles.
    pub index: usize,
    /// View depth at which the ray comes closest, and how close.
    pub depth: f64,
    pub distance: f64,
}

/// A ball that a ray goes through. Lengths in the unit of the particle set, depths of the ray.
struct Pierced {
    index: usize,
    nearest: f64,
    /// Squared, of the centre.
    miss: f64,
    radius: f64,
    weight: f64,
}

impl Scene {
    /// Follows the ray through a place in the picture, in pixels from its upper left corner.
    pub fn glance(&self, [x, y]: [f64; 2]) -> Glance {
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        let camera = &self.camera;
        let nx = (2.0 * x / width - 1.0) * (width / height) * camera.tan_half_fov;
        let ny = (1.0 - 2.0 * y / height) * camera.tan_half_fov;
        let ray = Ray {
            scene: self,
            slices: Slices::new(camera, self.height, self.rate),
            direction: camera.forward + nx * camera.right + ny * camera.up,
            unit: self.particles.unit(),
        };
        let pierced = ray.pierced();
        let (sight, opacity) = ray.sight(&pierced);
        let met = |ball: &Pierced| Met {
            index: ball.index,
            depth: ball.nearest * ray.unit,
            distance: ball.miss.sqrt() * ray.unit,
        };
        let mut met: Vec<Met> = pierced.iter().map(met).collect();
        met.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        Glance { sight, met, opacity }
    }
}

struct Ray<'a> {
    scene: &'a Scene,
    slices: Slices,
    /// For each unit of view depth.
    direction: DVec3,
    /// Of the particle set, in the unit of the run.
    unit: f64,
}

/// Sums over the particles at one sample: w, and w times what decides the opacity.
type Sums = [f64; 2];

impl Ray<'_> {
    /// The particles that the ray goes through between near and far. It looks at all of them: for a
    /// ray now and then that takes less than to keep an order of them.
    fn pierced(&self) -> Vec<Pierced> {
        let Scene { particles, quantity, camera, .. } = self.scene;
        let eye = particles.to_device(camera.eye);
        let [near, far] = [camera.near, camera.far].map(|depth| depth / self.unit);
        let floor = radius_floor(self.scene, &self.slices);
        let length = self.direction.length_squared();
        let pierced = |(index, (position, radius)): (usize, (DVec3, f64))| {
            let way = position - eye;
            let depth = way.dot(camera.forward);
            let raised = radius.max(floor * depth.clamp(near, far));
            let nearest = way.dot(self.direction) / length;
            let miss = (way - nearest * self.direction).length_squared();
            let meets = miss < raised * raised && depth + raised > near && depth - raised < far;
            (meets && !quantity.is_rejected(index)).then(|| Pierced {
                index,
                nearest,
                miss,
                radius: raised,
                weight: (particles.weight_root(index) * radius / raised).powi(3),
            })
        };
        particles.balls().enumerate().filter_map(pierced).collect()
    }

    /// The place that is seen, and the opacity of the pixel.
    fn sight(&self, pierced: &[Pierced]) -> (Option<Sight>, f64) {
        let contributions = self.contributions(pierced);
        let (mut best, mut stretch) = (0..0, 0..0);
        let (mut most, mut sum) = (0.0, 0.0);
        for (sample, &contribution) in contributions.iter().enumerate() {
            if contribution > 0.0 {
                if sum == 0.0 {
                    stretch.start = sample;
                }
                sum += contribution;
                stretch.end = sample + 1;
            }
            if sum > most {
                (best, most) = (stretch.clone(), sum);
            }
            if contribution == 0.0 {
                sum = 0.0;
            }
        }
        let opacity = contributions.iter().sum::<f64>().min(1.0);
        let mut reached = 0.0;
        let middle = best.into_iter().find(|&sample| {
            reached += contributions[sample];
            reached >= 0.5 * most
        });
        let sight = middle.map(|sample| {
            let depth = self.slices.depth(sample as f64 + 0.5);
            let around = pierced.iter().map(|ball| (ball.index, self.weight(ball, depth / self.unit)));
            let point = self.scene.camera.eye + depth * self.direction;
            Sight {
                point,
                depth,
                opacity: most,
                around: around.filter(|(_, weight)| *weight > 0.0).collect(),
            }
        });
        (sight, opacity)
    }

    /// What each sample adds to the opacity of the pixel.
    fn contributions(&self, pierced: &[Pierced]) -> Vec<f64> {
        let mut sums: Vec<Sums> = vec![[0.0; 2]; self.slices.count as usize];
        for ball in pierced {
            let half = ((ball.radius * ball.radius - ball.miss) / self.direction.length_squared()).sqrt();
            // A sample more on each side: whether it lies inside is decided by its weight.
            let number =
                |depth: f64| (depth * self.unit / self.slices.near).ln() / self.slices.log_step - 0.5;
            let first = number((ball.nearest - half).max(f64::MIN_POSITIVE)).floor().max(0.0) as usize;
            let last = number((ball.nearest + half).max(f64::MIN_POSITIVE)).ceil().max(0.0) as usize;
            let value = f64::from(self.scene.quantity.opacity_of(ball.index));
            for (sample, sums) in sums.iter_mut().enumerate().take(last + 1).skip(first) {
                let weight = self.weight(ball, self.slices.depth(sample as f64 + 0.5) / self.unit);
                sums[0] += weight;
                sums[1] += weight * value;
            }
        }
        let length = self.direction.length() / self.scene.reference_length;
        let mut transparency = 1.0;
        let contribution = |(sample, [weight, value]): (usize, Sums)| {
            if weight <= 0.0 {
                return 0.0;
            }
            let alpha = f64::from(self.scene.transfer.sample((value / weight) as f32)[3]);
            let [from, to] = [0.0, 1.0].map(|edge| self.slices.depth(sample as f64 + edge));
            let opacity = -((to - from) * length * (-alpha).ln_1p()).exp_m1();
            let contribution = transparency * opacity;
            transparency *= 1.0 - opacity;
            contribution
        };
        sums.into_iter().enumerate().map(contribution).collect()
    }

    /// w of a ball at a depth of the ray.
    fn weight(&self, ball: &Pierced, depth: f64) -> f64 {
        let along = depth - ball.nearest;
        let square = ball.miss + along * along * self.direction.length_squared();
        ball.weight * shape(self.scene.kernel, square / (ball.radius * ball.radius))
    }
}

/// W(r, h)·h³ but for a constant factor, by (r/h)².
fn shape(kernel: Kernel, square: f64) -> f64 {
    let rho = square.sqrt();
    match kernel {
        _ if square >= 1.0 => 0.0,
        Kernel::Poly6 => (1.0 - square).powi(3),
        Kernel::Cubic if rho <= 0.5 => 6.0 * (rho.powi(3) - square) + 1.0,
        Kernel::Cubic => 2.0 * (1.0 - rho).powi(3),
        Kernel::WendlandC2 => (1.0 - rho).powi(4) * (1.0 + 4.0 * rho),
    }
}
