//! ParaView collections (`.pvd`): which files are the frames of a run, and when.

use std::path::PathBuf;

use super::error::{Fault, Place};
use super::vtk_xml;

/// A file of a collection.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    pub time: f64,
    /// As the collection has it: relative to the collection's own directory, or absolute.
    pub path: PathBuf,
}

/// The files of a collection in the order of their times; files of one time keep their order.
pub fn parse(bytes: &[u8]) -> Result<Vec<Entry>, Fault> {
    let text = std::str::from_utf8(bytes)
        .map_err(|error| Fault::at("expected UTF-8 text", Place::Byte(error.valid_up_to() as u64)))?;
    let document = vtk_xml::tree(text)?;
    let collection = document.root_element().children().find(|node| node.has_tag_name("Collection"));
    let collection = collection.ok_or_else(|| {
        Fault::at("expected a Collection element, found none", Place::Part("VTKFile".into()))
    })?;
    let mut entries = Vec::new();
    for (index, node) in collection.children().filter(|node| node.has_tag_name("DataSet")).enumerate() {
        let fault = |what: String| Fault::at(what, Place::Part(format!("DataSet {index}")));
        let path = node.attribute("file").filter(|file| !file.is_empty());
        let path = path.ok_or_else(|| fault("expected the name of a file, found none".into()))?.into();
        let timestep = node.attribute("timestep").unwrap_or("none");
        let time = timestep.trim().parse::<f64>().ok().filter(|time| time.is_finite());
        let time = time.ok_or_else(|| {
            fault(format!("expected a time as timestep, found `{}`", timestep.escape_debug()))
        })?;
        entries.push(Entry { time, path });
    }
    entries.sort_by(|a, b| a.time.total_cmp(&b.time));
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn collection(data_sets: &str) -> Result<Vec<Entry>, Fault> {
        let file = format!(r#"<VTKFile type="Collection"><Collection>{data_sets}</Collection></VTKFile>"#);
        parse(file.as_bytes())
    }

    #[test]
    fn entries_come_in_time_order() {
        let entries = collection(
            r#"<DataSet timestep="1e1" part="0" file="b.vtu"/><DataSet timestep="9" group="" part="0" file="data/a.vtu"/>
               <DataSet timestep="9.0" part="1" file="c.vtu"/>"#,
        );
        let expected = [(9.0, "data/a.vtu"), (9.0, "c.vtu"), (10.0, "b.vtu")];
        assert_eq!(entries.unwrap(), expected.map(|(time, path)| Entry { time, path: path.into() }));
        assert_eq!(collection(""), Ok(vec![]));
    }

    #[test]
    fn faults_name_the_data_set() {
        let sound = r#"<DataSet timestep="0" file="a.vtu"/>"#;
        for broken in [
            r#"<DataSet timestep="0"/>"#,
            r#"<DataSet file="a.vtu"/>"#,
            r#"<DataSet timestep="soon" file="a.vtu"/>"#,
            r#"<DataSet timestep="nan" file="a.vtu"/>"#,
        ] {
            let fault = collection(&format!("{sound}{broken}")).unwrap_err();
            assert_eq!(fault.place, Some(Place::Part("DataSet 1".into())), "{broken}");
        }
        for other in [&b"<VTKFile/>"[..], b"<a/>", b"", b"\xff", b"<VTKFile><Collection>"] {
            assert!(parse(other).is_err());
        }
    }
}
