//! Transfer functions in the form of ParaView's colour maps: a JSON array of maps, of which the first is
//! taken.
//!
//! `RGBPoints` holds x, r, g, b of each point, in sRGB, `Points` x, opacity, midpoint and sharpness; x may be
//! in any unit, and the ends of the colours become u = 0 and u = 1. Between its points a map is
//! interpolated in its `ColorSpace`, here linearly in linear light: segments are cut up where that differs.

use std::path::Path;

use anyhow::{Context, anyhow, bail, ensure};
use renderer::colour_space::{diverging, from_lab, to_lab, to_linear, to_srgb};
use renderer::{ColourPoint, ControlPoint, MapView, TransferFunction, TransferView};
use serde_json::{Map, Value, json};

use crate::io_error::describe;
use crate::whole_file::write_whole;

/// A segment is cut into so many parts, where its colour space is not linear light.
const PARTS: u32 = 8;
/// The same of a segment of opacity that is not straight.
const CURVE_PARTS: u32 = 16;

/// Colours, and u and opacity of each node where there are any.
pub type Imported = (MapView, Option<Vec<(f32, f32)>>);

/// Reads a function: colours, and opacities where the file has them.
///
/// # Errors
/// A file that cannot be read, or is no colour map; the file comes first, then the key.
pub fn read(path: &Path) -> anyhow::Result<Imported> {
    let name = || path.display().to_string();
    let text = std::fs::read_to_string(path).map_err(|error| anyhow!(describe(&error))).with_context(name)?;
    parse(text.trim_start_matches('\u{feff}')).with_context(name)
}

/// Puts what was read in the place of what `transfer` has.
pub fn adopt(transfer: &mut TransferView, (map, opacities): Imported) {
    if let Some(opacities) = opacities {
        let point = |(u, opacity)| ControlPoint { u, rgb: [1.0; 3], opacity };
        transfer.points = opacities.into_iter().map(point).collect();
    }
    transfer.map = Some(map);
    if let Ok(function) = transfer.function() {
        for point in &mut transfer.points {
            let [r, g, b, _] = function.sample(point.u);
            point.rgb = [r, g, b];
        }
    }
}

fn parse(text: &str) -> anyhow::Result<Imported> {
    let file: Value = serde_json::from_str(text).map_err(|error| anyhow!("is not JSON: {error}"))?;
    let first = match &file {
        Value::Array(maps) => maps.first().context("holds no colour map")?,
        map => map,
    };
    let map = first.as_object().context("expected an array of colour maps, or one")?;
    let points = numbers(map, "RGBPoints", 4)?.context("RGBPoints: is missing")?;
    let points: Vec<[f64; 4]> = points.as_chunks().0.to_vec();
    let ends = [points[0][0], points[points.len() - 1][0]];
    ensure!(ends[0] < ends[1], "RGBPoints: the last x, {}, is not above the first, {}", ends[1], ends[0]);
    let u = |x: f64| ((x - ends[0]) / (ends[1] - ends[0])).clamp(0.0, 1.0) as f32;
    let map_points = colours(&points, space(map)?)
        .into_iter()
        .map(|[x, r, g, b]| ColourPoint {
            u: u(x),
            rgb: [r, g, b].map(|c| to_linear(c.clamp(0.0, 1.0)) as f32),
        })
        .collect();
    let opacities = numbers(map, "Points", 4)?.map(|points| {
        let points = within(&opacities(points.as_chunks().0), ends);
        points.into_iter().map(|(x, opacity)| (u(x), opacity.clamp(0.0, 1.0) as f32)).collect()
    });
    Ok((MapView { points: map_points, ..MapView::default() }, opacities))
}

/// Numbers in groups of `group`, the first of each ascending; `None` where there is no such key.
fn numbers(map: &Map<String, Value>, key: &str, group: usize) -> anyhow::Result<Option<Vec<f64>>> {
    let Some(value) = map.get(key) else { return Ok(None) };
    let list = value.as_array().with_context(|| format!("{key}: expected an array of numbers"))?;
    let numbers: Option<Vec<f64>> = list.iter().map(Value::as_f64).collect();
    let numbers = numbers.with_context(|| format!("{key}: expected an array of numbers"))?;
    ensure!(
        numbers.len() >= 2 * group && numbers.len().is_multiple_of(group),
        "{key}: has {} numbers, expected a multiple of {group}, at least {}",
        numbers.len(),
        2 * group
    );
    let most = group * TransferFunction::MAX_POINTS / 2;
    ensure!(numbers.len() <= most, "{key}: has {} numbers, more than {most}", numbers.len());
    let ascends = numbers.chunks(group).is_sorted_by_key(|point| point[0]);
    ensure!(ascends, "{key}: x does not ascend");
    Ok(Some(numbers))
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Space {
    Rgb,
    Hsv,
    Lab,
    Diverging,
    Step,
}

fn space(map: &Map<String, Value>) -> anyhow::Result<Space> {
    let Some(value) = map.get("ColorSpace") else { return Ok(Space::Rgb) };
    Ok(match value.as_str() {
        Some("RGB") => Space::Rgb,
        Some("HSV") => Space::Hsv,
        // Lab by another measure of distance, which is close to it.
        Some("Lab" | "CIELAB" | "Lab/CIEDE2000") => Space::Lab,
        Some("Diverging") => Space::Diverging,
        Some("Step") => Space::Step,
        _ => bail!("ColorSpace: {value} is none of RGB, HSV, Lab, Lab/CIEDE2000, Diverging, Step"),
    })
}

/// x and sRGB of enough points.
fn colours(points: &[[f64; 4]], space: Space) -> Vec<[f64; 4]> {
    // Tables are dense enough as they are.
    let parts = if points.len() > 64 { 1 } else { PARTS };
    let mut all = vec![points[0]];
    for pair in points.windows(2) {
        let [[x0, a @ ..], [x1, b @ ..]] = [pair[0], pair[1]];
        if space == Space::Step {
            all.push([x1, a[0], a[1], a[2]]);
            all.push(pair[1]);
            continue;
        }
        for part in 1..=parts {
            let share = f64::from(part) / f64::from(parts);
            let [r, g, b] = between(a, b, share, space);
            all.push([x0 + share * (x1 - x0), r, g, b]);
        }
    }
    all
}

fn between(a: [f64; 3], b: [f64; 3], share: f64, space: Space) -> [f64; 3] {
    let mix = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i]));
    match space {
        Space::Rgb | Space::Step => mix(a, b),
        Space::Lab => from_lab(mix(to_lab(a), to_lab(b))),
        Space::Diverging => diverging(a, b, share),
        Space::Hsv => {
            let (a, mut b) = (to_hsv(a), to_hsv(b));
            // The shorter way round.
            b[0] -= (b[0] - a[0]).round();
            from_hsv(mix(a, b))
        }
    }
}

/// Hue, saturation and value, from 0 to 1.
fn to_hsv([r, g, b]: [f64; 3]) -> [f64; 3] {
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let spread = most - least;
    let sixths = match () {
        () if spread <= 0.0 => 0.0,
        () if most == r => (g - b) / spread,
        () if most == g => (b - r) / spread + 2.0,
        () => (r - g) / spread + 4.0,
    };
    [(sixths / 6.0).rem_euclid(1.0), if most > 0.0 { spread / most } else { 0.0 }, most]
}

fn from_hsv([h, s, v]: [f64; 3]) -> [f64; 3] {
    [5.0, 3.0, 1.0].map(|turn| {
        let k = (turn + 6.0 * h).rem_euclid(6.0);
        v - v * s * k.min(4.0 - k).clamp(0.0, 1.0)
    })
}

/// x and opacity of enough points: midpoints and sharpness as VTK has them.
fn opacities(points: &[[f64; 4]]) -> Vec<(f64, f64)> {
    let mut all = vec![(points[0][0], points[0][1])];
    for pair in points.windows(2) {
        let [[x0, y0, middle, sharpness], [x1, y1, ..]] = [pair[0], pair[1]];
        let straight = sharpness < 0.01 && (middle - 0.5).abs() < 1e-6;
        let parts = if straight || y0 == y1 { 1 } else { CURVE_PARTS };
        for part in 1..=parts {
            let share = f64::from(part) / f64::from(parts);
            all.push((x0 + share * (x1 - x0), curve(y0, y1, share, middle, sharpness)));
        }
    }
    all
}

/// The part of a curve over x from `low` to `high`, to whose ends it is interpolated.
fn within(points: &[(f64, f64)], [low, high]: [f64; 2]) -> Vec<(f64, f64)> {
    let at = |x: f64| {
        let next = points.partition_point(|point| point.0 < x);
        match (next.checked_sub(1).map(|before| points[before]), points.get(next)) {
            (Some((x0, y0)), Some((x1, y1))) => y0 + (x - x0) / (x1 - x0) * (y1 - y0),
            (Some((_, y)), None) => y,
            (None, after) => after.map_or(0.0, |after| after.1),
        }
    };
    let inside = points.iter().filter(|point| (low..=high).contains(&point.0)).copied();
    let is_at = |x: f64| points.iter().any(|point| point.0 == x);
    let first = (points[0].0 < low && !is_at(low)).then(|| (low, at(low)));
    let last = (points[points.len() - 1].0 > high && !is_at(high)).then(|| (high, at(high)));
    first.into_iter().chain(inside).chain(last).collect()
}

/// vtkPiecewiseFunction between two nodes.
fn curve(y0: f64, y1: f64, share: f64, middle: f64, sharpness: f64) -> f64 {
    let middle = middle.clamp(1e-5, 1.0 - 1e-5);
    let s = if share < middle { 0.5 * share / middle } else { 0.5 + 0.5 * (share - middle) / (1.0 - middle) };
    match sharpness {
        _ if share >= 1.0 => y1,
        sharpness if sharpness > 0.99 => {
            if s < 0.5 {
                y0
            } else {
                y1
            }
        }
        sharpness if sharpness < 0.01 => y0 + s * (y1 - y0),
        sharpness => {
            let power = 1.0 + 10.0 * sharpness;
            let s = match s < 0.5 {
                true => 0.5 * (2.0 * s).powf(power),
                false => 1.0 - 0.5 * (2.0 * (1.0 - s)).powf(power),
            };
            let slope = (1.0 - sharpness) * (y1 - y0);
            let (s2, s3) = (s * s, s * s * s);
            let value = (2.0 * s3 - 3.0 * s2 + 1.0) * y0
                + (3.0 * s2 - 2.0 * s3) * y1
                + (2.0 * s3 - 3.0 * s2 + s) * slope;
            (value + (s3 - s2) * slope).clamp(y0.min(y1), y0.max(y1))
        }
    }
}

/// Writes `transfer`, in values of `range`.
///
/// # Errors
/// Where the file cannot be written, or the function is none.
pub fn write(path: &Path, transfer: &TransferView, range: [f64; 2]) -> anyhow::Result<()> {
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let text = format!("{:#}\n", to_json(&name, transfer, range)?);
    write_whole(path, text.as_bytes())
}

fn to_json(name: &str, transfer: &TransferView, [low, high]: [f64; 2]) -> anyhow::Result<Value> {
    let x = |u: f32| low + f64::from(u) * (high - low);
    let colours = transfer.colours()?;
    let function = transfer.function()?;
    let mut rgb: Vec<f64> = Vec::new();
    let mut add = |u: f32, [r, g, b]: [f32; 3]| {
        rgb.push(x(u));
        rgb.extend([r, g, b].map(|channel| to_srgb(f64::from(channel))));
    };
    if let Some(first) = colours.first().filter(|first| first.u > 0.0) {
        add(0.0, first.rgb);
    }
    for (i, point) in colours.iter().enumerate() {
        add(point.u, point.rgb);
        let Some(next) = colours.get(i + 1).filter(|_| colours.len() <= 64) else { continue };
        // ParaView has no linear light: a few points between keep close to it.
        for part in (1..PARTS).filter(|_| next.u > point.u) {
            let u = point.u + part as f32 / PARTS as f32 * (next.u - point.u);
            let [r, g, b, _] = function.sample(u);
            add(u, [r, g, b]);
        }
    }
    if let Some(last) = colours.last().filter(|last| last.u < 1.0) {
        add(1.0, last.rgb);
    }
    let opacities: Vec<f64> =
        transfer.points.iter().flat_map(|point| [x(point.u), f64::from(point.opacity), 0.5, 0.0]).collect();
    Ok(json!([{ "Name": name, "ColorSpace": "RGB", "RGBPoints": rgb, "Points": opacities }]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_srgb_over_any_range() {
        let (map, opacities) = parse(
            r#"[{"Name": "x", "ColorSpace": "RGB", "RGBPoints": [100, 0, 0, 0, 300, 1, 0.5, 0],
                "Points": [100, 0, 0.5, 0, 200, 0.4, 0.5, 0, 300, 1, 0.5, 0]}]"#,
        )
        .unwrap();
        let colours = map.colours().unwrap();
        assert_eq!((colours[0].u, colours.last().unwrap().u), (0.0, 1.0));
        assert!((colours.last().unwrap().rgb[1] - 0.214_041).abs() < 1e-5);
        // Halfway in sRGB, which is far from halfway in linear light.
        let middle = colours.iter().find(|point| point.u == 0.5).unwrap();
        assert!((middle.rgb[0] - 0.214_041).abs() < 1e-5, "{middle:?}");
        assert_eq!(opacities.unwrap(), [(0.0, 0.0), (0.5, 0.4), (1.0, 1.0)]);
    }

    #[test]
    fn opacities_are_cut_where_the_colours_end() {
        let of = |points: &str| {
            let text = format!(r#"{{"RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1], "Points": [{points}]}}"#);
            parse(&text).unwrap().1.unwrap()
        };
        assert_eq!(of("-99, 0, 0.5, 0, 1, 1, 0.5, 0"), [(0.0, 0.99), (1.0, 1.0)]);
        assert_eq!(
            of("-1, 0, 0.5, 0, 0.5, 0.75, 0.5, 0, 2, 0, 0.5, 0"),
            [(0.0, 0.5), (0.5, 0.75), (1.0, 0.5)]
        );
        // A step at an end stays one, and what lies beyond goes on as it ends.
        let step = of("-1, 1, 0.5, 0, 0, 1, 0.5, 0, 0, 0, 0.5, 0, 1, 1, 0.5, 0");
        assert_eq!(step, [(0.0, 1.0), (0.0, 0.0), (1.0, 1.0)]);
        assert_eq!(of("-3, 0.25, 0.5, 0, -2, 0.5, 0.5, 0"), [(0.0, 0.5)]);
        assert_eq!(of("2, 0.25, 0.5, 0, 3, 0.5, 0.5, 0"), [(1.0, 0.25)]);
    }

    #[test]
    fn every_colour_space_is_followed() {
        let of = |space: &str| {
            let text = format!(
                r#"[{{"ColorSpace": "{space}", "RGBPoints": [0, 0.23, 0.3, 0.75, 1, 0.7, 0.02, 0.15]}}]"#
            );
            let (map, _) = parse(&text).unwrap();
            map.points.iter().rev().find(|point| point.u == 0.5).map(|point| point.rgb)
        };
        let grey = of("Diverging").unwrap();
        assert!(grey.iter().all(|channel| (channel - grey[0]).abs() < 0.02) && grey[0] > 0.6, "{grey:?}");
        let lab = of("Lab").unwrap();
        assert!(lab != of("RGB").unwrap() && lab != of("HSV").unwrap());
        assert_eq!(of("Step"), None, "a step has no middle");
        for colour in [[0.2, 0.7, 0.1], [0.9, 0.1, 0.3], [0.1, 0.1, 0.8]] {
            let back = from_hsv(to_hsv(colour));
            assert!(colour.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-12), "{colour:?} {back:?}");
        }
    }

    #[test]
    fn what_is_written_is_read_again() {
        let mut view = TransferView::default();
        let text = to_json("mine", &view, [-2.0, 7.0]).unwrap().to_string();
        let before = view.function().unwrap();
        adopt(&mut view, parse(&text).unwrap());
        let after = view.function().unwrap();
        for i in 0..=100 {
            let u = i as f32 / 100.0;
            let apart =
                before.sample(u).iter().zip(after.sample(u)).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(apart < 0.004, "{u}: {apart}");
        }
    }

    #[test]
    fn curves_of_vtk_begin_and_end_at_their_nodes() {
        for (middle, sharpness) in [(0.5, 0.0), (0.2, 0.0), (0.5, 0.5), (0.7, 1.0)] {
            assert_eq!(curve(0.2, 0.8, 0.0, middle, sharpness), 0.2);
            assert_eq!(curve(0.2, 0.8, 1.0, middle, sharpness), 0.8);
            assert!((curve(0.2, 0.8, middle, middle, sharpness) - 0.5).abs() < 0.31);
        }
        assert_eq!(curve(0.0, 1.0, 0.2, 0.2, 0.0), 0.5);
    }

    #[test]
    fn errors_name_file_and_key() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.json");
        for (text, expected) in [
            ("[", "is not JSON"),
            ("[]", "no colour map"),
            ("[{}]", "RGBPoints: is missing"),
            (r#"[{"RGBPoints": [0, 1, 1, 1, 1]}]"#, "RGBPoints: has 5 numbers"),
            (r#"[{"RGBPoints": [1, 1, 1, 1, 0, 1, 1, 1]}]"#, "RGBPoints: x does not ascend"),
            (r#"[{"RGBPoints": [0, 1, 1, 1, "a", 1, 1, 1]}]"#, "RGBPoints: expected an array of numbers"),
            (r#"[{"RGBPoints": [0, 1, 1, 1, 1, 1, 1, 1], "ColorSpace": "Oklab"}]"#, "ColorSpace: \"Oklab\""),
            (r#"[{"RGBPoints": [0, 1, 1, 1, 1, 1, 1, 1], "Points": [1]}]"#, "Points: has 1 numbers"),
        ] {
            std::fs::write(&path, text).unwrap();
            let error = format!("{:#}", read(&path).unwrap_err());
            assert!(error.contains("map.json") && error.contains(expected), "{text}: {error}");
        }
    }
}
