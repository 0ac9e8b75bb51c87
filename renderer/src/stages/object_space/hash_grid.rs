//! Particles in the cells of a grid in world space, for looking them up by place.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;
use rayon::prelude::*;

/// `Slot` of `cast.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(super) struct Slot {
    pub key: u32,
    pub first: u32,
    pub end: u32,
}

/// Cells as large as a mean support radius or larger, each with the particles whose supports meet it.
pub(crate) struct HashGrid {
    /// First corner, and side of a cell.
    pub corner: DVec3,
    pub side: f64,
    pub count: [u32; 3],
    pub(super) slots: Vec<Slot>,
    pub references: Vec<u32>,
    /// References of the fullest cell.
    pub largest: u32,
}

/// A cell has a number below this: it is one less than its key.
const MOST_CELLS: f64 = u32::MAX as f64;
/// Cells that a particle meets on average, at most: those much larger than most others meet many.
const MOST_MET: f64 = 100.0;
/// Single precision may put a sample into the next cell: supports are taken to be larger by this share.
const SLACK: f64 = 1e-3;

impl HashGrid {
    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        (size_of_val(&self.slots[..]) + size_of_val(&self.references[..])) as u64
    }

    /// `balls`: places and support radii.
    pub fn new(balls: &[(DVec3, f64)]) -> HashGrid {
        let reach = |(place, radius): &(DVec3, f64)| [*place - *radius, *place + *radius];
        let [low, high] = balls
            .iter()
            .map(reach)
            .fold([DVec3::MAX, DVec3::MIN], |[low, high], [a, b]| [low.min(a), high.max(b)]);
        let mean = balls.iter().map(|(_, radius)| radius).sum::<f64>() / balls.len().max(1) as f64;
        let extent = (high - low).max(DVec3::splat(mean));
        let mut side = mean;
        let counts = |side: f64| (extent / side).floor() + 1.0;
        let met =
            |side: f64| balls.iter().map(|(_, radius)| (2.0 * radius / side + 2.0).powi(3)).sum::<f64>();
        while counts(side).element_product() >= MOST_CELLS || met(side) > MOST_MET * balls.len() as f64 {
            side *= 2.0;
        }
        let count = counts(side).to_array().map(|count| count as u32);
        let mut pairs: Vec<(u32, u32)> = balls
            .par_iter()
            .enumerate()
            .flat_map_iter(|(index, (place, radius))| {
                let radius = radius * (1.0 + SLACK) + SLACK * side;
                let at = |corner: DVec3| {
                    let cell = ((corner - low) / side).floor().to_array();
                    std::array::from_fn(|axis| (cell[axis].max(0.0) as u32).min(count[axis] - 1))
                };
                cells(at(*place - radius), at(*place + radius), count).map(move |cell| (cell, index as u32))
            })
            .collect();
        pairs.par_sort_unstable();
        let largest = pairs.chunk_by(|a, b| a.0 == b.0).map(|cell| cell.len() as u32).max().unwrap_or(0);
        let slots = slots(&pairs);
        let references = pairs.into_iter().map(|(_, index)| index).collect();
        HashGrid { corner: low, side, count, slots, references, largest }
    }

    #[cfg(test)]
    fn particles_at(&self, place: DVec3) -> &[u32] {
        let at = ((place - self.corner) / self.side).floor().as_uvec3().to_array();
        let number = at[0] + self.count[0] * (at[1] + self.count[1] * at[2]);
        let mut slot = first_slot(number, self.slots.len());
        while self.slots[slot].key != 0 && self.slots[slot].key != number + 1 {
            slot = (slot + 1) % self.slots.len();
        }
        &self.references[self.slots[slot].first as usize..self.slots[slot].end as usize]
    }
}

/// Numbers of the cells in a box.
fn cells(first: [u32; 3], last: [u32; 3], count: [u32; 3]) -> impl Iterator<Item = u32> {
    let row = move |y: u32, z: u32| count[0] * (y + count[1] * z);
    (first[2]..=last[2])
        .flat_map(move |z| (first[1]..=last[1]).map(move |y| row(y, z)))
        .flat_map(move |row| (first[0]..=last[0]).map(move |x| row + x))
}

/// A table at most half full, of power-of-two size: open addressing, one slot after the other.
fn slots(pairs: &[(u32, u32)]) -> Vec<Slot> {
    let cells = pairs.chunk_by(|a, b| a.0 == b.0);
    let mut slots = vec![Slot::default(); (2 * cells.clone().count()).next_power_of_two().max(2)];
    let mut first = 0;
    for cell in cells {
        let mut place = first_slot(cell[0].0, slots.len());
        while slots[place].key != 0 {
            place = (place + 1) % slots.len();
        }
        let end = first + cell.len() as u32;
        slots[place] = Slot { key: cell[0].0 + 1, first, end };
        first = end;
    }
    slots
}

/// `slot_of` of `cast.wgsl`.
fn first_slot(cell: u32, slots: usize) -> usize {
    (cell.wrapping_mul(2_654_435_769) >> 7) as usize & (slots - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_finds_the_particles_that_reach_it() {
        let mut state = 1_u32;
        let mut unit = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24)
        };
        let mut place = || DVec3::new(unit(), unit(), unit());
        let balls: Vec<(DVec3, f64)> = (0..400).map(|i| (place(), 0.02 + 0.0002 * f64::from(i))).collect();
        let grid = HashGrid::new(&balls);
        let mut reached = 0;
        for _ in 0..2000 {
            let place = place();
            let found = grid.particles_at(place);
            assert!(found.is_sorted() && found.len() <= grid.largest as usize);
            for (index, (middle, radius)) in (0..).zip(&balls) {
                if (place - *middle).length() < *radius {
                    assert!(found.contains(&index), "{place} is in the support of {index}");
                    reached += 1;
                }
            }
        }
        assert!(reached > 500, "{reached}");
    }

    #[test]
    fn a_giant_among_dwarfs_does_not_meet_every_cell_of_its_size() {
        let place = |i: i32| DVec3::splat(f64::from(i));
        let mut balls: Vec<(DVec3, f64)> = (0..1000).map(|i| (place(i), 1e-3)).collect();
        balls.push((DVec3::ZERO, 1e6));
        let grid = HashGrid::new(&balls);
        assert!(grid.references.len() <= 100 * balls.len(), "{}", grid.references.len());
        assert!(
            grid.particles_at(place(500)).contains(&500) && grid.particles_at(place(500)).contains(&1000)
        );
    }

    #[test]
    fn one_particle_and_none_have_a_grid() {
        assert_eq!(HashGrid::new(&[(DVec3::ONE, 0.5)]).particles_at(DVec3::ONE), [0]);
        assert!(HashGrid::new(&[]).references.is_empty());
    }
}
