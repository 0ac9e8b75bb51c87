//! A device with little memory renders in tiles, and renders the same picture.

use reference::compare::compare;
use reference::device::{mismatch, open, picture, prepare, render};
use reference::picture::Image;
use reference::scenes::{self, Scene};
use renderer::GpuOptions;

/// Bytes that a tile's grid may take: from a few tiles to a single bundle a tile.
const MEMORY: [u64; 4] = [256 << 10, 64 << 10, 32 << 10, 16 << 10];

fn scenes() -> Vec<Scene> {
    let mut deep = scenes::plain(121, 17, 9);
    let camera = deep.view.camera.as_mut().expect("plain scenes have a camera");
    camera.near = Some(0.01);
    deep.view.sampling.rate = 8.0;
    deep.name = "many layers".to_owned();
    let mut dense = scenes::plain(122, 64, 48);
    dense.particles.iter_mut().for_each(|particle| particle.support_radius *= 3.0);
    dense.name = "many references".to_owned();
    vec![scenes::plain(120, 64, 48), deep, dense]
}

#[test]
fn little_memory_makes_the_same_pictures() {
    let scenes = scenes();
    let whole: Vec<Image<f32>> = scenes.iter().map(picture).collect();
    for memory in MEMORY {
        let mut renderer = open(&GpuOptions { memory: Some(memory), ..GpuOptions::default() });
        for (scene, whole) in scenes.iter().zip(&whole) {
            let tiled = Image::from(&render(&mut renderer, &prepare(scene)));
            let comparison = compare(whole, &tiled);
            assert!(comparison.max <= 1e-4, "{} with {memory} bytes: {comparison}", scene.name);
        }
    }
}

#[test]
fn tiled_pictures_match_the_twin() {
    let mut renderer = open(&GpuOptions { memory: Some(32 << 10), ..GpuOptions::default() });
    for scene in scenes() {
        let image = Image::from(&render(&mut renderer, &prepare(&scene)));
        let mismatch = mismatch(&scene, &image);
        assert!(mismatch.is_none(), "{}", mismatch.unwrap_or_default());
    }
}
