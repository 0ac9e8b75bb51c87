use super::*;
use crate::frames::Numbers;

/// A file of pieces with text arrays.
fn file(attributes: &str, content: &str) -> String {
    format!(
        r#"<?xml version="1.0"?><VTKFile type="UnstructuredGrid" {attributes}><UnstructuredGrid>{content}</UnstructuredGrid></VTKFile>"#
    )
}

fn array(name: &str, kind: &str, components: usize, text: &str) -> String {
    format!(
        r#"<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">{text}</DataArray>"#
    )
}

fn piece(points: usize, positions: &str, fields: &str) -> String {
    let positions = array("Points", "Float32", 3, positions);
    format!(
        r#"<Piece NumberOfPoints="{points}" NumberOfCells="0"><PointData>{fields}</PointData><Points>{positions}</Points></Piece>"#
    )
}

#[track_caller]
fn refused(file: &str, words: &[&str]) {
    let fault = parse(file.as_bytes()).expect_err("was read");
    let place = fault.place.as_ref().map(ToString::to_string).unwrap_or_default();
    let said = format!("{}: {place}", fault.what);
    for word in words {
        assert!(said.contains(word), "`{said}` does not say `{word}`");
    }
    assert!(fault.place.is_some(), "`{said}` has no place");
}

#[test]
fn pieces_are_joined() {
    let a = piece(1, "0 1 2", &[array("m", "Float32", 1, "5"), array("v", "Int8", 2, "1 2")].concat());
    let b = piece(1, "3 4 5", &[array("v", "Int8", 2, "3 4"), array("m", "Float64", 1, "6")].concat());
    let empty = r#"<Piece NumberOfPoints="0" NumberOfCells="0"/>"#;
    let frame = parse(file("", &[empty, &a, empty, &b].concat()).as_bytes()).unwrap();
    assert_eq!(frame.positions().numbers(), &Numbers::F32(vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]));
    assert_eq!(frame.fields()[0].column.numbers(), &Numbers::F64(vec![5.0, 6.0]));
    assert_eq!(frame.fields()[1].column.numbers(), &Numbers::F64(vec![1.0, 2.0, 3.0, 4.0]));

    let without = piece(1, "3 4 5", &array("m", "Float32", 1, "6"));
    refused(&file("", &[&*a, &without].concat()), &["`v`", "Piece 1"]);
    refused(&file("", &[&*without, &a].concat()), &["`v`", "Piece 1"]);
    assert_eq!(parse(file("", empty).as_bytes()).unwrap().len(), 0);
}

#[test]
fn time_and_left_out_arrays() {
    let time = format!("<FieldData>{}</FieldData>", array("TimeValue", "Float64", 1, "0.125"));
    let cells = format!("<CellData>{}</CellData>", array("c", "Float32", 1, "1"));
    let names = r#"<Array type="String" Name="s" format="ascii">65 0</Array>"#;
    let content = time + &piece(1, "0 1 2", names).replace("<PointData>", &(cells + "<PointData>"));
    let frame = parse(file("", &content).as_bytes()).unwrap();
    assert_eq!(frame.metadata.time, Some(0.125));
    assert_eq!(frame.warnings.len(), 2, "{:?}", frame.warnings);
}

#[test]
fn base64_may_be_broken_into_lines_and_followed_by_elements() {
    let points = r#"<DataArray type="Float32" NumberOfComponents="3" format="binary">
        DAAAAAAAAA
        AAAIA/AAAAQA==
        <InformationKey name="a"><Value>1</Value></InformationKey></DataArray>"#;
    let content = format!(r#"<Piece NumberOfPoints="1"><Points>{points}</Points></Piece>"#);
    let frame = parse(file(r#"byte_order="LittleEndian""#, &content).as_bytes()).unwrap();
    assert_eq!(frame.position(0), [0.0, 1.0, 2.0]);
}

#[test]
fn faults_name_the_array() {
    let mass = |text: &str| file("", &piece(2, "0 1 2 3 4 5", &array("m", "Float32", 1, text)));
    refused(&mass("1"), &["expected 2 values, found 1", "PointData array `m`"]);
    refused(&mass("1 2 3"), &["found 1 more", "`m`"]);
    refused(&mass("1 x"), &["`x`", "`m`"]);
    refused(&file("", &piece(99_999_999_999_999, "0", "")), &["Points array `Points`"]);
    refused(&file("", &piece(usize::MAX, "0", "")), &["Points array `Points`"]);
    refused(&file("", r#"<Piece NumberOfPoints="-1"/>"#), &["NumberOfPoints", "`-1`", "Piece"]);
    refused(&file("", r#"<Piece/>"#), &["NumberOfPoints"]);
    refused(&file("", r#"<Piece NumberOfPoints="1"/>"#), &["Points"]);
    refused(&file("", ""), &["Piece"]);
    let sound = file("", &piece(1, "0 1 2", ""));
    refused(&sound.replace("\"3\"", "\"2\""), &["3, found 2"]);
    refused(&sound.replace("\"3\"", "\"0\""), &["NumberOfComponents"]);
    refused(&sound.replace("Float32", "Float16"), &["`Float16`"]);
    refused(&sound.replace("ascii", "hex"), &["`hex`"]);
    refused(&sound.replace("ascii", "appended"), &["AppendedData"]);
}

#[test]
fn other_files_and_layouts_are_refused_by_name() {
    let sound = |attributes: &str| file(attributes, &piece(1, "0 1 2", ""));
    assert!(parse(sound("").as_bytes()).is_ok());
    assert!(parse(format!("\u{feff}{}", sound("")).as_bytes()).is_ok());
    refused(&sound(r#"compressor="vtkLZMADataCompressor""#), &["vtkLZMADataCompressor", "compressor"]);
    refused(&sound(r#"header_type="UInt16""#), &["`UInt16`", "header_type"]);
    refused(&sound(r#"byte_order="PDP""#), &["`PDP`", "byte_order"]);
    for (kind, word) in
        [("ImageData", "grid"), ("Collection", ".pvd"), ("PPolyData", "other files"), ("x", "`x`")]
    {
        refused(&sound("").replacen("UnstructuredGrid", kind, 1), &[word, "VTKFile type"]);
    }
    refused("", &["XML"]);
    refused("# vtk DataFile Version 3.0", &["XML"]);
    refused("<VTKFile", &["XML", "line 1"]);
}

#[test]
fn cells_other_than_vertices_are_refused() {
    let cells = |types: &str| {
        let types = array("types", "UInt8", 1, types);
        let content = piece(1, "0 1 2", "").replace("NumberOfCells=\"0\"", "NumberOfCells=\"1\"");
        file("", &content.replace("</Piece>", &format!("<Cells>{types}</Cells></Piece>")))
    };
    assert!(parse(cells("1").as_bytes()).is_ok());
    refused(&cells("5"), &["surface", "`types`"]);
    refused(&file("", r#"<Piece NumberOfPoints="3" NumberOfPolys="1"/>"#), &["surface"]);
    refused(&file("", r#"<Piece NumberOfPoints="3" NumberOfLines="1"/>"#), &["lines"]);
}

#[test]
fn arrays_that_share_their_bytes_cannot_outgrow_the_file() {
    let zeros = vec![0u8; 3 << 20];
    let data = [&((zeros.len() as u32).to_le_bytes())[..], zeros.as_slice()].concat();
    let points = zeros.len() / 12;
    let shared = r#"<DataArray type="Float32" NumberOfComponents="3" format="appended" offset="0"/>"#;
    let head = format!(
        r#"<VTKFile type="UnstructuredGrid"><UnstructuredGrid><Piece NumberOfPoints="{points}"><Points>{shared}</Points><PointData>{}</PointData></Piece></UnstructuredGrid><AppendedData encoding="raw">_"#,
        shared.repeat(200)
    );
    let file = [head.as_bytes(), &data, b"</AppendedData></VTKFile>"].concat();
    let fault = parse(&file).unwrap_err();
    assert!(fault.what.contains("memory"), "{}", fault.what);
}
