//! `<Piece>` elements: the points and arrays of each, and all of them joined.

use roxmltree::Node;

use crate::frames::readers::error::{Fault, Place};
use crate::frames::readers::vtk_cells::not_particles;
use crate::frames::{Column, Field, Numbers};

use super::arrays::{Array, Store};

/// The points of one piece, or of several joined.
pub(super) struct Points {
    pub positions: Column,
    pub fields: Vec<Field>,
    /// Names of the arrays that were left out.
    pub cell_arrays: Vec<String>,
    pub text_arrays: Vec<String>,
}

/// A `<Piece>` and how errors name it.
struct Piece<'a, 'i> {
    node: Node<'a, 'i>,
    label: String,
}

/// All pieces under `data`, the element of the data set, joined in their order.
pub(super) fn read(data: Node<'_, '_>, store: &Store<'_>) -> Result<Points, Fault> {
    let pieces: Vec<_> = data.children().filter(|node| node.has_tag_name("Piece")).collect();
    let many = pieces.len() > 1;
    let mut joined: Option<Points> = None;
    for (index, node) in pieces.into_iter().enumerate() {
        let piece = Piece { node, label: if many { format!("Piece {index} ") } else { String::new() } };
        let points = piece.points(store)?;
        joined = Some(match joined {
            None => points,
            // Parallel writers leave the arrays out of empty pieces.
            Some(before) if points.positions.is_empty() => before,
            Some(before) if before.positions.is_empty() => points,
            Some(before) => piece.join(before, points)?,
        });
    }
    joined.ok_or_else(|| {
        Fault::at("expected a Piece element, found none", Place::Part(data.tag_name().name().into()))
    })
}

impl<'a, 'i> Piece<'a, 'i> {
    fn points(&self, store: &Store<'_>) -> Result<Points, Fault> {
        let rows =
            self.count("NumberOfPoints")?.ok_or_else(|| self.fault("expected NumberOfPoints, found none"))?;
        self.check_cells(store)?;
        let positions = match self.arrays("Points").into_iter().next() {
            Some(array) if array.components()? == 3 => array.column(store, rows)?,
            Some(array) => {
                let what = format!("expected NumberOfComponents of 3, found {}", array.components()?);
                return Err(array.fault(what));
            }
            None if rows == 0 => {
                Column::new(3, Numbers::F32(Vec::new())).ok_or_else(|| self.fault("no points"))?
            }
            None => return Err(self.fault(format!("expected an array of {rows} Points, found none"))),
        };
        let (mut fields, mut text_arrays) = (Vec::new(), Vec::new());
        for array in self.arrays("PointData") {
            if array.is_text() {
                text_arrays.push(array.name.to_owned());
            } else {
                fields.push(Field { name: array.name.to_owned(), column: array.column(store, rows)? });
            }
        }
        let cell_arrays = self.arrays("CellData").iter().map(|array| array.name.to_owned()).collect();
        Ok(Points { positions, fields, cell_arrays, text_arrays })
    }

    /// Checks that the piece has no cells but vertices.
    fn check_cells(&self, store: &Store<'_>) -> Result<(), Fault> {
        for (attribute, what) in
            [("NumberOfLines", "lines"), ("NumberOfStrips", "a surface"), ("NumberOfPolys", "a surface")]
        {
            if let Some(count) = self.count(attribute)?.filter(|&count| count > 0) {
                let why =
                    format!("holds {what} ({attribute} {count}), not particles: expected vertex cells only");
                return Err(self.fault(why));
            }
        }
        let Some(cells) = self.count("NumberOfCells")?.filter(|&cells| cells > 0) else {
            return Ok(());
        };
        let Some(types) = self.arrays("Cells").into_iter().find(|array| array.name == "types") else {
            return Err(self.fault(format!("expected the types of {cells} Cells, found none")));
        };
        let column = types.column(store, cells)?;
        store.give_back(&column);
        match (0..column.len()).find_map(|cell| not_particles(column.get(cell, 0) as i64)) {
            Some(why) => Err(types.fault(why)),
            None => Ok(()),
        }
    }

    /// The arrays in a section such as `PointData`.
    fn arrays(&self, section: &str) -> Vec<Array<'a, 'i>> {
        let part = format!("{}{section}", self.label);
        self.node
            .children()
            .filter(|node| node.has_tag_name(section))
            .flat_map(|section| section.children())
            .filter(|node| node.is_element())
            .map(|node| Array::new(node, &part))
            .collect()
    }

    fn count(&self, attribute: &str) -> Result<Option<usize>, Fault> {
        let Some(text) = self.node.attribute(attribute) else {
            return Ok(None);
        };
        text.trim().parse().map(Some).map_err(|_| {
            self.fault(format!("expected a count as {attribute}, found `{}`", text.escape_debug()))
        })
    }

    fn fault(&self, what: impl Into<String>) -> Fault {
        Fault::at(
            what,
            Place::Part(if self.label.is_empty() { "Piece" } else { self.label.trim_end() }.into()),
        )
    }

    fn join(&self, before: Points, after: Points) -> Result<Points, Fault> {
        let Points { positions, mut fields, mut cell_arrays, mut text_arrays } = after;
        let mut joined = Vec::with_capacity(before.fields.len());
        for field in before.fields {
            let same = fields.iter().position(|other| {
                other.name == field.name && other.column.components() == field.column.components()
            });
            let Some(same) = same else {
                let what = format!(
                    "expected a PointData array `{}` of {} components, like the pieces before, found none",
                    field.name.escape_debug(),
                    field.column.components()
                );
                return Err(self.fault(what));
            };
            let column = self.append(field.column, fields.swap_remove(same).column)?;
            joined.push(Field { name: field.name, column });
        }
        if let Some(extra) = fields.first() {
            let what = format!(
                "expected the PointData of the pieces before, found also `{}`",
                extra.name.escape_debug()
            );
            return Err(self.fault(what));
        }
        cell_arrays.retain(|name| !before.cell_arrays.contains(name));
        text_arrays.retain(|name| !before.text_arrays.contains(name));
        Ok(Points {
            positions: self.append(before.positions, positions)?,
            fields: joined,
            cell_arrays: [before.cell_arrays, cell_arrays].concat(),
            text_arrays: [before.text_arrays, text_arrays].concat(),
        })
    }

    /// One column after the other, in double precision where either is.
    fn append(&self, before: Column, after: Column) -> Result<Column, Fault> {
        let components = before.components();
        let numbers = match (before.into_numbers(), after.into_numbers()) {
            (Numbers::F32(mut before), Numbers::F32(after)) => {
                before.extend(after);
                Numbers::F32(before)
            }
            (before, after) => {
                let mut all = doubles(before);
                all.extend(doubles(after));
                Numbers::F64(all)
            }
        };
        Column::new(components, numbers).ok_or_else(|| self.fault("expected whole rows"))
    }
}

fn doubles(numbers: Numbers) -> Vec<f64> {
    match numbers {
        Numbers::F32(numbers) => numbers.into_iter().map(f64::from).collect(),
        Numbers::F64(numbers) => numbers,
    }
}
