//! The arrays under POINT_DATA and CELL_DATA, each announced by the keyword of its role.

use crate::frames::Numbers;
use crate::frames::readers::error::Fault;
use crate::frames::readers::vtk_numbers::{Kind, shown};

use super::arrays::{self, Element};
use super::cursor::Cursor;

/// The head of an array, read up to its numbers.
pub(super) struct Head {
    pub name: String,
    pub components: usize,
    pub rows: usize,
    pub element: Element,
    /// Colours, which are bytes in a binary file and shares of one in a text.
    colours: bool,
}

/// Keywords that announce an array.
const ROLES: [&str; 11] = [
    "SCALARS",
    "COLOR_SCALARS",
    "LOOKUP_TABLE",
    "TEXTURE_COORDINATES",
    "VECTORS",
    "NORMALS",
    "TENSORS",
    "TENSORS6",
    "GLOBAL_IDS",
    "PEDIGREE_IDS",
    "EDGE_FLAGS",
];

/// The head of the array that `keyword` announces for each of `rows` points or cells; `None` for a
/// colour table, which is passed over.
pub(super) fn head(
    cursor: &mut Cursor<'_>,
    keyword: &str,
    start: usize,
    rows: usize,
) -> Result<Option<Head>, Fault> {
    if !ROLES.contains(&keyword) {
        let found = shown(keyword.as_bytes());
        return Err(cursor.fault_at(start, format!("expected a section such as POINT_DATA, found {found}")));
    }
    let (name, _) = cursor.word("the name of an array")?;
    let name = decoded(name);
    let (components, kind) = match keyword {
        "SCALARS" => {
            let kind = arrays::number_kind(cursor)?;
            let components = scalar_components(cursor)?;
            (components, kind)
        }
        "COLOR_SCALARS" => (cursor.count("colour channels")?, Kind::UInt8),
        "LOOKUP_TABLE" => {
            let size = cursor.count("colours")?;
            cursor.end_of_line()?;
            let values = arrays::size(cursor, size, 4, "LOOKUP_TABLE")?;
            arrays::skip(cursor, Element::Number(Kind::UInt8), values, "LOOKUP_TABLE")?;
            return Ok(None);
        }
        "TEXTURE_COORDINATES" => (cursor.count("texture coordinates")?, arrays::number_kind(cursor)?),
        "VECTORS" | "NORMALS" => (3, arrays::number_kind(cursor)?),
        "TENSORS" => (9, arrays::number_kind(cursor)?),
        "TENSORS6" => (6, arrays::number_kind(cursor)?),
        // Identifiers and flags.
        _ => {
            let element = arrays::element(cursor)?;
            cursor.end_of_line()?;
            return Ok(Some(Head { name, components: 1, rows, element, colours: false }));
        }
    };
    cursor.end_of_line()?;
    if keyword == "SCALARS" && cursor.take_word("LOOKUP_TABLE", cursor.binary) {
        cursor.line();
    }
    let colours = keyword == "COLOR_SCALARS";
    Ok(Some(Head { name, components, rows, element: Element::Number(kind), colours }))
}

/// The number of components that may end a SCALARS line.
fn scalar_components(cursor: &mut Cursor<'_>) -> Result<usize, Fault> {
    let start = cursor.position();
    let line_is_done = cursor.line().is_empty();
    cursor.words.position = start;
    if line_is_done { Ok(1) } else { cursor.count("components") }
}

/// The head of the next array of a FIELD; `None` for the place of an array that the writer left out.
pub(super) fn field_head(cursor: &mut Cursor<'_>) -> Result<Option<Head>, Fault> {
    let (name, _) = loop {
        let found = cursor.word("the name of an array")?;
        match found.0 {
            b"METADATA" => arrays::skip_metadata(cursor),
            b"NULL_ARRAY" => return Ok(None),
            _ => break found,
        }
    };
    let name = decoded(name);
    let components = cursor.count("components")?;
    let rows = cursor.count("rows")?;
    let element = arrays::element(cursor)?;
    cursor.end_of_line()?;
    Ok(Some(Head { name, components, rows, element, colours: false }))
}

impl Head {
    /// The numbers that follow; `None` for strings, which are passed over.
    pub fn numbers(&self, cursor: &mut Cursor<'_>) -> Result<Option<Numbers>, Fault> {
        let what = self.what();
        let count = arrays::size(cursor, self.rows, self.components, &what)?;
        match self.element {
            Element::Number(kind) => {
                let mut numbers = arrays::numbers(cursor, kind, count, &what)?;
                if let (true, false, Numbers::F64(shares)) = (self.colours, cursor.binary, &mut numbers) {
                    shares.iter_mut().for_each(|share| *share = (*share * 255.0).round());
                }
                Ok(Some(numbers))
            }
            Element::Text => arrays::skip(cursor, Element::Text, count, &what).map(|()| None),
        }
    }

    pub fn skip(&self, cursor: &mut Cursor<'_>) -> Result<(), Fault> {
        let what = self.what();
        let count = arrays::size(cursor, self.rows, self.components, &what)?;
        arrays::skip(cursor, self.element, count, &what)
    }

    /// The array as errors name it.
    pub fn what(&self) -> String {
        format!("array {}", shown(self.name.as_bytes()))
    }
}

/// A name as it was before the writer replaced its spaces and the like by `%20` and the like.
fn decoded(word: &[u8]) -> String {
    percent_encoding::percent_decode(word).decode_utf8_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(text: &str, keyword: &str) -> Head {
        head(&mut Cursor::new(text.as_bytes()), keyword, 0, 2).unwrap().unwrap()
    }

    #[test]
    fn every_role_has_its_components() {
        for (keyword, line, components) in [
            ("SCALARS", " a float\nLOOKUP_TABLE default\n", 1),
            ("SCALARS", " a float 2\nLOOKUP_TABLE default\n", 2),
            ("SCALARS", " a float\n", 1),
            ("COLOR_SCALARS", " a 4\n", 4),
            ("VECTORS", " a double\n", 3),
            ("NORMALS", " a double\n", 3),
            ("TENSORS", " a double\n", 9),
            ("TEXTURE_COORDINATES", " a 2 float\n", 2),
            ("GLOBAL_IDS", " a vtkIdType\n", 1),
        ] {
            assert_eq!(first(line, keyword).components, components, "{keyword}");
        }
    }

    #[test]
    fn names_lose_their_escapes() {
        assert_eq!(first(" mass%20flux float\n", "SCALARS").name, "mass flux");
    }

    #[test]
    fn colours_are_bytes_in_text_too() {
        let mut cursor = Cursor::new(b" c 2\n0 0.2 1 0.5\n");
        let colours = head(&mut cursor, "COLOR_SCALARS", 0, 2).unwrap().unwrap().numbers(&mut cursor);
        assert_eq!(colours, Ok(Some(Numbers::F64(vec![0.0, 51.0, 255.0, 128.0]))));
    }

    #[test]
    fn unknown_sections_are_faults() {
        let fault = head(&mut Cursor::new(b" a float\n"), "SCALAR", 0, 2).err().unwrap();
        assert!(fault.what.contains("`SCALAR`"), "{}", fault.what);
    }

    #[test]
    fn field_arrays_may_have_metadata_between_them() {
        let text = b"METADATA\nINFORMATION 0\n\nv 3 2 float\n1 2 3 4 5 6";
        let mut cursor = Cursor::new(text);
        let head = field_head(&mut cursor).unwrap().unwrap();
        assert_eq!((head.name.as_str(), head.components, head.rows), ("v", 3, 2));
        assert_eq!(head.numbers(&mut cursor).unwrap().map(|n| n.len()), Some(6));
        assert!(field_head(&mut Cursor::new(b"NULL_ARRAY\n")).unwrap().is_none());
    }
}
