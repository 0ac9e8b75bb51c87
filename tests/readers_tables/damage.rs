//! Cut, flipped and swollen files: an error or a frame, in bounded time and memory.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::write::GzEncoder;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngSeed, TestRunner};
use sphcast::frames::Frame;
use sphcast::frames::readers::{ReadError, read};

use crate::metered::{alone, peak};
use crate::{FIXTURES, fixture};

const SLOWEST: Duration = Duration::from_secs(5);

/// Writes a damaged file under the name of its fixture, reads it, and checks what it cost.
fn read_damaged(folder: &Path, name: &str, bytes: &[u8]) -> Result<Frame, ReadError> {
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    let begin = Instant::now();
    let (result, allocated) = peak(|| read(&path, &Default::default()));
    let limit = 64 * bytes.len() + (64 << 20);
    assert!(begin.elapsed() < SLOWEST, "{name}: {:?}", begin.elapsed());
    assert!(allocated < limit, "{name}: {allocated} bytes allocated for {}", bytes.len());
    if let Ok(frame) = &result {
        assert!(frame.bytes() < limit, "{name}: a frame of {} bytes", frame.bytes());
    }
    result
}

/// Bytes at the end of a fixture that particles do not need.
fn tail(name: &str) -> Option<usize> {
    Some(match name {
        // A list behind the vertices; what follows the points.
        "binary.ply" => 13,
        "plain.bgeo" => 2,
        // A number cut short is a number.
        "ascii.ply" | "chemistry.xyz" => 16,
        "binary_big_endian.ply" | "gzip.bgeo" | "deflated.npz" | "stored_fortran_f64.npz" => 0,
        "positions.npy" | "records.npy" => 0,
        // HDF5 files may end in unused space; text has no count; raw positions are checked below.
        _ => return None,
    })
}

#[test]
fn a_cut_file_is_an_error() {
    let _turn = alone();
    let folder = tempfile::tempdir().unwrap();
    for name in FIXTURES {
        let whole = std::fs::read(fixture(name)).unwrap();
        let ends = (0..whole.len()).filter(|&at| at < 300 || at + 60 > whole.len() || at % 1999 == 0);
        for at in ends {
            let result = read_damaged(folder.path(), name, &whole[..at]);
            match tail(name) {
                // No bytes at all are an .xyz without particles.
                Some(tail) if at + tail < whole.len() && (at > 0 || !name.ends_with(".xyz")) => {
                    let error = result.expect_err(&format!("{name} cut at {at}")).to_string();
                    assert!(error.contains(name), "{error}");
                }
                _ if name == "raw.xyz" => assert_eq!(result.is_ok(), at % 12 == 0, "cut at {at}"),
                _ => {}
            }
        }
        assert!(read_damaged(folder.path(), name, &whole).is_ok(), "{name}");
    }
}

#[derive(Clone, Debug)]
enum Damage {
    Set(Index, u8),
    SetInHead(Index, u8),
    Flip(Index, u8),
    Insert(Index, Vec<u8>),
    Remove(Index, usize),
    Truncate(Index),
}

fn damage() -> impl Strategy<Value = Damage> {
    let edge = prop_oneof![Just(0u8), Just(0xff), Just(0x7f), Just(0x80), Just(b'9'), any::<u8>()];
    prop_oneof![
        3 => (any::<Index>(), edge.clone()).prop_map(|(at, to)| Damage::Set(at, to)),
        4 => (any::<Index>(), edge).prop_map(|(at, to)| Damage::SetInHead(at, to)),
        2 => (any::<Index>(), 0u8..8).prop_map(|(at, bit)| Damage::Flip(at, bit)),
        1 => (any::<Index>(), prop::collection::vec(any::<u8>(), 1..40)).prop_map(|(at, bytes)| Damage::Insert(at, bytes)),
        1 => (any::<Index>(), 1usize..40).prop_map(|(at, len)| Damage::Remove(at, len)),
        1 => any::<Index>().prop_map(Damage::Truncate),
    ]
}

fn apply(bytes: &mut Vec<u8>, damage: &Damage) {
    if bytes.is_empty() {
        return;
    }
    let len = bytes.len();
    match damage {
        Damage::Set(at, to) => bytes[at.index(len)] = *to,
        Damage::SetInHead(at, to) => bytes[at.index(len.min(600))] = *to,
        Damage::Flip(at, bit) => bytes[at.index(len)] ^= 1 << bit,
        Damage::Insert(at, new) => {
            bytes.splice(at.index(len)..at.index(len), new.iter().copied());
        }
        Damage::Remove(at, count) => {
            bytes.drain(at.index(len)..(at.index(len) + count).min(len));
        }
        Damage::Truncate(at) => bytes.truncate(at.index(len)),
    }
}

#[test]
fn damage_anywhere_is_an_error_or_a_frame() {
    let _turn = alone();
    let folder = tempfile::tempdir().unwrap();
    for name in FIXTURES {
        let whole = std::fs::read(fixture(name)).unwrap();
        let config = Config {
            cases: 120,
            rng_seed: RngSeed::Fixed(20),
            failure_persistence: None,
            ..Config::default()
        };
        let errors = std::cell::Cell::new(0);
        let strategy = prop::collection::vec(damage(), 1..5);
        let outcome = TestRunner::new(config).run(&strategy, |damages| {
            let mut bytes = whole.clone();
            damages.iter().for_each(|damage| apply(&mut bytes, damage));
            if read_damaged(folder.path(), name, &bytes).is_err() {
                errors.set(errors.get() + 1);
            }
            Ok(())
        });
        outcome.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(errors.get() > 0, "{name}: none of the damages was seen");
    }
}

fn bombs() -> Vec<(&'static str, Vec<u8>)> {
    let zeros = vec![0u8; 64 << 20];
    let gzip = |head: &[u8]| {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(head).unwrap();
        encoder.write_all(&zeros).unwrap();
        encoder.finish().unwrap()
    };
    let bgeo = |points: i32, attributes: i32| {
        let mut head = b"BgeoV".to_vec();
        for number in [5, points, 0, 0, 0, attributes, 0, 0, 0] {
            head.extend(number.to_be_bytes());
        }
        head
    };
    let npy = |shape: &str| {
        let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend((header.len() as u16).to_le_bytes());
        bytes.extend(header.bytes());
        bytes
    };
    let mut deep = b"\x93NUMPY\x02\x00\x00\x00\x08\x00{'descr': ".to_vec();
    deep.resize(12 + 0x80000, b'[');
    let ply =
        |elements: &str| format!("ply\nformat binary_little_endian 1.0\n{elements}end_header\n").into_bytes();
    vec![
        ("endless_attributes.bgeo", gzip(&bgeo(1, i32::MAX))),
        ("many_points.bgeo", gzip(&bgeo(i32::MAX, 0))),
        ("few_points.bgeo", gzip(&bgeo(3, 0))),
        ("huge.npy", npy("(4611686018427387904, 3)")),
        ("hidden_by_zero.npy", npy("(0, 9223372036854775807, 9223372036854775807)")),
        ("deep.npy", deep),
        ("empty_rows.ply", ply("element face 18446744073709551615\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n")),
        ("huge_list.ply", [ply("element face 1\nproperty list uint double i\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"), vec![0xff; 64]].concat()),
        ("many.ply", ply("element vertex 18446744073709551615\nproperty double x\nproperty double y\nproperty double z\n")),
    ]
}

#[test]
fn swollen_files_stay_small() {
    let _turn = alone();
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in bombs() {
        let result = read_damaged(folder.path(), name, &bytes);
        // Three points in a long stream are three points.
        assert_eq!(result.is_ok(), name == "few_points.bgeo", "{name}");
    }
}

/// Files that are none: a folder, nothing at all, and a kind that is not known.
#[test]
fn what_is_no_particle_file_is_named() {
    let _turn = alone();
    let folder = tempfile::tempdir().unwrap();
    let error = |path: PathBuf| read(&path, &Default::default()).unwrap_err().to_string();
    assert!(error(folder.path().to_owned()).contains("not a file"));
    assert!(error(folder.path().join("absent.csv")).contains("absent.csv: cannot be read"));
    std::fs::write(folder.path().join("a.png"), b"\x89PNG").unwrap();
    assert!(error(folder.path().join("a.png")).contains(".bgeo, .ply"));
}
