//! A particle that is found again in other frames.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use crate::frames::{Field, Frame};

/// A particle as it is in the frame in view, or as it was in the last one that had it.
#[derive(Clone)]
pub struct Tracked {
    pub frame: Arc<Frame>,
    /// Which frame of the sequence that is.
    pub index: usize,
    pub row: usize,
    pub mark: Mark,
    /// The frame that was last looked through, and whether it lacks the particle.
    looked_through: Arc<Frame>,
    pub lost: bool,
}

/// By what a particle is known again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mark {
    Id(f64),
    /// The frame has no usable ids: rows are all there is.
    Row(usize),
}

/// A wish to know where a particle is in another frame.
pub struct Search {
    pub frame: Arc<Frame>,
    pub index: usize,
    pub mark: Mark,
}

/// The row that was found; `None` where the frame lacks the particle.
pub struct Located {
    pub search: Search,
    pub row: Option<usize>,
}

impl Tracked {
    pub fn new(frame: Arc<Frame>, index: usize, row: usize) -> Tracked {
        let id = ids(&frame).map(|ids| ids.column.get(row, 0)).filter(|id| id.is_finite());
        let mark = id.map_or(Mark::Row(row), Mark::Id);
        Tracked { looked_through: Arc::clone(&frame), frame, index, row, mark, lost: false }
    }

    /// In the unit of the run.
    pub fn position(&self) -> DVec3 {
        DVec3::from_array(self.frame.position(self.row))
    }

    /// What is to be looked for in `frame`, where that was not done yet.
    pub fn search(&self, index: usize, frame: &Arc<Frame>) -> Option<Search> {
        let known = Arc::ptr_eq(&self.looked_through, frame);
        (!known).then(|| Search { frame: Arc::clone(frame), index, mark: self.mark })
    }

    /// Takes in what was found, where that is about this particle.
    pub fn take(&mut self, located: &Located) {
        let Located { search: Search { frame, index, mark }, row } = located;
        if *mark != self.mark {
            return;
        }
        self.looked_through = Arc::clone(frame);
        self.lost = row.is_none();
        if let Some(row) = *row {
            (self.frame, self.index, self.row) = (Arc::clone(frame), *index, row);
        }
    }
}

impl Search {
    /// Goes through the ids of the frame, on all threads.
    pub fn locate(self) -> Located {
        let count = self.frame.len();
        let row = match (self.mark, ids(&self.frame)) {
            (Mark::Id(id), Some(ids)) => {
                (0..count).into_par_iter().find_first(|row| ids.column.get(*row, 0) == id)
            }
            (Mark::Id(_), None) => None,
            (Mark::Row(row), _) => (row < count).then_some(row),
        };
        // A particle without a place cannot be marked.
        let row = row.filter(|row| self.frame.position(*row).iter().all(|x| x.is_finite()));
        Located { search: self, row }
    }
}

fn ids(frame: &Frame) -> Option<&Field> {
    frame.field("id").filter(|field| field.column.components() == 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Column, Metadata};

    /// Particles at x = 0, 1, 2, ... with these ids.
    fn frame(ids: Option<&[f64]>, count: usize) -> Arc<Frame> {
        let positions = (0..count).flat_map(|row| [row as f64, 0.0, 0.0]).collect::<Vec<_>>();
        let field = |ids: &[f64]| Field { name: "ParticleIDs".into(), column: Column::scalars(ids.to_vec()) };
        let fields = ids.map(field).into_iter().collect();
        Arc::new(Frame::new(Column::new(3, positions).unwrap(), fields, Metadata::default()).unwrap())
    }

    fn find(tracked: &Tracked, frame: &Arc<Frame>) -> Option<usize> {
        Search { frame: Arc::clone(frame), index: 1, mark: tracked.mark }.locate().row
    }

    #[test]
    fn a_particle_is_known_by_its_id_however_rows_are_sorted() {
        let tracked = Tracked::new(frame(Some(&[7.0, 5.0, 9.0]), 3), 0, 1);
        assert_eq!((tracked.mark, tracked.position().x), (Mark::Id(5.0), 1.0));
        assert_eq!(find(&tracked, &frame(Some(&[9.0, 8.0, 7.0, 5.0]), 4)), Some(3));
        assert_eq!(find(&tracked, &frame(Some(&[9.0, 8.0]), 2)), None);
        assert_eq!(find(&tracked, &frame(None, 9)), None, "another row is another particle");
    }

    #[test]
    fn without_ids_the_row_must_do() {
        let tracked = Tracked::new(frame(None, 5), 0, 4);
        assert_eq!(tracked.mark, Mark::Row(4));
        assert_eq!((find(&tracked, &frame(None, 6)), find(&tracked, &frame(None, 4))), (Some(4), None));
    }
}
