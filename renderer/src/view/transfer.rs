//! The transfer function of a view: opacities by control points, colours by those or by a map.

use serde::{Deserialize, Serialize};

use super::{ViewError, check, positive};
use crate::colour_map::ColourMap;
use crate::transfer::{ColourPoint, ControlPoint, TransferFunction, joined};

/// The transfer function; without a reference length, a thirtieth of the run's diagonal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TransferView {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference_length: Option<f64>,
    pub points: Vec<ControlPoint>,
    /// Colours in the place of those of the points.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub map: Option<MapView>,
}

impl Default for TransferView {
    fn default() -> Self {
        let point = |u, rgb, opacity| ControlPoint { u, rgb, opacity };
        TransferView {
            reference_length: None,
            // Blue over grey to red in linear light, with the middle thin so that both ends show.
            points: vec![
                point(0.0, [0.03, 0.12, 0.60], 0.45),
                point(0.25, [0.16, 0.45, 0.85], 0.25),
                point(0.5, [0.75, 0.75, 0.70], 0.18),
                point(0.75, [0.90, 0.36, 0.12], 0.30),
                point(1.0, [0.65, 0.03, 0.03], 0.60),
            ],
            map: None,
        }
    }
}

/// Colours along u: a map by its name, or points of colour. One of the two.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MapView {
    /// One of [`ColourMap::all`].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// As those of the transfer function: linear between, constant outside, a step where two share one u.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<ColourPoint>,
    /// Whether u = 0 and u = 1 change places.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub reversed: bool,
}

/// What is shown of values on one side of the range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutsideView {
    /// Linear light.
    pub rgb: [f32; 3],
    /// Of a path of one reference length.
    pub opacity: f32,
}

impl MapView {
    pub fn named(name: &str) -> MapView {
        MapView { name: Some(name.to_owned()), ..MapView::default() }
    }

    /// The colours in ascending order of u.
    ///
    /// # Errors
    /// Where neither or both of name and points are given, or there is no map of this name, or points are out of range.
    pub fn colours(&self) -> Result<Vec<ColourPoint>, ViewError> {
        let mut points = match (&self.name, self.points.as_slice()) {
            (Some(name), []) => named(name)?,
            (None, points @ [_, ..]) => points.to_vec(),
            (Some(_), _) => return Err(ViewError::new("transfer.map", "has both a name and points")),
            (None, []) => return Err(ViewError::new("transfer.map", "has neither a name nor points")),
        };
        const KEY: &str = "transfer.map.points";
        check(points.len() <= TransferFunction::MAX_POINTS, KEY, || {
            format!("has {} points, expected 1 to {}", points.len(), TransferFunction::MAX_POINTS)
        })?;
        for (i, ColourPoint { u, rgb: [r, g, b] }) in points.iter().enumerate() {
            let valid = [u, r, g, b].into_iter().all(|value| (0.0..=1.0).contains(value));
            check(valid, KEY, || format!("point {i} has a value outside 0 to 1"))?;
        }
        points.sort_by(|a, b| a.u.total_cmp(&b.u));
        if self.reversed {
            points.reverse();
            points.iter_mut().for_each(|point| point.u = 1.0 - point.u);
        }
        Ok(points)
    }
}

fn named(name: &str) -> Result<Vec<ColourPoint>, ViewError> {
    let Some(map) = ColourMap::by_name(name) else {
        let names: Vec<&str> = ColourMap::all().iter().map(|map| map.name).collect();
        let what = format!("there is no map `{name}`; there are: {}", names.join(", "));
        return Err(ViewError::new("transfer.map.name", what));
    };
    let last = (map.colours().len() - 1) as f32;
    let point = |(i, rgb): (usize, &[f32; 3])| ColourPoint { u: i as f32 / last, rgb: *rgb };
    Ok(map.colours().iter().enumerate().map(point).collect())
}

impl TransferView {
    /// The function itself, over u.
    ///
    /// # Errors
    /// Names the key of what is out of range.
    pub fn function(&self) -> Result<TransferFunction, ViewError> {
        let function = TransferFunction::new(&self.points)?;
        match &self.map {
            None => Ok(function),
            Some(map) => joined(&map.colours()?, function.points()),
        }
    }

    /// Colours in ascending order of u, of the map or of the points.
    pub fn colours(&self) -> Result<Vec<ColourPoint>, ViewError> {
        match &self.map {
            Some(map) => map.colours(),
            None => {
                let function = TransferFunction::new(&self.points)?;
                Ok(function.points().iter().map(|point| ColourPoint { u: point.u, rgb: point.rgb }).collect())
            }
        }
    }

    pub(super) fn validate(&self) -> Result<(), ViewError> {
        if let Some(length) = self.reference_length {
            check(positive(length), "transfer.reference_length", || {
                format!("{length} is not a positive length")
            })?;
        }
        self.function().map(drop)
    }
}

impl OutsideView {
    pub(super) fn validate(side: &Option<OutsideView>, key: &'static str) -> Result<(), ViewError> {
        let Some(OutsideView { rgb: [r, g, b], opacity }) = side else { return Ok(()) };
        let valid = [r, g, b, opacity].into_iter().all(|value| (0.0..=1.0).contains(value));
        check(valid, key, || "has a value outside 0 to 1".into())
    }
}

#[cfg(test)]
mod tests {
    use crate::view::View;

    fn read(transfer: &str) -> Result<View, String> {
        let view =
            View::from_json(&format!("{{\"transfer\": {transfer}}}")).map_err(|error| error.to_string())?;
        view.validate().map_err(|error| error.to_string())?;
        Ok(view)
    }

    #[test]
    fn colours_come_from_the_map_and_opacities_from_the_points() {
        let text = r#"{"map": {"name": "grey", "reversed": true}, "points": [
            {"u": 0, "rgb": [1, 0, 0], "opacity": 0}, {"u": 0.5, "rgb": [1, 0, 0], "opacity": 0.8}]}"#;
        let view = read(text).unwrap();
        let function = view.transfer.function().unwrap();
        assert_eq!(function.sample(0.0), [1.0, 1.0, 1.0, 0.0]);
        assert!((function.sample(0.25)[3] - 0.4).abs() < 1e-6);
        assert_eq!(function.sample(1.0), [0.0, 0.0, 0.0, 0.8]);
        assert_eq!(View::from_json(&view.to_json()).unwrap(), view);
    }

    #[test]
    fn a_view_without_a_map_says_nothing_of_it() {
        assert!(!View::default().to_json().contains("map"));
        let view = View::default();
        let function = view.transfer.function().unwrap();
        assert_eq!(function.points(), view.transfer.points);
    }

    #[test]
    fn errors_name_the_key() {
        for (transfer, key) in [
            (r#"{"map": {"name": "jet"}}"#, "transfer.map.name: there is no map `jet`; there are: viridis"),
            (r#"{"map": {}}"#, "transfer.map: has neither"),
            (r#"{"map": {"name": "vik", "points": [{"u": 0, "rgb": [0, 0, 0]}]}}"#, "transfer.map: has both"),
            (r#"{"map": {"points": [{"u": 2, "rgb": [0, 0, 0]}]}}"#, "transfer.map.points: point 0"),
            (r#"{"map": {"nme": "vik"}}"#, "nme"),
            (r#"{"reference_length": 0}"#, "transfer.reference_length"),
        ] {
            let error = read(transfer).unwrap_err();
            assert!(error.contains(key), "{transfer}: {error}");
        }
    }
}
