//! The embedded demo run: a tank of two dyed waters that a paddle stirs.
//!
//! 53,504 particles, 27 frames 0.1 s apart, positions and dye `concentration`, simulated with
//! SPlisHSPlasH 2.19. Coordinates are kept to within 3.7e-5 m, a 600th of the particle spacing of
//! 0.022 m, concentrations to within 1.3e-4 ([`packed`](super::packed) tells how).
//! `app/examples/make_demo.rs` makes the file anew.

use std::sync::OnceLock;

use anyhow::anyhow;
use renderer::View;

use super::Frame;
use super::packed::PackedRun;

static BYTES: &[u8] = include_bytes!("../../../assets/demo.sphrun");
static VIEW: &str = include_str!("../../../assets/demo-view.json");

/// Times of the frames, in seconds.
pub fn times() -> anyhow::Result<Vec<f64>> {
    Ok(PackedRun::read_header(BYTES)?.times)
}

/// Frame `index`; the first call unpacks the whole run into 12 MB.
pub fn frame(index: usize) -> anyhow::Result<Frame> {
    static RUN: OnceLock<Result<PackedRun, String>> = OnceLock::new();
    let run = RUN.get_or_init(|| PackedRun::from_bytes(BYTES).map_err(|error| format!("{error:#}")));
    run.as_ref().map_err(|error| anyhow!("the embedded run: {error}"))?.frame(index)
}

/// The view that shows the demo at its best: both dyes vivid, the mixed water between them thin.
pub fn view() -> View {
    View::from_json(VIEW).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_embedded_run_is_whole() {
        let times = times().unwrap();
        assert_eq!(times.len(), 27);
        assert!((times[26] - 2.6).abs() < 1e-9);
        let frame = frame(26).unwrap();
        assert_eq!(frame.len(), 53_504);
        assert_eq!(frame.metadata.support_radius, Some(0.044));
        let column = &frame.field("concentration").unwrap().column;
        let mean = (0..frame.len()).map(|row| column.get(row, 0)).sum::<f64>() / frame.len() as f64;
        assert!((mean - 0.506).abs() < 1e-4, "{mean}");
        assert!(BYTES.len() < 12_000_000);
    }

    #[test]
    fn the_view_of_the_demo_is_valid() {
        let view = View::from_json(VIEW).unwrap();
        view.validate().unwrap();
        assert!(view.camera.is_some());
    }
}
