//! Generated scenes: `demo:radial:N` and `demo:checker:N` (contract, section 3).
//!
//! Both are the cube lattice of n³ particles in [−1, 1]³ whose count is nearest to N: particle
//! (i, j, k) lies at −1 + (i + ½)·dx on each axis, dx = 2/n, moved by up to ±0.15·dx per axis. The
//! move is a hash of the lattice index (splitmix64), so a scene is the same on every machine and
//! with any number of threads.
//!
//! Particles are stored brick by brick (8 × 8 × 8 of them), the bricks along a Morton curve: what
//! is near in space is near in memory, as in the output of solvers that sort for their neighbour
//! search, and neighbouring GPU threads touch neighbouring cells.

use rayon::prelude::*;

use super::{Column, Field, Frame, Metadata};

/// What the quantity of a generated scene is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// Field `radius` = min(|x|, 1).
    Radial,
    /// Field `concentration` in 8 × 8 × 8 cubes, the paper's figure 8: every other cube is empty
    /// (0), and the cubes between hold (1 + column + row)/15, where the column counts from the left
    /// (−x) and the row from the front (+z). So the dye grows from 1/15 in front on the left to 1
    /// behind on the right, and each dyed cube borders on clear ones only.
    Checker,
}

/// A scene of about `particles` particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Generated {
    pub pattern: Pattern,
    /// Number asked for, 1 to [`Generated::MAX_PARTICLES`]; the scene has the nearest cube number.
    pub particles: u64,
}

/// Particles along the side of a brick.
const BRICK: u64 = 8;
/// Largest move of a particle from its lattice point, in units of the spacing.
const JITTER: f64 = 0.15;
/// Cubes of the checker board along a side.
const CUBES: u64 = 8;

impl Generated {
    /// The most particles that can be asked for: 1000 along a side.
    pub const MAX_PARTICLES: u64 = 1_000_000_000;

    /// Reads `radial:N` or `checker:N`; the error says what is wrong.
    pub fn parse(text: &str) -> Result<Generated, String> {
        const EXPECTED: &str = "expected demo, demo:radial:N or demo:checker:N";
        let (pattern, count) = text.split_once(':').unwrap_or((text, ""));
        let pattern = match pattern {
            "radial" => Pattern::Radial,
            "checker" => Pattern::Checker,
            other => return Err(format!("there is no demo `{other}`, {EXPECTED}")),
        };
        // Digits in groups are how people write large numbers.
        match count.replace('_', "").parse() {
            Ok(particles) if (1..=Self::MAX_PARTICLES).contains(&particles) => {
                Ok(Generated { pattern, particles })
            }
            _ => Err(format!(
                "`{count}` is not a number of particles between 1 and {}, {EXPECTED}",
                Self::MAX_PARTICLES
            )),
        }
    }

    /// Lattice points along a side: the n whose cube is nearest to the number asked for.
    pub fn side(&self) -> u64 {
        let below = (1..).take_while(|n: &u64| n.pow(3) <= self.particles).last().unwrap_or(1);
        let above = below + 1;
        if self.particles - below.pow(3) <= above.pow(3) - self.particles { below } else { above }
    }

    /// Lattice spacing dx.
    pub fn spacing(&self) -> f64 {
        2.0 / self.side() as f64
    }

    /// Builds the frame, on all threads.
    pub fn frame(&self) -> Frame {
        let n = self.side();
        let count = n.pow(3) as usize;
        let mut positions = vec![0.0_f32; 3 * count];
        let mut values = vec![0.0_f32; count];

        let (mut rest, mut rest_values) = (positions.as_mut_slice(), values.as_mut_slice());
        let mut work = Vec::new();
        for brick in bricks(n) {
            let (mine, others) = rest.split_at_mut(3 * brick.len());
            let (mine_values, others_values) = rest_values.split_at_mut(brick.len());
            work.push((brick, mine, mine_values));
            (rest, rest_values) = (others, others_values);
        }
        work.into_par_iter().for_each(|(brick, positions, values)| {
            let places = positions.chunks_exact_mut(3).zip(values);
            for (lattice, (place, value)) in brick.points().zip(places) {
                let point = self.point(lattice, n);
                place.copy_from_slice(&point);
                *value = self.value(lattice, point, n);
            }
        });

        let name = match self.pattern {
            Pattern::Radial => "radius",
            Pattern::Checker => "concentration",
        };
        let fields = vec![Field { name: name.to_owned(), column: Column::scalars(values) }];
        let metadata = Metadata { support_radius: Some(2.0 * self.spacing()), ..Metadata::default() };
        let positions = Column::new(3, positions).expect("three numbers were written for each particle");
        Frame::new(positions, fields, metadata).expect("one value was written for each particle")
    }

    fn point(&self, lattice: [u64; 3], n: u64) -> [f32; 3] {
        let dx = self.spacing();
        let index = lattice[0] + n * (lattice[1] + n * lattice[2]);
        std::array::from_fn(|axis| {
            let random = splitmix64(3 * index + axis as u64);
            // 53 bits make a uniform f64 in [0, 1).
            let uniform = (random >> 11) as f64 * (0.5_f64).powi(53);
            let jitter = JITTER * (2.0 * uniform - 1.0);
            (-1.0 + (lattice[axis] as f64 + 0.5 + jitter) * dx) as f32
        })
    }

    fn value(&self, lattice: [u64; 3], point: [f32; 3], n: u64) -> f32 {
        match self.pattern {
            Pattern::Radial => {
                let [x, y, z] = point.map(f64::from);
                (x * x + y * y + z * z).sqrt().min(1.0) as f32
            }
            // The lattice point decides, not the moved one: the cubes' faces stay sharp.
            Pattern::Checker => checker(lattice.map(|i| (2 * i + 1) * CUBES / (2 * n))),
        }
    }
}

/// Concentration of a cube of the checker board.
fn checker([x, y, z]: [u64; 3]) -> f32 {
    let row = CUBES - 1 - z;
    if (x + y + row).is_multiple_of(2) { (1 + x + row) as f32 / (2 * CUBES - 1) as f32 } else { 0.0 }
}

/// A box of lattice points.
struct Brick {
    start: [u64; 3],
    end: [u64; 3],
}

impl Brick {
    fn len(&self) -> usize {
        (0..3).map(|axis| (self.end[axis] - self.start[axis]) as usize).product()
    }

    fn points(&self) -> impl Iterator<Item = [u64; 3]> {
        let axis = |axis: usize| self.start[axis]..self.end[axis];
        let (xs, ys, zs) = (axis(0), axis(1), axis(2));
        zs.flat_map(move |z| {
            let xs = xs.clone();
            ys.clone().flat_map(move |y| xs.clone().map(move |x| [x, y, z]))
        })
    }
}

/// The bricks of a lattice of side `n`, along a Morton curve.
fn bricks(n: u64) -> Vec<Brick> {
    let along = n.div_ceil(BRICK);
    let mut places: Vec<[u64; 3]> = (0..along.pow(3))
        .map(|index| [index % along, index / along % along, index / (along * along)])
        .collect();
    places.sort_by_cached_key(|&place| morton(place));
    let brick = |place: [u64; 3]| Brick {
        start: place.map(|p| p * BRICK),
        end: place.map(|p| ((p + 1) * BRICK).min(n)),
    };
    places.into_iter().map(brick).collect()
}

/// Interleaves the low 16 bits of three numbers.
fn morton(place: [u64; 3]) -> u64 {
    let spread = |p: u64| (0..16).fold(0, |code, bit| code | (p >> bit & 1) << (3 * bit));
    spread(place[0]) | spread(place[1]) << 1 | spread(place[2]) << 2
}

/// The generator of Steele, Lea and Flood 2014, taken as a hash of its counter.
fn splitmix64(index: u64) -> u64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_cube_number_is_taken() {
        for (asked, side) in [(1, 1), (4, 1), (5, 2), (1000, 10), (1331, 11), (1165, 10), (1166, 11)] {
            assert_eq!(Generated { pattern: Pattern::Radial, particles: asked }.side(), side, "{asked}");
        }
    }

    #[test]
    fn every_lattice_point_has_one_particle_near_it() {
        let scene = Generated { pattern: Pattern::Radial, particles: 11 * 11 * 11 };
        let (frame, dx) = (scene.frame(), scene.spacing());
        let mut seen = vec![false; frame.len()];
        let radius = frame.field("radius").unwrap();
        for row in 0..frame.len() {
            let position = frame.position(row);
            let mut index = 0;
            for axis in [2, 1, 0] {
                let lattice = (position[axis] + 1.0) / dx - 0.5;
                assert!((lattice - lattice.round()).abs() <= JITTER + 1e-4);
                index = 11 * index + lattice.round() as usize;
            }
            assert!(!std::mem::replace(&mut seen[index], true));
            let length = position.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!((radius.column.get(row, 0) - length.min(1.0)).abs() < 1e-6);
        }
        assert_eq!(frame.metadata.support_radius, Some(2.0 * dx));
    }

    #[test]
    fn the_checker_board_grows_to_the_right_and_to_the_back() {
        assert_eq!(checker([0, 0, 7]), 1.0 / 15.0);
        assert_eq!(checker([7, 0, 0]), 1.0);
        assert!(checker([2, 0, 7]) > checker([0, 0, 7]));
        assert!(checker([0, 0, 5]) > checker([0, 0, 7]));
        for place in [[3, 4, 5], [0, 0, 0], [6, 1, 2]] {
            let neighbour = [place[0] + 1, place[1], place[2]];
            assert!((checker(place) == 0.0) != (checker(neighbour) == 0.0));
        }
        let frame = Generated { pattern: Pattern::Checker, particles: 4096 }.frame();
        let column = &frame.field("concentration").unwrap().column;
        let dyed = (0..frame.len()).filter(|&row| column.get(row, 0) > 0.0).count();
        assert_eq!(dyed, 2048);
    }

    #[test]
    fn wrong_names_and_numbers_are_told() {
        assert!(Generated::parse("radial:1_000").is_ok());
        assert!(Generated::parse("cube:5").unwrap_err().contains("no demo `cube`"));
        for count in ["", "0", "-1", "many", "99999999999"] {
            assert!(Generated::parse(&format!("radial:{count}")).unwrap_err().contains("not a number"));
        }
    }
}
