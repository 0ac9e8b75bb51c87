//! How coarse a picture must be to be there in time.

/// Pictures are drawn at 1/1 to 1/16 of their full size.
pub const DIVISORS: [u32; 8] = [1, 2, 3, 4, 6, 8, 12, 16];

/// What pictures took so far, by divisor.
#[derive(Clone, Debug)]
pub struct Pace {
    /// Milliseconds that a moving picture may take.
    budget: f64,
    /// Full size in pixels that the measurements belong to.
    pixels: f64,
    measured: [Option<f64>; DIVISORS.len()],
    /// Divisor before anything was measured.
    guess: u32,
}

impl Pace {
    pub fn new(budget: f64, software: bool) -> Pace {
        Pace {
            budget,
            pixels: 1.0,
            measured: [None; DIVISORS.len()],
            // A program on the CPU is some hundred times slower than a GPU.
            guess: if software { 8 } else { 2 },
        }
    }

    /// Milliseconds that a moving picture may take.
    pub fn budget(&self) -> f64 {
        self.budget
    }

    /// Changes the milliseconds that a moving picture may take.
    pub fn set_budget(&mut self, milliseconds: f64) {
        self.budget = milliseconds;
    }

    /// Takes note that a picture of `pixels` full size, drawn at 1/`divisor`, took `milliseconds`.
    pub fn learn(&mut self, pixels: f64, divisor: u32, milliseconds: f64) {
        let growth = pixels.max(1.0) / self.pixels;
        let Some(place) = DIVISORS.iter().position(|&d| d == divisor) else { return };
        let change = match self.measured[place] {
            // Another scene: what one size shows about it holds for the other sizes, too.
            Some(before) if before > 0.0 => milliseconds / before,
            _ => growth,
        };
        for measured in self.measured.iter_mut().flatten() {
            *measured *= change;
        }
        self.measured[place] = Some(milliseconds);
        self.pixels = pixels.max(1.0);
    }

    /// Milliseconds that a picture at 1/`divisor` will take: measured there, or at the nearest
    /// divisor and in proportion to the pixels.
    pub fn predict(&self, divisor: u32) -> Option<f64> {
        let nearest = |(&d, measured): (&u32, &Option<f64>)| measured.map(|ms| (d, ms));
        let (from, ms) = DIVISORS
            .iter()
            .zip(&self.measured)
            .filter_map(nearest)
            .min_by_key(|(d, _)| d.abs_diff(divisor))?;
        Some(ms * (f64::from(from) / f64::from(divisor)).powi(2))
    }

    /// The divisor for a moving picture: the finest within the budget. Where none is, the finest
    /// that costs little more than the coarsest: below some size, all take the same.
    pub fn moving(&self) -> u32 {
        let last = DIVISORS[DIVISORS.len() - 1];
        let Some(coarsest) = self.predict(last) else { return self.guess };
        let limit = self.budget.max(1.3 * coarsest);
        DIVISORS.into_iter().find(|&d| self.predict(d).is_some_and(|ms| ms <= limit)).unwrap_or(last)
    }

    /// The divisor to start with at rest: full where that is quick.
    pub fn resting(&self) -> u32 {
        match self.predict(1) {
            Some(full) if full <= 3.0 * self.budget => 1,
            _ => self.moving(),
        }
    }

    /// The next finer one on the way to full size.
    pub fn finer(divisor: u32) -> u32 {
        match divisor {
            0..=2 => 1,
            3..=6 => 2,
            _ => 4,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_pictures_meet_the_budget() {
        let mut pace = Pace::new(50.0, true);
        assert_eq!(pace.moving(), 8);
        pace.learn(1e6, 8, 20.0);
        assert_eq!(pace.moving(), 6, "20·(8/6)² is within 50, 20·(8/4)² is not");
        pace.learn(1e6, 1, 30.0);
        assert_eq!((pace.moving(), pace.resting()), (1, 1));
    }

    #[test]
    fn coarser_is_pointless_where_it_is_not_faster() {
        let mut pace = Pace::new(50.0, true);
        pace.learn(1e6, 16, 180.0);
        pace.learn(1e6, 8, 200.0);
        assert_eq!(pace.moving(), 8);
    }

    #[test]
    fn another_scene_rescales_everything() {
        let mut pace = Pace::new(50.0, false);
        pace.learn(1e6, 4, 10.0);
        pace.learn(1e6, 1, 100.0);
        pace.learn(1e6, 4, 20.0);
        assert_eq!(pace.predict(1), Some(200.0));
        assert_eq!((pace.moving(), pace.resting()), (2, 2));
    }

    #[test]
    fn refinement_ends_at_full_size() {
        for start in DIVISORS {
            let mut divisor = start;
            let mut passes = 0;
            while divisor > 1 {
                divisor = Pace::finer(divisor);
                passes += 1;
            }
            assert!(passes <= 3);
        }
    }
}
