//! The tolerance set by mouse, and the error that it makes measured.

use crate::harness::{Window, missing};

#[test]
fn a_tolerance_is_set_and_its_error_measured() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::open(folder.path(), &["demo", "--size", "120x90"]);
    // High enough for the whole section.
    window.resize([900, 800]);
    window.wait_for_full_picture();
    // The sections above it are folded away, so that all of it is in view.
    window.fold(&["Quantity", "Transfer function"]);

    // On a software adapter it does not pay to adapt this view.
    window.click("adapt", [0.1, 0.5]);
    window.wait_for_full_picture();
    // Logarithmic, from 10⁻⁴ to 10⁻¹: two thirds of the way is about 10⁻².
    window.drag("tolerance", [0.53, 0.5], [0.65, 0.5]);
    window.wait_for_full_picture();
    let (_, view) = window.save(folder.path());
    assert!(view.sampling.always_adaptive);
    let tolerance = view.sampling.tolerance.unwrap();
    assert!((0.008..0.0125).contains(&tolerance), "{tolerance}");

    window.click("measure", [0.5, 0.5]);
    let found = window.wait_for("measured max=");
    let (max, above) = found.split_once(" above=").unwrap();
    let max: f64 = max.parse().unwrap();
    assert!(max > 0.0 && max <= tolerance, "{max} of {tolerance}");
    assert_eq!(above, "0");

    // It is gone with the picture that it is about.
    window.drag("picture", [0.3, 0.5], [0.6, 0.4]);
    window.wait_for("no measurement");
}
