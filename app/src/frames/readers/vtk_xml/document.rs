//! The XML of a file, and the appended data that is not XML.

use std::borrow::Cow;

use memchr::memmem;
use roxmltree::{Document, ParsingOptions};

use crate::frames::readers::error::{Fault, Place};

/// A file cut in two: its XML made whole again, and the bytes of its `<AppendedData>`.
pub(super) struct Parts<'a> {
    pub xml: Cow<'a, str>,
    pub appended: Option<&'a [u8]>,
}

/// Cuts the appended data out of a file. Raw appended data may hold any bytes, so this happens
/// before anything looks at the XML.
pub(super) fn split(bytes: &[u8]) -> Result<Parts<'_>, Fault> {
    let Some(tag) = memmem::find(bytes, b"<AppendedData") else {
        return Ok(Parts { xml: String::from_utf8_lossy(bytes), appended: None });
    };
    let truncated = |expected: &str| {
        let place = Place::Part("AppendedData".into());
        Fault::at(format!("truncated: expected {expected}, the file ends"), place)
    };
    let length = memchr::memchr(b'>', &bytes[tag..]).ok_or_else(|| truncated("the end of the tag"))?;
    let (head, rest) = bytes.split_at(tag + length + 1);
    if head.ends_with(b"/>") {
        return Ok(Parts { xml: String::from_utf8_lossy(bytes), appended: Some(&[]) });
    }
    let data = rest.trim_ascii_start().strip_prefix(b"_").ok_or_else(|| {
        let place = Place::Byte((bytes.len() - rest.trim_ascii_start().len()) as u64);
        Fault::at("expected `_` at the start of the appended data", place)
    })?;
    let end = memmem::rfind(data, b"</AppendedData").ok_or_else(|| truncated("`</AppendedData>`"))?;
    let (data, tail) = data.split_at(end);
    let xml = [String::from_utf8_lossy(head), String::from_utf8_lossy(tail)].concat();
    Ok(Parts { xml: xml.into(), appended: Some(data) })
}

/// The element tree of a VTK file.
pub(in crate::frames::readers) fn tree(xml: &str) -> Result<Document<'_>, Fault> {
    check_tags(xml)?;
    // Particle files have a few elements an array; the limit keeps the tree small whatever comes.
    let options = ParsingOptions { nodes_limit: 1 << 20, ..ParsingOptions::default() };
    let document = Document::parse_with_options(xml, options).map_err(|error| {
        Fault::at(format!("expected well-formed XML: {error}"), Place::Line(error.pos().row as usize))
    })?;
    match document.root_element().tag_name().name() {
        "VTKFile" => Ok(document),
        other => {
            let what = format!("expected a VTKFile element, found `{}`", other.escape_debug());
            Err(Fault::at(what, Place::Line(1)))
        }
    }
}

/// Refuses tags of absurd length: the XML parser compares every attribute of a tag with every other.
fn check_tags(xml: &str) -> Result<(), Fault> {
    const LONGEST: usize = 1 << 14;
    let bytes = xml.as_bytes();
    let mut end = 0;
    for start in memchr::memchr_iter(b'<', bytes) {
        if start < end {
            continue;
        }
        let length = memchr::memchr(b'>', &bytes[start..]).unwrap_or(bytes.len() - start);
        if length > LONGEST {
            let line = 1 + memchr::memchr_iter(b'\n', &bytes[..start]).count();
            return Err(Fault::at(
                format!("expected a tag, found {length} bytes without `>`"),
                Place::Line(line),
            ));
        }
        end = start + length;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn raw_data_is_cut_out() {
        let file = b"<VTKFile><AppendedData encoding=\"raw\">\n _\x00<\xff</AppendedData></VTKFile>";
        let parts = split(file).unwrap();
        assert_eq!(parts.appended, Some(&b"\x00<\xff"[..]));
        assert_eq!(parts.xml, "<VTKFile><AppendedData encoding=\"raw\"></AppendedData></VTKFile>");
        assert!(tree(&parts.xml).is_ok());
    }

    #[test]
    fn every_cut_is_a_fault() {
        let file = b"<VTKFile><AppendedData encoding=\"raw\">_\x00<\xff</AppendedData></VTKFile>";
        for length in 0..file.len() {
            let read = split(&file[..length]).and_then(|parts| tree(&parts.xml).map(|_| ()));
            assert!(read.is_err(), "cut at {length}");
        }
    }

    #[test]
    fn other_xml_is_refused() {
        assert!(tree("<html/>").unwrap_err().what.contains("VTKFile"));
        assert!(tree("<!DOCTYPE a [<!ENTITY b 'c'>]><VTKFile/>").is_err());
        let long = format!("<VTKFile {}/>", "a='' ".repeat(10_000));
        assert!(tree(&long).unwrap_err().what.contains("without `>`"));
    }

    #[test]
    fn deep_nesting_is_no_stack_overflow() {
        let deep = "<a>".repeat(200_000);
        assert!(tree(&deep).is_err());
        let deep = format!("<VTKFile>{deep}{}</VTKFile>", "</a>".repeat(200_000));
        assert!(tree(&deep).is_ok());
    }
}
