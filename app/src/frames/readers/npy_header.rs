//! The header of a `.npy` array: a Python dictionary with the type, the order and the shape.
//!
//! Read here, without recursion, since a header of ten thousand brackets must not overflow a stack.

use super::cursor::Cursor;
use super::error::{Fault, Place};
use super::rows::{Endian, Scalar};
use super::text::quote;

/// A header of plain arrays takes 128 bytes, and one of a record some more.
const LONGEST_HEADER: usize = 1 << 20;

#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    pub name: String,
    pub scalar: Scalar,
    pub endian: Endian,
    pub count: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub enum DType {
    Plain(Scalar, Endian),
    Record(Vec<Member>),
    /// Pickled Python objects, which only Python can read.
    Object,
    /// Text, complex or half-precision numbers, dates.
    Other(String),
}

#[derive(Clone, Debug)]
pub struct Header {
    pub dtype: DType,
    pub fortran: bool,
    pub shape: Vec<u64>,
}

impl Header {
    pub fn parse(cursor: &mut Cursor<'_>) -> Result<Header, Fault> {
        if !cursor.rest().starts_with(b"\x93NUMPY") {
            return Err(Fault::at("not a NumPy array, expected it to begin with \\x93NUMPY", cursor.here()));
        }
        cursor.take(6, "the header")?;
        let [major, _] = cursor.array::<2>("the header")?;
        let length = match major {
            1 => usize::from(u16::from_le_bytes(cursor.array("the header")?)),
            2 | 3 => u32::from_le_bytes(cursor.array("the header")?) as usize,
            _ => {
                return Err(Fault::at(
                    format!("version {major} of .npy, expected 1, 2 or 3"),
                    Place::Byte(6),
                ));
            }
        };
        let place = cursor.here();
        if length > LONGEST_HEADER {
            return Err(Fault::at(
                format!("header of {length} bytes, expected at most {LONGEST_HEADER}"),
                place,
            ));
        }
        let text = String::from_utf8_lossy(cursor.take(length, "the header")?);
        let header = dictionary(&text).map_err(|what| Fault::at(what, place.clone()))?;
        match header.dtype {
            DType::Object => {
                Err(Fault::at("array of Python objects (pickle) is not read, expected numbers", place))
            }
            _ => Ok(header),
        }
    }

    pub fn rows(&self) -> usize {
        self.shape.first().map_or(1, |&n| n as usize)
    }

    /// Numbers in a row; [`Header::bytes`] has checked that they fit.
    pub fn components(&self) -> usize {
        self.shape.iter().skip(1).product::<u64>() as usize
    }

    /// Bytes of the data; `None` where that is beyond counting or the type has no size here.
    pub fn bytes(&self) -> Option<usize> {
        let size = match &self.dtype {
            DType::Plain(scalar, _) => scalar.bytes(),
            DType::Record(members) => members.iter().try_fold(0usize, |sum, member| {
                sum.checked_add(member.count.checked_mul(member.scalar.bytes())?)
            })?,
            DType::Object => return None,
            DType::Other(_) => return Some(0),
        };
        // A zero in the shape must not hide what the other numbers would multiply to.
        self.shape.iter().try_fold(size as u64, |product, &n| product.checked_mul(n.max(1)))?;
        usize::try_from(self.shape.iter().product::<u64>() * size as u64).ok()
    }

    pub fn describe(&self) -> String {
        let shape: Vec<String> = self.shape.iter().map(u64::to_string).collect();
        let dtype = match &self.dtype {
            DType::Plain(scalar, _) => format!("{scalar:?}"),
            DType::Record(_) => "records".into(),
            DType::Object => "objects".into(),
            DType::Other(name) => name.clone(),
        };
        format!("array of {dtype} with shape ({})", shape.join(", "))
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Text(String),
    Word(String),
    Mark(char),
}

fn tokens(text: &str) -> Result<Vec<Token>, String> {
    let mut tokens = Vec::new();
    let mut rest = text.trim_matches(|c: char| c.is_whitespace() || c == '\0');
    while let Some(first) = rest.chars().next() {
        match first {
            '\'' | '"' => {
                let (content, after) =
                    rest[1..].split_once(first).ok_or("header has a string without end")?;
                tokens.push(Token::Text(content.to_owned()));
                rest = after;
            }
            '{' | '}' | '(' | ')' | '[' | ']' | ',' | ':' => {
                tokens.push(Token::Mark(first));
                rest = &rest[1..];
            }
            c if c.is_whitespace() => rest = rest.trim_start(),
            _ => {
                let end =
                    rest.find(|c: char| !c.is_alphanumeric() && c != '_' && c != '-').unwrap_or(rest.len());
                if end == 0 {
                    return Err(format!("header has a stray {}", quote(&first.to_string())));
                }
                tokens.push(Token::Word(rest[..end].to_owned()));
                rest = &rest[end..];
            }
        }
    }
    Ok(tokens)
}

struct Tokens(std::iter::Peekable<std::vec::IntoIter<Token>>);

impl Tokens {
    fn mark(&mut self, mark: char) -> bool {
        self.0.next_if(|token| *token == Token::Mark(mark)).is_some()
    }

    fn expect(&mut self, mark: char) -> Result<(), String> {
        if self.mark(mark) { Ok(()) } else { Err(format!("header has no `{mark}` where one is expected")) }
    }

    fn text(&mut self) -> Result<String, String> {
        match self.0.next() {
            Some(Token::Text(text)) => Ok(text),
            _ => Err("header has no string where one is expected".into()),
        }
    }

    /// `(2, 3)`, or a number alone.
    fn shape(&mut self) -> Result<Vec<u64>, String> {
        let tuple = self.mark('(');
        let mut shape = Vec::new();
        while let Some(Token::Word(word)) = self.0.next_if(|token| matches!(token, Token::Word(_))) {
            // Python 2 wrote `3L`.
            let digits = word.trim_end_matches('L');
            shape.push(digits.parse().map_err(|_| format!("header has a shape of {}", quote(&word)))?);
            if !tuple {
                return Ok(shape);
            }
            if !self.mark(',') {
                break;
            }
        }
        self.expect(')')?;
        Ok(shape)
    }

    fn dtype(&mut self) -> Result<DType, String> {
        if !self.mark('[') {
            return Ok(plain(&self.text()?));
        }
        let mut members = Vec::new();
        let mut other = None;
        while self.mark('(') {
            let name = self.text()?;
            self.expect(',')?;
            let dtype = plain(&self.text()?);
            let count = if self.mark(',') && self.0.peek() != Some(&Token::Mark(')')) {
                self.shape()?.iter().try_fold(1u64, |product, &n| product.checked_mul(n))
            } else {
                Some(1)
            };
            let count = count.and_then(|count| usize::try_from(count).ok()).filter(|&count| count > 0);
            let count = count.ok_or_else(|| format!("column {} has no size", quote(&name)))?;
            self.mark(',');
            self.expect(')')?;
            self.mark(',');
            match dtype {
                DType::Plain(scalar, endian) => members.push(Member { name, scalar, endian, count }),
                odd => other = Some(odd),
            }
        }
        self.expect(']')?;
        if members.is_empty() && other.is_none() {
            return Err("header has a record without columns".into());
        }
        Ok(other.unwrap_or(DType::Record(members)))
    }
}

/// A type string such as `<f4`.
fn plain(name: &str) -> DType {
    let (endian, kind) = match name.as_bytes() {
        [b'>', kind @ ..] => (Endian::Big, kind),
        [b'<' | b'|' | b'=', kind @ ..] => (Endian::Little, kind),
        kind => (Endian::Little, kind),
    };
    let scalar = match kind {
        b"f4" => Scalar::F32,
        b"f8" => Scalar::F64,
        b"i1" => Scalar::I8,
        b"i2" => Scalar::I16,
        b"i4" => Scalar::I32,
        b"i8" => Scalar::I64,
        b"u1" | b"b1" => Scalar::U8,
        b"u2" => Scalar::U16,
        b"u4" => Scalar::U32,
        b"u8" => Scalar::U64,
        [b'O', ..] => return DType::Object,
        _ => return DType::Other(quote(name)),
    };
    DType::Plain(scalar, endian)
}

fn dictionary(text: &str) -> Result<Header, String> {
    let mut tokens = Tokens(tokens(text)?.into_iter().peekable());
    let (mut dtype, mut fortran, mut shape) = (None, None, None);
    tokens.expect('{')?;
    while !tokens.mark('}') {
        let key = tokens.text()?;
        tokens.expect(':')?;
        match key.as_str() {
            "descr" => dtype = Some(tokens.dtype()?),
            "shape" => shape = Some(tokens.shape()?),
            "fortran_order" => {
                fortran = match tokens.0.next() {
                    Some(Token::Word(word)) if word == "True" => Some(true),
                    Some(Token::Word(word)) if word == "False" => Some(false),
                    _ => return Err("header has a fortran_order that is neither True nor False".into()),
                }
            }
            _ => return Err(format!("header has an unknown key {}", quote(&key))),
        }
        tokens.mark(',');
    }
    match (dtype, fortran, shape) {
        (Some(dtype), Some(fortran), Some(shape)) => Ok(Header { dtype, fortran, shape }),
        _ => Err("header lacks one of descr, fortran_order and shape".into()),
    }
}
