//! Every VTK file of the shared data, where a checkout has it beside the workspace.

use std::path::PathBuf;

use sphcast::frames::{Frame, Numbers};

use crate::{difference, different, from_table, read};

/// The folder of that name in the shared data, unless it is absent.
fn folder(name: &str) -> Option<PathBuf> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(name);
    if folder.is_dir() {
        return Some(folder);
    }
    println!("skipped: {} is not there", folder.display());
    None
}

fn load(path: PathBuf) -> Result<Frame, String> {
    read(&path, &std::fs::read(&path).unwrap())
}

fn vtk_files(folder: &std::path::Path) -> Vec<String> {
    let names =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> =
        names.filter(|name| [".vtk", ".vtu", ".vtp"].iter().any(|end| name.ends_with(end))).collect();
    names.sort();
    names
}

#[test]
fn one_frame_is_the_same_in_every_format() {
    let Some(folder) = folder("oneframe") else { return };
    let table = std::fs::read_to_string(folder.join("frame.csv")).unwrap();
    let (whole, quarter) = (from_table(&table, |_| true), from_table(&table, |id| id.is_multiple_of(4)));
    for name in vtk_files(&folder) {
        let frame = load(folder.join(&name)).unwrap_or_else(|why| panic!("{name}: {why}"));
        match name.as_str() {
            "frame_splishsplash.vtk" => {
                assert_eq!(different(frame.positions(), whole.positions()), None);
                for field in ["velocity", "density", "id"] {
                    let (found, expected) = (frame.field(field).unwrap(), whole.field(field).unwrap());
                    assert_eq!(different(&found.column, &expected.column), None, "{field}");
                }
                assert_eq!(frame.fields().len(), 3);
            }
            // Six digits, then the nearest f32.
            "frame_quarter_vtk42_ascii.vtk" => {
                assert_eq!(frame.len(), quarter.len());
                for i in 0..frame.len() {
                    let (found, expected) = (frame.position(i), quarter.position(i));
                    assert!((0..3).all(|axis| (found[axis] - expected[axis]).abs() <= 5.2e-6), "row {i}");
                }
                assert!(difference(&frame, &quarter).is_some());
            }
            "frame_quarter_ascii.vtu" => assert_eq!(difference(&frame, &quarter), None),
            _ => assert_eq!(difference(&frame, &whole), None, "{name}"),
        }
    }
}

#[test]
fn every_frame_of_the_runs_is_read() {
    for (name, files, particles, fields) in [
        ("dambreak", 30, 30240, &["id", "velocity", "density"][..]),
        ("mixer", 27, 53504, &["velocity", "density", "concentration", "id"]),
    ] {
        let Some(folder) = folder(name) else { continue };
        let names = vtk_files(&folder);
        assert_eq!(names.len(), files);
        for name in names {
            let frame = load(folder.join(&name)).unwrap_or_else(|why| panic!("{name}: {why}"));
            assert_eq!(frame.len(), particles, "{name}");
            assert!(
                frame.fields().iter().map(|field| field.name.as_str()).eq(fields.iter().copied()),
                "{name}"
            );
            assert!((0..frame.len()).all(|i| frame.position(i).iter().all(|x| x.abs() < 2.0)), "{name}");
            let id = &frame.field("id").unwrap().column;
            let mut seen = vec![false; particles];
            (0..particles).for_each(|i| seen[id.get(i, 0) as usize] = true);
            assert!(seen.into_iter().all(|seen| seen), "{name}: ids are not a permutation");
        }
    }
}

#[test]
fn files_of_other_programs_are_read() {
    let Some(folder) = folder("splashsurf") else { return };
    let expected = [
        ("bunny_frame_14_7705_particles.vtk", 7706, &["id", "velocity"][..], [-0.6087, 0.6701, -0.9785]),
        ("cube_2366_particles.vtk", 2366, &[], [0.85, 0.04999, 0.85]),
        ("cube_8_particles.vtk", 8, &[], [0.5, 0.4995, 0.5]),
        ("cube_8_particles.vtu", 8, &["velocity", "pressure", "density", "index"], [0.5, 0.4995, 0.5]),
        ("double_dam_break_frame_01_4732_particles.vtk", 4732, &["id", "velocity"], [-1.45, 0.04999, -1.45]),
        (
            "double_dam_break_frame_26_4732_particles.vtk",
            4732,
            &["id", "velocity"],
            [-1.515, -0.01525, -1.515],
        ),
        (
            "fluid_250_particles.vtu",
            250,
            &["velocity", "pressure", "density", "index"],
            [0.1133, 0.1478, 0.1097],
        ),
        (
            "fluid_encoded_250_particles.vtu",
            250,
            &["velocity", "pressure", "density", "index"],
            [0.1133, 0.1478, 0.1097],
        ),
        ("hilbert2_7954_particles.vtk", 7954, &["id"], [-0.6701, -0.653, 0.003183]),
    ];
    assert!(vtk_files(&folder).iter().eq(expected.iter().map(|(name, ..)| name)));
    for (name, particles, fields, least) in expected {
        let frame = load(folder.join(name)).unwrap_or_else(|why| panic!("{name}: {why}"));
        assert_eq!(frame.len(), particles, "{name}");
        assert!(frame.fields().iter().map(|field| field.name.as_str()).eq(fields.iter().copied()), "{name}");
        for (axis, least) in least.iter().enumerate() {
            let found = (0..particles).map(|i| frame.position(i)[axis]).fold(f64::INFINITY, f64::min);
            assert!((found - least).abs() < 1e-3, "{name}: {found} on axis {axis}");
        }
        let double = matches!(frame.positions().numbers(), Numbers::F64(_));
        assert_eq!(double, name.contains("_8_") || name.contains("_250_"), "{name}");
    }
    let [plain, encoded] = ["fluid_250_particles.vtu", "fluid_encoded_250_particles.vtu"];
    assert_eq!(difference(&load(folder.join(plain)).unwrap(), &load(folder.join(encoded)).unwrap()), None);
}

/// Broken files with words that the fault has to say.
const FAULTS: [(&str, &[&str]); 20] = [
    ("truncated_in_points.vtk", &["truncated", "POINTS", "byte 106"]),
    ("truncated_in_last_field.vtk", &["truncated", "`id`", "byte"]),
    ("points_count_too_large.vtk", &["48000000000 bytes", "POINTS", "byte 95"]),
    ("points_count_negative.vtk", &["number of points", "`-5`", "byte 78"]),
    ("point_data_count_mismatch.vtk", &["POINT_DATA 2000", "1999", "byte 48124"]),
    ("polydata_surface.vtk", &["surface", "POLYGONS", "line 7"]),
    ("header_only.vtk", &["expected POINTS"]),
    ("empty_0_bytes.vtk", &["# vtk DataFile Version"]),
    ("random_bytes.vtk", &["# vtk DataFile Version", "line 1"]),
    ("not_a_vtk.vtk", &["XML"]),
    ("wrong_point_count.vtu", &["72000", "24000", "Points"]),
    ("huge_point_count.vtu", &["99999999999999", "Points"]),
    ("offset_outside_file.vtu", &["offset", "`concentration`"]),
    ("truncated_appended.vtu", &["truncated", "AppendedData"]),
    ("corrupt_zlib.vtu", &["block 0", "damaged", "`velocity`"]),
    ("block_count_huge.vtu", &["blocks", "4294967295", "`velocity`"]),
    ("unknown_compressor.vtu", &["vtkNoSuchDataCompressor", "compressor"]),
    ("truncated_xml.vtu", &["XML", "line"]),
    ("sequence_with_gap/frame_4.vtu", &["XML", "line"]),
    ("../oneframe/frame.csv", &["VTK XML"]),
];

#[test]
fn broken_files_say_what_is_wrong_and_where() {
    let Some(folder) = folder("broken") else { return };
    for (name, words) in FAULTS {
        let why = load(folder.join(name)).err().unwrap_or_else(|| panic!("{name} was read"));
        for word in words {
            assert!(why.contains(word), "{name}: `{why}` does not say `{word}`");
        }
    }
}

#[test]
fn files_at_the_edge_are_read() {
    let Some(folder) = folder("broken") else { return };
    let read: Vec<(String, Frame)> = vtk_files(&folder)
        .into_iter()
        .filter(|name| FAULTS.iter().all(|(broken, _)| broken != name))
        .map(|name| (name.clone(), load(folder.join(&name)).unwrap_or_else(|why| panic!("{name}: {why}"))))
        .collect();
    assert_eq!(read.len(), 18);
    let sound = &read.iter().find(|(name, _)| name == "ok_reference.vtu").unwrap().1;
    for (name, frame) in &read {
        let particles = match name.split('_').next() {
            Some("zero") => 0,
            Some("one") if name.starts_with("one_particle") => 1,
            _ => 2000,
        };
        assert_eq!(frame.len(), particles, "{name}");
        assert_eq!(
            frame.fields().len(),
            sound.fields().len() * usize::from(name != "zero_particles.vtk"),
            "{name}"
        );
        let lost: Vec<usize> =
            (0..particles).filter(|&i| frame.position(i).iter().any(|x| !x.is_finite())).collect();
        let expected = match name.as_str() {
            "nan_inf_positions.vtu" => [5, 17, 18].into_iter().chain(100..110).collect(),
            "all_nan_positions.vtu" => (0..2000).collect(),
            _ => Vec::new(),
        };
        assert_eq!(lost, expected, "{name}");
    }
    for (frame, particles) in [(1, 300), (2, 300), (3, 250), (5, 300), (10, 0), (11, 300)] {
        let frame = load(folder.join(format!("sequence_with_gap/frame_{frame}.vtu"))).unwrap();
        assert_eq!(frame.len(), particles);
    }
}
