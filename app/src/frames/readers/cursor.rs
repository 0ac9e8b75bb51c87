//! Reading binary headers without trusting them.

use super::error::{Fault, Place};

/// A position in bytes that only moves over what is there.
pub struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Cursor { bytes, at: 0 }
    }

    pub fn offset(&self) -> usize {
        self.at
    }

    pub fn here(&self) -> Place {
        Place::Byte(self.at as u64)
    }

    pub fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// The next `len` bytes; `what` names them where they are not there.
    pub fn take(&mut self, len: usize, what: &str) -> Result<&'a [u8], Fault> {
        let rest = self.rest();
        let taken = rest.get(..len).ok_or_else(|| {
            let what = format!("file ends in {what}: expected {len} bytes, found {}", rest.len());
            Fault::at(what, self.here())
        })?;
        self.at += len;
        Ok(taken)
    }

    pub fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N], Fault> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N, what)?);
        Ok(array)
    }
}
