//! The picture in the window: from what the renderer drew to the screen, what lies over it, and what the
//! mouse does there.

pub mod annotations;
pub mod error_map;
pub mod handles;
pub mod layers;
pub mod overlay;
pub mod picture_view;
pub mod tone;
