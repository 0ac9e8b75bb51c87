use super::*;
use crate::frames::Numbers;
use crate::frames::readers::error::Place;

const TWO_POINTS: &str =
    "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n0 1 2 3 4 5\n";

fn with(rest: &str) -> Result<Frame, Fault> {
    parse(format!("{TWO_POINTS}{rest}").as_bytes())
}

#[track_caller]
fn refused(result: Result<Frame, Fault>, words: &[&str]) -> Fault {
    let fault = result.expect_err("was read");
    for word in words {
        assert!(fault.what.contains(word), "`{}` does not say `{word}`", fault.what);
    }
    assert!(fault.place.is_some(), "`{}` has no place", fault.what);
    fault
}

#[test]
fn points_alone_are_particles() {
    let frame = with("").unwrap();
    assert_eq!(frame.positions().numbers(), &Numbers::F32(vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]));
    assert!(frame.fields().is_empty());
}

#[test]
fn all_roles_of_arrays_are_fields() {
    let frame = with(
        "METADATA\nINFORMATION 0\n\nVERTICES 2 4\n1 0 1 1\nCELL_DATA 2\nSCALARS c int\nLOOKUP_TABLE default\n7 8\n\
         POINT_DATA 2\nSCALARS a double 1\nLOOKUP_TABLE t\n0.1 0.2\nLOOKUP_TABLE t 1\n0 0 0 1\n\
         VECTORS v float\n1 2 3 4 5 6\nNORMALS n float\n1 0 0 0 1 0\nTEXTURE_COORDINATES tc 2 float\n0 0 1 1\n\
         TENSORS t float\n1 0 0 0 1 0 0 0 1 1 0 0 0 1 0 0 0 1\nCOLOR_SCALARS col 3\n0 0 0 1 1 1\n\
         FIELD more 2\nid 1 2 vtkIdType\n5 6\nlabel 1 2 string\nfirst one\nsecond\n",
    )
    .unwrap();
    let names: Vec<_> = frame.fields().iter().map(|f| (f.name.as_str(), f.column.components())).collect();
    assert_eq!(names, [("a", 1), ("v", 3), ("n", 3), ("tc", 2), ("t", 9), ("col", 3), ("id", 1)]);
    assert_eq!(frame.fields()[0].column.numbers(), &Numbers::F64(vec![0.1, 0.2]));
    assert_eq!(frame.warnings.len(), 2, "{:?}", frame.warnings);
}

#[test]
fn time_is_read_from_the_fields_of_the_file() {
    let text = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nFIELD FieldData 2\nTIME 1 1 double\n0.25\n\
                CYCLE 1 1 int\n3\nPOINTS 0 float\n";
    assert_eq!(parse(text.as_bytes()).unwrap().metadata.time, Some(0.25));
}

#[test]
fn binary_windows_line_ends_and_integer_positions() {
    let mut bytes =
        b"# vtk DataFile Version 4.2\r\nt\r\nBINARY\r\nDATASET POLYDATA\r\nPOINTS 1 short\r\n".to_vec();
    // The first number looks like an end of line.
    bytes.extend([0x0d, 0x0a, 0, 2, 0xff, 0xff]);
    let frame = parse(&bytes).unwrap();
    assert_eq!(frame.position(0), [f64::from(0x0d0a), 2.0, -1.0]);
    refused(parse(&bytes[..bytes.len() - 1]), &["truncated", "6 bytes of POINTS", "5 are left"]);
}

#[test]
fn faults_say_what_was_expected_and_where() {
    let fault = refused(with("POINT_DATA 3\n"), &["POINT_DATA 2", "found 3"]);
    assert_eq!(fault.place, Some(Place::Line(7)));
    refused(
        with("POINT_DATA 2\nSCALARS a float\nLOOKUP_TABLE t\n1"),
        &["truncated", "2 values of array `a`"],
    );
    refused(with("POINT_DATA 2\nFIELD f 2\na 1 2 float\n1 2\n"), &["truncated", "name of an array"]);
    refused(with("POINT_DATA 2\nFIELD f 1\na 1 3 float\n1 2 3\n"), &["`a`", "2 rows", "found 3"]);
    refused(with("POINT_DATA 2\nFIELD f 1\na 0 2 float\n"), &["`a`", "component"]);
    refused(with("SCALARS a float\n"), &["POINT_DATA"]);
    refused(with("POINT_DATA 2\nSCALARS a floot\n"), &["data type", "`floot`"]);
    refused(with("POINTS 0 float\n"), &["second"]);
    refused(with("POLYGONS 1 4\n3 0 1 0\n"), &["surface", "not particles"]);
    refused(with("hello"), &["`HELLO`"]);
}

#[test]
fn other_files_are_refused_by_name() {
    refused(parse(b""), &["# vtk DataFile Version"]);
    refused(parse(b"<?xml version=\"1.0\"?>"), &["XML"]);
    refused(parse(b"# vtk DataFile Version 9.0\n"), &["version"]);
    refused(parse(b"# vtk DataFile Version 3.0\nt\nTEXT\n"), &["ASCII or BINARY", "`TEXT`"]);
    refused(parse(b"# vtk DataFile Version 3.0\nt\nASCII\n"), &["truncated", "DATASET"]);
    refused(parse(b"# vtk DataFile Version 3.0\nt\nASCII\nPOINTS 1 float"), &["DATASET"]);
    let grid = b"# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\n";
    refused(parse(grid), &["STRUCTURED_POINTS", "grid"]);
}

#[test]
fn counts_that_lie_are_faults() {
    for count in ["-5", "4000000000", "18446744073709551615", "99999999999999999999"] {
        for format in ["ASCII", "BINARY"] {
            let text = format!(
                "# vtk DataFile Version 3.0\nt\n{format}\nDATASET POLYDATA\nPOINTS {count} float\n0 1 2"
            );
            assert!(parse(text.as_bytes()).is_err(), "{count} {format}");
        }
    }
}
