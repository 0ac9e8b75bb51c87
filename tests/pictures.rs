//! The renderer's pictures of random scenes are those of the f64 twin: at most 10⁻³ apart on 99.9 %
//! of the pixels, and 10⁻⁵ on average.

use reference::compare::compare;
use reference::device::{assert_alike, picture};
use reference::picture::{Image, render_with_floor};
use reference::scenes::{self, Scene, Shape};
use reference::setup::Setup;
use renderer::Kernel;

/// Every shape with every kernel at one size, `rounds` times with other seeds.
fn scenes(size: [u32; 2], first_seed: u64, rounds: u64) -> impl Iterator<Item = Scene> {
    let kernels = Shape::ALL.into_iter().flat_map(|shape| Kernel::ALL.map(|kernel| (shape, kernel)));
    let count = (Shape::ALL.len() * Kernel::ALL.len()) as u64;
    (0..rounds).flat_map(move |round| {
        let seeds = first_seed + round * count..;
        kernels
            .clone()
            .zip(seeds)
            .map(move |((shape, kernel), seed)| scenes::random(seed, shape, size, kernel))
    })
}

/// Pictures of one pixel, side by side as one picture.
fn joined<T>(images: impl Iterator<Item = Image<T>>) -> Image<T> {
    let pixels: Vec<[T; 4]> = images.flat_map(|image| image.pixels).collect();
    Image { width: pixels.len() as u32, height: 1, pixels }
}

#[test]
fn one_pixel() {
    let scenes: Vec<Scene> = scenes([1, 1], 1_000, 5).collect();
    let twins = scenes.iter().map(|scene| render_with_floor(&Setup::new(&scene.view), &scene.particles));
    let comparison = compare(&joined(twins), &joined(scenes.iter().map(picture)));
    let worst = &scenes[comparison.worst[0] as usize].name;
    assert!(comparison.is_alike(), "{comparison}, which is {worst}");
}

#[test]
fn less_than_a_bundle() {
    assert_alike(scenes([7, 5], 2_000, 2));
}

#[test]
fn bundles_that_the_image_cuts() {
    assert_alike(scenes([33, 21], 3_000, 2));
}

#[test]
fn whole_bundles() {
    assert_alike(scenes([64, 48], 4_000, 1));
}
