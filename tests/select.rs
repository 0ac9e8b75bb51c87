//! Clips and filters leave particles out as if the file lacked them, and nothing else: what a view
//! leaves open goes by the whole frame. A selection and its inverse share the particles between them.

use std::ops::ControlFlow;
use std::sync::Arc;

use glam::DVec3;
use reference::device::shared;
use reference::random::Random;
use renderer::{ClipBox, ClipPlane, Filter, Picture, Scene, SelectView, View};
use sphcast::frames::{Column, Field, Frame, Metadata};
use sphcast::scene;

/// Particles in the cube from −1 to 1, with a scalar and a vector; some of them cannot be shown.
fn frame(seed: u64) -> Frame {
    let mut random = Random::new(seed);
    let mut positions: Vec<f64> = (0..600).flat_map(|_| random.in_cube().to_array()).collect();
    positions[30] = f64::NAN;
    let heat: Vec<f64> = (0..600).map(|_| random.unit()).collect();
    let flow: Vec<f64> = (0..600).flat_map(|_| random.in_cube().to_array()).collect();
    let field = |name: &str, components, data: Vec<f64>| Field {
        name: name.into(),
        column: Column::new(components, data).unwrap(),
    };
    let metadata = Metadata { support_radius: Some(0.35), ..Metadata::default() };
    let fields = vec![field("heat", 1, heat), field("velocity", 3, flow)];
    Frame::new(Column::new(3, positions).unwrap(), fields, metadata).unwrap()
}

/// The same without the rows that `keeps` refuses.
fn without(frame: &Frame, keeps: impl Fn(usize) -> bool) -> Frame {
    let rows: Vec<usize> = (0..frame.len()).filter(|row| keeps(*row)).collect();
    let part = |column: &Column| {
        let numbers = |row: &usize| (0..column.components()).map(|c| column.get(*row, c)).collect::<Vec<_>>();
        Column::new(column.components(), rows.iter().flat_map(numbers).collect::<Vec<_>>()).unwrap()
    };
    let fields = frame.fields().iter();
    let fields =
        fields.map(|field| Field { name: field.name.clone(), column: part(&field.column) }).collect();
    Frame::new(part(frame.positions()), fields, frame.metadata.clone()).unwrap()
}

/// Something of every kind, turned and cut at random.
fn select(seed: u64) -> SelectView {
    let mut random = Random::new(seed ^ 0xface);
    let corner = 0.6 * random.in_cube();
    let clip_box = ClipBox {
        min: corner - 0.7,
        max: corner + 0.7,
        rotation_degrees: 90.0 * random.in_cube(),
        invert: seed % 2 == 1,
        on: seed % 3 != 1,
    };
    let clip_plane =
        ClipPlane { point: 0.3 * random.in_cube(), normal: random.in_cube(), invert: seed % 4 < 2, on: true };
    let filter = |field: &str, range, invert| Filter { field: field.into(), range, invert, on: true };
    let filters =
        vec![filter("heat", [0.2, 0.9], seed.is_multiple_of(2)), filter("VEL.x", [-0.8, 2.0], false)];
    SelectView { clip_box: Some(clip_box), clip_plane: Some(clip_plane), filters }
}

fn view(select: SelectView) -> View {
    let mut view = View { select, ..View::default() };
    (view.image.width, view.image.height) = (40, 30);
    view.quantity.name = Some("heat".into());
    view
}

fn prepare(frame: &Frame, view: &View) -> Scene {
    let radius = view.particles.support_radius;
    let particles = Arc::new(scene::selected_particles(frame, radius, &view.select).unwrap());
    let quantity = Arc::new(scene::quantity(frame, &particles, &view.quantity).unwrap());
    Scene::new(particles, quantity, view).unwrap()
}

fn picture(scene: &Scene) -> Picture {
    shared().render(scene, &mut |_| ControlFlow::Continue(())).unwrap()
}

#[test]
fn a_clipped_picture_is_that_of_a_file_without_those_particles() {
    for seed in 0..8 {
        let frame = frame(seed);
        let selecting = view(select(seed));
        let clipped = prepare(&frame, &selecting);
        let choice = scene::choice(&frame, &selecting.select).unwrap();
        let rest = without(&frame, |row| choice.keeps(row) || frame.position(row)[0].is_nan());
        assert!(rest.len() > 10 && rest.len() < 590, "{} are left", rest.len());

        // What the view leaves open is as in the whole frame: for the file, it must be said.
        let whole = prepare(&frame, &view(SelectView::default()));
        let mut said = view(SelectView::default());
        said.quantity.range = Some(whole.quantity.range());
        said.transfer.reference_length = Some(whole.reference_length);
        let open = renderer::CameraView::OPEN;
        let overview = renderer::CameraView {
            eye: open,
            target: open,
            up: DVec3::Y,
            fov_y_degrees: 35.0,
            near: None,
            far: None,
        };
        let extent = whole.particles.whole();
        said.camera = Some(overview.settled(extent.bounds, extent.support_radii[1], 40.0 / 30.0));
        let theirs = prepare(&rest, &said);

        assert_eq!(clipped.camera, theirs.camera, "near and far are those of what is left");
        assert_eq!(clipped.particles.rejected(), theirs.particles.rejected());
        let (ours, theirs) = (picture(&clipped), picture(&theirs));
        assert!(ours.pixels.iter().filter(|pixel| pixel[3] > 0.01).count() > 20, "it shows something");
        assert!(ours.pixels == theirs.pixels, "seed {seed}: the pictures differ");
        assert_ne!(ours.pixels, picture(&whole).pixels, "seed {seed}: nothing was left out");
    }
}

#[test]
fn what_is_left_open_does_not_jump_as_a_clip_is_dragged() {
    let frame = frame(3);
    let whole = prepare(&frame, &view(SelectView::default()));
    for middle in [-0.9, -0.2, 0.4, 3.0] {
        let point = DVec3::new(middle, 0.0, 0.0);
        let plane = ClipPlane { point, normal: DVec3::X, invert: false, on: true };
        let cut = prepare(&frame, &view(SelectView { clip_plane: Some(plane), ..SelectView::default() }));
        let stance = |scene: &Scene| (scene.camera.eye, scene.camera.forward);
        assert_eq!(stance(&cut), stance(&whole));
        assert_eq!(cut.reference_length, whole.reference_length);
        assert_eq!(cut.quantity.range(), whole.quantity.range());
        assert!(cut.particles.len() < whole.particles.len());
        assert_eq!(cut.particles.rejected(), whole.particles.rejected(), "left out is not rejected");
    }
}

#[test]
fn each_particle_is_in_one_of_a_selection_and_its_inverse() {
    // On a lattice, so that many lie on the boundary itself.
    let positions = (0..512).flat_map(|i| [i % 8, i / 8 % 8, i / 64]).map(f64::from).collect::<Vec<_>>();
    let heat = Field {
        name: "heat".into(),
        column: Column::scalars((0..512).map(|i| f64::from(i % 5)).collect::<Vec<_>>()),
    };
    let frame = Frame::new(Column::new(3, positions).unwrap(), vec![heat], Metadata::default()).unwrap();
    for text in [
        r#"{"box": {"min": [2, 0, 3], "max": [5, 5, 3], "invert": false}}"#,
        r#"{"box": {"min": [1, 1, 1], "max": [5, 5, 5], "rotation_degrees": [0, 90, 45], "invert": false}}"#,
        r#"{"plane": {"point": [4, 0, 0], "normal": [1, 1, 0], "invert": false}}"#,
        r#"{"filters": [{"field": "heat", "range": [1, 3], "invert": false}]}"#,
    ] {
        let select: SelectView = serde_json::from_str(text).unwrap();
        let inverse: SelectView = serde_json::from_str(&text.replace("false", "true")).unwrap();
        let [own, inverse] = [&select, &inverse].map(|select| {
            let choice = scene::choice(&frame, select).unwrap();
            (0..512).map(|row| choice.keeps(row)).collect::<Vec<bool>>()
        });
        assert!((0..512).all(|row| own[row] != inverse[row]), "{text}");
        assert!(own.contains(&true) && own.contains(&false), "{text}");
    }
}

#[test]
fn a_filter_by_a_field_that_is_not_there_is_an_error_that_names_it() {
    let frame = frame(1);
    let filter = |on| Filter { field: "dye".into(), range: [0.0, 1.0], invert: false, on };
    let select = |on| SelectView { filters: vec![filter(on)], ..SelectView::default() };
    let why = scene::selected_particles(&frame, None, &select(true)).err().unwrap().to_string();
    assert_eq!(why, "select.filters: filter 0: there is no field `dye`; there are: heat, velocity");
    assert!(scene::selected_particles(&frame, None, &select(false)).is_ok());
}
