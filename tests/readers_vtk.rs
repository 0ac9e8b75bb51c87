//! The readers of the VTK family: files that say the same read the same, and no file, however
//! broken, gives anything but a frame or a fault that says where.

#[path = "readers_vtk/allocations.rs"]
mod allocations;
#[path = "readers_vtk/broken.rs"]
mod broken;
#[path = "readers_vtk/shared_data.rs"]
mod shared_data;

use std::path::{Path, PathBuf};

use sphcast::frames::readers::{vtk_legacy, vtk_xml};
use sphcast::frames::{Column, Field, Frame, Metadata, Numbers};

/// Reads a file of the VTK family by its extension; a fault as the text that a user sees.
fn read(path: &Path, bytes: &[u8]) -> Result<Frame, String> {
    let parse = if path.extension().is_some_and(|extension| extension == "vtk") {
        vtk_legacy::parse
    } else {
        vtk_xml::parse
    };
    parse(bytes).map_err(|fault| {
        let place = fault.place.as_ref().unwrap_or_else(|| panic!("`{}` has no place", fault.what));
        format!("{}: {place}", fault.what)
    })
}

/// Our fixtures, each with its bytes.
fn fixtures() -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/vtk");
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension != "csv"));
    paths.sort();
    paths.into_iter().map(|path| (path.clone(), std::fs::read(path).unwrap())).collect()
}

/// A frame from a table `id,x,y,z,vx,vy,vz,density,concentration` of the rows that `keep` wants.
fn from_table(text: &str, keep: impl Fn(u32) -> bool) -> Frame {
    let mut ids = Vec::new();
    let mut columns: [Vec<f32>; 8] = Default::default();
    for line in text.lines().skip(1) {
        let mut cells = line.split(',');
        let id: u32 = cells.next().unwrap().parse().unwrap();
        if keep(id) {
            ids.push(f64::from(id));
            columns.iter_mut().zip(cells).for_each(|(column, cell)| column.push(cell.parse().unwrap()));
        }
    }
    let [x, y, z, vx, vy, vz, density, concentration] = columns;
    let rows = |x: Vec<f32>, y: Vec<f32>, z: Vec<f32>| {
        let rows: Vec<f32> = (0..x.len()).flat_map(|i| [x[i], y[i], z[i]]).collect();
        Column::new(3, rows).unwrap()
    };
    let field = |name: &str, column| Field { name: name.into(), column };
    let fields = vec![
        field("velocity", rows(vx, vy, vz)),
        field("density", Column::scalars(density)),
        field("concentration", Column::scalars(concentration)),
        field("id", Column::scalars(ids)),
    ];
    Frame::new(rows(x, y, z), fields, Metadata::default()).unwrap()
}

/// Says where two columns differ in a bit; NaN is equal to itself here.
fn different(a: &Column, b: &Column) -> Option<String> {
    if a.components() != b.components() || a.len() != b.len() {
        return Some(format!("{} x {} against {} x {}", a.len(), a.components(), b.len(), b.components()));
    }
    let bits = |numbers: &Numbers| -> Vec<u64> {
        match numbers {
            Numbers::F32(numbers) => numbers.iter().map(|x| u64::from(x.to_bits())).collect(),
            Numbers::F64(numbers) => numbers.iter().map(|x| x.to_bits()).collect(),
        }
    };
    if std::mem::discriminant(a.numbers()) != std::mem::discriminant(b.numbers()) {
        return Some("single against double precision".into());
    }
    let at = bits(a.numbers()).iter().zip(bits(b.numbers())).position(|(&a, b)| a != b)?;
    Some(format!("value {at}"))
}

/// Says how a frame differs from what is expected, fields matched by name in any order.
fn difference(found: &Frame, expected: &Frame) -> Option<String> {
    if let Some(why) = different(found.positions(), expected.positions()) {
        return Some(format!("positions: {why}"));
    }
    if found.fields().len() != expected.fields().len() {
        return Some(format!("{} fields against {}", found.fields().len(), expected.fields().len()));
    }
    expected.fields().iter().find_map(|field| {
        let Some(other) = found.fields().iter().find(|other| other.name == field.name) else {
            return Some(format!("no field `{}`", field.name));
        };
        different(&other.column, &field.column).map(|why| format!("field `{}`: {why}", field.name))
    })
}

#[test]
fn all_variants_hold_the_same_frame() {
    let expected = from_table(include_str!("fixtures/vtk/expected.csv"), |_| true);
    assert_eq!(expected.len(), 756);
    let fixtures = fixtures();
    assert!(fixtures.len() >= 16, "fixtures are missing");
    for (path, bytes) in fixtures {
        let frame = read(&path, &bytes).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
        assert_eq!(difference(&frame, &expected), None, "{}", path.display());
        assert!(frame.warnings.is_empty(), "{}: {:?}", path.display(), frame.warnings);
        let timed = ["ascii.vtu", "raw_zlib_blocks_big_endian.vtu"].iter().any(|name| path.ends_with(name));
        assert_eq!(frame.metadata.time, timed.then_some(5.0 / 6.0), "{}", path.display());
    }
}

#[test]
fn the_comparison_sees_every_difference() {
    let table = "id,x,y,z,vx,vy,vz,density,concentration\n7,1,2,3,4,5,6,7,8\n9,1,2,3,4,5,6,7,8\n";
    let frame = from_table(table, |_| true);
    assert_eq!(difference(&frame, &frame.clone()), None);
    for (from, to) in [
        ("7,1,2", "7,1.0000001,2"),
        ("7,1,2", "7,-1,2"),
        ("6,7,8", "6,7,8.000001"),
        ("9,", "10,"),
        ("5,6,7", "5,nan,7"),
    ] {
        let other = from_table(&table.replacen(from, to, 1), |_| true);
        assert!(difference(&frame, &other).is_some(), "{from} -> {to}");
    }
    assert!(difference(&frame, &from_table(table, |id| id == 7)).is_some());
    let with =
        |fields: Vec<Field>| Frame::new(frame.positions().clone(), fields, Metadata::default()).unwrap();
    let mut fields = frame.fields().to_vec();
    fields[1].name = "Density".into();
    assert!(difference(&frame, &with(fields.clone())).is_some());
    fields[1] = Field { name: "density".into(), column: Column::scalars(vec![7.0f64, 7.0]) };
    assert!(difference(&frame, &with(fields.clone())).is_some());
    fields.pop();
    assert!(difference(&frame, &with(fields)).is_some());
}
