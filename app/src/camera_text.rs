//! A camera as text, for the clipboard.

use anyhow::{Context, anyhow, bail};
use renderer::{CameraView, View};
use serde::Deserialize;
use serde_json::Value;

/// What the text starts with in messages.
const WHERE: &str = "clipboard";

/// All that a view may hold, and a camera may not.
const VIEW: [&str; 10] = [
    "camera",
    "image",
    "quantity",
    "particles",
    "select",
    "transfer",
    "sampling",
    "annotations",
    "bookmarks",
    "path",
];

/// The camera as `view.json` writes it.
pub fn to_text(camera: &CameraView) -> anyhow::Result<String> {
    Ok(serde_json::to_string_pretty(camera)?)
}

/// Reads a camera, or the camera of a whole `view.json`. Its eye and target may be open.
///
/// # Errors
/// What is neither; the key, or line and column, come after the clipboard's name.
pub fn from_text(text: &str) -> anyhow::Result<CameraView> {
    let json = |error: serde_json::Error| anyhow!("{WHERE}: is neither a camera nor a view: {error}");
    let value: Value = serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(json)?;
    let is_view = value.as_object().is_some_and(|keys| VIEW.iter().any(|key| keys.contains_key(*key)));
    let camera = if is_view {
        let view = View::from_json(text.trim_start_matches('\u{feff}')).map_err(json)?;
        match view.camera {
            Some(camera) => camera,
            None => bail!("{WHERE}: the view has no camera"),
        }
    } else {
        CameraView::deserialize(value).map_err(json)?
    };
    camera.validate().context(WHERE)?;
    Ok(camera)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAMERA: &str = r#"{"eye": [0, 0, 5], "target": [1, 0, 0], "fov_y_degrees": 30}"#;

    #[test]
    fn a_camera_and_a_view_with_one_are_read() {
        let camera = from_text(CAMERA).unwrap();
        assert_eq!(
            from_text(&format!("{{\"image\": {{\"width\": 9}}, \"camera\": {CAMERA}}}")).unwrap(),
            camera
        );
        assert_eq!(from_text(&to_text(&camera).unwrap()).unwrap(), camera);
        assert_eq!(camera.fov_y_degrees, 30.0);
    }

    #[test]
    fn what_is_wrong_is_told() {
        let wrong = |text: &str| format!("{:#}", from_text(text).unwrap_err());
        assert!(wrong("hello").starts_with("clipboard: is neither a camera nor a view: expected value"));
        assert!(wrong(r#"{"eyes": [0, 0, 5]}"#).contains("unknown field `eyes`"));
        assert_eq!(wrong(r#"{"image": {}}"#), "clipboard: the view has no camera");
        for key in ["select", "annotations", "path"] {
            assert_eq!(wrong(&format!("{{\"{key}\": {{}}}}")), "clipboard: the view has no camera");
        }
        assert_eq!(wrong(r#"{"bookmarks": []}"#), "clipboard: the view has no camera");
        assert_eq!(
            wrong(r#"{"eye": [0, 0, 5], "target": [0, 0, 5]}"#),
            "clipboard: camera.target: is the same point as camera.eye"
        );
    }
}
