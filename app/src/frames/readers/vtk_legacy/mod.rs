//! Legacy VTK files, versions 1 to 5, text or binary: the points of a POLYDATA or
//! UNSTRUCTURED_GRID and the arrays over them.

mod arrays;
mod attributes;
mod cells;
mod cursor;

use crate::frames::{Column, Field, Frame, Metadata};

use super::error::Fault;
use super::vtk_numbers::shown;
use attributes::Head;
use cursor::Cursor;

/// Reads a legacy `.vtk` file.
pub fn parse(bytes: &[u8]) -> Result<Frame, Fault> {
    let mut cursor = Cursor::new(bytes);
    header(&mut cursor)?;
    let mut reader = Reader::new(cursor);
    while let Some((keyword, start)) = reader.cursor.keyword() {
        reader.section(&keyword, start)?;
    }
    reader.finish()
}

/// The three lines that every file begins with: version, title, ASCII or BINARY.
fn header(cursor: &mut Cursor<'_>) -> Result<(), Fault> {
    const START: &[u8] = b"# vtk DataFile Version ";
    let first = cursor.line();
    let version = match first.split_at_checked(START.len()) {
        Some((start, version)) if start.eq_ignore_ascii_case(START) => version,
        _ if first.starts_with(b"<") => {
            return Err(cursor.fault_at(0, "expected a legacy VTK file, found XML (a .vtu or .vtp file?)"));
        }
        _ => {
            let found = if first.is_empty() { "an empty line or file".into() } else { shown(first) };
            let what = format!("expected `# vtk DataFile Version` and a number, found {found}");
            return Err(cursor.fault_at(0, what));
        }
    };
    if !matches!(version.trim_ascii(), [b'1'..=b'5', b'.', b'0'..=b'9']) {
        let what = format!("expected a VTK file version from 1.0 to 5.1, found {}", shown(version));
        return Err(cursor.fault_at(0, what));
    }
    cursor.line();
    let (format, start) = cursor.word("ASCII or BINARY")?;
    cursor.binary = match format.to_ascii_uppercase().as_slice() {
        b"ASCII" => false,
        b"BINARY" => true,
        _ => {
            return Err(cursor.fault_at(start, format!("expected ASCII or BINARY, found {}", shown(format))));
        }
    };
    Ok(())
}

/// What the arrays that follow belong to.
#[derive(Clone, Copy)]
enum Owner {
    File,
    Points,
    Cells { count: usize },
}

struct Reader<'a> {
    cursor: Cursor<'a>,
    dataset: bool,
    positions: Option<Column>,
    owner: Owner,
    fields: Vec<Field>,
    metadata: Metadata,
    cell_arrays: usize,
    string_arrays: usize,
}

impl<'a> Reader<'a> {
    fn new(cursor: Cursor<'a>) -> Self {
        Reader {
            cursor,
            dataset: false,
            positions: None,
            owner: Owner::File,
            fields: Vec::new(),
            metadata: Metadata::default(),
            cell_arrays: 0,
            string_arrays: 0,
        }
    }

    /// Reads what follows `keyword`, which starts at byte `start`.
    fn section(&mut self, keyword: &str, start: usize) -> Result<(), Fault> {
        match keyword {
            "DATASET" => self.dataset(start),
            "FIELD" => self.field(),
            "METADATA" => {
                arrays::skip_metadata(&mut self.cursor);
                Ok(())
            }
            _ if !self.dataset => Err(self
                .cursor
                .fault_at(start, format!("expected DATASET, found {}", shown(keyword.as_bytes())))),
            "POINTS" => self.points(start),
            "CELLS" | "VERTICES" => cells::skip_list(&mut self.cursor, keyword).map(|_| ()),
            "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" => cells::refuse_list(&mut self.cursor, keyword, start),
            "CELL_TYPES" => cells::check_types(&mut self.cursor, start),
            "POINT_DATA" => self.point_data(start),
            "CELL_DATA" => {
                self.owner = Owner::Cells { count: self.cursor.count("cells")? };
                self.cursor.end_of_line()
            }
            _ => self.attribute(keyword, start),
        }
    }

    fn dataset(&mut self, start: usize) -> Result<(), Fault> {
        let (word, _) = self.cursor.word("the type of the data set")?;
        let name = word.to_ascii_uppercase();
        if self.dataset {
            return Err(self.cursor.fault_at(start, "expected one DATASET, found a second one"));
        }
        self.dataset = matches!(name.as_slice(), b"POLYDATA" | b"UNSTRUCTURED_GRID");
        if self.dataset {
            return Ok(());
        }
        let what = format!("expected DATASET POLYDATA or UNSTRUCTURED_GRID, found {}", shown(word));
        let grids: [&[u8]; 3] = [b"STRUCTURED_POINTS", b"STRUCTURED_GRID", b"RECTILINEAR_GRID"];
        let what = if grids.contains(&name.as_slice()) { what + ": a grid, not particles" } else { what };
        Err(self.cursor.fault_at(start, what))
    }

    fn points(&mut self, start: usize) -> Result<(), Fault> {
        if self.positions.is_some() {
            return Err(self.cursor.fault_at(start, "expected one POINTS section, found a second one"));
        }
        let count = self.cursor.count("points")?;
        let kind = arrays::number_kind(&mut self.cursor)?;
        self.cursor.end_of_line()?;
        let values = arrays::size(&self.cursor, count, 3, "POINTS")?;
        let numbers = arrays::numbers(&mut self.cursor, kind, values, "POINTS")?;
        self.positions = Column::new(3, numbers);
        Ok(())
    }

    fn point_data(&mut self, start: usize) -> Result<(), Fault> {
        let count = self.cursor.count("points")?;
        self.cursor.end_of_line()?;
        match &self.positions {
            Some(positions) if positions.len() == count => {
                self.owner = Owner::Points;
                Ok(())
            }
            Some(positions) => {
                let what =
                    format!("expected POINT_DATA {}, one row for each point, found {count}", positions.len());
                Err(self.cursor.fault_at(start, what))
            }
            None => Err(self.cursor.fault_at(start, "expected POINTS before POINT_DATA")),
        }
    }

    fn field(&mut self) -> Result<(), Fault> {
        self.cursor.word("the name of the field")?;
        let count = self.cursor.count("arrays")?;
        for _ in 0..count {
            let start = self.cursor.position();
            if let Some(head) = attributes::field_head(&mut self.cursor)? {
                self.array(head, start)?;
            }
        }
        Ok(())
    }

    fn attribute(&mut self, keyword: &str, start: usize) -> Result<(), Fault> {
        let rows = match self.owner {
            // The arrays know their section; without one only their names can be checked.
            Owner::File => 0,
            Owner::Points => self.positions.as_ref().map_or(0, Column::len),
            Owner::Cells { count } => count,
        };
        let head = attributes::head(&mut self.cursor, keyword, start, rows)?;
        match (head, self.owner) {
            (None, _) => Ok(()),
            (Some(_), Owner::File) => {
                Err(self.cursor.fault_at(start, format!("expected POINT_DATA or CELL_DATA before {keyword}")))
            }
            (Some(head), _) => self.array(head, start),
        }
    }

    /// Keeps or passes over the array whose head was read.
    fn array(&mut self, head: Head, start: usize) -> Result<(), Fault> {
        match self.owner {
            Owner::Cells { .. } => {
                self.cell_arrays += 1;
                head.skip(&mut self.cursor)
            }
            Owner::File if is_time(&head.name) => {
                let time = head.numbers(&mut self.cursor)?.filter(|time| !time.is_empty());
                self.metadata.time = time.map(|time| Column::scalars(time).get(0, 0)).or(self.metadata.time);
                Ok(())
            }
            Owner::File => head.skip(&mut self.cursor),
            Owner::Points => self.point_array(head, start),
        }
    }

    fn point_array(&mut self, head: Head, start: usize) -> Result<(), Fault> {
        let points = self.positions.as_ref().map_or(0, Column::len);
        if head.rows != points {
            let what =
                format!("{}: expected {points} rows, one for each point, found {}", head.what(), head.rows);
            return Err(self.cursor.fault_at(start, what));
        }
        if head.components == 0 {
            let what = format!("{}: expected at least one component, found 0", head.what());
            return Err(self.cursor.fault_at(start, what));
        }
        match head.numbers(&mut self.cursor)? {
            Some(numbers) => {
                let column = Column::new(head.components, numbers);
                self.fields.extend(column.map(|column| Field { name: head.name, column }));
            }
            None => self.string_arrays += 1,
        }
        Ok(())
    }

    fn finish(self) -> Result<Frame, Fault> {
        let Some(positions) = self.positions else {
            let expected = if self.dataset { "POINTS" } else { "DATASET" };
            return Err(self.cursor.fault(format!("truncated: expected {expected}, the file ends")));
        };
        let mut frame = Frame::new(positions, self.fields, self.metadata)
            .map_err(|error| self.cursor.fault(error.to_string()))?;
        if self.cell_arrays > 0 {
            let warning = format!("{} arrays over cells left out: particles are points", self.cell_arrays);
            frame.warnings.push(warning);
        }
        if self.string_arrays > 0 {
            frame.warnings.push(format!("{} arrays of strings left out", self.string_arrays));
        }
        Ok(frame)
    }
}

/// Whether an array over the whole file is the time of the frame, as VisIt or ParaView names it.
fn is_time(name: &str) -> bool {
    ["TIME", "TimeValue"].iter().any(|time| name.eq_ignore_ascii_case(time))
}

#[cfg(test)]
mod tests;
