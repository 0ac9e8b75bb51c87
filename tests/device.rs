//! What happens to the device is an error that says so, never a panic or a wrong picture.

use std::ops::ControlFlow;

use reference::device::{open, prepare};
use reference::scenes;
use renderer::{Gpu, GpuError, GpuOptions, Picture, RenderError, Renderer};

fn render(renderer: &mut Renderer, scene: &renderer::Scene) -> Result<Picture, RenderError> {
    renderer.render(scene, &mut |_| ControlFlow::Continue(()))
}

#[test]
fn a_lost_device_is_said_to_be_lost_again_and_again() {
    let mut renderer = open(&GpuOptions::default());
    let scene = prepare(&scenes::plain(50, 24, 16));
    assert!(render(&mut renderer, &scene).is_ok());
    renderer.gpu().lose();
    let other = prepare(&scenes::plain(51, 200, 160));
    for _ in 0..3 {
        let result = render(&mut renderer, &other);
        assert!(matches!(result, Err(RenderError::DeviceLost(_))), "{result:?}");
    }
}

#[test]
fn a_device_lost_before_its_pipelines_is_noticed() {
    let mut renderer = open(&GpuOptions::default());
    let scene = prepare(&scenes::plain(52, 400, 300));
    let gpu = Gpu::new(&GpuOptions::default()).expect("an adapter");
    gpu.lose();
    assert!(matches!(Renderer::new(gpu).map(drop), Err(RenderError::DeviceLost(_))));
    // Another device is none of this one's business.
    assert!(render(&mut renderer, &scene).is_ok());
}

#[test]
fn an_adapter_that_is_not_there_is_named_with_those_that_are() {
    let options = GpuOptions { adapter: Some("Voodoo 2".into()), ..GpuOptions::default() };
    match Gpu::new(&options).map(drop) {
        Err(GpuError::NoSuchAdapter { wanted, found }) => {
            assert_eq!(wanted, "Voodoo 2");
            assert!(!found.is_empty());
        }
        other => panic!("{other:?}"),
    }
}
