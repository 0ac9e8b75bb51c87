//! Sequences: which files, in which order, and what a bad one among them does.

#[path = "support/files.rs"]
mod files;

use std::fs;
use std::path::{Path, PathBuf};

use sphcast::frames::{FrameStream, Sequence};

use files::write_vtk;

fn names(sequence: &Sequence) -> Vec<String> {
    let name = |name: &str| Path::new(name).file_name().unwrap().to_string_lossy().into_owned();
    sequence.sources().iter().map(|source| name(&source.name)).collect()
}

fn open(argument: impl Into<PathBuf>) -> Sequence {
    Sequence::open(&[argument.into()]).unwrap()
}

fn refusal(argument: impl Into<PathBuf>) -> String {
    Sequence::open(&[argument.into()]).unwrap_err().to_string()
}

#[test]
fn a_directory_is_its_largest_series_in_natural_order() {
    let folder = tempfile::tempdir().unwrap();
    for number in [10, 9, 1, 2] {
        write_vtk(&folder.path().join(format!("fluid_{number}.vtk")), 2, true);
        fs::write(folder.path().join(format!("fluid_{number}.json")), "{}").unwrap();
    }
    for number in 1..=3 {
        write_vtk(&folder.path().join(format!("walls_{number}.vtk")), 2, true);
    }
    fs::write(folder.path().join("README.md"), "").unwrap();
    let sequence = open(folder.path());
    assert_eq!(names(&sequence), ["fluid_1.vtk", "fluid_2.vtk", "fluid_9.vtk", "fluid_10.vtk"]);
    let [note] = sequence.notes() else { panic!("{:?}", sequence.notes()) };
    assert!(note.contains("2 series") && note.contains("`fluid_#.vtk`, the largest (4 frames)"), "{note}");

    let globbed = open(folder.path().join("walls_*"));
    assert_eq!(names(&globbed), ["walls_1.vtk", "walls_2.vtk", "walls_3.vtk"]);
    assert!(globbed.notes().is_empty());
    let beside_sidecars = open(folder.path().join("fluid_*"));
    assert_eq!(names(&beside_sidecars), names(&sequence));
}

#[test]
fn files_are_sorted_and_other_arguments_keep_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in ["a_10.vtk", "a_2.vtk", "b_1.vtk"] {
        write_vtk(&path(name), 1, true);
    }
    let arguments =
        [path("b_1.vtk"), path("a_10.vtk"), path("a_2.vtk"), "demo:radial:8".into(), path("b_1.vtk")];
    let sequence = Sequence::open(&arguments).unwrap();
    assert_eq!(names(&sequence), ["a_2.vtk", "a_10.vtk", "b_1.vtk", "demo:radial:8", "b_1.vtk"]);
    assert_eq!(sequence.sources()[3].load(&Default::default()).unwrap().len(), 8);
}

#[test]
fn a_collection_goes_by_time() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("data")).unwrap();
    write_vtk(&folder.path().join("data/x.vtk"), 3, true);
    let text = r#"<VTKFile type="Collection"><Collection>
        <DataSet timestep="2.5" file="data/x.vtk"/><DataSet timestep="0.5" file="y.vtk"/>
        </Collection></VTKFile>"#;
    fs::write(folder.path().join("run.pvd"), text).unwrap();
    let sequence = open(folder.path().join("run.pvd"));
    assert_eq!(names(&sequence), ["y.vtk", "x.vtk"]);
    assert_eq!(sequence.sources()[1].time, Some(2.5));
    assert_eq!(sequence.sources()[1].load(&Default::default()).unwrap().metadata.time, Some(2.5));
    assert!(sequence.sources()[0].load(&Default::default()).is_err(), "y.vtk is not there");

    fs::write(folder.path().join("bad.pvd"), "<VTKFile").unwrap();
    assert!(refusal(folder.path().join("bad.pvd")).contains("bad.pvd: "));
}

#[test]
fn what_names_no_frame_is_told() {
    let folder = tempfile::tempdir().unwrap();
    assert!(refusal(folder.path().join("no.vtk")).ends_with("no.vtk: no such file or directory"));
    assert!(refusal(folder.path()).contains("has no particle files"));
    assert!(refusal(folder.path().join("*.vtk")).ends_with("*.vtk: matches no file"));
    assert!(refusal("demo:sphere:5").starts_with("demo:sphere:5: there is no demo `sphere`"));
    assert!(refusal("demo:radial:x").contains("`x` is not a number of particles"));
}

#[test]
fn the_demo_is_there_without_arguments() {
    let demo = Sequence::open(&[]).unwrap();
    assert!(demo.is_demo());
    assert_eq!(demo.len(), open("demo").len());
    assert!(!open("demo:radial:1").is_demo());
    assert_eq!(demo.sources()[3].time, Some(0.3));
}

#[test]
fn a_gap_a_bad_frame_an_empty_one_and_a_missing_field_stop_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = |number: usize| folder.path().join(format!("frame_{number}.vtk"));
    for (number, count) in [(1, 30), (2, 30), (3, 25), (4, 30), (5, 30), (10, 0), (11, 30)] {
        write_vtk(&path(number), count, number != 11);
    }
    let whole = fs::read(path(4)).unwrap();
    fs::write(path(4), &whole[..whole.len() / 3]).unwrap();

    let sequence = open(folder.path());
    let stream = FrameStream::new(sequence.frame_sources(), 1 << 20, || {});
    let sizes: Vec<Option<usize>> =
        (0..sequence.len()).map(|index| stream.wait(index).ok().map(|frame| frame.len())).collect();
    assert_eq!(sizes, [Some(30), Some(30), Some(25), None, Some(30), Some(0), Some(30)]);
    assert!(stream.wait(6).unwrap().field("concentration").is_none());
}
