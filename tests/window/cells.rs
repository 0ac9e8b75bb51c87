//! The classes of the cells laid over the picture, and a pixel looked into.

use crate::harness::{Window, missing};

#[test]
fn an_overlay_is_laid_over_the_picture_and_a_pixel_looked_into() {
    if let Some(why) = missing() {
        eprintln!("skipped: {why}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut window = Window::open(folder.path(), &["demo", "--size", "120x90"]);
    window.wait_for_full_picture();
    window.fold(&["Quantity", "Transfer function", "Sampling"]);
    // In the middle of the picture, well away from its legend.
    let middle = [200, 250, 80, 80];
    let plain = window.desktop().resting_pixels(middle);

    window.key("c");
    let mut found = window.wait_for("cells");
    window.wait_for_area("depth");
    // On a software adapter it does not pay to adapt this view.
    if found.contains("mixed: 0,") {
        window.wait_for_area("adapt-anyway");
        window.click("adapt-anyway", [0.5, 0.5]);
        window.wait_for_full_picture();
        found = window.wait_for("cells");
    }
    assert!(found.starts_with("CellClasses") && !found.contains("mixed: 0,"), "{found}");
    let classes = window.desktop().resting_pixels(middle);
    assert_ne!(plain, classes);
    // From the classes to a slice of them, and to the errors that are predicted.
    window.click("depth", [0.85, 0.5]);
    window.rest();
    assert_ne!(window.desktop().resting_pixels(middle), classes);
    window.click("overlay", [0.62, 0.5]);
    window.rest();
    let predicted = window.desktop().resting_pixels(middle);
    assert_ne!(predicted, classes);

    // The cells come with the picture, also while it turns.
    window.drag("picture", [0.3, 0.5], [0.5, 0.5]);
    window.wait_for("cells");
    window.wait_for_full_picture();
    window.wait_for("cells");
    window.click("overlay", [0.12, 0.5]);
    window.wait_for("picture");

    // A click looks into a pixel; without the tool it does not, and a drag with it turns the camera.
    window.click("inspect", [0.5, 0.5]);
    window.wait_for("inspect on");
    window.click("picture", [0.45, 0.5]);
    let found = window.wait_for("inspected");
    let cells: usize = found.rsplit('=').next().unwrap().parse().unwrap();
    assert!(cells > 3, "{found}");
    window.wait_for_area("inspector");
    window.rest();
    // Beside the inspector, there is a strip left of the picture.
    window.drag("picture", [0.03, 0.5], [0.03, 0.55]);
    window.wait_for("inspected");
    window.wait_for_full_picture();

    window.key("Escape");
    window.wait_for("inspector closed");
    window.key("i");
    window.wait_for("inspect off");
    window.click("picture", [0.45, 0.5]);
    window.rest();
    assert!(!window.said.iter().rev().take(8).any(|line| line.contains("inspected")), "{:#?}", window.said);
    assert!(!window.said.iter().any(|line| line.starts_with("event: error")), "{:#?}", window.said);
}
