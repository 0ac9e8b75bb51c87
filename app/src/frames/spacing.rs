//! Spacing of particles: the median distance to the nearest neighbour.

use rayon::prelude::*;

use super::Frame;

/// Nearest neighbours are looked up for this many particles at most; the median of so many is
/// within a percent of that of all.
const SAMPLES: usize = 1 << 17;
/// Points in a leaf of the tree.
const LEAF: usize = 8;
/// Slices shorter than this are made into a tree by one thread.
const ALONE: usize = 1 << 14;

type Point = [f64; 3];

/// The median over the particles of the distance to the nearest particle at another place, in the
/// unit of the positions. Particles that coincide count as one neighbour, and positions that are not
/// finite as none. `None` where fewer than two places are left.
pub fn median_spacing(frame: &Frame) -> Option<f64> {
    let mut points: Vec<Point> = (0..frame.len())
        .into_par_iter()
        .map(|row| frame.position(row))
        .filter(|point| point.iter().all(|x| x.is_finite()))
        .collect();
    let tree = Tree::new(&mut points, 0);
    // In the order of the tree, every n-th point is an even sample of space.
    let mut squares: Vec<f64> = points
        .par_iter()
        .step_by(points.len().div_ceil(SAMPLES).max(1))
        .map(|point| tree.nearest(&points, point, f64::INFINITY))
        .filter(|square| square.is_finite())
        .collect();
    let middle = squares.len() / 2;
    (!squares.is_empty()).then(|| squares.select_nth_unstable_by(middle, f64::total_cmp).1.sqrt())
}

/// A k-d tree over a slice of points, which it sorts.
enum Tree {
    /// First point and number of points.
    Leaf(usize, usize),
    Node {
        axis: usize,
        split: f64,
        /// Points at the split or below it, and at it or above it.
        halves: Box<[Tree; 2]>,
    },
}

impl Tree {
    /// A tree over `points`, the first of which has the number `start`.
    fn new(points: &mut [Point], start: usize) -> Tree {
        let (axis, extent) = longest_axis(points);
        // Any number of points in one place are one: a search through them would be as long as they are many.
        if points.len() <= LEAF || extent == 0.0 {
            return Tree::Leaf(start, if extent == 0.0 { 1 } else { points.len() });
        }
        let middle = points.len() / 2;
        let split = points.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis])).1[axis];
        let alone = points.len() < ALONE;
        let (low, high) = points.split_at_mut(middle);
        let (low, high) = match alone {
            true => (Tree::new(low, start), Tree::new(high, start + middle)),
            false => rayon::join(|| Tree::new(low, start), || Tree::new(high, start + middle)),
        };
        Tree::Node { axis, split, halves: Box::new([low, high]) }
    }

    /// Square of the distance from `query` to the nearest point elsewhere, or `best` if that is less.
    fn nearest(&self, points: &[Point], query: &Point, best: f64) -> f64 {
        match self {
            Tree::Leaf(start, count) => points[*start..]
                .iter()
                .take(*count)
                .map(|point| (0..3).map(|axis| (point[axis] - query[axis]).powi(2)).sum::<f64>())
                .filter(|square| *square > 0.0)
                .fold(best, f64::min),
            Tree::Node { axis, split, halves } => {
                let beyond = query[*axis] - split;
                let [near, far] = if beyond < 0.0 { [0, 1] } else { [1, 0] };
                let best = halves[near].nearest(points, query, best);
                if beyond * beyond < best { halves[far].nearest(points, query, best) } else { best }
            }
        }
    }
}

/// The axis along which the box of `points` is longest, and how long.
fn longest_axis(points: &[Point]) -> (usize, f64) {
    let mut bounds = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    for point in points {
        for (bounds, x) in bounds.iter_mut().zip(point) {
            *bounds = [bounds[0].min(*x), bounds[1].max(*x)];
        }
    }
    let extents = bounds.map(|[low, high]| high - low);
    let longest = if extents[1] > extents[0] { 1 } else { 0 };
    let longest = if extents[2] > extents[longest] { 2 } else { longest };
    (longest, extents[longest])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Column, Metadata};

    fn frame(points: &[Point]) -> Frame {
        let positions = Column::new(3, points.concat()).unwrap();
        Frame::new(positions, Vec::new(), Metadata::default()).unwrap()
    }

    #[test]
    fn a_lattice_has_its_spacing() {
        let points: Vec<Point> =
            (0..4096).map(|i| [i % 16, i / 16 % 16, i / 256].map(|k| 0.25 * f64::from(k))).collect();
        assert_eq!(median_spacing(&frame(&points)), Some(0.25));
    }

    #[test]
    fn it_is_what_a_search_through_all_pairs_finds() {
        let scene = crate::frames::Generated::parse("radial:3000").unwrap().frame();
        let points: Vec<Point> = (0..scene.len()).map(|row| scene.position(row)).collect();
        let square = |a: &Point, b: &Point| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>();
        let nearest =
            |a: &Point| points.iter().map(|b| square(a, b)).filter(|s| *s > 0.0).fold(9.0, f64::min);
        let mut all: Vec<f64> = points.iter().map(nearest).collect();
        all.sort_by(f64::total_cmp);
        assert_eq!(median_spacing(&scene), Some(all[all.len() / 2].sqrt()));
    }

    #[test]
    fn coincident_particles_are_no_neighbours() {
        let mut points: Vec<Point> = vec![[0.5; 3]; 200_000];
        assert_eq!(median_spacing(&frame(&points)), None);
        points.push([0.5, 0.5, 3.5]);
        points.push([f64::NAN; 3]);
        assert_eq!(median_spacing(&frame(&points)), Some(3.0));
        assert_eq!(median_spacing(&frame(&[])), None);
    }

    #[test]
    fn an_outlier_and_extreme_scales_change_nothing() {
        for scale in [1e-30, 1.0, 1e30] {
            let mut points: Vec<Point> = (0..999).map(|i| [f64::from(i) * scale, 0.0, 0.0]).collect();
            points.push([1e9 * scale; 3]);
            let spacing = median_spacing(&frame(&points)).unwrap();
            assert!((spacing / scale - 1.0).abs() < 1e-9, "{spacing}");
        }
    }
}
