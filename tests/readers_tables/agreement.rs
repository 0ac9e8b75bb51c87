//! One frame in many formats is one frame.

use std::path::Path;

use sphcast::frames::{Column, Field, Frame, Metadata, Numbers};

use crate::{FIXTURES, fixture, read_ok, shared_data};

const FIELDS: [&str; 4] = ["velocity", "density", "concentration", "id"];

/// Where two columns differ, as f32: that is what all the files hold.
fn column_difference(name: &str, a: &Column, b: &Column) -> Option<String> {
    if (a.len(), a.components()) != (b.len(), b.components()) {
        return Some(format!("{name}: {}x{} and {}x{}", a.len(), a.components(), b.len(), b.components()));
    }
    let cells = (0..a.len()).flat_map(|row| (0..a.components()).map(move |component| (row, component)));
    cells.into_iter().find_map(|(row, component)| {
        let values = [a, b].map(|column| column.get(row, component) as f32);
        (values[0].to_bits() != values[1].to_bits()).then(|| format!("{name}[{row}].{component}: {values:?}"))
    })
}

/// Where a frame differs from the reference, in the positions and the usual fields that both have.
fn difference(reference: &Frame, other: &Frame) -> Option<String> {
    column_difference("position", reference.positions(), other.positions()).or_else(|| {
        FIELDS.iter().find_map(|name| {
            let (a, b) = (reference.field(name)?, other.field(name)?);
            column_difference(name, &a.column, &b.column)
        })
    })
}

fn without_density(frame: &Frame) -> Frame {
    let fields = frame.fields().iter().filter(|field| field.name != "density").cloned().collect();
    Frame::new(frame.positions().clone(), fields, Metadata::default()).unwrap()
}

fn has(frame: &Frame, names: &[&str]) -> bool {
    names.iter().all(|name| frame.field(name).is_some())
}

#[test]
fn fixtures_agree_bit_for_bit() {
    let _turn = crate::metered::together();
    let reference = read_ok(&fixture("binary.ply"));
    assert_eq!(reference.len(), 1512);
    assert!(has(&reference, &FIELDS));
    for name in FIXTURES {
        let frame = read_ok(&fixture(name));
        // Phantom's density follows from h, and is not the simulator's.
        let reference = if name == "phantom.h5" { without_density(&reference) } else { reference.clone() };
        assert_eq!(difference(&reference, &frame), None, "{name}");
        let expected: &[&str] = match name {
            "positions.npy" | "raw.xyz" | "rows.xyz" | "chemistry.xyz" => &[],
            "stored_fortran_f64.npz" => &["concentration"],
            "phantom.h5" => &["velocity", "density", "mass", "itype", "h"],
            _ => &FIELDS,
        };
        assert!(has(&frame, expected), "{name}");
    }
}

/// The comparator must see a last bit, a missing row and a swapped row.
#[test]
fn the_comparator_sees_what_differs() {
    let _turn = crate::metered::together();
    let reference = read_ok(&fixture("binary.ply"));
    let Numbers::F32(values) = reference.positions().numbers().clone() else { panic!("expected f32") };
    let frame = |values: Vec<f32>| {
        let fields = reference.fields().to_vec();
        Frame::new(Column::new(3, values).unwrap(), fields, Metadata::default()).unwrap()
    };
    assert_eq!(difference(&reference, &frame(values.clone())), None);
    let mut bit = values.clone();
    bit[4000] = f32::from_bits(bit[4000].to_bits() ^ 1);
    assert!(difference(&reference, &frame(bit)).unwrap().starts_with("position[1333].1"));
    let mut swapped = values.clone();
    swapped.rotate_left(3);
    assert!(difference(&reference, &frame(swapped)).is_some());
    let density: Vec<f32> = vec![1.0; reference.len()];
    let fields = vec![Field { name: "rho".into(), column: Column::scalars(density) }];
    let other = Frame::new(reference.positions().clone(), fields, Metadata::default()).unwrap();
    assert!(difference(&reference, &other).unwrap().starts_with("density[0]"));
}

#[test]
fn metadata_comes_with_the_formats_that_have_it() {
    let _turn = crate::metered::together();
    let metadata = |name: &str| read_ok(&fixture(name)).metadata;
    let near = |value: Option<f64>, expected: f64| value.is_some_and(|value| (value - expected).abs() < 1e-6);
    let npz = metadata("deflated.npz");
    assert!(
        near(npz.time, 0.833333333) && near(npz.support_radius, 0.05) && near(npz.particle_radius, 0.0125)
    );
    let gadget = metadata("gadget.hdf5");
    assert!(near(gadget.time, 0.833333333) && near(gadget.particle_mass, 0.015625));
    assert_eq!(gadget.support_per_smoothing_length, Some(1.0));
    let pysph = read_ok(&fixture("pysph.hdf5"));
    assert_eq!(pysph.metadata.support_per_smoothing_length, Some(2.0));
    assert!(near(pysph.metadata.time, 0.833333333));
    assert!(pysph.warnings[0].contains("wall"));
    let phantom = read_ok(&fixture("phantom.h5"));
    assert_eq!(phantom.metadata.support_per_smoothing_length, Some(2.0));
    assert_eq!(phantom.metadata.particle_mass, None);
    let at = |name: &str, row: usize| phantom.field(name).unwrap().column.get(row, 0);
    assert_eq!((at("mass", 0), at("mass", 1)), (0.03125, 0.015625));
    let expected = 0.03125 * (1.2 / f64::from(0.025f32)).powi(3);
    assert!((at("density", 0) / expected - 1.0).abs() < 1e-12);
}

#[test]
fn f64_stays_f64_and_f32_stays_f32() {
    let _turn = crate::metered::together();
    let double = |name: &str| matches!(read_ok(&fixture(name)).positions().numbers(), Numbers::F64(_));
    for name in ["stored_fortran_f64.npz", "pysph.hdf5", "phantom.h5", "comma.csv"] {
        assert!(double(name), "{name}");
    }
    for name in ["ascii.ply", "deflated.npz", "gadget.hdf5", "plain.bgeo", "raw.xyz", "positions.npy"] {
        assert!(!double(name), "{name}");
    }
}

/// The rows of a frame that have an id which four divides.
fn quarter(frame: &Frame) -> Frame {
    let id = &frame.field("id").unwrap().column;
    let rows: Vec<usize> = (0..frame.len()).filter(|&row| id.get(row, 0) % 4.0 == 0.0).collect();
    let pick = |column: &Column| {
        let cells = |&row: &usize| (0..column.components()).map(move |component| column.get(row, component));
        Column::new(column.components(), rows.iter().flat_map(cells).collect::<Vec<f64>>()).unwrap()
    };
    let field = |field: &Field| Field { name: field.name.clone(), column: pick(&field.column) };
    let fields = frame.fields().iter().map(field).collect();
    Frame::new(pick(frame.positions()), fields, Metadata::default()).unwrap()
}

#[test]
fn all_formats_of_the_real_frame_agree() {
    let _turn = crate::metered::together();
    let Some(data) = shared_data() else { return };
    let folder: &Path = &data.join("oneframe");
    let reference = read_ok(&folder.join("frame_binary.ply"));
    assert_eq!(reference.len(), 30240);
    for name in [
        "frame_splishsplash.bgeo",
        "frame.xyz",
        "frame.csv",
        "frame.npz",
        "frame_f64_fortran.npz",
        "frame_positions.npy",
        "frame_gadget.hdf5",
        "frame_pysph.hdf5",
    ] {
        let frame = read_ok(&folder.join(name));
        assert_eq!(difference(&reference, &frame), None, "{name}");
        assert!(frame.metadata.support_radius.is_some_and(|radius| (radius - 0.05).abs() < 1e-6), "{name}");
        assert!(frame.metadata.time.is_some_and(|time| (time - 0.83333333).abs() < 1e-6), "{name}");
        assert!(frame.warnings.is_empty(), "{name}: {:?}", frame.warnings);
    }
    let reference = quarter(&reference);
    assert_eq!(reference.len(), 7560);
    for name in ["frame_quarter_ascii.ply", "frame_quarter_binary.ply"] {
        let frame = read_ok(&folder.join(name));
        assert!(has(&frame, &FIELDS), "{name}");
        assert_eq!(difference(&reference, &frame), None, "{name}");
    }
}
