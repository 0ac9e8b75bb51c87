//! The search for broken bounds in a bundle: what the device says of it, against the twin.

use reference::bricks::{Bricks, Place, difference, lit};
use reference::picture::Values;
use reference::random::Random;
use renderer::{Brick, BundleDetail, CellDetail, FieldInBrick, KnownValues};

/// How what the device says is read: as it is, or wrongly on purpose.
#[derive(Clone, Copy)]
pub struct Reading {
    /// The share of a brick's interval that is cut off at each end.
    pub shrunk: f64,
    /// By how many slices bricks are taken to lie behind where they do.
    pub shifted: f64,
    /// Whether every brick with particles is taken for covered.
    pub covered: bool,
    /// The share of the charge that is believed.
    pub charge: f64,
    /// The share of the error of a slope, and of its rise.
    pub off: f64,
    pub rise: f64,
}

pub const AS_IT_IS: Reading =
    Reading { shrunk: 0.0, shifted: 0.0, covered: false, charge: 1.0, off: 1.0, rise: 1.0 };

/// What single precision may add to a difference of two responses in [0, 1].
const ROUNDING: f64 = 1e-6;
/// The share of the budget below which a column has ended (`OCCLUDED` of `levels.wgsl`).
const OCCLUDED: f64 = 0.0625;
/// Places in a brick, beside its samples, at which it is looked at.
const PLACES: usize = 6;

/// Bricks of each kind that were looked at: the test of the test.
#[derive(Debug, Default)]
pub struct Seen {
    pub covered: usize,
    pub uncovered: usize,
    pub empty: usize,
    pub ended: usize,
    pub charged: usize,
    pub sloped: usize,
    pub coloured: usize,
}

/// The search for broken bounds.
pub struct Search<'a> {
    pub twin: &'a Bricks,
    pub reading: Reading,
    pub budget: f64,
    pub random: Random,
    pub seen: Seen,
    pub broken: Vec<String>,
}

/// A ray of a brick or of a column in a cell: the share of the light behind that reaches the eye from
/// there, and what it meets.
#[derive(Clone, Copy)]
struct Stretch {
    front: f64,
    response: [f64; 4],
}

impl Stretch {
    /// The largest difference from another response that is seen, over black and over white light.
    fn from(&self, other: [f64; 4]) -> f64 {
        let apart = [0.0, 1.0].map(|light| difference(lit(self.response, light), lit(other, light)));
        self.front * apart[0].max(apart[1])
    }
}

impl Search<'_> {
    pub fn bundle(&mut self, detail: &BundleDetail) {
        for column in 0..16 {
            let mut fronts = [1.0; 4];
            for cell in detail.cells.iter().filter(|cell| cell.cell.layer < detail.end_layer) {
                let place = Place { bundle: detail.bundle, layer: cell.cell.layer, column, brick: 0 };
                self.column(place, cell, &mut fronts);
            }
        }
    }

    /// The bricks of a column in a cell; `fronts` is brought behind them.
    fn column(&mut self, place: Place, cell: &CellDetail, fronts: &mut [f64; 4]) {
        let rays = self.twin.rays(&place);
        let mut whole = fronts.map(|front| Stretch { front, response: [0.0; 4] });
        for brick in 0..4 {
            let place = Place { brick, ..place };
            let mut stretches = Vec::new();
            for &ray in &rays {
                let samples = self.twin.samples(&place, ray, self.reading.shifted);
                samples.iter().for_each(|values| self.within_cell(&place, cell, *values));
                let response = self.twin.response(&place, ray, &samples);
                let stretch = Stretch { front: fronts[ray], response };
                if let Some(bricks) = &cell.bricks {
                    self.slope(
                        &place,
                        &bricks[place.column as usize][brick as usize],
                        ray,
                        &samples,
                        stretch,
                    );
                }
                stretches.push(stretch);
                whole[ray].response = behind(whole[ray].response, response);
                fronts[ray] *= 1.0 - response[3];
            }
            if let Some(bricks) = cell.bricks.as_ref().filter(|_| !rays.is_empty()) {
                let brick = bricks[place.column as usize][brick as usize];
                self.between_samples(&place, &brick);
                self.charge(&place, &brick, &stretches);
            }
        }
        self.shown(&place, cell, &rays.iter().map(|ray| whole[*ray]).collect::<Vec<_>>());
    }

    /// u at a sample lies within the bounds of its cell and of its brick.
    fn within_cell(&mut self, place: &Place, cell: &CellDetail, values: Option<Values>) {
        self.within(place, "the cell", cell.values, values.map(|[_, opacity]| opacity), AS_IT_IS);
        if let Some(bricks) = &cell.bricks {
            let brick = &bricks[place.column as usize][place.brick as usize];
            self.within_brick(place, "the brick", brick, values);
        }
    }

    /// So it does of both fields.
    fn within_brick(&mut self, place: &Place, what: &str, brick: &Brick, values: Option<Values>) {
        self.within(place, what, brick.opacity.values, values.map(|[_, opacity]| opacity), self.reading);
        if let Some(colour) = brick.colour {
            self.seen.coloured += 1;
            self.within(place, what, colour.values, values.map(|[colour, _]| colour), self.reading);
        }
    }

    /// So does u anywhere else in the brick.
    fn between_samples(&mut self, place: &Place, brick: &Brick) {
        match brick.opacity.values {
            KnownValues::Unknown => panic!("{place:?} has a brick that is not known"),
            KnownValues::Empty => self.seen.empty += 1,
            KnownValues::Between { covered: true, .. } => self.seen.covered += 1,
            KnownValues::Between { covered: false, .. } => self.seen.uncovered += 1,
        }
        let camera = &self.twin.setup.camera;
        let (corner, size) = (place.corner(), [camera.width, camera.height]);
        for _ in 0..PLACES {
            let pixel = [0, 1].map(|axis| {
                let last = f64::from(size[axis] - 1).min(f64::from(corner[axis] + 1)) + 0.5;
                self.random.between(f64::from(corner[axis]) + 0.5, last)
            });
            let deep = self.random.between(0.5, 3.5) + self.reading.shifted;
            let values = self.twin.values(pixel, f64::from(place.first_slab()) + deep);
            self.within_brick(place, "the brick between its samples", brick, values);
        }
    }

    fn within(&mut self, place: &Place, what: &str, values: KnownValues, u: Option<f64>, reading: Reading) {
        let sound = match (values, u) {
            (KnownValues::Unknown, _) | (KnownValues::Empty, None) => true,
            (KnownValues::Empty, Some(_)) => false,
            (KnownValues::Between { covered, .. }, None) => !covered && !reading.covered,
            (KnownValues::Between { low, high, .. }, Some(u)) => {
                let (low, high) = (f64::from(low), f64::from(high));
                let cut = reading.shrunk * (high - low);
                (low + cut..=high - cut).contains(&u)
            }
        };
        if !sound {
            self.broken.push(format!("{place:?}: {what}, {values:?}, does not hold {u:?}"));
        }
    }

    /// No two rays of a brick differ by more than twice its charge; and where it has none, no light comes
    /// from there.
    fn charge(&mut self, place: &Place, brick: &Brick, rays: &[Stretch]) {
        let front = rays.iter().map(|ray| ray.front).fold(0.0, f64::max);
        let Some(charge) = brick.charge.map(f64::from) else {
            self.seen.ended += 1;
            if front > OCCLUDED * self.budget * (1.0 + ROUNDING) {
                self.broken.push(format!("{place:?}: has ended, but for {front} of the light"));
            }
            return;
        };
        self.seen.charged += usize::from(charge > 0.0 && front > 0.01);
        let responses = rays.iter().map(|ray| ray.response);
        let apart = responses.map(|response| Stretch { front, response });
        for (a, b) in apart.clone().flat_map(|a| rays.iter().map(move |b| (a, b))) {
            let apart = a.from(b.response);
            if apart > 2.0 * (self.reading.charge * charge + ROUNDING) {
                self.broken.push(format!("{place:?}: rays are {apart} apart, charged {charge}"));
            }
        }
    }

    /// u at the samples of a ray is near the slope of the brick, and the light of samples on the slope no
    /// farther from the ray's than is charged.
    fn slope(
        &mut self,
        place: &Place,
        brick: &Brick,
        ray: usize,
        samples: &[Option<Values>; 4],
        is: Stretch,
    ) {
        let fields = [brick.colour.unwrap_or(brick.opacity), brick.opacity];
        let sides = [0, 1].map(|side| {
            let samples = samples.map(|values| values.map(|values| values[side]));
            self.on_slope(place, &fields[side], ray, &samples)
        });
        let [Some(colour), Some(opacity)] = sides else { return };
        let Some(charge) = brick.coarse_charge.map(f64::from) else { return };
        self.seen.sloped += 1;
        let on_slope = std::array::from_fn(|k| Some([colour[k], opacity[k]]));
        let off = is.from(self.twin.response(place, ray, &on_slope));
        if off > self.reading.charge * charge + ROUNDING {
            self.broken.push(format!("{place:?}: the slope is {off} from a ray, charged {charge}"));
        }
    }

    /// u on the slope of a field, to which u at the samples of a ray is near; `None` where it has none.
    fn on_slope(
        &mut self,
        place: &Place,
        field: &FieldInBrick,
        ray: usize,
        samples: &[Option<f64>; 4],
    ) -> Option<[f64; 4]> {
        let (Some(slope), KnownValues::Between { low, high, .. }) = (field.slope, field.values) else {
            return None;
        };
        let rise = slope.rise.map(|rise| self.reading.rise * f64::from(rise));
        let on_slope = self.twin.places(place, ray, slope.width).map(|at| {
            let u = f64::from(slope.middle) + at.iter().zip(rise).map(|(at, rise)| at * rise).sum::<f64>();
            u.clamp(f64::from(low), f64::from(high))
        });
        for (u, on_slope) in samples.iter().zip(on_slope) {
            if u.is_some_and(|u| (u - on_slope).abs() > self.reading.off * f64::from(slope.off)) {
                self.broken.push(format!("{place:?}: {u:?} is not near {on_slope} on {slope:?}"));
            }
        }
        Some(on_slope)
    }

    /// What is shown in place of a whole column is no farther from any of its rays than its bricks are
    /// charged. Where no bricks were looked at, there is nothing to be seen.
    fn shown(&mut self, place: &Place, cell: &CellDetail, rays: &[Stretch]) {
        let (Some(bricks), Some(shown)) = (&cell.bricks, &cell.shown) else {
            if rays.iter().any(|ray| ray.response != [0.0; 4]) {
                self.broken.push(format!("{place:?}: the cell is not transparent"));
            }
            return;
        };
        let charges = bricks[place.column as usize].map(|brick| brick.charge.map(f64::from));
        let Some(charged) = charges.into_iter().sum::<Option<f64>>() else { return };
        let middle = shown[place.column as usize].map(f64::from);
        for off in rays.iter().map(|ray| ray.from(middle)) {
            if off > self.reading.charge * charged + ROUNDING {
                self.broken.push(format!("{place:?}: shown {off} from a ray, charged {charged}"));
            }
        }
    }
}

/// Premultiplied colour and opacity of one stretch with another behind it.
fn behind(front: [f64; 4], back: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|channel| front[channel] + (1.0 - front[3]) * back[channel])
}
