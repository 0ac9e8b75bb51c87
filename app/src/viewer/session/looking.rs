//! Looking closer: the tool in hand, what it points at, the particle that was picked, and what is
//! measured.

use std::sync::Arc;

use glam::DVec3;

use super::Session;
use crate::viewer::inspect::picked::{Located, Picked, Search};
use crate::viewer::inspect::pointing::{Place, Pointed, Question, Shot};

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

/// A distance: up to two ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Distance {
    /// In the unit of the run.
    pub ends: Vec<DVec3>,
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
    fn add(&mut self, end: DVec3) {
        if self.ends.len() > 1 {
            self.ends.clear();
        }
        self.ends.push(end);
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
            match (looking.tool, nearest) {
                (Some(Tool::Pick), Some((_, near))) => {
                    let Shot { frame, index, .. } = &pointed.shot;
                    looking.picked = Some(Picked::new(Arc::clone(frame), *index, near.row));
                    self.log(format!("picked row={}", near.row));
                }
                (Some(Tool::Measure), Some((point, near))) => {
                    looking.distance.add(if looking.distance.at_particles { near.position } else { point });
                    self.log("measured an end");
                }
                (Some(Tool::Pick | Tool::Measure), None) => self.log("nothing there"),
                _ => {}
            }
        }
        self.looking.pointed = Some(pointed);
    }

    /// Where the picked particle is in the frame in view, where that is not known.
    pub fn search(&mut self) -> Option<Search> {
        let (index, frame) = self.frame.as_ref()?;
        let picked = self.looking.picked.as_ref()?;
        if Arc::ptr_eq(&picked.looked_through, frame) {
            return None;
        }
        if !picked.follow {
            self.looking.picked = None;
            return None;
        }
        Some(Search { frame: Arc::clone(frame), index: *index, mark: picked.mark })
    }

    /// Puts the picked particle in the middle of the picture, and keeps it there, or lets it go.
    pub fn keep_in_the_middle(&mut self, keep: bool) {
        let Some(picked) = &mut self.looking.picked else { return };
        picked.in_the_middle = keep;
        if let Some(camera) = self.camera.as_mut().filter(|_| keep) {
            camera.look_at(picked.position());
        }
    }

    /// Takes where the picked particle went, and takes the camera along where that is wanted.
    pub fn take_located(&mut self, located: Located) {
        let Located { search: Search { frame, index, mark }, row } = located;
        let Some(picked) = self.looking.picked.as_mut().filter(|picked| picked.mark == mark) else { return };
        let before = picked.position();
        picked.looked_through = Arc::clone(&frame);
        picked.lost = row.is_none();
        if let Some(row) = row {
            (picked.frame, picked.index, picked.row) = (frame, index, row);
            let way = picked.position() - before;
            if let Some(camera) = self.camera.as_mut().filter(|_| picked.in_the_middle) {
                camera.shift(way);
            }
        }
    }
}
