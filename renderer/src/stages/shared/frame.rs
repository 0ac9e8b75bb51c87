//! Constants of a picture and of a tile, as the shaders see them (`frame.wgsl`).

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::camera::{CELL_SLICES, Camera, Slices};
use crate::plan::Tile;
use crate::scene::Scene;

/// A support radius below this share of the distance between samples is raised to it. Samples are
/// at most one pitch apart laterally and along depth, so no point is farther than √¾ ≈ 0.866 of the
/// pitch from one: a particle of this radius always reaches a sample. Its weight stays V·W(r, h),
/// with the raised h; a particle moves the edge of the fluid by less than a pixel.
pub(crate) const RADIUS_FLOOR: f64 = 0.9;

/// `Frame` of `frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct FrameUniform {
    pub right: [f32; 3],
    pub pitch: f32,
    pub up: [f32; 3],
    pub near: f32,
    pub forward: [f32; 3],
    pub far: f32,
    pub pivot_high: [f32; 3],
    pub log_step: f32,
    pub pivot_low: [f32; 3],
    pub radius_floor: f32,
    pub size: [u32; 2],
    pub particle_count: u32,
    pub path_scale: f32,
    pub pivot_depth: f32,
    pub near_offset: f32,
    pub far_offset: f32,
    pub logarithmic: u32,
    pub sample_offset: [f32; CELL_SLICES as usize],
    pub slab_depth: [f32; CELL_SLICES as usize],
    pub slab_edge: [f32; CELL_SLICES as usize + 4],
}

impl FrameUniform {
    /// Constants of `scene`, whose rays are cut into `slices`, with `particle_count` particles on the
    /// device; lengths in the particle set's unit.
    pub(crate) fn new(scene: &Scene, slices: &Slices, particle_count: u64) -> FrameUniform {
        let camera = &scene.camera;
        let particles = &scene.particles;
        let unit = particles.unit();
        let pivot_depth = pivot_depth(camera);
        let pivot = particles.to_device(camera.eye + pivot_depth * camera.forward);
        let pivot_high = pivot.as_vec3();
        let pivot_low = (pivot - pivot_high.as_dvec3()).as_vec3();
        let step = slices.log_step;
        // Slices of a cell lie symmetric about its middle, 8 slices in.
        let from_middle = |slice: f64| slice - f64::from(CELL_SLICES) / 2.0;
        FrameUniform {
            right: single(camera.right),
            pitch: pitch(scene) as f32,
            up: single(camera.up),
            near: (camera.near / unit) as f32,
            forward: single(camera.forward),
            far: (camera.far / unit) as f32,
            pivot_high: pivot_high.to_array(),
            log_step: step as f32,
            pivot_low: pivot_low.to_array(),
            radius_floor: radius_floor(scene, slices) as f32,
            size: [scene.width, scene.height],
            particle_count: particle_count as u32,
            path_scale: (unit / scene.reference_length) as f32,
            pivot_depth: (pivot_depth / unit) as f32,
            near_offset: ((camera.near - pivot_depth) / unit) as f32,
            far_offset: ((camera.far - pivot_depth) / unit) as f32,
            logarithmic: logarithmic(scene),
            sample_offset: std::array::from_fn(|k| (from_middle(k as f64 + 0.5) * step).exp_m1() as f32),
            slab_depth: std::array::from_fn(|k| {
                ((from_middle(k as f64) * step).exp() * step.exp_m1()) as f32
            }),
            slab_edge: std::array::from_fn(|k| (from_middle(k as f64) * step).exp_m1() as f32),
        }
    }
}

/// Depth of the point that positions in view space are relative to: amid a view volume that is
/// shallow for its distance, where depths differ little and f32 would round them all alike; never so
/// far from near that a particle close to the eye would lose by it.
pub(crate) fn pivot_depth(camera: &Camera) -> f64 {
    (camera.near + 0.5 * (camera.far - camera.near)).min(2.0 * camera.near)
}

/// Smallest support radius that cannot fall between samples, in units of view depth.
pub(crate) fn radius_floor(scene: &Scene, slices: &Slices) -> f64 {
    RADIUS_FLOOR * pitch(scene).max(slices.log_step.exp_m1())
}

/// Slope between neighbouring pixel centres.
pub(crate) fn pitch(scene: &Scene) -> f64 {
    2.0 * scene.camera.tan_half_fov / f64::from(scene.height)
}

/// Bits of the fields on a logarithmic scale.
fn logarithmic(scene: &Scene) -> u32 {
    let [colour, opacity] =
        scene.quantity.placements().map(|placement| u32::from(placement.log_width().is_some()));
    colour | opacity << 1
}

fn single(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

/// `Tile` of `frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct TileUniform {
    pub first: [u32; 2],
    pub count: [u32; 2],
    pub first_layer: u32,
    pub layers: u32,
    pub pair_capacity: u32,
    pub portions: u32,
}

impl TileUniform {
    /// For a tile without crowded cells, as far as is known.
    pub(crate) fn new(tile: &Tile, pair_capacity: u64) -> TileUniform {
        TileUniform {
            first: tile.first,
            count: tile.count,
            first_layer: tile.first_layer,
            layers: tile.layers,
            pair_capacity: u32::try_from(pair_capacity).unwrap_or(u32::MAX),
            portions: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::layout::check_layout;
    use crate::stages::shared::FRAME_WGSL;

    #[test]
    fn uniforms_lie_as_the_shaders_expect() {
        check_layout!(
            FRAME_WGSL,
            "Frame",
            FrameUniform,
            right,
            pitch,
            up,
            near,
            forward,
            far,
            pivot_high,
            log_step,
            pivot_low,
            radius_floor,
            size,
            particle_count,
            path_scale,
            pivot_depth,
            near_offset,
            far_offset,
            logarithmic,
            sample_offset,
            slab_depth,
            slab_edge
        );
        check_layout!(
            FRAME_WGSL,
            "Tile",
            TileUniform,
            first,
            count,
            first_layer,
            layers,
            pair_capacity,
            portions
        );
    }
}
