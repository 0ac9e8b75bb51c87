//! Colour by one field, opacity by another.

use rayon::prelude::*;

use crate::particles::Quantity;
use crate::placement::Placement;
use crate::stages::shared::Fields;

impl Quantity {
    /// This quantity for the colour of samples, and `opacity` for their opacity, each interpolated and
    /// normalised by itself. Both are of the same particles, and neither has an opacity of its own.
    /// A particle that lacks one of the two is left out of both.
    pub fn with_opacity(&self, opacity: &Quantity) -> Quantity {
        assert!(self.fields() == Fields::One && opacity.fields() == Fields::One, "one field each");
        assert_eq!(self.values.len(), opacity.values.len(), "two fields of the same particles");
        let rejected = [Self::REJECTED; 2];
        let values: Vec<[f32; 2]> = self
            .values
            .par_iter()
            .zip(&opacity.values)
            .map(|(&u, &v)| if u == Self::REJECTED || v == Self::REJECTED { rejected } else { [u, v] })
            .collect();
        let left_out = values.par_iter().filter(|&&pair| pair == rejected).count() as u64;
        Quantity {
            id: crate::particles::next_id(),
            placement: self.placement,
            opacity_placement: Some(opacity.placement),
            rejected: left_out,
            values: bytemuck::cast_vec(values),
        }
    }

    /// Where the values of the second field lie on the device's axis; `None` where one field decides both.
    pub fn opacity_placement(&self) -> Option<&Placement> {
        self.opacity_placement.as_ref()
    }

    /// Where values are on the device's axes: those that decide the colour, and those that decide the
    /// opacity.
    pub(crate) fn placements(&self) -> [Placement; 2] {
        [self.placement, self.opacity_placement.unwrap_or(self.placement)]
    }

    pub(crate) fn fields(&self) -> Fields {
        if self.opacity_placement.is_some() { Fields::Two } else { Fields::One }
    }

    /// What decides the opacity of the particle `index`, normalised.
    pub(crate) fn opacity_of(&self, index: usize) -> f32 {
        let stride = self.fields().count() as usize;
        self.values[index * stride + stride - 1]
    }

    /// The values of the particles with the indices `chosen`, in that order.
    pub(crate) fn gather(&self, chosen: &[u32]) -> Vec<f32> {
        let stride = self.fields().count() as usize;
        let of = |&index: &u32| &self.values[index as usize * stride..(index as usize + 1) * stride];
        chosen.par_iter().flat_map_iter(|index| of(index).iter().copied()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::{ParticleSet, RawParticle};

    fn set(count: usize) -> ParticleSet {
        ParticleSet::new(count, |row| RawParticle {
            position: [row as f64, 0.0, 0.0],
            support_radius: 1.0,
            volume: 1.0,
        })
    }

    #[test]
    fn a_particle_that_lacks_one_field_is_left_out_of_both() {
        let particles = set(4);
        let field = |values: [f64; 4]| Quantity::new(&particles, Some([0.0, 10.0]), move |row| values[row]);
        let colour = field([0.0, f64::NAN, 5.0, 10.0]);
        let opacity = field([10.0, 1.0, f64::INFINITY, 2.5]);
        let both = colour.with_opacity(&opacity);
        assert_eq!(
            (both.rejected(), both.range(), both.opacity_placement().map(Placement::range)),
            (2, [0.0, 10.0], Some([0.0, 10.0]))
        );
        assert_eq!([0, 1, 2, 3].map(|index| both.is_rejected(index)), [false, true, true, false]);
        assert_eq!(both.gather(&[3, 0]), [1.0, 0.25, 0.0, 1.0]);
        assert_eq!(colour.gather(&[3, 0]), [1.0, 0.0]);
        assert_ne!(both.id(), colour.id());
    }
}
