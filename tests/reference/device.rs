//! The renderer under test, on this machine's adapter.

use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock};

use renderer::{Gpu, GpuOptions, ParticleSet, Picture, Quantity, RawParticle, Renderer, Scene, View};

use crate::particle::Particle;

/// One renderer for a whole test process: pipelines are built once. Without an adapter the test
/// fails, since a skipped comparison proves nothing.
fn renderer() -> &'static Mutex<Renderer> {
    static RENDERER: OnceLock<Mutex<Renderer>> = OnceLock::new();
    RENDERER.get_or_init(|| {
        let gpu = Gpu::new(&GpuOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        Mutex::new(Renderer::new(gpu).unwrap_or_else(|error| panic!("{error}")))
    })
}

/// The scene of `particles` as `view` has it.
pub fn scene(particles: &[Particle], view: &View) -> Scene {
    let set = ParticleSet::new(particles.len(), |row| {
        let Particle { position, support_radius, volume, .. } = particles[row];
        RawParticle { position: position.to_array(), support_radius, volume }
    });
    let quantity = Quantity::new(&set, view.quantity.range, |row| particles[row].quantity);
    Scene::new(Arc::new(set), Arc::new(quantity), view).unwrap_or_else(|error| panic!("{error}"))
}

/// Renders `scene` at full sampling.
pub fn render(scene: &Scene) -> Picture {
    // A test that failed with the renderer in its hands says nothing against the renderer.
    let mut renderer = renderer().lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let picture = renderer.render(scene, &mut |_| ControlFlow::Continue(()));
    picture.unwrap_or_else(|error| panic!("{error}"))
}
