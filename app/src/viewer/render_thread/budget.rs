//! How much larger the error of a moving picture may be, so that it is there in time.
//!
//! Two things make a picture quicker: a larger E_I, and fewer pixels. E_I comes first, since a known
//! error in sharp pixels hides less than blurred ones: it rises until a picture of *full* size would keep
//! the time, or up to a limit. What is then still missing is left to the resolution ([`crate::viewer::render_thread::pace`]),
//! which goes by the times of pictures with the E_I in force. Where E_I at its limit turns out to bring
//! next to nothing (most of the time goes into the grid, or all is sampled in full because adapting does
//! not pay), it goes back to the user's, and only the resolution is divided, until the scene takes a
//! clearly different time.
//!
//! Pure: times come in, an E_I comes out.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// What the user wants of moving pictures: a setting of the program, and no part of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Budget {
    pub on: bool,
    /// Milliseconds that a moving picture may take.
    pub milliseconds: f64,
    /// The largest E_I while something moves.
    pub most: f64,
}

impl Budget {
    /// What may be asked for, in milliseconds and as E_I.
    pub const MILLISECONDS: std::ops::RangeInclusive<f64> = 5.0..=2000.0;
    pub const MOST: std::ops::RangeInclusive<f64> = 0.001..=1.0;

    /// The same within what may be asked for: a file may say anything.
    pub fn sound(self) -> Budget {
        let within =
            |value: f64, range: std::ops::RangeInclusive<f64>| value.clamp(*range.start(), *range.end());
        Budget {
            milliseconds: within(self.milliseconds, Budget::MILLISECONDS),
            most: within(self.most, Budget::MOST),
            ..self
        }
    }
}

impl Default for Budget {
    fn default() -> Budget {
        Budget { on: false, milliseconds: 40.0, most: 0.1 }
    }
}

/// From a smaller E_I the way up begins here: below, nearly everything is sampled.
const LEAST: f64 = 1e-4;
/// A picture may take this share of its time before E_I falls again. In between nothing changes.
const QUICK: f64 = 0.7;
/// The share of its time that a falling E_I aims at.
const AIM: f64 = 0.85;
/// So many quick pictures in a row, before E_I falls.
const PATIENCE: u32 = 3;
/// The largest steps up and down, as factors of E_I.
const UP: f64 = 2.0;
const DOWN: f64 = 1.5;
/// The least gain in time for which a larger error is worth it.
const GAIN: f64 = 1.15;
/// After what change in time it is tried again.
const OTHER_SCENE: f64 = 2.0;
/// Pictures that such a verdict takes.
const ENOUGH: usize = 5;

/// Raises E_I while pictures of full size are too slow, and lowers it again.
#[derive(Clone, Debug, Default)]
pub struct Raise {
    /// Natural logarithm of E_I in force over the user's.
    amount: f64,
    /// Quick pictures in a row.
    quick: u32,
    /// Times of pictures with the user's E_I, and with the limit.
    own: Recent,
    limit: Recent,
    /// The time at the limit, where that was found to bring nothing.
    futile: Option<f64>,
    /// What all this is about: the user's E_I, and the time and limit asked for.
    asked: Option<(f64, Budget)>,
}

impl Raise {
    /// E_I for a moving picture, where the user's is `own`: between that and the limit. Full sampling
    /// stays full.
    pub fn tolerance(&self, own: Option<f64>, budget: &Budget) -> Option<f64> {
        let own = own?;
        if !budget.on || self.amount == 0.0 {
            return Some(own);
        }
        Some((own.max(LEAST) * self.amount.exp()).min(budget.most).max(own))
    }

    /// Learns that a moving picture with the E_I in force would take `milliseconds` in full size.
    pub fn learn(&mut self, milliseconds: f64, own: Option<f64>, budget: &Budget) {
        let Some(own) = own.filter(|own| budget.on && *own < budget.most) else {
            self.amount = 0.0;
            return;
        };
        if self.asked != Some((own, *budget)) {
            let own_times = std::mem::take(&mut self.own);
            *self = Raise {
                asked: Some((own, *budget)),
                amount: self.amount,
                own: own_times,
                ..Raise::default()
            };
        }
        let room = (budget.most / own.max(LEAST)).ln();
        self.amount = self.amount.min(room);
        if self.amount == 0.0 {
            self.own.push(milliseconds);
        }
        if self.is_futile() {
            return;
        }
        if milliseconds > budget.milliseconds {
            self.up(milliseconds, room, budget.milliseconds);
        } else if milliseconds < QUICK * budget.milliseconds {
            self.down(milliseconds, budget.milliseconds);
        } else {
            self.quick = 0;
        }
    }

    /// Learns that a picture at rest, with the user's E_I, took `milliseconds`.
    pub fn rest(&mut self, milliseconds: f64) {
        self.own.push(milliseconds);
    }

    fn up(&mut self, milliseconds: f64, room: f64, limit: f64) {
        self.quick = 0;
        if self.amount < room {
            self.limit = Recent::default();
            self.amount = (self.amount + (milliseconds / limit).ln().clamp(0.05, UP.ln())).min(room);
            return;
        }
        self.limit.push(milliseconds);
        if let (Some(at_limit), Some(own)) = (self.limit.verdict(), self.own.median())
            && own < GAIN * at_limit
        {
            self.futile = Some(at_limit);
            (self.amount, self.own, self.limit) = (0.0, Recent::default(), Recent::default());
        }
    }

    fn down(&mut self, milliseconds: f64, limit: f64) {
        self.quick += 1;
        if self.quick >= PATIENCE {
            self.quick = 0;
            let step = (AIM * limit / milliseconds.max(1e-3)).ln().min(DOWN.ln());
            self.amount = (self.amount - step).max(0.0);
        }
    }

    /// Whether it was found to bring nothing, and the scene is still much the same.
    fn is_futile(&mut self) -> bool {
        let Some(then) = self.futile else { return false };
        let changed = |now: f64| now > OTHER_SCENE * then || now < then / OTHER_SCENE;
        if self.own.verdict().is_some_and(changed) {
            self.futile = None;
        }
        self.futile.is_some()
    }
}

/// The last few times: one that is out of the ordinary does not count.
#[derive(Clone, Debug, Default)]
struct Recent {
    times: VecDeque<f64>,
}

impl Recent {
    fn push(&mut self, milliseconds: f64) {
        if self.times.len() == ENOUGH {
            self.times.pop_front();
        }
        self.times.push_back(milliseconds);
    }

    fn median(&self) -> Option<f64> {
        let mut sorted: Vec<f64> = self.times.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        sorted.get(sorted.len() / 2).copied()
    }

    /// The median of as many as a verdict takes.
    fn verdict(&self) -> Option<f64> {
        self.median().filter(|_| self.times.len() == ENOUGH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUDGET: Budget = Budget { on: true, milliseconds: 40.0, most: 0.1 };
    const OWN: Option<f64> = Some(0.004);

    /// Draws `count` pictures of a scene in which a picture takes as long as `time` says of its E_I.
    fn draw(raise: &mut Raise, count: usize, time: impl Fn(f64) -> f64) -> Vec<f64> {
        let one = |_| {
            let tolerance = raise.tolerance(OWN, &BUDGET).unwrap();
            raise.learn(time(tolerance), OWN, &BUDGET);
            tolerance
        };
        (0..count).map(one).collect()
    }

    /// Fixed costs of 10 ms, and a ray cast that falls with the square root of E_I.
    fn falling(tolerance: f64) -> f64 {
        10.0 + 70.0 * (0.004 / tolerance).sqrt()
    }

    #[test]
    fn it_rises_until_the_time_is_kept_and_stays_there() {
        let mut raise = Raise::default();
        let tolerances = draw(&mut raise, 30, falling);
        assert_eq!(tolerances[0], 0.004, "the first picture has the user's");
        let settled = &tolerances[20..];
        assert!(settled.iter().all(|e| *e == settled[0]), "{settled:?}");
        let time = falling(settled[0]);
        assert!((QUICK * 40.0..=40.0).contains(&time), "{time}");
    }

    #[test]
    fn it_falls_back_to_the_users_when_the_scene_becomes_quick() {
        let mut raise = Raise::default();
        draw(&mut raise, 30, falling);
        assert!(raise.amount > 0.0);
        let tolerances = draw(&mut raise, 30, |_| 10.0);
        assert!(tolerances.windows(2).all(|pair| pair[1] <= pair[0]), "never up again");
        assert_eq!(*tolerances.last().unwrap(), 0.004);
    }

    #[test]
    fn it_stays_between_the_users_and_the_limit() {
        for (own, most) in [(0.004, 0.1), (0.0, 0.02), (1e-6, 1.0), (0.3, 0.1), (0.1, 0.1)] {
            let budget = Budget { most, ..BUDGET };
            let mut raise = Raise::default();
            // By turns much too slow and much too quick.
            for number in 0..60 {
                let tolerance = raise.tolerance(Some(own), &budget).unwrap();
                assert!(tolerance >= own && tolerance <= most.max(own), "{tolerance} of {own}, {most}");
                raise.learn(if number % 20 < 10 { 900.0 } else { 0.0 }, Some(own), &budget);
            }
        }
    }

    #[test]
    fn at_the_limit_it_stays_where_that_helps() {
        let mut raise = Raise::default();
        let tolerances = draw(&mut raise, 40, |tolerance| 20.0 * falling(tolerance));
        assert!(tolerances[20..].iter().all(|e| (e - 0.1).abs() < 1e-12));
    }

    #[test]
    fn where_it_brings_nothing_it_goes_back_until_the_scene_is_another() {
        let mut raise = Raise::default();
        let tolerances = draw(&mut raise, 60, |_| 200.0);
        assert!(tolerances.iter().any(|e| (e - 0.1).abs() < 1e-12), "it was tried");
        assert!(tolerances[20..].iter().all(|e| *e == 0.004), "and given up");
        // Times of one scene vary; those of another are clearly other times.
        let noisy = [150.0, 260.0, 200.0, 400.0, 190.0, 210.0, 170.0];
        for milliseconds in noisy {
            raise.learn(milliseconds, OWN, &BUDGET);
        }
        assert!(raise.amount == 0.0);
        draw(&mut raise, 8, |tolerance| 8.0 * falling(tolerance));
        assert!(raise.amount > 0.0, "it is tried again");
    }

    #[test]
    fn a_single_quick_or_slow_picture_changes_little() {
        let mut raise = Raise::default();
        draw(&mut raise, 30, falling);
        let before = raise.tolerance(OWN, &BUDGET).unwrap();
        raise.learn(1.0, OWN, &BUDGET);
        assert_eq!(raise.tolerance(OWN, &BUDGET).unwrap(), before);
        raise.learn(4000.0, OWN, &BUDGET);
        assert!(raise.tolerance(OWN, &BUDGET).unwrap() <= 1.001 * UP * before);
    }

    #[test]
    fn switched_off_or_sampled_in_full_nothing_is_raised() {
        let off = Budget { on: false, ..BUDGET };
        let mut raise = Raise::default();
        draw(&mut raise, 10, falling);
        assert_eq!(raise.tolerance(OWN, &off), OWN);
        raise.learn(900.0, OWN, &off);
        assert!(raise.amount == 0.0);
        draw(&mut raise, 10, falling);
        raise.learn(900.0, None, &BUDGET);
        assert_eq!(raise.tolerance(None, &BUDGET), None);
    }
}
