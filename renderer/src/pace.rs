//! How much work one submission gets: short enough for drivers' watchdogs and for cancelling, long
//! enough to keep the device busy.

use std::time::Duration;

/// Time that one submission should take.
const TARGET: Duration = Duration::from_millis(80);

/// Learns how many bundles fit the target, and remembers it from picture to picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    bundles: f64,
}

impl Pace {
    /// Starts with few bundles on a slow adapter.
    pub(crate) fn new(slow: bool) -> Pace {
        Pace { bundles: if slow { 32.0 } else { 2048.0 } }
    }

    pub(crate) fn bundles(&self) -> u64 {
        self.bundles as u64
    }

    /// Learns from a submission of `bundles` that took `elapsed`. One measurement changes the pace by
    /// a factor of four at most: bundles differ much in their cost.
    pub(crate) fn learn(&mut self, bundles: u64, elapsed: Duration) {
        let ratio = TARGET.as_secs_f64() / elapsed.as_secs_f64().max(1e-6);
        let wanted = bundles as f64 * ratio;
        self.bundles = wanted.clamp(self.bundles / 4.0, self.bundles * 4.0).clamp(1.0, 1e7);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pace_approaches_the_target_and_stays_in_bounds() {
        let mut pace = Pace::new(true);
        for _ in 0..20 {
            // A device that casts ten bundles a millisecond.
            let bundles = pace.bundles();
            pace.learn(bundles, Duration::from_secs_f64(bundles as f64 * 1e-4));
        }
        assert!((700..=900).contains(&pace.bundles()), "{}", pace.bundles());
        for _ in 0..20 {
            pace.learn(pace.bundles(), Duration::from_secs(1000));
        }
        assert_eq!(pace.bundles(), 1);
    }
}
