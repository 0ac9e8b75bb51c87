//! The renderer under test, on this machine's adapter.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock};

use renderer::{Gpu, GpuOptions, ParticleSet, Picture, Quantity, RawParticle, Renderer, View};

use crate::compare::compare;
use crate::floor;
use crate::margins::margins;
use crate::particle::Particle;
use crate::picture::{self, Image};
use crate::scenes::Scene;
use crate::setup::Setup;

/// A renderer of its own. Without an adapter the test fails, since a skipped comparison proves nothing.
pub fn open(options: &GpuOptions) -> Renderer {
    let gpu = Gpu::new(options).unwrap_or_else(|error| panic!("{error}"));
    Renderer::new(gpu).unwrap_or_else(|error| panic!("{error}"))
}

/// The renderer that the tests of one process share: its pipelines are built once.
pub fn shared() -> MutexGuard<'static, Renderer> {
    static RENDERER: OnceLock<Mutex<Renderer>> = OnceLock::new();
    let renderer = RENDERER.get_or_init(|| Mutex::new(open(&GpuOptions::default())));
    // A test that failed with the renderer in its hands says nothing against the renderer.
    renderer.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Particles as the renderer takes them.
pub fn particle_set(particles: &[Particle]) -> Arc<ParticleSet> {
    Arc::new(ParticleSet::new(particles.len(), |row| {
        let Particle { position, support_radius, volume, .. } = particles[row];
        RawParticle { position: position.to_array(), support_radius, volume }
    }))
}

/// The quantity of the same particles, and that of their opacity where the view has one, as the renderer takes
/// them.
pub fn quantity(set: &ParticleSet, particles: &[Particle], view: &View) -> Arc<Quantity> {
    let colour = Quantity::new(set, view.quantity.spread(), |row| particles[row].quantity);
    Arc::new(match &view.quantity.opacity {
        Some(opacity) => {
            colour.with_opacity(&Quantity::new(set, opacity.spread(), |row| particles[row].opacity))
        }
        None => colour,
    })
}

/// `scene` as the renderer takes it; nothing of it is known to the renderer from before.
pub fn prepare(scene: &Scene) -> renderer::Scene {
    let Scene { particles, view, name } = scene;
    let set = particle_set(particles);
    let quantity = quantity(&set, particles, view);
    renderer::Scene::new(set, quantity, view).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Renders a prepared scene at full sampling.
pub fn render(renderer: &mut Renderer, scene: &renderer::Scene) -> Picture {
    let picture = renderer.render(scene, &mut |_| ControlFlow::Continue(()));
    picture.unwrap_or_else(|error| panic!("{error}"))
}

/// The renderer's picture of `scene`, which is checked to be one: finite, premultiplied, in [0, 1].
pub fn picture(scene: &Scene) -> Image<f32> {
    let image = Image::from(&render(&mut shared(), &prepare(scene)));
    let Scene { name, view, .. } = scene;
    assert_eq!([image.width, image.height], [view.image.width, view.image.height], "{name}");
    assert_eq!(image.pixels.len(), (image.width * image.height) as usize, "{name}");
    for (index, pixel) in image.pixels.iter().enumerate() {
        let sound = pixel.iter().all(|channel| (0.0..=1.0).contains(channel));
        let premultiplied = pixel[..3].iter().all(|colour| *colour <= pixel[3] + 1e-5);
        let (x, y) = (index as u32 % image.width, index as u32 / image.width);
        assert!(sound && premultiplied, "{name}: pixel ({x}, {y}) is {pixel:?}");
    }
    image
}

/// What is wrong with `image` as a picture of `scene`, by the twin with the sub-pixel floor; `None`
/// where they are alike.
pub fn mismatch(scene: &Scene, image: &Image<f32>) -> Option<String> {
    let setup = Setup::new(&scene.view);
    let twin = picture::render_with_floor(&setup, &scene.particles);
    let comparison = compare(&twin, image);
    (!comparison.is_alike()).then(|| {
        let [x, y] = comparison.worst;
        let worst = (y * image.width + x) as usize;
        let (expected, found) = (twin.pixels[worst], image.pixels[worst]);
        let raised: Vec<Particle> = scene.particles.iter().map(|p| floor::raise(p, &setup)).collect();
        let margins = margins(&setup, &raised, x, y);
        let name = &scene.name;
        format!("{name}: {comparison}: expected {expected:.6?}, found {found:.6?}; {margins}")
    })
}

/// Fails with a line for each of the scenes whose picture is not like its twin.
pub fn assert_alike(scenes: impl IntoIterator<Item = Scene>) {
    let mismatches: Vec<String> =
        scenes.into_iter().filter_map(|scene| mismatch(&scene, &picture(&scene))).collect();
    assert!(mismatches.is_empty(), "{} pictures differ:\n{}", mismatches.len(), mismatches.join("\n"));
}
