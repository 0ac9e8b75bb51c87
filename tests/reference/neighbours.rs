//! Which particles may reach a point: uniform hashes in world space, one for each class of radii.

use std::collections::{BTreeMap, HashMap};

use glam::DVec3;

use crate::particle::Particle;

/// A hash over the supports of particles.
pub struct Neighbours {
    /// Radii of one class differ by at most a factor of four, so that neither lists nor the number
    /// of cells that one support meets grow with the span of all radii.
    classes: Vec<Class>,
}

struct Class {
    /// Side of a cell: no radius of the class is larger.
    side: f64,
    /// Indices of the particles whose support's box meets a cell.
    cells: HashMap<[i64; 3], Vec<u32>>,
}

impl Neighbours {
    pub fn new(particles: &[Particle]) -> Neighbours {
        let mut members = BTreeMap::<i32, Vec<u32>>::new();
        for (index, particle) in particles.iter().enumerate() {
            let class = (0.5 * particle.support_radius.log2()).floor() as i32;
            members.entry(class).or_default().push(index as u32);
        }
        let classes = members
            .into_iter()
            .map(|(class, members)| Class::new(4.0_f64.powi(class + 1), &members, particles))
            .collect();
        Neighbours { classes }
    }

    /// Indices of all particles whose support holds `x`, and of some others.
    pub fn around(&self, x: DVec3) -> impl Iterator<Item = usize> + '_ {
        self.classes.iter().flat_map(move |class| {
            class.cells.get(&class.cell(x)).into_iter().flatten().map(|&index| index as usize)
        })
    }
}

impl Class {
    fn new(side: f64, members: &[u32], particles: &[Particle]) -> Class {
        let mut class = Class { side, cells: HashMap::new() };
        for &index in members {
            let Particle { position, support_radius, .. } = particles[index as usize];
            let low = class.cell(position - support_radius);
            let high = class.cell(position + support_radius);
            for x in low[0]..=high[0] {
                for y in low[1]..=high[1] {
                    for z in low[2]..=high[2] {
                        class.cells.entry([x, y, z]).or_default().push(index);
                    }
                }
            }
        }
        class
    }

    fn cell(&self, x: DVec3) -> [i64; 3] {
        (x / self.side).floor().to_array().map(|index| index as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn nobody_is_missed() {
        let mut random = Random::new(1);
        for _ in 0..20 {
            let particles: Vec<Particle> = (0..200)
                .map(|_| Particle {
                    position: random.in_cube(),
                    support_radius: random.log_between(1e-3, 3.0),
                    volume: 1.0,
                    quantity: 0.0,
                    opacity: 0.0,
                })
                .collect();
            let neighbours = Neighbours::new(&particles);
            for _ in 0..200 {
                let x = random.in_cube();
                let found: Vec<usize> = neighbours.around(x).collect();
                for (index, particle) in particles.iter().enumerate() {
                    let inside = (x - particle.position).length() < particle.support_radius;
                    let times = found.iter().filter(|&&other| other == index).count();
                    assert!(times <= 1 && times >= usize::from(inside));
                }
            }
        }
    }
}
