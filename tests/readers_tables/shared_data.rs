//! The real runs and the broken files beside the repository.

use sphcast::frames::readers::read;

use crate::{read_ok, shared_data};

/// Broken files with words that their error must hold.
const ERRORS: [(&str, &[&str]); 26] = [
    ("text_cell.csv", &["column `y`", "`n/a`", "line 51"]),
    ("ragged_row.csv", &["5 cells", "expected 9", "line 31"]),
    ("no_header.csv", &["header", "line 1"]),
    ("missing_y_column.csv", &["column y is missing", "line 1"]),
    ("not_multiple_of_12.xyz", &["12 bytes", "23995", "byte"]),
    ("truncated.ply", &["element `vertex`", "expected", "found", "byte"]),
    ("count_too_large.ply", &["3000000000 rows", "byte"]),
    ("no_end_header.ply", &["end_header", "line"]),
    ("no_positions.npz", &["no positions", "found"]),
    ("length_mismatch.npz", &["1997 rows", "expected 2000", "array `concentration`"]),
    ("positions_2_columns.npz", &["2 columns", "expected 3"]),
    ("object_array.npz", &["Python objects", "array `position`"]),
    ("truncated.npz", &["zip"]),
    ("truncated_gzip.bgeo", &["gzip", "truncated", "byte"]),
    ("uncompressed_truncated.bgeo", &["30240 points", "expected", "found", "byte"]),
    ("negative_count.bgeo", &["-1", "byte 9"]),
    ("new_style.bgeo", &["JSON", "old style"]),
    ("gadget_no_coordinates.hdf5", &["no Coordinates", "PartType0"]),
    ("truncated.hdf5", &["HDF5", "damaged"]),
    ("text.hdf5", &["not an HDF5 file"]),
    // The same files under the wrong name.
    ("../oneframe/frame.json", &["expected one of .vtk"]),
    ("broken_sidecar.json", &["expected one of .vtk"]),
    ("negative_radius.json", &["expected one of .vtk"]),
    ("sequence_with_gap", &["not a file"]),
    ("../phantom/LICENSE", &["expected one of .vtk"]),
    ("../dambreak", &["not a file"]),
];

/// Files that are unusual but sound, with their number of particles.
const SOUND: [(&str, usize); 17] = [
    ("zero_particles.csv", 0),
    ("zero_particles.ply", 0),
    ("zero_particles.xyz", 0),
    ("zero_particles.npz", 0),
    ("header_only.csv", 0),
    ("one_particle.csv", 1),
    ("one_particle.ply", 1),
    ("one_particle.xyz", 1),
    ("one_particle.npz", 1),
    ("semicolons_decimal_comma.csv", 200),
    ("windows_bom_crlf.csv", 200),
    ("spaces_and_comments.csv", 200),
    ("paraview_style.csv", 200),
    ("utf16.csv", 200),
    ("negative_radius.csv", 200),
    ("zero_radius.csv", 200),
    ("text.xyz", 50),
];

#[test]
fn broken_files_say_what_and_where() {
    let _turn = crate::metered::together();
    let Some(data) = shared_data() else { return };
    for (name, words) in ERRORS {
        let error =
            read(&data.join("broken").join(name), &Default::default()).err().map(|error| error.to_string());
        let error = error.unwrap_or_else(|| panic!("{name} was read"));
        assert!(error.contains(name), "{error}");
        for word in words {
            assert!(error.contains(word), "`{word}` is not in: {error}");
        }
    }
}

#[test]
fn unusual_files_are_read() {
    let _turn = crate::metered::together();
    let Some(data) = shared_data() else { return };
    let mut table = None;
    for (name, particles) in SOUND {
        let frame = read_ok(&data.join("broken").join(name));
        assert_eq!(frame.len(), particles, "{name}");
        if name.ends_with(".csv") && particles > 1 {
            let first = table.get_or_insert_with(|| frame.clone());
            assert_eq!(frame.positions(), first.positions(), "{name}");
            let field = |frame: &sphcast::frames::Frame| frame.field("concentration").unwrap().column.clone();
            assert_eq!(field(&frame), field(first), "{name}");
        }
    }
    let radius = read_ok(&data.join("broken/negative_radius.csv"));
    assert_eq!(radius.field("radius").unwrap().column.get(0, 0), -0.0125);
    let lengths = read_ok(&data.join("broken/gadget_negative_smoothing.hdf5"));
    assert_eq!(lengths.field("smoothing_length").unwrap().column.get(0, 0), -1.0);
}

/// No file outside the VTK family is left untried.
#[test]
fn every_broken_file_has_its_line() {
    let _turn = crate::metered::together();
    let Some(data) = shared_data() else { return };
    for entry in std::fs::read_dir(data.join("broken")).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let vtk = name.ends_with(".vtk") || name.ends_with(".vtu");
        let known = ERRORS.iter().map(|(name, _)| *name).chain(SOUND.iter().map(|(name, _)| *name));
        let other = ["gadget_negative_smoothing.hdf5"];
        assert!(vtk || known.chain(other).any(|known| known == name), "{name}");
    }
}

#[test]
fn phantom_gets_its_density() {
    let _turn = crate::metered::together();
    let Some(data) = shared_data() else { return };
    let frame = read_ok(&data.join("phantom/phantom_adiabatic_00000.h5"));
    assert_eq!(frame.len(), 20736);
    assert_eq!(frame.metadata.support_per_smoothing_length, Some(2.0));
    let density = &frame.field("density").unwrap().column;
    let (low, high) = (0..frame.len())
        .map(|row| density.get(row, 0))
        .fold((f64::INFINITY, 0.0f64), |(low, high), value| (low.min(value), high.max(value)));
    assert!((low - 0.0797).abs() < 1e-3 && (high - 1.0).abs() < 1e-3, "{low} {high}");
    let mass = frame.metadata.particle_mass.unwrap();
    assert!((mass / 2.6973983e-6 - 1.0).abs() < 1e-6, "{mass}");
}

#[test]
fn splashsurf_bgeo_is_read() {
    let _turn = crate::metered::together();
    let Some(data) = shared_data() else { return };
    let frame = read_ok(&data.join("splashsurf/dam_break_frame_9_6859_particles.bgeo"));
    assert_eq!(frame.len(), 6859);
    assert!(["id", "density", "velocity"].iter().all(|name| frame.field(name).is_some()));
}

#[test]
fn broken_sidecars_are_warnings() {
    let _turn = crate::metered::together();
    let Some(data) = shared_data() else { return };
    let folder = tempfile::tempdir().unwrap();
    let frame = folder.path().join("frame_7.csv");
    std::fs::write(&frame, "x,y,z\n1,2,3\n").unwrap();
    let with_sidecar = |name: &str| {
        std::fs::copy(data.join(name), folder.path().join("run.json")).unwrap();
        read_ok(&frame)
    };
    let broken = with_sidecar("broken/broken_sidecar.json");
    assert!(broken.warnings.len() == 1 && broken.warnings[0].contains("run.json"), "{:?}", broken.warnings);
    std::fs::remove_file(folder.path().join("run.json")).unwrap();
    let negative = with_sidecar("broken/negative_radius.json");
    assert!(
        negative.warnings.len() == 1 && negative.warnings[0].contains("-0.0125"),
        "{:?}",
        negative.warnings
    );
    assert_eq!((negative.metadata.particle_radius, negative.metadata.support_radius), (None, Some(0.05)));
    std::fs::remove_file(folder.path().join("run.json")).unwrap();
    let run = with_sidecar("mixer/run.json");
    assert!(run.warnings.is_empty());
    assert!(run.metadata.time.is_some_and(|time| (time - 0.6).abs() < 1e-6), "{:?}", run.metadata);
    std::fs::remove_file(folder.path().join("run.json")).unwrap();
    assert!(with_sidecar("mixer/scene.json").warnings.is_empty());
}
