//! From named columns to a frame: which are positions, which together are one vector.

use super::error::Fault;
use super::rows::zeroed;
use crate::frames::names::{VELOCITY_COMPONENTS, canonical};
use crate::frames::{Column, Field, Frame, Metadata, Numbers};

/// Names of a three-component column that holds positions, in lower case.
const POSITION_NAMES: [&str; 9] =
    ["position", "positions", "pos", "coords", "coordinates", "points", "point", "xyz", "x"];

/// Names of three columns that together are positions, in lower case; the first complete set wins.
const POSITION_COMPONENTS: [[&str; 3]; 13] = [
    ["x", "y", "z"],
    ["points:0", "points:1", "points:2"],
    PARAVIEW_POINTS,
    ["position_x", "position_y", "position_z"],
    ["position.x", "position.y", "position.z"],
    ["position:0", "position:1", "position:2"],
    ["pos_x", "pos_y", "pos_z"],
    ["pos.x", "pos.y", "pos.z"],
    ["posx", "posy", "posz"],
    ["coordinates_x", "coordinates_y", "coordinates_z"],
    ["coordinates:0", "coordinates:1", "coordinates:2"],
    ["coords_x", "coords_y", "coords_z"],
    ["px", "py", "pz"],
];

const PARAVIEW_POINTS: [&str; 3] = ["points_0", "points_1", "points_2"];

/// Endings that make `name` + ending the components of a vector `name`.
const VECTOR_ENDINGS: [[&str; 4]; 3] =
    [[":0", ":1", ":2", ":3"], ["_x", "_y", "_z", "_w"], [".x", ".y", ".z", ".w"]];

/// Newer ParaViews write `name_0`; elsewhere such names are as likely to be different things.
const PARAVIEW_ENDINGS: [&str; 4] = ["_0", "_1", "_2", "_3"];

/// A column of the file.
#[derive(Clone, Debug)]
pub struct Source {
    pub name: String,
    pub components: usize,
    /// Whether only f64 keeps its values.
    pub double: bool,
}

/// A column of the frame.
#[derive(Clone, Debug)]
pub struct Table {
    pub name: String,
    pub components: usize,
    pub double: bool,
}

/// Where every column of the file goes. Table 0 holds the positions.
#[derive(Clone, Debug)]
pub struct Layout {
    pub tables: Vec<Table>,
    /// For every source its table and the component that its first number fills.
    pub slots: Vec<(usize, usize)>,
}

/// A name as it is compared: lower case, without a unit in brackets.
fn key(name: &str) -> String {
    let name = name.trim();
    let bare = name.split(['[', '(']).next().map_or(name, str::trim_end);
    if bare.is_empty() { name } else { bare }.to_ascii_lowercase()
}

impl Layout {
    /// Sorts the columns of a file into positions and fields.
    pub fn of(sources: &[Source]) -> Result<Layout, Fault> {
        let keys: Vec<String> = sources.iter().map(|source| key(&source.name)).collect();
        let mut builder =
            Builder { sources, keys: &keys, slots: vec![None; sources.len()], tables: Vec::new() };
        builder.positions()?;
        builder.velocity();
        builder.vectors();
        builder.rest();
        let slots = builder.slots.into_iter().flatten().collect();
        Ok(Layout { tables: builder.tables, slots })
    }

    /// Zeroed numbers for every table.
    pub fn zeroed(&self, rows: usize) -> Vec<Numbers> {
        self.tables.iter().map(|table| zeroed(rows * table.components, table.double)).collect()
    }

    /// The frame of the filled tables.
    pub fn frame(&self, numbers: Vec<Numbers>, metadata: Metadata) -> Result<Frame, Fault> {
        let mut columns = Vec::with_capacity(numbers.len());
        for (table, numbers) in self.tables.iter().zip(numbers) {
            let column = Column::new(table.components, numbers)
                .ok_or_else(|| Fault::new(format!("`{}` does not fill whole rows", table.name)))?;
            columns.push(Field { name: table.name.clone(), column });
        }
        let positions = columns.remove(0).column;
        Frame::new(positions, columns, metadata).map_err(|error| Fault::new(error.to_string()))
    }
}

struct Builder<'a> {
    sources: &'a [Source],
    keys: &'a [String],
    slots: Vec<Option<(usize, usize)>>,
    tables: Vec<Table>,
}

impl Builder<'_> {
    /// The free single-number source of that name.
    fn single(&self, name: &str) -> Option<usize> {
        (0..self.sources.len())
            .find(|&i| self.slots[i].is_none() && self.sources[i].components == 1 && self.keys[i] == name)
    }

    fn triple(&self, names: [&str; 3]) -> Option<[usize; 3]> {
        Some([self.single(names[0])?, self.single(names[1])?, self.single(names[2])?])
    }

    fn claim(&mut self, name: &str, sources: &[usize]) {
        let mut components = 0;
        for &source in sources {
            self.slots[source] = Some((self.tables.len(), components));
            components += self.sources[source].components;
        }
        let double = sources.iter().any(|&source| self.sources[source].double);
        self.tables.push(Table { name: name.to_owned(), components, double });
    }

    fn positions(&mut self) -> Result<(), Fault> {
        let vector = (0..self.sources.len())
            .find(|&i| self.sources[i].components > 1 && POSITION_NAMES.contains(&self.keys[i].as_str()));
        if let Some(source) = vector {
            let Source { name, components, .. } = &self.sources[source];
            if *components != 3 {
                return Err(Fault::new(format!("`{name}` has {components} columns, expected 3: x, y and z")));
            }
            self.claim("position", &[source]);
            return Ok(());
        }
        match POSITION_COMPONENTS.iter().find_map(|&names| self.triple(names)) {
            Some(sources) => {
                self.claim("position", &sources);
                Ok(())
            }
            None => Err(self.no_positions()),
        }
    }

    fn no_positions(&self) -> Fault {
        let partial = POSITION_COMPONENTS.iter().find_map(|names| {
            let missing: Vec<&str> =
                names.iter().copied().filter(|name| self.single(name).is_none()).collect();
            (missing.len() < 3).then(|| missing.join(", "))
        });
        let found: Vec<&str> = self.sources.iter().map(|source| source.name.trim()).take(20).collect();
        let found = if found.is_empty() { "nothing".to_owned() } else { found.join(", ") };
        match partial {
            Some(missing) => Fault::new(format!("no positions: column {missing} is missing beside {found}")),
            None => {
                Fault::new(format!("no positions: expected columns x, y, z or `position`, found {found}"))
            }
        }
    }

    fn velocity(&mut self) {
        if self.keys.iter().any(|key| canonical(key) == "velocity") {
            return;
        }
        if let Some(sources) = VELOCITY_COMPONENTS.iter().find_map(|&names| self.triple(names)) {
            self.claim("velocity", &sources);
        }
    }

    fn vectors(&mut self) {
        let keys = self.keys;
        let paraview = PARAVIEW_POINTS.iter().all(|name| keys.iter().any(|key| key == name));
        let endings = VECTOR_ENDINGS.iter().chain(paraview.then_some(&PARAVIEW_ENDINGS));
        for [first, second, third, fourth] in endings {
            for (source, name) in keys.iter().enumerate() {
                let Some(base) = name.strip_suffix(first) else { continue };
                let names = [name.as_str(), &format!("{base}{second}"), &format!("{base}{third}")];
                let longer = keys.iter().any(|key| *key == format!("{base}{fourth}"));
                let Some(sources) = self.triple(names) else { continue };
                if longer || base.is_empty() || sources[0] != source {
                    continue;
                }
                // The key is the start of the name in other letters, so it is as long.
                let written = self.sources[source].name.trim().get(..base.len()).unwrap_or(base).to_owned();
                self.claim(&written, &sources);
            }
        }
    }

    fn rest(&mut self) {
        for source in 0..self.sources.len() {
            if self.slots[source].is_none() {
                let name = self.sources[source].name.trim().to_owned();
                self.claim(&name, &[source]);
            }
        }
    }
}

impl Source {
    pub fn of(name: &str, column: &Column) -> Source {
        let double = matches!(column.numbers(), Numbers::F64(_));
        Source { name: name.to_owned(), components: column.components(), double }
    }
}

/// The frame of named columns that are all equally long.
pub fn from_columns(columns: Vec<(String, Column)>, metadata: Metadata) -> Result<Frame, Fault> {
    let sources: Vec<Source> = columns.iter().map(|(name, column)| Source::of(name, column)).collect();
    let layout = Layout::of(&sources)?;
    let rows = columns.first().map_or(0, |(_, column)| column.len());
    let mut tables: Vec<Numbers> = layout.tables.iter().map(|table| zeroed(0, table.double)).collect();
    for ((_, column), &(table, first)) in columns.into_iter().zip(&layout.slots) {
        let plan = &layout.tables[table];
        if column.components() == plan.components {
            tables[table] = column.into_numbers();
            continue;
        }
        if tables[table].is_empty() {
            tables[table] = zeroed(rows * plan.components, plan.double);
        }
        match &mut tables[table] {
            Numbers::F32(values) => {
                for (row, out) in values.chunks_exact_mut(plan.components).enumerate() {
                    out[first] = column.get(row, 0) as f32;
                }
            }
            Numbers::F64(values) => {
                for (row, out) in values.chunks_exact_mut(plan.components).enumerate() {
                    out[first] = column.get(row, 0);
                }
            }
        }
    }
    layout.frame(tables, metadata)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(names: &[&str]) -> Result<Layout, Fault> {
        let sources: Vec<Source> =
            names.iter().map(|&name| Source { name: name.into(), components: 1, double: true }).collect();
        Layout::of(&sources)
    }

    fn tables(names: &[&str]) -> Vec<(String, usize)> {
        layout(names).unwrap().tables.into_iter().map(|table| (table.name, table.components)).collect()
    }

    #[test]
    fn the_usual_headers_give_positions_and_velocity() {
        let expected = [("position".to_owned(), 3), ("velocity".to_owned(), 3), ("id".to_owned(), 1)];
        assert_eq!(tables(&["id", "x", "y", "z", "vx", "vy", "vz"]), expected);
        assert_eq!(
            tables(&[
                "Pos.x [m]",
                "Pos.y [m]",
                "Pos.z [m]",
                "id",
                "Vel.x [m/s]",
                "Vel.y [m/s]",
                "Vel.z [m/s]"
            ])[1..],
            [("Vel".to_owned(), 3), ("id".to_owned(), 1)]
        );
        assert_eq!(tables(&["id", "v", "u", "w", "Points:0", "Points:1", "Points:2"]), expected);
    }

    #[test]
    fn components_keep_their_order() {
        let layout = layout(&["z", "y", "x", "vz", "vx", "vy"]).unwrap();
        assert_eq!(layout.slots, [(0, 2), (0, 1), (0, 0), (1, 2), (1, 0), (1, 1)]);
    }

    #[test]
    fn numbered_columns_are_a_vector_only_in_files_of_paraview() {
        let plain = tables(&["x", "y", "z", "c_0", "c_1", "c_2"]);
        assert_eq!(plain.len(), 4);
        let paraview = tables(&["Points_0", "Points_1", "Points_2", "c_0", "c_1", "c_2"]);
        assert_eq!(paraview[1], ("c".to_owned(), 3));
    }

    #[test]
    fn a_missing_axis_is_named() {
        let fault = layout(&["id", "x", "z"]).unwrap_err();
        assert!(fault.what.contains("column y is missing"), "{}", fault.what);
        let fault = layout(&["a", "b"]).unwrap_err();
        assert!(fault.what.contains("found a, b"), "{}", fault.what);
    }
}
