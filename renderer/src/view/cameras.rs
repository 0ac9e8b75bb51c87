//! `"bookmarks"` and `"path"`: cameras by their names, and a camera that moves with the frames.

use serde::{Deserialize, Serialize};

use super::{CameraView, ViewError, check};

/// A camera with a name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bookmark {
    pub name: String,
    pub camera: CameraView,
}

/// How the camera moves from frame to frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PathView {
    /// Where the camera is at some frames, in ascending order; it moves smoothly between them. Without
    /// any, it starts from the view's camera.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub keyframes: Vec<Keyframe>,
    /// Turns around the target, over the whole run: counter-clockwise as seen from above. Beside the
    /// keyframes where there are some.
    #[serde(skip_serializing_if = "is_zero")]
    pub revolutions: f64,
}

/// A camera at a frame of the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keyframe {
    /// Counted from 0; it may lie between two frames.
    pub frame: f64,
    pub camera: CameraView,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl PathView {
    /// The most turns.
    pub const MAX_REVOLUTIONS: f64 = 1000.0;

    /// Whether the camera stays where it is.
    pub fn is_empty(&self) -> bool {
        self.keyframes.is_empty() && self.revolutions == 0.0
    }

    pub(super) fn validate(&self) -> Result<(), ViewError> {
        const FRAMES: &str = "path.keyframes";
        check(self.revolutions.abs() <= PathView::MAX_REVOLUTIONS, "path.revolutions", || {
            format!("{} is not between −1000 and 1000", self.revolutions)
        })?;
        for (i, Keyframe { frame, camera }) in self.keyframes.iter().enumerate() {
            check(frame.is_finite() && *frame >= 0.0, FRAMES, || {
                format!("frame {frame} of keyframe {i} is not a number from 0 on")
            })?;
            settled(camera, FRAMES, || format!("keyframe {i}"))?;
        }
        let ascending = self.keyframes.windows(2).all(|pair| pair[0].frame < pair[1].frame);
        check(ascending, FRAMES, || "their frames are not in ascending order".into())
    }
}

pub(super) fn validate_bookmarks(bookmarks: &[Bookmark]) -> Result<(), ViewError> {
    bookmarks
        .iter()
        .try_for_each(|Bookmark { name, camera }| settled(camera, "bookmarks", || format!("`{name}`")))
}

/// Checks a camera that must be given in full; errors say which one it is.
fn settled(camera: &CameraView, key: &'static str, which: impl Fn() -> String) -> Result<(), ViewError> {
    check(camera.is_settled(), key, || format!("{}: the camera has no eye or no target", which()))?;
    camera.validate().map_err(|error| ViewError::new(key, format!("{}: {error}", which())))
}

#[cfg(test)]
mod tests {
    use crate::view::View;

    const CAMERA: &str = r#"{"eye": [0, 0, 5], "target": [0, 0, 0]}"#;

    fn read(text: &str) -> View {
        View::from_json(&text.replace("CAMERA", CAMERA)).unwrap()
    }

    #[test]
    fn they_are_kept_and_a_view_without_them_says_nothing_of_them() {
        let view = read(
            r#"{"bookmarks": [{"name": "front", "camera": CAMERA}],
                "path": {"keyframes": [{"frame": 0, "camera": CAMERA}, {"frame": 8.5, "camera": CAMERA}], "revolutions": -2}}"#,
        );
        view.validate().unwrap();
        assert_eq!(View::from_json(&view.to_json()).unwrap(), view);
        let plain = View::default().to_json();
        assert!(!plain.contains("bookmarks") && !plain.contains("path"), "{plain}");
    }

    #[test]
    fn errors_say_which_one_is_wrong() {
        for (text, error) in [
            (
                r#"{"path": {"keyframes": [{"frame": 3, "camera": CAMERA}, {"frame": 3, "camera": CAMERA}]}}"#,
                "path.keyframes: their frames are not in ascending order",
            ),
            (
                r#"{"path": {"keyframes": [{"frame": 0, "camera": {"eye": [1, 2, 3]}}]}}"#,
                "path.keyframes: keyframe 0: the camera has no eye or no target",
            ),
            (
                r#"{"bookmarks": [{"name": "a", "camera": {"eye": [0, 0, 5], "target": [0, 0, 0], "up": [0, 0, 1]}}]}"#,
                "bookmarks: `a`: camera.up: is parallel to the viewing direction",
            ),
            (r#"{"path": {"revolutions": 5000}}"#, "path.revolutions: 5000 is not between −1000 and 1000"),
        ] {
            assert_eq!(read(text).validate().unwrap_err().to_string(), error);
        }
    }
}
