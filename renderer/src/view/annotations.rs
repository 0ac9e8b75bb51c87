//! `"annotations"`: what is written and drawn over a picture.

use serde::{Deserialize, Serialize};

use super::{ViewError, check};

/// What stands over a picture. All items are off where the file does not name them; a view without
/// annotations draws none into pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AnnotationsView {
    /// Whether saved pictures have them; otherwise the window alone does.
    pub in_pictures: bool,
    /// The colours of the transfer function with the values that they stand for.
    pub colour_bar: bool,
    /// The opacities of the transfer function with the values that they stand for, where those are of another
    /// field.
    pub opacity_bar: bool,
    /// Small axes: which way the scene is turned.
    pub axes: bool,
    /// The frame's time, where it has one.
    pub time: bool,
    /// The frame's number in the run, from 0.
    pub frame_number: bool,
    /// A round length at the target's depth.
    pub scale_bar: bool,
    /// Written above the scene; nothing where it is empty.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub title: String,
    /// Written over the colour bar in place of the quantity's name.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub quantity_label: String,
    /// Written over the bar of the opacities in place of the name of their field.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub opacity_label: String,
    /// Written behind lengths, such as `m`: files do not say.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub length_unit: String,
    /// Written behind times, such as `s`.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub time_unit: String,
    /// Factor of all sizes, which are in proportion to the picture.
    pub size: f32,
    pub ink: Ink,
}

/// The colour of letters and lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ink {
    /// Dark on a light background, light on a dark one and on none.
    #[default]
    Automatic,
    Light,
    Dark,
}

impl Default for AnnotationsView {
    fn default() -> Self {
        AnnotationsView {
            in_pictures: true,
            colour_bar: false,
            opacity_bar: false,
            axes: false,
            time: false,
            frame_number: false,
            scale_bar: false,
            title: String::new(),
            quantity_label: String::new(),
            opacity_label: String::new(),
            length_unit: String::new(),
            time_unit: String::new(),
            size: 1.0,
            ink: Ink::Automatic,
        }
    }
}

impl AnnotationsView {
    /// Smallest and largest factor of sizes.
    pub const SIZES: [f32; 2] = [0.25, 4.0];
    /// The most letters of a text.
    pub const MAX_TEXT: usize = 200;

    /// What the window shows of a view that has no annotations: it is not saved with pictures.
    pub fn of_window() -> AnnotationsView {
        AnnotationsView {
            in_pictures: false,
            colour_bar: true,
            opacity_bar: true,
            axes: true,
            ..AnnotationsView::default()
        }
    }

    pub(super) fn validate(&self) -> Result<(), ViewError> {
        let [least, most] = AnnotationsView::SIZES;
        check((least..=most).contains(&self.size), "annotations.size", || {
            format!("{} is not between {least} and {most}", self.size)
        })?;
        let texts = [
            ("annotations.title", &self.title),
            ("annotations.quantity_label", &self.quantity_label),
            ("annotations.opacity_label", &self.opacity_label),
            ("annotations.length_unit", &self.length_unit),
            ("annotations.time_unit", &self.time_unit),
        ];
        texts.into_iter().try_for_each(|(key, text)| {
            let letters = text.chars().count();
            let most = AnnotationsView::MAX_TEXT;
            check(letters <= most, key, || format!("{letters} letters are more than {most}"))?;
            check(!text.contains(char::is_control), key, || "is more than one line".into())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::View;

    fn read(annotations: &str) -> View {
        View::from_json(&format!("{{\"annotations\": {annotations}}}")).unwrap()
    }

    #[test]
    fn a_view_without_them_has_none_and_stays_so() {
        let view = View::from_json("{}").unwrap();
        assert_eq!(view.annotations, None);
        assert!(!view.to_json().contains("annotations"));
    }

    #[test]
    fn what_is_named_is_drawn_into_pictures() {
        let view = read(r#"{"scale_bar": true, "title": "Mixer", "ink": "dark"}"#);
        let annotations = view.annotations.clone().unwrap();
        assert!(annotations.in_pictures && annotations.scale_bar && !annotations.colour_bar);
        assert_eq!((annotations.ink, annotations.size), (Ink::Dark, 1.0));
        assert!(view.validate().is_ok());
        assert_eq!(View::from_json(&view.to_json()).unwrap(), view);
    }

    #[test]
    fn what_is_out_of_range_is_told_by_its_key() {
        let wrong = |text: &str| read(text).validate().unwrap_err().to_string();
        assert_eq!(wrong(r#"{"size": 9}"#), "annotations.size: 9 is not between 0.25 and 4");
        assert!(wrong(r#"{"title": "a\nb"}"#).starts_with("annotations.title: "));
        let long = format!(r#"{{"length_unit": "{}"}}"#, "m".repeat(201));
        assert!(wrong(&long).starts_with("annotations.length_unit: 201 letters"));
    }
}
