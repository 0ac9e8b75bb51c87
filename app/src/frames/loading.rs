//! How far the reading of a frame is, and whether anybody still wants it.

use std::io::{self, Read};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// What the reader of one frame and whoever waits for it share.
#[derive(Debug, Default)]
pub struct Loading {
    /// Bytes read, and bytes of the file; 0 until that is known.
    read: AtomicU64,
    total: AtomicU64,
    cancelled: AtomicBool,
}

/// Says that what is read is no longer wanted.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("reading it was cancelled; open the file again to read it")]
pub struct Cancelled;

impl Loading {
    /// Says how many bytes there are to read.
    pub fn begin(&self, total: u64) {
        self.total.store(total, Ordering::Relaxed);
    }

    /// Takes note of `bytes` that were read.
    pub fn advance(&self, bytes: u64) -> Result<(), Cancelled> {
        self.read.fetch_add(bytes, Ordering::Relaxed);
        if self.is_cancelled() { Err(Cancelled) } else { Ok(()) }
    }

    /// Bytes read so far, and bytes in all. A reader that comes back to a place counts it again, so that
    /// there may be more of the former.
    pub fn bytes(&self) -> [u64; 2] {
        [&self.read, &self.total].map(|bytes| bytes.load(Ordering::Relaxed))
    }

    /// Has the reader end at its next piece.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

/// A reader whose pieces are counted.
pub struct Counted<'a, R> {
    pub inner: R,
    pub loading: &'a Loading,
}

impl<R: Read> Read for Counted<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let bytes = self.inner.read(buffer)?;
        self.loading.advance(bytes as u64).map_err(io::Error::other)?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_counted_and_a_cancelled_reader_ends() {
        let loading = Loading::default();
        let text = [7_u8; 100];
        loading.begin(100);
        let mut reader = Counted { inner: &text[..], loading: &loading };
        let mut piece = [0; 40];
        reader.read_exact(&mut piece).unwrap();
        assert_eq!(loading.bytes(), [40, 100]);
        loading.cancel();
        assert!(reader.read_to_end(&mut Vec::new()).unwrap_err().to_string().contains("cancelled"));
    }
}
