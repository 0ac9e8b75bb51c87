//! One panel a file. Panels edit the session's view; what needs the window they ask for by an action.

pub mod camera;
pub mod cell_classes;
pub mod cells;
pub mod error_legend;
pub mod filters;
pub mod help;
pub mod image;
pub mod inspector;
pub mod inspector_plot;
pub mod inspector_table;
pub mod legend;
pub mod measured_error;
pub mod messages;
pub mod overlay_legend;
pub mod particles;
pub mod performance;
pub mod presets;
pub mod probe;
pub mod quantity;
pub mod sampling;
pub mod saved;
pub mod selection;
pub mod timeline;
pub mod toolbar;
pub mod transfer_canvas;
pub mod transfer_editor;
