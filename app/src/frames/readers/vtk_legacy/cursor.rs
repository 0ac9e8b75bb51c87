//! A place in a legacy file, and the words, lines and byte runs that follow it.

use crate::frames::readers::error::{Fault, Place};
use crate::frames::readers::vtk_numbers::{Words, shown};

/// Reads a legacy file from front to back. The text between binary arrays is read by words too.
pub(super) struct Cursor<'a> {
    pub words: Words<'a>,
    /// Arrays are big-endian bytes rather than text.
    pub binary: bool,
}

impl<'a> Cursor<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Cursor { words: Words { bytes, position: 0 }, binary: false }
    }

    pub fn position(&self) -> usize {
        self.words.position
    }

    fn rest(&self) -> &'a [u8] {
        &self.words.bytes[self.words.position..]
    }

    /// What is wrong at byte `position`: told by line in a text file, by offset in a binary one.
    pub fn fault_at(&self, position: usize, what: impl Into<String>) -> Fault {
        let place = if self.binary {
            Place::Byte(position as u64)
        } else {
            let before = &self.words.bytes[..position.min(self.words.bytes.len())];
            Place::Line(1 + before.iter().filter(|&&b| b == b'\n').count())
        };
        Fault::at(what, place)
    }

    pub fn fault(&self, what: impl Into<String>) -> Fault {
        self.fault_at(self.position(), what)
    }

    /// The next word and where it starts.
    pub fn word(&mut self, expected: &str) -> Result<(&'a [u8], usize), Fault> {
        self.words.skip_white_space();
        let start = self.position();
        match self.words.next() {
            Some(word) => Ok((word, start)),
            None => Err(self.fault_at(start, format!("truncated: expected {expected}, the file ends"))),
        }
    }

    /// The next word in capitals, or `None` where only white space is left.
    pub fn keyword(&mut self) -> Option<(String, usize)> {
        self.words.skip_white_space();
        let start = self.position();
        let word = self.words.next()?;
        // No keyword is nearly as long; what follows a lost place in a binary file may be.
        let word = &word[..word.len().min(64)];
        Some((String::from_utf8_lossy(word).to_ascii_uppercase(), start))
    }

    /// Takes the next word if it is `expected`, without regard to case. With `touching` it has to
    /// start right here: binary numbers may begin with what looks like white space.
    pub fn take_word(&mut self, expected: &str, touching: bool) -> bool {
        let before = self.position();
        if !touching {
            self.words.skip_white_space();
        }
        let start = self.rest().get(..expected.len());
        let taken = start.is_some_and(|word| word.eq_ignore_ascii_case(expected.as_bytes()))
            && self.rest().get(expected.len()).is_none_or(u8::is_ascii_whitespace);
        self.words.position = if taken { self.position() + expected.len() } else { before };
        taken
    }

    /// The next word as a count. It may still be a lie about how much follows.
    pub fn count(&mut self, of: &str) -> Result<usize, Fault> {
        let (word, start) = self.word(&format!("the number of {of}"))?;
        std::str::from_utf8(word).ok().and_then(|text| text.parse().ok()).ok_or_else(|| {
            self.fault_at(start, format!("expected the number of {of}, found {}", shown(word)))
        })
    }

    /// What is left of this line, without its end; the place is then the start of the next line.
    pub fn line(&mut self) -> &'a [u8] {
        let rest = self.rest();
        let length = rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
        self.words.position += (length + 1).min(rest.len());
        rest[..length].trim_ascii()
    }

    /// Goes to the next line; it is a fault where something else than white space is left of this one.
    pub fn end_of_line(&mut self) -> Result<(), Fault> {
        let start = self.position();
        match self.line() {
            [] => Ok(()),
            found => {
                Err(self.fault_at(start, format!("expected the end of the line, found {}", shown(found))))
            }
        }
    }

    pub fn at_end(&self) -> bool {
        self.rest().is_empty()
    }

    /// The next `length` bytes.
    pub fn bytes(&mut self, length: Option<usize>, what: &str) -> Result<&'a [u8], Fault> {
        let rest = self.rest();
        match length.filter(|&length| length <= rest.len()) {
            Some(length) => {
                self.words.position += length;
                Ok(&rest[..length])
            }
            None => {
                let length =
                    length.map_or("more than any file holds".to_owned(), |length| length.to_string());
                Err(self
                    .fault(format!("truncated: expected {length} bytes of {what}, {} are left", rest.len())))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_lines_and_bytes_follow_each_other() {
        let mut cursor = Cursor::new(b"POINTS 2 float \r\n\x01\x02rest");
        assert_eq!(cursor.keyword(), Some(("POINTS".into(), 0)));
        assert_eq!(cursor.count("points"), Ok(2));
        assert_eq!(cursor.word("a type"), Ok((&b"float"[..], 9)));
        cursor.end_of_line().unwrap();
        assert_eq!(cursor.bytes(Some(2), "points"), Ok(&[1, 2][..]));
        assert!(cursor.bytes(Some(5), "points").is_err());
        assert!(cursor.bytes(None, "points").is_err());
        assert!(!cursor.take_word("RES", true));
        assert!(cursor.take_word("REST", true));
        assert_eq!(cursor.keyword(), None);
    }

    #[test]
    fn places_are_lines_in_text_and_bytes_in_binary() {
        let mut cursor = Cursor::new(b"a\nb -5");
        cursor.line();
        cursor.keyword();
        let fault = cursor.count("points").unwrap_err();
        assert_eq!(fault.place, Some(Place::Line(2)));
        assert!(fault.what.contains("`-5`"), "{}", fault.what);
        cursor.binary = true;
        assert_eq!(cursor.fault("").place, Some(Place::Byte(6)));
    }
}
