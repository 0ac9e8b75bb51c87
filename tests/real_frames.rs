//! Frames of real runs, with the views behind the tables of the design: the renderer's pictures are
//! those of the f64 twin. The data are not part of the repository; without them the test says so.

use std::path::{Path, PathBuf};

use glam::DVec3;
use reference::Particle;
use reference::device::assert_alike;
use reference::scenes::Scene;
use renderer::View;
use sphcast::frames::Frame;

/// Side of the pictures in pixels.
const SIDE: u32 = 96;

/// What the frame of `file` says; `None` where it is absent.
fn read(file: &Path) -> Option<Frame> {
    if !file.is_file() {
        println!("skipped: {} is absent", file.display());
        return None;
    }
    Some(sphcast::frames::readers::read(file, &Default::default()).unwrap_or_else(|error| panic!("{error}")))
}

/// The frame `data` seen with `view`, both as named in the folder of shared data.
fn scene(data: &str, view: &str) -> Option<Scene> {
    let shared = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    let frame = read(&shared.join("data").join(data))?;
    let text = std::fs::read_to_string(shared.join("design/views").join(view)).expect("views come with data");
    let mut view = View::from_json(&text).unwrap_or_else(|error| panic!("{view}: {error}"));
    (view.image.width, view.image.height) = (SIDE, SIDE);
    view.sampling.tolerance = None;
    let particles = particles(&frame, &view);
    Some(Scene { name: data.to_owned(), particles, view })
}

/// All masses of these runs are equal, so that volumes go with 1/ρ (contract, section 1).
fn particles(frame: &Frame, view: &View) -> Vec<Particle> {
    let name = view.quantity.name.as_deref().expect("the views name their quantity");
    let quantity = &frame.field(name).expect("the frame has the view's quantity").column;
    let density = &frame.field("density").expect("the frame has densities").column;
    let support_radius = view.particles.support_radius.expect("the views give the support radius");
    let particle = |row: usize| Particle {
        position: DVec3::from_array(frame.position(row)),
        support_radius,
        volume: 1.0 / density.get(row, 0),
        quantity: quantity.magnitude(row),
        opacity: 0.0,
    };
    (0..frame.len()).map(particle).collect()
}

#[test]
fn concentration_in_the_mixer() {
    let view = |name: &str| scene("mixer/mixer_0016.vtu", name);
    assert_alike([view("mixer-ramp.json"), view("mixer-peak.json")].into_iter().flatten());
}

#[test]
fn speed_in_the_dam_break() {
    let view = |name: &str| scene("dambreak/ParticleData_Fluid_14.vtk", name);
    assert_alike([view("dambreak-ramp.json"), view("dambreak-peak.json")].into_iter().flatten());
}
