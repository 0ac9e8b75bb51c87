//! Cells of a legacy file. Particles are its points; cells only tell whether they are particles.

use crate::frames::readers::error::Fault;
use crate::frames::readers::vtk_cells::not_particles;
use crate::frames::readers::vtk_numbers::Kind;

use super::arrays::{self, Element};
use super::cursor::Cursor;

/// Passes over the list of cells after `keyword`, in the layout of version 4 (a count and indices
/// for each cell) or 5 (OFFSETS and CONNECTIVITY arrays). Returns the number of cells.
pub(super) fn skip_list(cursor: &mut Cursor<'_>, keyword: &str) -> Result<usize, Fault> {
    let first = cursor.count("cells")?;
    let second = cursor.count("cell indices")?;
    cursor.end_of_line()?;
    // An old list cannot begin with this word: its first number would be a cell of a billion points.
    if !cursor.take_word("OFFSETS", cursor.binary) {
        arrays::skip(cursor, Element::Number(Kind::Int32), second, keyword)?;
        return Ok(first);
    }
    skip_array(cursor, first, "OFFSETS")?;
    let (word, start) = cursor.word("CONNECTIVITY")?;
    if !word.eq_ignore_ascii_case(b"CONNECTIVITY") {
        return Err(cursor.fault_at(start, "expected CONNECTIVITY after OFFSETS"));
    }
    skip_array(cursor, second, "CONNECTIVITY")?;
    // Cell i lies between offsets i and i + 1.
    Ok(first.saturating_sub(1))
}

fn skip_array(cursor: &mut Cursor<'_>, count: usize, what: &str) -> Result<(), Fault> {
    let kind = arrays::number_kind(cursor)?;
    cursor.end_of_line()?;
    arrays::skip(cursor, Element::Number(kind), count, what)
}

/// Passes over a list of lines, polygons or strips, which has to be empty.
pub(super) fn refuse_list(cursor: &mut Cursor<'_>, keyword: &str, start: usize) -> Result<(), Fault> {
    match skip_list(cursor, keyword)? {
        0 => Ok(()),
        count => {
            let what = if keyword == "LINES" { "lines" } else { "a surface" };
            Err(cursor.fault_at(
                start,
                format!("holds {what} ({keyword} {count}), not particles: expected vertex cells only"),
            ))
        }
    }
}

/// Checks that all cells under CELL_TYPES are vertices.
pub(super) fn check_types(cursor: &mut Cursor<'_>, start: usize) -> Result<(), Fault> {
    let count = cursor.count("cell types")?;
    cursor.end_of_line()?;
    // In parts, so that looking at the types takes no memory.
    const PART: usize = 4096;
    for done in (0..count).step_by(PART) {
        let part = (count - done).min(PART);
        let types = crate::frames::Column::scalars(arrays::numbers(cursor, Kind::Int32, part, "CELL_TYPES")?);
        if let Some(why) = (0..part).find_map(|i| not_particles(types.get(i, 0) as i64)) {
            return Err(cursor.fault_at(start, why));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_both_layouts_are_passed_over() {
        let mut old = Cursor::new(b" 2 4\n1 0 1 1\nX");
        assert_eq!(skip_list(&mut old, "CELLS"), Ok(2));
        assert!(old.take_word("X", false));

        let mut new = Cursor::new(b" 3 2\nOFFSETS vtktypeint64\n0 1 2\nCONNECTIVITY vtktypeint64\n0 1\nX");
        assert_eq!(skip_list(&mut new, "CELLS"), Ok(2));
        assert!(new.take_word("X", false));
    }

    #[test]
    fn a_wrong_count_does_not_eat_the_next_section() {
        let mut cursor = Cursor::new(b" 2 6\n1 0 1 1\nCELL_TYPES 2\n1 1");
        let fault = skip_list(&mut cursor, "CELLS").unwrap_err();
        assert!(fault.what.contains("CELL_TYPES"), "{}", fault.what);
    }

    #[test]
    fn other_cells_are_refused() {
        assert_eq!(check_types(&mut Cursor::new(b" 2\n1 2"), 0), Ok(()));
        assert!(check_types(&mut Cursor::new(b" 2\n1 5"), 0).unwrap_err().what.contains("surface"));
        assert_eq!(refuse_list(&mut Cursor::new(b" 0 0\n"), "POLYGONS", 0), Ok(()));
        assert!(
            refuse_list(&mut Cursor::new(b" 1 3\n2 0 1"), "LINES", 0).unwrap_err().what.contains("lines")
        );
    }
}
