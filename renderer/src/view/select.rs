//! Which particles are in the picture: a clip box, a clip plane, and filters by value.
//!
//! Particles whose centres are not selected are left out before anything else happens to them: the
//! picture is that of a run without them. Boundaries belong to what is selected, and `invert` takes
//! the complement, so that each particle is in exactly one of a selection and its inverse.

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use super::{ViewError, check};

/// What all that is on selects together; everything where nothing is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SelectView {
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub clip_box: Option<ClipBox>,
    #[serde(rename = "plane", skip_serializing_if = "Option::is_none")]
    pub clip_plane: Option<ClipPlane>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub filters: Vec<Filter>,
}

/// A box in which centres must lie, its sides included. Lengths in the unit of the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClipBox {
    /// Corners of the box before it is turned; `min` is nowhere above `max`.
    pub min: DVec3,
    pub max: DVec3,
    /// Turns the box around its middle: about the axis x, then y, then z of the world.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub rotation_degrees: DVec3,
    /// Whether what lies outside is kept instead.
    #[serde(default)]
    pub invert: bool,
    #[serde(default = "yes")]
    pub on: bool,
}

/// A plane on whose front side centres must lie, the plane included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClipPlane {
    /// Any point of the plane, in the unit of the run.
    pub point: DVec3,
    /// Points to the side that is kept; of any length but zero.
    pub normal: DVec3,
    /// Whether the other side is kept instead.
    #[serde(default)]
    pub invert: bool,
    #[serde(default = "yes")]
    pub on: bool,
}

/// A range in which a field's value must lie, its ends included. What is no number lies in no range.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Filter {
    /// A field's name, `field.x` for a component; of a vector field the length counts.
    pub field: String,
    pub range: [f64; 2],
    /// Whether the values outside are kept instead.
    #[serde(default)]
    pub invert: bool,
    #[serde(default = "yes")]
    pub on: bool,
}

fn yes() -> bool {
    true
}

fn is_zero(angles: &DVec3) -> bool {
    *angles == DVec3::ZERO
}

impl SelectView {
    /// Whether there is nothing in it, on or off.
    pub fn is_empty(&self) -> bool {
        *self == SelectView::default()
    }

    /// Whether something in it is on, and particles may be left out.
    pub fn is_on(&self) -> bool {
        self.clip_box.is_some_and(|clip| clip.on)
            || self.clip_plane.is_some_and(|clip| clip.on)
            || self.filters.iter().any(|filter| filter.on)
    }

    /// Tells of a point, in the unit of the run, whether box and plane keep it.
    pub fn keeps_point(&self) -> impl Fn(DVec3) -> bool + Sync + use<> {
        let clip_box = self.clip_box.filter(|clip| clip.on).map(|clip| clip.keeps());
        let clip_plane = self.clip_plane.filter(|clip| clip.on).map(|clip| clip.keeps());
        move |point| {
            clip_box.as_ref().is_none_or(|keeps| keeps(point))
                && clip_plane.as_ref().is_none_or(|keeps| keeps(point))
        }
    }

    pub(super) fn validate(&self) -> Result<(), ViewError> {
        if let Some(clip) = &self.clip_box {
            let sound = clip.min.is_finite() && clip.max.is_finite() && clip.min.cmple(clip.max).all();
            check(sound, "select.box", || "min is not a finite point below max in every coordinate".into())?;
            check(clip.rotation_degrees.is_finite(), "select.box.rotation_degrees", || {
                "is not finite".into()
            })?;
        }
        if let Some(clip) = &self.clip_plane {
            check(clip.point.is_finite(), "select.plane.point", || "is not finite".into())?;
            check(clip.normal.is_finite() && clip.direction().is_some(), "select.plane.normal", || {
                "is not a direction: it must be finite and not zero".into()
            })?;
        }
        for (number, Filter { field, range: [low, high], .. }) in self.filters.iter().enumerate() {
            check(low.is_finite() && high.is_finite() && low <= high, "select.filters", || {
                format!(
                    "range [{low}, {high}] of filter {number} (`{field}`) is not an ascending pair of finite numbers"
                )
            })?;
        }
        Ok(())
    }
}

impl ClipBox {
    /// Middle of the box, and half its sides.
    pub fn middle(&self) -> (DVec3, DVec3) {
        // Halves first: the sum of two huge coordinates may overflow.
        (self.min * 0.5 + self.max * 0.5, self.max * 0.5 - self.min * 0.5)
    }

    /// Unit vectors along the sides of the turned box, as columns.
    pub fn axes(&self) -> DMat3 {
        if is_zero(&self.rotation_degrees) {
            return DMat3::IDENTITY;
        }
        let [x, y, z] = self.rotation_degrees.to_array().map(f64::to_radians);
        DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x)
    }

    fn keeps(self) -> impl Fn(DVec3) -> bool + Sync + use<> {
        let back = self.axes().transpose();
        let straight = is_zero(&self.rotation_degrees);
        let (middle, _) = self.middle();
        move |point| {
            // A box that is not turned is compared with its corners as they are written.
            let point = if straight { point } else { middle + back * (point - middle) };
            let inside = point.cmpge(self.min).all() && point.cmple(self.max).all();
            inside != self.invert
        }
    }
}

impl ClipPlane {
    /// The normal as a unit vector; `None` where it has no direction.
    pub fn direction(&self) -> Option<DVec3> {
        // Its largest coordinate becomes 1 first: squares of tiny and huge ones leave the range of f64.
        (self.normal / self.normal.abs().max_element()).try_normalize()
    }

    fn keeps(self) -> impl Fn(DVec3) -> bool + Sync + use<> {
        let direction = self.direction().unwrap_or(DVec3::Z);
        move |point| ((point - self.point).dot(direction) >= 0.0) != self.invert
    }
}

impl Filter {
    /// Whether a particle with this value is kept.
    pub fn keeps(&self, value: f64) -> bool {
        let [low, high] = self.range;
        (low..=high).contains(&value) != self.invert
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::View;

    fn select(text: &str) -> SelectView {
        let view = View::from_json(&format!("{{\"select\": {text}}}")).unwrap();
        view.validate().unwrap();
        view.select
    }

    #[test]
    fn boundaries_belong_to_the_selection_and_not_to_its_inverse() {
        let lattice = || {
            (0..=8i32.pow(3)).map(|i| DVec3::new(f64::from(i % 8), f64::from(i / 8 % 8), f64::from(i / 64)))
        };
        for (clip, kept) in [
            (r#""box": {"min": [1, 2, 3], "max": [4, 4, 4]"#, 4 * 3 * 2),
            (r#""plane": {"point": [0, 3, 0], "normal": [0, 1e-200, 0]"#, 8 * 5 * 8),
        ] {
            let own = select(&format!("{{{clip}}}}}")).keeps_point();
            let inverse = select(&format!("{{{clip}, \"invert\": true}}}}")).keeps_point();
            let off = select(&format!("{{{clip}, \"on\": false}}}}")).keeps_point();
            assert_eq!(lattice().take(512).filter(|point| own(*point)).count(), kept, "{clip}");
            assert!(lattice().all(|point| own(point) != inverse(point) && off(point)), "{clip}");
        }
        let filter = Filter { field: "q".into(), range: [1.0, 2.0], invert: false, on: true };
        let inverse = Filter { invert: true, ..filter.clone() };
        assert_eq!(
            [0.9, 1.0, 2.0, 2.1, f64::NAN].map(|q| filter.keeps(q)),
            [false, true, true, false, false]
        );
        assert!([0.9, 1.0, 2.0, 2.1, f64::NAN].iter().all(|q| filter.keeps(*q) != inverse.keeps(*q)));
    }

    #[test]
    fn a_box_is_turned_around_its_middle() {
        let keeps =
            select(r#"{"box": {"min": [9, -2, -1], "max": [11, 2, 1], "rotation_degrees": [0, 0, 90]}}"#)
                .keeps_point();
        assert!(keeps(DVec3::new(11.9, 0.9, 0.9)) && !keeps(DVec3::new(10.0, 1.9, 0.0)));
        // About x first, then about z: what was along y comes to lie along z, and stays there.
        let keeps =
            select(r#"{"box": {"min": [-1, -4, -1], "max": [1, 4, 1], "rotation_degrees": [90, 0, 90]}}"#)
                .keeps_point();
        assert!(keeps(DVec3::new(0.0, 0.0, 3.9)) && !keeps(DVec3::new(3.9, 0.0, 0.0)));
    }

    #[test]
    fn what_is_on_is_kept_together() {
        let both = r#"{"box": {"min": [0, 0, 0], "max": [4, 4, 4]}, "plane": {"point": [2, 0, 0], "normal": [1, 0, 0]}}"#;
        let keeps = select(both).keeps_point();
        assert_eq!([1.0, 3.0, 5.0].map(|x| keeps(DVec3::new(x, 1.0, 1.0))), [false, true, false]);
        assert!(select(both).is_on() && !SelectView::default().is_on() && SelectView::default().is_empty());
    }

    #[test]
    fn the_file_holds_what_was_set_and_nothing_else() {
        assert!(!View::default().to_json().contains("select"));
        let text = r#"{"plane": {"point": [0, 0, 1], "normal": [0, 0, 2]}, "filters": [{"field": "id", "range": [3, 3]}]}"#;
        let view = View { select: select(text), ..View::default() };
        assert_eq!(View::from_json(&view.to_json()).unwrap(), view);
    }

    #[test]
    fn what_selects_nothing_that_can_be_meant_is_refused_by_its_key() {
        for (text, key) in [
            (r#"{"box": {"min": [0, 0, 2], "max": [1, 1, 1]}}"#, "select.box"),
            (r#"{"plane": {"point": [0, 0, 0], "normal": [0, 0, 0]}}"#, "select.plane.normal"),
            (r#"{"filters": [{"field": "q", "range": [2, 1]}]}"#, "select.filters"),
        ] {
            let view = View::from_json(&format!("{{\"select\": {text}}}")).unwrap();
            assert_eq!(view.validate().unwrap_err().key, key);
        }
        let unknown = View::from_json(r#"{"select": {"sphere": {}}}"#).unwrap_err().to_string();
        assert!(unknown.contains("sphere"), "{unknown}");
    }
}
