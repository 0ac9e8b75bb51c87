//! Fixtures cut, flipped and stuffed: a fault or a frame, in bounded time and memory.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use sphcast::frames::{Frame, Numbers};

use crate::{allocations, difference, different, fixtures, read};

/// Runs `work` over `size` bytes; says what it took too much of.
fn bounded<T>(size: usize, work: impl FnOnce() -> T) -> Result<T, String> {
    let start = Instant::now();
    let (peak, result) = allocations::peak(work);
    let (time, most) = (start.elapsed(), 64 * size + (32 << 20));
    if time > Duration::from_secs(5) {
        return Err(format!("{size} bytes took {time:?}"));
    }
    if peak > most { Err(format!("{size} bytes took {peak} bytes of memory")) } else { Ok(result) }
}

#[test]
fn the_bounds_are_watched() {
    assert_eq!(bounded(10, || 1), Ok(1));
    assert!(bounded(10, || vec![0u8; 40 << 20].len()).is_err());
    assert!(bounded(1 << 20, || vec![0u8; 40 << 20].len()).is_ok());
}

/// Whether a frame read from the first part of a file holds nothing but what the whole file holds.
/// In a text a cut may shorten the last number, which nothing can tell.
fn is_part(part: &Frame, whole: &Frame, text: bool) -> bool {
    let columns = |frame: &Frame| {
        let fields = frame.fields().iter().map(|field| (field.name.clone(), field.column.clone()));
        std::iter::once((String::new(), frame.positions().clone())).chain(fields).collect::<Vec<_>>()
    };
    let (found, expected) = (columns(part), columns(whole));
    let last = found.len() - 1;
    found.len() <= expected.len()
        && found.iter().zip(&expected).enumerate().all(|(index, (found, expected))| {
            let why = different(&found.1, &expected.1);
            let shortened = || {
                let end = match expected.1.numbers() {
                    Numbers::F32(numbers) => numbers.len(),
                    Numbers::F64(numbers) => numbers.len(),
                };
                text && index == last && why == Some(format!("value {}", end - 1))
            };
            found.0 == expected.0 && (why.is_none() || shortened())
        })
}

/// Places to cut a file of `length` bytes at: all near its ends, and some between.
fn cuts(length: usize) -> impl Iterator<Item = usize> {
    let near = 700.min(length);
    (0..near).chain((near..length - near).step_by(101)).chain(length - near..length)
}

#[test]
fn a_cut_file_is_a_fault_or_tells_no_lie() {
    for (path, bytes) in fixtures() {
        let whole = read(&path, &bytes).unwrap();
        let xml = path.extension().is_some_and(|extension| extension != "vtk");
        let text = path.to_string_lossy().contains("ascii");
        for length in cuts(bytes.len()) {
            let Ok(part) = bounded(length, || read(&path, &bytes[..length])).unwrap() else {
                continue;
            };
            let end = bytes[length..].trim_ascii().is_empty();
            assert!(!xml || end, "{}: a cut at {length} was not seen", path.display());
            assert!(is_part(&part, &whole, text), "{}: a cut at {length} changed values", path.display());
        }
    }
}

#[test]
fn a_part_is_told_from_other_frames() {
    let table = "id,x,y,z,vx,vy,vz,density,concentration\n7,1,2,3,4,5,6,7,8\n9,1,2,3,4,5,6,7,8\n";
    let whole = crate::from_table(table, |_| true);
    assert!(is_part(&whole, &whole, false));
    let shortened = crate::from_table(&table.replace("9,", "0,"), |_| true);
    assert!(is_part(&shortened, &whole, true));
    assert!(!is_part(&shortened, &whole, false));
    assert!(!is_part(&crate::from_table(&table.replacen("7,8", "7,9", 1), |_| true), &whole, true));
    assert!(!is_part(&crate::from_table(table, |id| id == 7), &whole, true));
}

/// A change to a file. Most numbers that steer a reader stand near the start.
#[derive(Clone, Debug)]
enum Edit {
    Flip(Index, u8),
    Cut(Index),
    Insert(Index, Vec<u8>),
    Remove(Index, u8),
    /// Another digit in place of one of the first digits.
    Digit(Index, u8),
    /// A number made huge.
    Grow(Index),
}

fn edits() -> impl Strategy<Value = Vec<Edit>> {
    let at = any::<Index>;
    let edit = prop_oneof![
        3 => (at(), 0..8u8).prop_map(|(at, bit)| Edit::Flip(at, bit)),
        1 => at().prop_map(Edit::Cut),
        2 => (at(), prop::collection::vec(any::<u8>(), 1..9)).prop_map(|(at, bytes)| Edit::Insert(at, bytes)),
        2 => (at(), 1..9u8).prop_map(|(at, count)| Edit::Remove(at, count)),
        4 => (at(), b'0'..=b'9').prop_map(|(at, digit)| Edit::Digit(at, digit)),
        2 => at().prop_map(Edit::Grow),
    ];
    prop::collection::vec(edit, 1..4)
}

impl Edit {
    fn apply(&self, bytes: &mut Vec<u8>) {
        const HEAD: usize = 4000;
        let digits = |bytes: &[u8]| -> Vec<usize> {
            (0..bytes.len().min(HEAD)).filter(|&i| bytes[i].is_ascii_digit()).collect()
        };
        // Half of the places lie near the start.
        let place = |at: &Index, bytes: &[u8]| match at.index(2) {
            0 => at.index(bytes.len() + 1),
            _ => at.index(bytes.len().min(HEAD) + 1),
        };
        match self {
            Edit::Flip(at, bit) => {
                let at = place(at, bytes);
                bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << bit);
            }
            Edit::Cut(at) => bytes.truncate(at.index(bytes.len() + 1)),
            Edit::Insert(at, new) => {
                let at = place(at, bytes);
                bytes.splice(at..at, new.iter().copied());
            }
            Edit::Remove(at, count) => {
                let start = place(at, bytes);
                let end = (start + usize::from(*count)).min(bytes.len());
                bytes.drain(start..end);
            }
            Edit::Digit(at, digit) => {
                let digits = digits(bytes);
                if !digits.is_empty() {
                    bytes[digits[at.index(digits.len())]] = *digit;
                }
            }
            Edit::Grow(at) => {
                let digits = digits(bytes);
                if !digits.is_empty() {
                    let at = digits[at.index(digits.len())];
                    bytes.splice(at..at, *b"999999999");
                }
            }
        }
    }
}

/// Reads a changed file; says what is not as it should be.
fn check(path: &Path, bytes: &[u8]) -> Result<Option<Frame>, String> {
    match bounded(bytes.len(), || read(path, bytes))? {
        Err(_) => Ok(None),
        Ok(frame) if frame.bytes() > 64 * bytes.len() + (1 << 20) => {
            Err(format!("{} bytes gave a frame of {}", bytes.len(), frame.bytes()))
        }
        Ok(frame) => Ok(Some(frame)),
    }
}

#[test]
fn changed_files_are_faults_or_frames() {
    let fixtures: Vec<(PathBuf, Vec<u8>)> = fixtures();
    let config = Config { cases: 20_000, failure_persistence: None, ..Config::default() };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let (faults, changed) = (std::cell::Cell::new(0), std::cell::Cell::new(0));
    let originals: Vec<Frame> = fixtures.iter().map(|(path, bytes)| read(path, bytes).unwrap()).collect();
    runner
        .run(&(any::<Index>(), edits()), |(which, edits)| {
            let which = which.index(fixtures.len());
            let (path, mut bytes) = fixtures[which].clone();
            edits.iter().for_each(|edit| edit.apply(&mut bytes));
            match check(&path, &bytes).map_err(TestCaseError::fail)? {
                None => faults.set(faults.get() + 1),
                Some(frame) if difference(&frame, &originals[which]).is_some() => {
                    changed.set(changed.get() + 1)
                }
                Some(_) => {}
            }
            Ok(())
        })
        .unwrap();
    // Else the edits have missed what they are meant to hit.
    assert!(faults.get() > 5000 && changed.get() > 1000, "{faults:?} faults, {changed:?} changed frames");
}
