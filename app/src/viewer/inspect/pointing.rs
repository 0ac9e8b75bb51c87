//! What the mouse points at in the picture: the place that is seen there, and the particles around it.

use std::sync::Arc;

use glam::DVec3;
use renderer::{QuantityView, Scene};

use crate::frames::Frame;
use crate::scene::Selection;

/// What was drawn of a frame, to look into.
#[derive(Clone)]
pub struct Shot {
    pub frame: Arc<Frame>,
    pub index: usize,
    pub scene: Arc<Scene>,
    /// Of the picture at full resolution, in pixels.
    pub size: [u32; 2],
    /// As the view has it.
    pub quantity: QuantityView,
}

/// A place in the picture, in shares of its width and height from the upper left corner.
pub type Place = [f64; 2];

/// A wish to know what is to be seen somewhere.
#[derive(Clone)]
pub struct Question {
    pub shot: Shot,
    pub place: Place,
    /// Whether that was clicked on.
    pub click: bool,
}

/// What was found out.
pub struct Pointed {
    pub shot: Shot,
    pub place: Place,
    pub click: bool,
    /// `None` where nothing is to be seen.
    pub seen: Option<Seen>,
    /// Particles whose supports the ray through the place meets.
    pub met: usize,
}

/// A place in the world that is seen. Lengths in the unit of the run.
pub struct Seen {
    pub point: DVec3,
    /// The quantity as it is interpolated there; and that of the opacity, where it is another one.
    pub value: f64,
    pub opacity: Option<(String, f64)>,
    /// Particles along the ray, the nearest to the point first.
    pub near: Vec<Near>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    pub row: usize,
    pub position: DVec3,
    /// From the point that is seen.
    pub distance: f64,
}

/// As many of the particles along a ray are told.
const NEAR: usize = 12;

impl Shot {
    pub fn is_same(&self, other: &Shot) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene) && self.size == other.size
    }
}

impl Question {
    /// Follows the ray. Takes milliseconds for a million particles.
    pub fn answer(self) -> Pointed {
        let Question { shot, place, click } = self;
        let [width, height] = shot.size;
        // The place is seen as in the picture at full resolution, whatever was drawn so far.
        let scene = Scene { width, height, ..(*shot.scene).clone() };
        let glance = scene.glance([place[0] * f64::from(width), place[1] * f64::from(height)]);
        let seen = glance.sight.map(|sight| {
            let row = |index: usize| scene.particles.source_row(index);
            let mut near: Vec<Near> = glance
                .met
                .iter()
                .map(|met| {
                    let position = scene.particles.position(met.index);
                    Near { row: row(met.index), position, distance: position.distance(sight.point) }
                })
                .collect();
            near.sort_by(|a, b| a.distance.total_cmp(&b.distance));
            near.truncate(NEAR);
            let value = |name: Option<&str>| {
                let selection = Selection::new(&shot.frame, name);
                let selection = selection.unwrap_or_else(|_| Selection::default_of(&shot.frame));
                let add = |[sum, weights]: [f64; 2], &(index, weight): &(usize, f64)| {
                    [sum + weight * selection.value(row(index)), weights + weight]
                };
                let [sum, weights] = sight.around.iter().fold([0.0; 2], add);
                sum / weights
            };
            let name = &shot.quantity.name;
            let other = shot.quantity.opacity.as_ref().and_then(|opacity| opacity.name.clone());
            let other = other.filter(|other| Some(other) != name.as_ref());
            let opacity = other.map(|other| (other.clone(), value(Some(&other))));
            let value = value(name.as_deref());
            Seen { point: sight.point, value, opacity, near }
        });
        Pointed { place, click, seen, met: glance.met.len(), shot }
    }
}

#[cfg(test)]
mod tests {
    use renderer::View;

    use super::*;
    use crate::frames::{Column, Field, Metadata};
    use crate::viewer::render_thread::prepare::Preparation;

    /// A lattice of 5 × 5 × 5 particles from 0 to 4, whose heat is 10·z, seen from the front.
    fn shot() -> Shot {
        let lattice = || (0..125).map(|i| [i % 5, i / 5 % 5, i / 25].map(f64::from));
        let positions = lattice().flatten().collect::<Vec<_>>();
        let heat = lattice().map(|[_, _, z]| 10.0 * z).collect::<Vec<_>>();
        let field = Field { name: "heat".into(), column: Column::scalars(heat) };
        let metadata = Metadata { support_radius: Some(2.0), ..Metadata::default() };
        let frame = Frame::new(Column::new(3, positions).unwrap(), vec![field], metadata).unwrap();
        let frame = Arc::new(frame);
        let camera = r#"{"camera": {"eye": [2, 2, 20], "target": [2, 2, 2], "fov_y_degrees": 30}}"#;
        let mut view = View::from_json(camera).unwrap();
        (view.image.width, view.image.height) = (40, 30);
        view.transfer.reference_length = Some(0.01);
        view.quantity.name = Some("heat".into());
        let (scene, _) = Preparation::default().scene(&frame, &view).unwrap();
        Shot { frame, index: 0, scene: Arc::new(scene), size: [400, 300], quantity: view.quantity }
    }

    fn point_at(shot: Shot, place: Place) -> Pointed {
        Question { shot, place, click: false }.answer()
    }

    #[test]
    fn the_front_of_a_dense_block_is_seen_and_its_nearest_particle_found() {
        let pointed = point_at(shot(), [0.5, 0.5]);
        let seen = pointed.seen.unwrap();
        // Dense: the edge of the foremost supports, 2 before the particles at z = 4.
        assert!(seen.point.distance(DVec3::new(2.0, 2.0, 6.0)) < 0.1, "{:?}", seen.point);
        assert!((seen.value - 40.0).abs() < 1e-6, "{}", seen.value);
        let [nearest, second] = [seen.near[0], seen.near[1]];
        assert_eq!((nearest.row, nearest.position), (112, DVec3::new(2.0, 2.0, 4.0)));
        assert!(nearest.distance <= second.distance && pointed.met >= 25);
    }

    #[test]
    fn beside_the_block_is_nothing() {
        let pointed = point_at(shot(), [0.01, 0.5]);
        assert!(pointed.seen.is_none() && pointed.met == 0);
    }
}
