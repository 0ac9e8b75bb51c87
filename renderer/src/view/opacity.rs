//! Opacity by another field than the colour.

use serde::{Deserialize, Serialize};

use crate::placement::{Scale, Spread};

use super::{ViewError, check_range};

/// Which field decides the opacity, and which of its values are 0 and 1 on the transfer function's axis,
/// where its opacity is read. The colour is read at the value of the field that is shown.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OpacityView {
    /// A field's name, `field.x` for a component; the field of the colour where it is absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The finite extremes over the frame where it is absent; on a logarithmic scale, those of what is
    /// positive, its upper 30 decades at most. Beyond its ends, opacities are those at the ends.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub range: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "super::is_linear")]
    pub scale: Scale,
}

impl OpacityView {
    /// Which values are the ends of the transfer function.
    pub fn spread(&self) -> Spread {
        Spread { range: self.range, scale: self.scale, outside: false }
    }

    pub(super) fn validate(&self) -> Result<(), ViewError> {
        check_range(self.range, self.scale, "quantity.opacity.range")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::View;

    #[test]
    fn a_view_without_an_opacity_says_nothing_of_it() {
        assert!(!View::default().to_json().contains("\"opacity\": {"));
        let text = r#"{"quantity": {"name": "velocity", "opacity": {"name": "density", "range": [0, 2]}}}"#;
        let view = View::from_json(text).unwrap();
        let expected =
            OpacityView { name: Some("density".into()), range: Some([0.0, 2.0]), ..OpacityView::default() };
        assert_eq!(view.quantity.opacity, Some(expected));
        assert_eq!(View::from_json(&view.to_json()).unwrap(), view);
        let text = r#"{"quantity": {"opacity": {"scale": "log"}}}"#;
        let log = View::from_json(text).unwrap();
        let expected = OpacityView { scale: Scale::Log, ..OpacityView::default() };
        assert_eq!(log.quantity.opacity, Some(expected));
        assert_eq!(View::from_json(&log.to_json()).unwrap(), log);
    }

    #[test]
    fn errors_name_the_key() {
        let error = View::from_json(r#"{"quantity": {"opacity": {"rnge": [0, 1]}}}"#).unwrap_err();
        assert!(error.to_string().contains("rnge"), "{error}");
        let falling = OpacityView { range: Some([1.0, 0.0]), ..OpacityView::default() };
        let from_zero = OpacityView { range: Some([0.0, 1.0]), scale: Scale::Log, name: None };
        let wide = OpacityView { range: Some([1e-300, 1e300]), scale: Scale::Log, name: None };
        for wrong in [&falling, &from_zero, &wide] {
            assert_eq!(wrong.validate().unwrap_err().key, "quantity.opacity.range");
        }
        for linear in [from_zero, wide].map(|view| OpacityView { scale: Scale::Linear, ..view }) {
            assert!(linear.validate().is_ok());
        }
    }
}
