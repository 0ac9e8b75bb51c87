//! Bytes of a file that are there as they are, or as base64.

use std::borrow::Cow;

use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

/// An array as it lies in the file; bytes of other arrays may follow it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Encoded<'a> {
    Raw(&'a [u8]),
    Base64(&'a [u8]),
}

const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

impl<'a> Encoded<'a> {
    /// At most how many bytes this decodes to.
    pub fn capacity(self) -> usize {
        match self {
            Encoded::Raw(bytes) => bytes.len(),
            Encoded::Base64(text) => text.len() / 4 * 3 + 2,
        }
    }

    /// The first `length` bytes.
    pub fn take(self, length: usize, what: &str) -> Result<Cow<'a, [u8]>, String> {
        let truncated =
            || format!("truncated: expected {length} bytes of {what}, at most {} are left", self.capacity());
        match self {
            Encoded::Raw(bytes) => bytes.get(..length).map(Cow::Borrowed).ok_or_else(truncated),
            Encoded::Base64(text) => {
                let characters = length.div_ceil(3).checked_mul(4).ok_or_else(truncated)?;
                // The last group may lack its padding.
                let characters = characters.min(text.len());
                let mut bytes = BASE64
                    .decode(&text[..characters])
                    .map_err(|error| format!("expected base64 in {what}: {error}"))?;
                if bytes.len() < length {
                    return Err(truncated());
                }
                bytes.truncate(length);
                Ok(Cow::Owned(bytes))
            }
        }
    }

    /// What follows the first `length` bytes, where those were encoded on their own.
    pub fn after(self, length: usize) -> Self {
        match self {
            Encoded::Raw(bytes) => Encoded::Raw(bytes.get(length..).unwrap_or_default()),
            Encoded::Base64(text) => Encoded::Base64(text.get(length.div_ceil(3) * 4..).unwrap_or_default()),
        }
    }

    /// Whether the first `length` bytes were encoded on their own: as base64 they then end in padding.
    pub fn breaks_after(self, length: usize) -> bool {
        match self {
            Encoded::Raw(_) => true,
            Encoded::Base64(text) => text.get(length.div_ceil(3) * 4 - 1) == Some(&b'='),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_encodings_hold_the_same_bytes() {
        for encoded in [Encoded::Raw(b"abcdef"), Encoded::Base64(b"YWJjZGVm")] {
            assert_eq!(encoded.take(4, "").unwrap().as_ref(), b"abcd");
            assert_eq!(encoded.after(3).take(3, "").unwrap().as_ref(), b"def");
            assert!(encoded.take(7, "").unwrap_err().contains("truncated"));
            assert!(encoded.take(usize::MAX, "").is_err());
            assert!(encoded.after(100).take(1, "").is_err());
        }
    }

    #[test]
    fn padding_may_be_missing_but_not_wrong() {
        for text in ["YQ==", "YQ"] {
            assert_eq!(Encoded::Base64(text.as_bytes()).take(1, "").unwrap().as_ref(), b"a");
        }
        assert!(Encoded::Base64(b"Y*==").take(1, "").is_err());
    }
}
