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

/// Whether a fixture is one of those with an array of every type and role.
fn is_of_types(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("types_"))
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
    let mut fixtures = fixtures();
    fixtures.retain(|(path, _)| !is_of_types(path));
    assert_eq!(fixtures.len(), 16);
    for (path, bytes) in fixtures {
        let frame = read(&path, &bytes).unwrap_or_else(|why| panic!("{}: {why}", path.display()));
        assert_eq!(difference(&frame, &expected), None, "{}", path.display());
        assert!(frame.warnings.is_empty(), "{}: {:?}", path.display(), frame.warnings);
        let timed = ["ascii.vtu", "raw_zlib_blocks_big_endian.vtu"].iter().any(|name| path.ends_with(name));
        assert_eq!(frame.metadata.time, timed.then_some(5.0 / 6.0), "{}", path.display());
    }
}

/// Arrays of the `types_` fixtures of one component: their values repeat these four.
const TYPES: [(&str, [f64; 4]); 13] = [
    ("char", [-128.0, 127.0, -64.0, 63.0]),
    ("uchar", [0.0, 255.0, 0.0, 127.0]),
    ("short", [-32768.0, 32767.0, -16384.0, 16383.0]),
    ("ushort", [0.0, 65535.0, 0.0, 32767.0]),
    ("int", [-2147483648.0, 2147483647.0, -1073741824.0, 1073741823.0]),
    ("uint", [0.0, 4294967295.0, 0.0, 2147483647.0]),
    ("long", [-9007199254740992.0, 9007199254740992.0, -4503599627370496.0, 4503599627370496.0]),
    ("ulong", [0.0, 9007199254740992.0, 0.0, 4503599627370496.0]),
    ("longlong", [-9007199254740992.0, 9007199254740992.0, -4503599627370496.0, 4503599627370496.0]),
    ("ulonglong", [0.0, 9007199254740992.0, 0.0, 4503599627370496.0]),
    ("idtype", [-2147483648.0, 2147483647.0, -1073741824.0, 1073741823.0]),
    ("float", [-0.5, 1.5, -0.25, 0.75]),
    ("double", [-1.25e100, 0.125, -6.25e99, 0.0625]),
];

#[test]
fn all_types_and_roles_are_read() {
    let mut fixtures = fixtures();
    fixtures.retain(|(path, _)| is_of_types(path));
    assert_eq!(fixtures.len(), 7);
    for (path, bytes) in fixtures {
        let name = path.display();
        let frame = read(&path, &bytes).unwrap_or_else(|why| panic!("{name}: {why}"));
        let column =
            |field: &str| &frame.field(field).unwrap_or_else(|| panic!("{name}: no `{field}`")).column;
        let positions =
            (0..9).flat_map(|i| [f64::from(i) / 8.0, -0.25 * f64::from(i), f64::from(i) * 1024.0]);
        let positions: Vec<f64> = positions.map(|x| x + 0.0).collect();
        assert_eq!(different(frame.positions(), &Column::new(3, positions).unwrap()), None, "{name}");
        for (field, values) in TYPES {
            let values = (0..9).map(|i| values[i % 4]);
            let expected = match field {
                "float" => Column::scalars(values.map(|x| x as f32).collect::<Vec<f32>>()),
                _ => Column::scalars(values.collect::<Vec<f64>>()),
            };
            assert_eq!(different(column(field), &expected), None, "{name}: {field}");
        }
        for (field, components, scale) in [
            ("my scalars", 2, 1.0),
            ("vec", 3, 2.0),
            ("nrm", 3, 1.0),
            ("ten", 9, 1.0),
            ("tc", 2, 1.0),
            ("gid", 1, 100.0),
        ] {
            assert_eq!(column(field).components(), components, "{name}: {field}");
            let ends = [column(field).get(0, 0), column(field).get(8, components - 1)];
            let last = [0.0, 1.0, 0.0, 0.5][(9 * components - 1) % 4];
            assert_eq!(ends, [0.0, last * scale], "{name}: {field}");
        }
        let legacy = path.extension().is_some_and(|extension| extension == "vtk");
        assert_eq!(frame.fields().len(), 19 + usize::from(legacy), "{name}");
        if legacy {
            let bits: Vec<f32> = (0..9u8).map(|i| f32::from((i * 7 % 3) & 1)).collect();
            assert_eq!(different(column("bit"), &Column::scalars(bits)), None, "{name}");
        }
        assert_eq!(frame.metadata.time, Some(0.75), "{name}");
        assert_eq!(frame.warnings.len(), 2, "{name}: {:?}", frame.warnings);
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
