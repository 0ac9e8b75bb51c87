//! Looking closer: the tool in hand, what it points at, the particle that was picked, and what is
//! measured.

use std::sync::Arc;

use glam::DVec3;

use super::Session;
use crate::frames::Insertion;
use crate::viewer::inspect::pointing::{Place, Pointed, Question, Shot};
use crate::viewer::inspect::tracked::{Located, Search, Tracked};

/// What a click in the picture does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tool {
    /// Looks into the cells behind a pixel.
    Inspect,
    /// Picks a particle.
    Pick,
    /// Sets the ends of a distance.
    Measure,
}

impl Tool {
    /// Whether it needs to know what is to be seen under the mouse.
    fn points(self) -> bool {
        matches!(self, Tool::Pick | Tool::Measure)
    }
}

/// A particle that was picked.
#[derive(Clone)]
pub struct Picked {
    pub particle: Tracked,
    /// Whether it is looked for in other frames; otherwise it is forgotten with its own.
    pub follow: bool,
    /// Whether the camera goes along with it.
    pub in_the_middle: bool,
}

/// An end of a distance.
#[derive(Clone)]
pub enum End {
    /// In the unit of the run.
    Place(DVec3),
    /// It goes where the particle goes.
    Particle(Tracked),
}

impl End {
    /// In the unit of the run.
    pub fn position(&self) -> DVec3 {
        match self {
            End::Place(place) => *place,
            End::Particle(particle) => particle.position(),
        }
    }

    /// Whether its particle is not in the frame in view.
    pub fn is_lost(&self) -> bool {
        matches!(self, End::Particle(particle) if particle.lost)
    }
}

/// A distance: up to two ends.
pub struct Distance {
    pub ends: Vec<End>,
    /// Whether ends are at particles, or wherever something is seen.
    pub at_particles: bool,
}

/// What is looked at, beside the picture itself.
#[derive(Default)]
pub struct Looking {
    pub tool: Option<Tool>,
    shot: Option<Shot>,
    /// Under the mouse, while it rests or moves over the picture with a tool in hand.
    pub hover: Option<Place>,
    click: Option<Place>,
    /// The latest answer.
    pub pointed: Option<Pointed>,
    pub picked: Option<Picked>,
    pub distance: Distance,
}

impl Default for Distance {
    fn default() -> Distance {
        Distance { ends: Vec::new(), at_particles: true }
    }
}

impl Distance {
    fn add(&mut self, end: End) {
        if self.ends.len() > 1 {
            self.ends.clear();
        }
        self.ends.push(end);
    }

    fn particles(&self) -> impl Iterator<Item = &Tracked> {
        self.ends.iter().filter_map(|end| match end {
            End::Particle(particle) => Some(particle),
            End::Place(_) => None,
        })
    }

    fn particles_mut(&mut self) -> impl Iterator<Item = &mut Tracked> {
        self.ends.iter_mut().filter_map(|end| match end {
            End::Particle(particle) => Some(particle),
            End::Place(_) => None,
        })
    }
}

impl Looking {
    /// Takes the tool into the hand, or puts it away.
    pub fn toggle(&mut self, tool: Tool) {
        self.tool = (self.tool != Some(tool)).then_some(tool);
        (self.hover, self.click, self.pointed) = (None, None, None);
    }

    /// Keeps the tool and nothing that was found with it, when another run is opened.
    pub fn forget(&mut self) {
        *self = Looking { tool: self.tool, ..Looking::default() };
    }

    pub(super) fn renumber(&mut self, insertion: &Insertion) {
        let shots = [self.shot.as_mut(), self.pointed.as_mut().map(|pointed| &mut pointed.shot)];
        let shots = shots.into_iter().flatten().map(|shot| &mut shot.index);
        let picked = self.picked.iter_mut().map(|picked| &mut picked.particle);
        let particles = picked.chain(self.distance.particles_mut()).map(|particle| &mut particle.index);
        shots.chain(particles).for_each(|index| *index = insertion.moved(*index));
    }

    pub fn holds(&self, tool: Tool) -> bool {
        self.tool == Some(tool)
    }

    /// Whether pictures must come with what they were drawn from.
    pub fn needs_shot(&self) -> bool {
        self.tool.is_some_and(Tool::points)
    }

    pub fn set_shot(&mut self, shot: Option<Shot>) {
        self.shot = shot;
    }

    pub fn pick(&mut self, particle: Tracked) {
        self.picked = Some(Picked { particle, follow: true, in_the_middle: false });
    }

    pub fn click(&mut self, place: Place) {
        self.click = Some(place);
    }

    /// The latest wish to know what is to be seen: a click comes before the place under the mouse.
    pub fn question(&self) -> Option<Question> {
        let shot = self.shot.as_ref().filter(|_| self.needs_shot())?;
        let known = |place: Place| {
            let same = |pointed: &Pointed| pointed.place == place && pointed.shot.is_same(shot);
            self.pointed.as_ref().is_some_and(same)
        };
        let ask = |place, click| Question { shot: shot.clone(), place, click };
        match (self.click, self.hover) {
            (Some(place), _) => Some(ask(place, true)),
            (None, Some(place)) if !known(place) => Some(ask(place, false)),
            _ => None,
        }
    }
}

impl Session {
    /// Takes a tool into the hand, or puts it away where it is there.
    pub fn take_tool(&mut self, tool: Tool) {
        self.looking.toggle(tool);
        let name = format!("{tool:?}").to_lowercase();
        self.log(format!("{name} {}", if self.looking.holds(tool) { "on" } else { "off" }));
    }

    /// Closes, one at a time, what the tools have opened, that of the tool in hand first; then puts
    /// the tool away.
    pub fn put_away(&mut self) {
        let Looking { tool, picked, distance, .. } = &mut self.looking;
        let measuring = *tool == Some(Tool::Measure) && !distance.ends.is_empty();
        match () {
            () if measuring => distance.ends.clear(),
            () if self.probe.take().is_some() => self.log("inspector closed"),
            () if picked.take().is_some() => {}
            () if !distance.ends.is_empty() => distance.ends.clear(),
            () => {
                if let Some(tool) = *tool {
                    self.take_tool(tool);
                }
            }
        }
    }

    /// Takes what is to be seen somewhere, and does what the tool does where that was clicked on.
    pub fn take_pointed(&mut self, pointed: Pointed) {
        let looking = &mut self.looking;
        if pointed.click && looking.click == Some(pointed.place) {
            looking.click = None;
            let nearest =
                pointed.seen.as_ref().and_then(|seen| seen.near.first().map(|near| (seen.point, near)));
            let Shot { frame, index, .. } = &pointed.shot;
            let particle = |row| Tracked::new(Arc::clone(frame), *index, row);
            match (looking.tool, nearest) {
                (Some(Tool::Pick), Some((_, near))) => {
                    looking.pick(particle(near.row));
                    self.log(format!("picked row={}", near.row));
                }
                (Some(Tool::Measure), Some((point, near))) => {
                    let at_particles = looking.distance.at_particles;
                    let end =
                        if at_particles { End::Particle(particle(near.row)) } else { End::Place(point) };
                    looking.distance.add(end);
                    self.log("measured an end");
                }
                (Some(Tool::Pick | Tool::Measure), None) => self.log("nothing there"),
                _ => {}
            }
        }
        self.looking.pointed = Some(pointed);
    }

    /// A particle that was picked or measured from, and is to be looked for in the frame in view.
    pub fn search(&mut self) -> Option<Search> {
        let (index, frame) = self.frame.as_ref()?;
        let Looking { picked, distance, .. } = &mut self.looking;
        let left = |picked: &Picked| !picked.follow && picked.particle.search(*index, frame).is_some();
        if picked.as_ref().is_some_and(left) {
            *picked = None;
        }
        let picked = picked.iter().map(|picked| &picked.particle);
        picked.chain(distance.particles()).find_map(|particle| particle.search(*index, frame))
    }

    /// Puts the picked particle in the middle of the picture, and keeps it there, or lets it go.
    pub fn keep_in_the_middle(&mut self, keep: bool) {
        let Some(picked) = &mut self.looking.picked else { return };
        picked.in_the_middle = keep;
        if let Some(camera) = self.camera.as_mut().filter(|_| keep) {
            camera.look_at(picked.particle.position());
        }
    }

    /// Takes where a particle went, and takes the camera along where that is wanted.
    pub fn take_located(&mut self, located: &Located) {
        let Looking { picked, distance, .. } = &mut self.looking;
        distance.particles_mut().for_each(|particle| particle.take(located));
        let Some(picked) = picked else { return };
        let before = picked.particle.position();
        picked.particle.take(located);
        let way = picked.particle.position() - before;
        if let Some(camera) = self.camera.as_mut().filter(|_| picked.in_the_middle) {
            let before = *camera;
            camera.shift(way);
            self.moved_by_itself(before);
        }
    }
}
