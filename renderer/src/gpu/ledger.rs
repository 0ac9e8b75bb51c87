//! What is held of the device's memory, and the most of it at a time.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// Counts the bytes of all buffers and textures of one device.
#[derive(Clone, Default)]
pub(crate) struct Ledger(Arc<Sums>);

#[derive(Default)]
struct Sums {
    held: AtomicU64,
    peak: AtomicU64,
}

/// Some bytes that are held for as long as this lives.
pub(crate) struct Entry {
    ledger: Ledger,
    bytes: u64,
}

impl Ledger {
    /// Writes `bytes` down as held.
    pub(crate) fn enter(&self, bytes: u64) -> Entry {
        let held = self.0.held.fetch_add(bytes, Relaxed) + bytes;
        self.0.peak.fetch_max(held, Relaxed);
        Entry { ledger: self.clone(), bytes }
    }

    /// Bytes that are held now.
    pub(crate) fn held(&self) -> u64 {
        self.0.held.load(Relaxed)
    }

    /// The most bytes that were held at a time since the last [`Ledger::begin`].
    pub(crate) fn peak(&self) -> u64 {
        self.0.peak.load(Relaxed)
    }

    /// Forgets what was held at a time before.
    pub(crate) fn begin(&self) {
        self.0.peak.store(self.held(), Relaxed);
    }
}

impl Drop for Entry {
    fn drop(&mut self) {
        self.ledger.0.held.fetch_sub(self.bytes, Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_is_of_what_is_held_together() {
        let ledger = Ledger::default();
        let first = ledger.enter(5);
        drop(ledger.enter(7));
        let second = ledger.enter(3);
        assert_eq!((ledger.held(), ledger.peak()), (8, 12));
        drop(first);
        ledger.begin();
        assert_eq!((ledger.held(), ledger.peak()), (3, 3));
        drop(second);
        assert_eq!((ledger.held(), ledger.peak()), (0, 3));
    }
}
