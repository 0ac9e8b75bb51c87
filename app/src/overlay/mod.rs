//! What became of the cells of a picture, shown over it: by `render --overlay` and by the viewer.

mod legend;
mod lettering;
mod looks;
mod marks;
mod picture;
mod sheet;

pub use lettering::{Lettering, Line};
pub use looks::look;
pub use marks::{Depth, Mark, counts};
pub use picture::drawn_over;
pub use sheet::Sheet;

/// How much of the picture the classes cover, unless asked otherwise.
pub const OPACITY: f32 = 0.65;
