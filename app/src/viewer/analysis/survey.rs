//! Looking through all frames of a run for the extremes of their fields, in the background.

use std::sync::Arc;

use anyhow::bail;
use renderer::{Progress, Scale};

use crate::frames::{Frame, FrameSource};
use crate::scene::{Selection, extremes, quantity_names};

/// A field's name, as a view has it, and a scale that it may be shown on.
pub type Field = (Option<String>, Scale);

/// Extremes of fields, each in a frame.
pub type Found = Vec<(usize, Field, [f64; 2])>;

/// Reads one frame after the other. One that cannot be read has no part in it: it is told where it is shown.
///
/// # Errors
/// Where `progress` says to stop.
pub fn look_through(sources: &[Arc<dyn FrameSource>], progress: &mut Progress) -> anyhow::Result<Found> {
    let mut found = Vec::new();
    for (index, source) in sources.iter().enumerate() {
        if progress(index as f32 / sources.len() as f32).is_break() {
            bail!("cancelled");
        }
        if let Ok(frame) = source.load(&Arc::default()) {
            found.extend(fields(&frame).into_iter().map(|(field, extremes)| (index, field, extremes)));
        }
    }
    Ok(found)
}

fn fields(frame: &Frame) -> Vec<(Field, [f64; 2])> {
    let names = quantity_names(frame).into_iter().map(Some).chain([None]);
    let fields = names.flat_map(|name| [Scale::Linear, Scale::Log].map(|scale| (name.clone(), scale)));
    let of = |field: Field| {
        let selection = Selection::new(frame, field.0.as_deref()).ok()?;
        let extremes = extremes(frame, &selection, field.1)?;
        Some((field, extremes))
    };
    fields.filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;
    use std::path::PathBuf;

    use super::*;
    use crate::frames::Sequence;

    #[test]
    fn every_frame_and_field_is_looked_at_unless_it_is_cancelled() {
        let paths = ["demo:radial:27", "demo:radial:1000"].map(PathBuf::from);
        let sources = Sequence::open(&paths).unwrap().frame_sources();
        let found = look_through(&sources, &mut |_| ControlFlow::Continue(())).unwrap();
        for index in [0, 1] {
            for name in [None, Some("radius".to_owned())] {
                let of =
                    |scale| found.iter().find(|found| found.0 == index && found.1 == (name.clone(), scale));
                let (linear, log) = (of(Scale::Linear).unwrap().2, of(Scale::Log).unwrap().2);
                assert!(linear[0] <= log[0] && log[0] > 0.0 && linear[1] == log[1], "{linear:?} {log:?}");
            }
        }
        assert!(look_through(&sources, &mut |_| ControlFlow::Break(())).is_err());
    }
}
