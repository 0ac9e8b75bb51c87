//! The renderer under test, on this machine's adapter.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock};

use renderer::{Gpu, GpuOptions, ParticleSet, Picture, Quantity, RawParticle, Renderer};

use crate::compare::compare;
use crate::particle::Particle;
use crate::picture::{self, Image};
use crate::scenes::Scene;
use crate::setup::Setup;

/// One renderer for a whole test process: pipelines are built once. Without an adapter the test
/// fails, since a skipped comparison proves nothing.
fn renderer() -> &'static Mutex<Renderer> {
    static RENDERER: OnceLock<Mutex<Renderer>> = OnceLock::new();
    RENDERER.get_or_init(|| {
        let gpu = Gpu::new(&GpuOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        Mutex::new(Renderer::new(gpu).unwrap_or_else(|error| panic!("{error}")))
    })
}

/// `scene` as the renderer takes it.
pub fn prepare(scene: &Scene) -> renderer::Scene {
    let Scene { particles, view, name } = scene;
    let set = ParticleSet::new(particles.len(), |row| {
        let Particle { position, support_radius, volume, .. } = particles[row];
        RawParticle { position: position.to_array(), support_radius, volume }
    });
    let quantity = Quantity::new(&set, view.quantity.range, |row| particles[row].quantity);
    let prepared = renderer::Scene::new(Arc::new(set), Arc::new(quantity), view);
    prepared.unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Renders a prepared scene at full sampling.
pub fn render(scene: &renderer::Scene) -> Picture {
    // A test that failed with the renderer in its hands says nothing against the renderer.
    let mut renderer = renderer().lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let picture = renderer.render(scene, &mut |_| ControlFlow::Continue(()));
    picture.unwrap_or_else(|error| panic!("{error}"))
}

/// The renderer's picture of `scene`, which is checked to be one: finite, premultiplied, in [0, 1].
pub fn picture(scene: &Scene) -> Image<f32> {
    let image = Image::from(&render(&prepare(scene)));
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

/// What is wrong with the renderer's picture of `scene`, by its twin with the sub-pixel floor;
/// `None` where they are alike.
pub fn mismatch(scene: &Scene) -> Option<String> {
    let image = picture(scene);
    let twin = picture::render_with_floor(&Setup::new(&scene.view), &scene.particles);
    let comparison = compare(&twin, &image);
    (!comparison.is_alike()).then(|| {
        let [x, y] = comparison.worst;
        let worst = (y * image.width + x) as usize;
        let (expected, found) = (twin.pixels[worst], image.pixels[worst]);
        format!("{}: {comparison}: expected {expected:.6?}, found {found:.6?}", scene.name)
    })
}

/// Fails with a line for each of the scenes whose picture is not like its twin.
pub fn assert_alike(scenes: impl IntoIterator<Item = Scene>) {
    let mismatches: Vec<String> = scenes.into_iter().filter_map(|scene| mismatch(&scene)).collect();
    assert!(mismatches.is_empty(), "{} pictures differ:\n{}", mismatches.len(), mismatches.join("\n"));
}
