//! Which particles of a frame a view selects.

use glam::DVec3;
use renderer::{Filter, SelectView};

use super::{SceneError, Selection};
use crate::frames::Frame;

/// The rows of a frame that clips and filters leave.
pub struct Choice<'a, P> {
    frame: &'a Frame,
    keeps_point: P,
    filters: Vec<(&'a Filter, Selection<'a>)>,
}

/// What `select` chooses from `frame`.
///
/// # Errors
/// A filter by a field or component that the frame lacks.
pub fn choice<'a>(
    frame: &'a Frame,
    select: &'a SelectView,
) -> Result<Choice<'a, impl Fn(DVec3) -> bool + Sync + use<>>, SceneError> {
    let of_value = |(number, filter): (usize, &'a Filter)| {
        let field = Selection::new(frame, Some(&filter.field));
        let field = field.map_err(|why| SceneError::Filter { number, why: Box::new(why) })?;
        Ok((filter, field))
    };
    let on = select.filters.iter().enumerate().filter(|(_, filter)| filter.on);
    let filters = on.map(of_value).collect::<Result<_, SceneError>>()?;
    Ok(Choice { frame, keeps_point: select.keeps_point(), filters })
}

impl<P: Fn(DVec3) -> bool> Choice<'_, P> {
    /// Whether a particle is left in. Rows without a place are for the particle set to reject.
    pub fn keeps(&self, row: usize) -> bool {
        (self.keeps_point)(DVec3::from_array(self.frame.position(row)))
            && self.filters.iter().all(|(filter, field)| filter.keeps(field.value(row)))
    }
}
