//! The embedded demo run.

use super::{Column, Frame, Metadata};

pub fn frame_count() -> usize {
    1
}

pub fn time(index: usize) -> f64 {
    index as f64 * 0.1
}

pub fn frame(_index: usize) -> anyhow::Result<Frame> {
    let positions = Column::new(3, Vec::<f32>::new()).expect("no rows");
    Ok(Frame::new(positions, Vec::new(), Metadata::default())?)
}

pub fn view() -> renderer::View {
    renderer::View::default()
}
