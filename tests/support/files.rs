//! Small frame files for tests.

use std::fmt::Write;
use std::path::Path;

/// Writes a legacy VTK file of `count` particles on a line, 0.1 apart, with the field `concentration`
/// from 0 to 1, or with none.
pub fn write_vtk(path: &Path, count: usize, with_concentration: bool) {
    let mut text =
        format!("# vtk DataFile Version 3.0\nline\nASCII\nDATASET POLYDATA\nPOINTS {count} float\n");
    for i in 0..count {
        writeln!(text, "{} 0 0", 0.1 * i as f64).unwrap();
    }
    if with_concentration {
        write!(text, "POINT_DATA {count}\nSCALARS concentration float 1\nLOOKUP_TABLE default\n").unwrap();
        for i in 0..count {
            writeln!(text, "{}", i as f64 / count.max(2) as f64).unwrap();
        }
    }
    std::fs::write(path, text).unwrap();
}
