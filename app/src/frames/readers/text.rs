//! What the text formats share: encodings, lines, numbers.

use std::borrow::Cow;
use std::iter::Enumerate;
use std::str::Lines;

/// The text of a file: UTF-8 with or without a mark, or UTF-16 with one. Bytes that are not UTF-8
/// (names in an old encoding) become replacement characters, which no number contains.
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => String::from_utf8_lossy(rest),
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes),
        _ => String::from_utf8_lossy(bytes),
    }
}

fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Cow<'_, str> {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect::<String>().into()
}

/// Lines with their one-based numbers, without those that are blank or a comment.
#[derive(Clone)]
pub struct DataLines<'a>(Enumerate<Lines<'a>>);

pub fn data_lines(text: &str) -> DataLines<'_> {
    DataLines(text.lines().enumerate())
}

impl<'a> DataLines<'a> {
    /// The next line of any kind, trimmed.
    pub fn next_raw(&mut self) -> Option<(usize, &'a str)> {
        self.0.next().map(|(index, line)| (index + 1, line.trim()))
    }
}

impl<'a> Iterator for DataLines<'a> {
    type Item = (usize, &'a str);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let (number, line) = self.next_raw()?;
            if !line.is_empty() && !is_comment(line) {
                return Some((number, line));
            }
        }
    }
}

pub fn is_comment(line: &str) -> bool {
    line.starts_with(['#', '%']) || line.starts_with("//")
}

/// A number as programs write it: also Fortran's exponent `1.0D+00` and Microsoft's `-nan(ind)`.
pub fn number(cell: &str) -> Option<f64> {
    cell.parse().ok().or_else(|| unusual_number(cell))
}

#[cold]
fn unusual_number(cell: &str) -> Option<f64> {
    let fortran = cell.split_once(['d', 'D']).map(|(digits, exponent)| format!("{digits}e{exponent}"));
    if let Some(value) = fortran.and_then(|cell| cell.parse().ok()) {
        return Some(value);
    }
    let bare = cell.trim_start_matches(['-', '+']).to_ascii_lowercase();
    let sign = if cell.starts_with('-') { -1.0 } else { 1.0 };
    match bare.as_str() {
        "nan(ind)" | "nan(snan)" | "1.#ind" | "1.#qnan" => Some(f64::NAN),
        "1.#inf" => Some(sign * f64::INFINITY),
        _ => None,
    }
}

/// A cell for an error message: quoted, and cut where it is long.
pub fn quote(cell: &str) -> String {
    let mut short: String = cell.chars().take(40).collect();
    if short.len() < cell.len() {
        short.push('…');
    }
    format!("`{short}`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_with_a_mark_are_decoded() {
        let utf16: Vec<u8> = "\u{feff}a,é".encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert_eq!(decode(&utf16), "a,é");
        assert_eq!(decode(b"\xef\xbb\xbfa"), "a");
        assert_eq!(decode(b"\xb5m"), "\u{fffd}m");
    }

    #[test]
    fn numbers_of_other_languages() {
        assert_eq!(number("-1.5D+02"), Some(-150.0));
        assert_eq!(number("-1.#INF"), Some(f64::NEG_INFINITY));
        assert!(number("-nan(ind)").is_some_and(f64::is_nan));
        for text in ["n/a", "", "id", "1,5", "d", "0x10", "1e", "--1"] {
            assert_eq!(number(text), None, "{text}");
        }
    }

    #[test]
    fn lines_are_numbered_over_comments_and_blanks() {
        let lines: Vec<_> = data_lines("# a\r\n\r\n b \r\n%\nc").collect();
        assert_eq!(lines, [(3, "b"), (5, "c")]);
    }
}
