//! The device's memory: all arrays together stay within what they may take, whatever was rendered before.

use crate::gpu::{Gpu, Room};
use crate::plan::{Contents, TileLimits};
use crate::renderer::Renderer;

impl Renderer {
    /// Gives back what other pictures made larger than one within `limits` can use.
    pub(crate) fn give_back_above(&mut self, limits: &TileLimits, contents: Contents) {
        let (gpu, [particles, others]) = self.rooms(limits, contents);
        let particles_went = give_back(gpu, particles);
        if give_back(gpu, others) || particles_went {
            self.forget();
        }
        if particles_went {
            self.store.forget();
        }
    }

    /// The device; the arrays of the particles and those of a tile, and the most elements of each under
    /// `limits`.
    fn rooms(&mut self, limits: &TileLimits, contents: Contents) -> (&Gpu, [Vec<Room<'_>>; 2]) {
        let Renderer { gpu, store, grid, order, adapt, cast, .. } = self;
        let fields = contents.fields;
        let mut others = adapt.rooms(limits, contents);
        others.extend(grid.rooms(limits));
        others.push(order.room(limits));
        others.extend(cast.rooms(limits, fields));
        (gpu, [store.rooms(limits, fields).into(), others])
    }
}

/// Whether any room was larger than it may be, and was given back.
fn give_back(gpu: &Gpu, rooms: Vec<Room>) -> bool {
    rooms.into_iter().fold(false, |gave, (buffer, most)| buffer.give_back_above(gpu, most) || gave)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::GpuOptions;
    use crate::sampling::{Bound, BrickWidth};
    use crate::stages::shared::Fields;

    /// Bytes of all arrays of a tile that makes full use of its limits, with its pixels on their way to the
    /// host.
    fn bytes(renderer: &mut Renderer, limits: &TileLimits, contents: Contents) -> u64 {
        let rooms = renderer.rooms(limits, contents).1.into_iter().flatten();
        let arrays: u64 = rooms.map(|(buffer, most)| buffer.bytes_for(most)).sum();
        arrays + limits.bundles * 64 * 16
    }

    #[test]
    fn all_arrays_of_a_tile_together_fit_the_memory() {
        let mut renderer = Renderer::new(Gpu::new(&GpuOptions::default()).unwrap()).unwrap();
        for memory in [1 << 20, 64 << 20, 1 << 30, 4 << 30] {
            for (fields, bound, column_width) in [
                (Fields::One, Bound::Difference, BrickWidth::Two),
                (Fields::One, Bound::Difference, BrickWidth::Four),
                (Fields::Two, Bound::Difference, BrickWidth::Two),
                (Fields::Two, Bound::Difference, BrickWidth::Four),
                (Fields::One, Bound::Paper, BrickWidth::Two),
            ] {
                for particles in [0, 1, 1000, 1_000_000, 10_000_000, 1_000_000_000] {
                    let contents = Contents { particles, fields, bound, column_width };
                    let limits = TileLimits::new(1 << 40, memory, contents);
                    let bytes = bytes(&mut renderer, &limits, contents);
                    assert!(bytes <= memory / 16 * 16, "{bytes} of {memory} bytes for {contents:?}");
                    assert!(10 * bytes > 8 * memory, "only {bytes} of {memory} bytes for {contents:?}");
                    let fit = limits.particles * (52 + 4 * fields.count()) <= memory / 2;
                    assert!(fit && (limits.particles >= particles || 16 * 60 * particles > 8 * memory));
                }
            }
        }
    }
}
