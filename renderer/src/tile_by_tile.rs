//! One tile of a picture after the other.

use crate::error::{RenderError, TooLarge};
use crate::picture::Picture;
use crate::plan::Tile;
use crate::renderer::{GridSize, Progress, Renderer};
use crate::tiles::Job;

type Done = Result<(), RenderError>;

/// What is done with a tile whose grid is on the device.
pub(crate) type TileWork<'a> =
    dyn FnMut(&mut Renderer, &Job, &Tile, GridSize, &mut Progress, &mut Picture) -> Done + 'a;

impl Renderer {
    /// Has one of the tiles `todo` after the other on the device, cut where it is too large, and does `work`
    /// on it. `work` gets its own share of the progress.
    pub(crate) fn each_tile(
        &mut self,
        job: &mut Job,
        mut todo: Vec<Tile>,
        progress: &mut Progress,
        picture: &mut Picture,
        work: &mut TileWork,
    ) -> Done {
        let cells: u64 = todo.iter().map(Tile::cells).sum();
        let mut cells_done = 0;
        todo.reverse();
        while let Some(tile) = todo.pop() {
            let mut part =
                |share: f32| progress((cells_done as f32 + share * tile.cells() as f32) / cells as f32);
            match self.prepare_tile(job, &tile, &mut picture.stats.milliseconds)? {
                Ok(size) => {
                    picture.stats.pairs += size.pairs;
                    picture.stats.cells += size.cells;
                    work(self, job, &tile, size, &mut part, picture)?;
                    cells_done += tile.cells();
                }
                Err(too_large) => {
                    job.only_tile = false;
                    todo.extend(self.halves(&tile, too_large)?);
                }
            }
        }
        Ok(())
    }

    /// The two halves of a tile that is too large, the one to be cast first at the end.
    pub(crate) fn halves(&self, tile: &Tile, too_large: TooLarge) -> Result<[Tile; 2], RenderError> {
        match tile.split() {
            Some([first, second]) => Ok([second, first]),
            None => Err(RenderError::TooLarge(too_large)),
        }
    }
}
