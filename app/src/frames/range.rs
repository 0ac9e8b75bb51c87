//! `--frames A..B`: some of a sequence's frames.

use std::ops::Range;
use std::str::FromStr;

/// Frames from `start` up to, but not including, `end`, counted from 0; `None` is the sequence's end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    start: usize,
    end: Option<usize>,
}

impl FromStr for FrameRange {
    type Err = String;

    /// Reads `A..B`, `A..`, `..B`, or one number.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || format!("`{text}` is not a range of frames: expected A..B, A.., ..B or one number");
        let number = |text: &str| text.trim().parse::<usize>().map_err(|_| wrong());
        let Some((start, end)) = text.split_once("..") else {
            let start = number(text)?;
            return Ok(FrameRange { start, end: start.checked_add(1) });
        };
        let start = if start.is_empty() { 0 } else { number(start)? };
        let end = if end.is_empty() { None } else { Some(number(end)?) };
        match end {
            Some(end) if end <= start => Err(format!("`{text}` holds no frame: B is left out")),
            _ => Ok(FrameRange { start, end }),
        }
    }
}

impl FrameRange {
    /// The frames of a sequence of `count`; the error says which frames there are.
    pub fn within(self, count: usize) -> Result<Range<usize>, String> {
        let range = self.start..self.end.unwrap_or(count);
        if range.start < range.end && range.end <= count {
            return Ok(range);
        }
        let asked = match self.end {
            Some(end) => format!("{}..{end}", self.start),
            None => format!("{}..", self.start),
        };
        Err(format!("{asked} goes past the {count} frames that there are, 0..{count}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_read_and_checked() {
        let within = |text: &str| text.parse::<FrameRange>()?.within(10);
        assert_eq!(within("2..5"), Ok(2..5));
        assert_eq!(within("2.."), Ok(2..10));
        assert_eq!(within("..5"), Ok(0..5));
        assert_eq!(within("9"), Ok(9..10));
        assert_eq!(within(".."), Ok(0..10));
        for wrong in ["10", "0..11", "10..", "5..5", "6..5", "a..b", "", "1..2..3", "-1..2"] {
            assert!(within(wrong).is_err(), "{wrong}");
        }
    }
}
