//! Which VTK cells are particles, and what the others are.

/// Says why cells of this VTK type do not make a particle file; `None` for vertices and empty cells.
pub(super) fn not_particles(cell_type: i64) -> Option<String> {
    let what = match cell_type {
        0..=2 => return None,
        3 | 4 | 21 | 35 | 68 | 75 => "lines",
        5..=9 | 22 | 23 | 28 | 30 | 34 | 36 | 69 | 70 | 76 | 77 => "a surface",
        _ => "a mesh",
    };
    Some(format!("holds {what} (VTK cell type {cell_type}), not particles: expected vertex cells only"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_vertices_are_particles() {
        assert!((0..=2).all(|cell| not_particles(cell).is_none()));
        assert!(not_particles(5).is_some_and(|why| why.contains("surface")));
        assert!(not_particles(10).is_some_and(|why| why.contains("mesh")));
        assert!(not_particles(-1).is_some());
    }
}
