//! Tables of text with a header: comma, semicolon (with decimal commas), tab or blanks between cells.

use super::error::{Fault, Place};
use super::layout::{Layout, Source};
use super::text::{self, DataLines, quote};
use crate::frames::{Frame, Metadata, Numbers};

/// Reads a table. Cells are f64: nothing in a text says that it was less. An empty cell is NaN, as
/// data-frame programs write it.
pub fn parse(bytes: &[u8]) -> Result<Frame, Fault> {
    let text = text::decode(bytes);
    let (header, rows) = Header::find(text::data_lines(&text))?;
    let mut table = Table::plan(&header, rows.clone())?;
    for (line, row) in rows {
        table.push(&header, line, row)?;
    }
    let numbers = table.values.into_iter().map(Numbers::F64).collect();
    let mut frame = table.layout.frame(numbers, Metadata::default())?;
    frame.warnings = table.warnings;
    Ok(frame)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Char(char),
    Blanks,
}

impl Separator {
    /// The strongest separator of a line, outside quotes.
    fn of(line: &str) -> Separator {
        let outside: String = line.split('"').step_by(2).collect();
        [';', '\t', ','].into_iter().find(|&c| outside.contains(c)).map_or(Separator::Blanks, Separator::Char)
    }

    fn splits(self, c: char) -> bool {
        match self {
            Separator::Char(separator) => c == separator,
            Separator::Blanks => c.is_whitespace(),
        }
    }

    fn split<'a>(self, line: &'a str, cells: &mut Vec<&'a str>) {
        cells.clear();
        match self {
            _ if line.contains('"') => self.split_quoted(line, cells),
            Separator::Char(c) => cells.extend(line.split(c).map(str::trim)),
            Separator::Blanks => cells.extend(line.split_whitespace()),
        }
    }

    fn split_quoted<'a>(self, line: &'a str, cells: &mut Vec<&'a str>) {
        let mut quoted = false;
        let parts = line.split(|c: char| {
            quoted ^= c == '"';
            !quoted && self.splits(c)
        });
        for part in parts {
            let cell = part.trim();
            if self == Separator::Blanks && cell.is_empty() {
                continue;
            }
            let bare = cell.strip_prefix('"').and_then(|cell| cell.strip_suffix('"'));
            cells.push(bare.unwrap_or(cell).trim());
        }
    }
}

struct Header {
    names: Vec<String>,
    separator: Separator,
    line: usize,
}

impl Header {
    fn of(line: usize, row: &str) -> Header {
        let separator = Separator::of(row);
        let mut cells = Vec::new();
        separator.split(row, &mut cells);
        // A separator at the end of every line is not a column more.
        if cells.len() > 1 && cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        Header { names: cells.into_iter().map(str::to_owned).collect(), separator, line }
    }

    /// The header and the lines after it.
    fn find(mut lines: DataLines<'_>) -> Result<(Header, DataLines<'_>), Fault> {
        let mut comment = None;
        loop {
            let rows = lines.clone();
            let Some((number, line)) = lines.next_raw() else {
                return Err(Fault::at("empty table, expected a header line such as x,y,z", Place::Line(1)));
            };
            if line.is_empty() {
                continue;
            }
            if text::is_comment(line) {
                comment = Some((number, line));
                continue;
            }
            let header = Header::of(number, line);
            let numeric = header.names.iter().all(|name| header.separator.number(name).is_some());
            if !numeric {
                return Ok((header, lines));
            }
            // NumPy writes the header as a comment.
            let commented = comment
                .map(|(number, text)| Header::of(number, text.trim_start_matches(['#', '%', '/']).trim()));
            return match commented.filter(|names| names.names.len() == header.names.len()) {
                Some(names) => Ok((Header { separator: header.separator, ..names }, rows)),
                None => Err(Fault::at(
                    "no header: the first line holds numbers, and a header line that names the columns (x, y, z, ...) is needed",
                    Place::Line(number),
                )),
            };
        }
    }
}

impl Separator {
    fn number(self, cell: &str) -> Option<f64> {
        if let Some(value) = text::number(cell) {
            return Some(value);
        }
        let decimal_comma = self != Separator::Char(',') && !cell.contains('.');
        match cell.split_once(',') {
            Some((whole, rest)) if decimal_comma => text::number(&format!("{whole}.{rest}")),
            _ => None,
        }
    }
}

/// The numbers read so far.
struct Table<'a> {
    layout: Layout,
    /// For every column of the file its table, component there, and number of components.
    slots: Vec<Option<(usize, usize)>>,
    values: Vec<Vec<f64>>,
    cells: Vec<&'a str>,
    warnings: Vec<String>,
}

impl<'a> Table<'a> {
    /// Sorts the columns. One whose first cell is text is left out, unless it is a position.
    fn plan(header: &Header, mut rows: DataLines<'a>) -> Result<Table<'a>, Fault> {
        let at_header =
            |fault: Fault| Fault { place: fault.place.or(Some(Place::Line(header.line))), ..fault };
        let source = |name: &String| Source { name: name.clone(), components: 1, double: true };
        let all: Vec<Source> = header.names.iter().map(source).collect();
        let whole = Layout::of(&all).map_err(at_header)?;
        let mut cells = Vec::new();
        let mut warnings = Vec::new();
        let mut text_columns = vec![false; all.len()];
        if let Some((line, row)) = rows.next() {
            header.separator.split(row, &mut cells);
            for (column, (cell, slot)) in cells.iter().zip(&whole.slots).enumerate() {
                let text = !cell.is_empty() && header.separator.number(cell).is_none();
                if text && slot.0 != 0 {
                    let name = &header.names[column];
                    warnings.push(format!(
                        "column `{name}` holds text ({} in line {line}) and is left out",
                        quote(cell)
                    ));
                    text_columns[column] = true;
                }
            }
        }
        let kept: Vec<Source> = all
            .into_iter()
            .zip(&text_columns)
            .filter(|(_, text)| !**text)
            .map(|(source, _)| source)
            .collect();
        let layout = Layout::of(&kept).map_err(at_header)?;
        let mut kept_slots = layout.slots.iter().copied();
        let slots = text_columns.iter().map(|text| if *text { None } else { kept_slots.next() }).collect();
        let values = vec![Vec::new(); layout.tables.len()];
        Ok(Table { layout, slots, values, cells, warnings })
    }

    fn push(&mut self, header: &Header, line: usize, row: &'a str) -> Result<(), Fault> {
        header.separator.split(row, &mut self.cells);
        let expected = header.names.len();
        let trailing = self.cells.len() == expected + 1 && self.cells[expected].is_empty();
        if self.cells.len() != expected && !trailing {
            let found = self.cells.len();
            let what = format!("row has {found} cells, expected {expected} as in the header");
            return Err(Fault::at(what, Place::Line(line)));
        }
        for (values, table) in self.values.iter_mut().zip(&self.layout.tables) {
            values.resize(values.len() + table.components, f64::NAN);
        }
        for (column, (cell, slot)) in self.cells.iter().zip(&self.slots).enumerate() {
            let Some((table, component)) = *slot else { continue };
            if cell.is_empty() {
                continue;
            }
            let value = header.separator.number(cell).ok_or_else(|| {
                let what =
                    format!("expected a number in column `{}`, found {}", header.names[column], quote(cell));
                Fault::at(what, Place::Line(line))
            })?;
            let values = &mut self.values[table];
            let row_start = values.len() - self.layout.tables[table].components;
            values[row_start + component] = value;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> (String, Option<Place>) {
        let fault = parse(text.as_bytes()).unwrap_err();
        (fault.what, fault.place)
    }

    #[test]
    fn separators_are_found_outside_quotes() {
        for text in [
            "\"a;b\",x,y,z\n1,2,3,4\n",
            "\"a;b\";x;y;z\n1;2;3;4\n",
            "\"a;b\"\tx\ty\tz\n1\t2\t3\t4\n",
            "\"a;b\"  x y z\n 1 2   3 4\n",
        ] {
            let frame = parse(text.as_bytes()).unwrap();
            assert_eq!(frame.position(0), [2.0, 3.0, 4.0], "{text}");
            assert_eq!(frame.fields()[0].name, "a;b");
        }
    }

    #[test]
    fn decimal_commas_need_another_separator() {
        assert_eq!(parse(b"x;y;z\n1,5;-2,25;3\n").unwrap().position(0), [1.5, -2.25, 3.0]);
        assert_eq!(error("x;y;z\n1.000,5;2;3\n").1, Some(Place::Line(2)));
    }

    #[test]
    fn a_commented_header_counts_when_it_fits() {
        let frame = parse(b"# x y z m\n1 2 3 4\n").unwrap();
        assert_eq!((frame.len(), frame.fields()[0].name.as_str()), (1, "m"));
        assert!(error("# made by hand\n1 2 3 4\n").0.contains("header"));
        assert!(error("1,2,3\n").0.contains("header"));
        assert!(error("").0.contains("header"));
    }

    #[test]
    fn a_text_column_is_left_out_but_a_text_cell_is_an_error() {
        let frame = parse(b"x,y,z,kind,m\n1,2,3,fluid,4\n1,2,3,wall,5\n").unwrap();
        assert_eq!(frame.fields().len(), 1);
        assert!(frame.warnings[0].contains("kind"));
        assert_eq!(error("x,y,z,m\n1,2,3,4\n1,2,3,n/a\n").1, Some(Place::Line(3)));
        assert_eq!(error("x,y,z\nn/a,2,3\n").1, Some(Place::Line(2)));
        assert_eq!(error("x,y,z\n1,2,3\n\n1,2\n").1, Some(Place::Line(4)));
    }

    #[test]
    fn an_empty_cell_is_not_a_number_and_a_last_separator_is_nothing() {
        let frame = parse(b"x,y,z,m,\n1,2,3,,\n").unwrap();
        assert!(frame.fields()[0].column.get(0, 0).is_nan());
        assert_eq!(frame.fields().len(), 1);
    }
}
