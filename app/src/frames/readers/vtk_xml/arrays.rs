//! A `<DataArray>` element: its attributes, and its numbers wherever they are written.

use std::borrow::Cow;
use std::cell::Cell;

use roxmltree::Node;

use crate::frames::readers::error::{Fault, Place};
use crate::frames::readers::vtk_numbers::{Kind, TextFault, Words, read_text};
use crate::frames::{Column, Numbers};

use super::blocks::{self, Layout};
use super::encoded::Encoded;

/// What the arrays of a file share.
pub(super) struct Store<'a> {
    pub layout: Layout,
    pub appended: Option<Appended<'a>>,
    /// Bytes that arrays may still take in memory: arrays may share appended data, and compressed
    /// data may grow a thousandfold, so the file's size alone bounds nothing.
    pub allowance: Cell<usize>,
}

impl Store<'_> {
    /// Takes note that a column is about to be dropped.
    pub fn give_back(&self, column: &Column) {
        self.allowance.set(self.allowance.get().saturating_add(column.bytes()));
    }
}

/// The content of `<AppendedData>` after its `_`.
pub(super) struct Appended<'a> {
    pub data: &'a [u8],
    pub base64: bool,
}

/// An array element and how errors name it.
pub(super) struct Array<'a, 'i> {
    node: Node<'a, 'i>,
    pub name: &'a str,
    part: String,
}

impl<'a, 'i> Array<'a, 'i> {
    /// The `<DataArray>` that `node` is, in the section `part` of the file.
    pub fn new(node: Node<'a, 'i>, part: &str) -> Self {
        let name = node.attribute("Name").unwrap_or("unnamed");
        Array { node, name, part: format!("{part} array `{}`", name.escape_debug()) }
    }

    pub fn fault(&self, what: impl Into<String>) -> Fault {
        Fault::at(what, Place::Part(self.part.clone()))
    }

    pub fn is_text(&self) -> bool {
        self.node.attribute("type") == Some("String") || !self.node.has_tag_name("DataArray")
    }

    /// The columns of a row; one where the element does not say.
    pub fn components(&self) -> Result<usize, Fault> {
        match self.node.attribute("NumberOfComponents") {
            None => Ok(1),
            Some(text) => text.trim().parse().ok().filter(|&n| n > 0).ok_or_else(|| {
                self.fault(format!(
                    "expected NumberOfComponents of 1 or more, found `{}`",
                    text.escape_debug()
                ))
            }),
        }
    }

    /// The array as a table of `rows` rows.
    pub fn column(&self, store: &Store<'_>, rows: usize) -> Result<Column, Fault> {
        let components = self.components()?;
        let kind = self.kind()?;
        let more = || self.fault(format!("{rows} rows of {components} values are more than any file holds"));
        let count = rows.checked_mul(components).ok_or_else(more)?;
        let bytes = kind.bytes_for(count).ok_or_else(more)?;
        let size = format!("{rows} rows x {components} {kind:?}");
        let numbers = match self.node.attribute("format") {
            Some("ascii") => {
                let text = self.text();
                self.reserve(store, kind, count.min(text.len() / 2 + 1))?;
                self.text_numbers(&text, kind, count)?
            }
            Some("binary") => {
                let text = without_white_space(self.text());
                let encoded = Encoded::Base64(text.as_bytes());
                self.binary_numbers(store, encoded, kind, count, bytes, &size)?
            }
            Some("appended") => {
                let encoded = self.appended(store)?;
                self.binary_numbers(store, encoded, kind, count, bytes, &size)?
            }
            other => {
                let found = other.unwrap_or("none").escape_debug();
                return Err(self.fault(format!("expected format ascii, binary or appended, found `{found}`")));
            }
        };
        Column::new(components, numbers).ok_or_else(more)
    }

    fn kind(&self) -> Result<Kind, Fault> {
        Ok(match self.node.attribute("type") {
            Some("Bit") => Kind::Bit,
            Some("Int8") => Kind::Int8,
            Some("UInt8") => Kind::UInt8,
            Some("Int16") => Kind::Int16,
            Some("UInt16") => Kind::UInt16,
            Some("Int32") => Kind::Int32,
            Some("UInt32") => Kind::UInt32,
            Some("Int64") => Kind::Int64,
            Some("UInt64") => Kind::UInt64,
            Some("Float32") => Kind::Float32,
            Some("Float64") => Kind::Float64,
            other => {
                let found = other.unwrap_or("none").escape_debug();
                return Err(self.fault(format!("expected a number type such as Float32, found `{found}`")));
            }
        })
    }

    /// The text of the element itself, without that of elements in it.
    fn text(&self) -> Cow<'a, str> {
        let texts = self.node.children().filter(|child| child.is_text()).filter_map(|child| child.text());
        // White space between child elements is text too.
        let texts: Vec<&str> = texts.filter(|text| !text.trim_ascii().is_empty()).collect();
        match texts.as_slice() {
            [one] => Cow::Borrowed(one),
            more => Cow::Owned(more.concat()),
        }
    }

    fn text_numbers(&self, text: &str, kind: Kind, count: usize) -> Result<Numbers, Fault> {
        let mut words = Words { bytes: text.as_bytes(), position: 0 };
        let numbers = read_text(&mut words, kind, count).map_err(|fault| {
            self.fault(match fault {
                TextFault::Ended { after } => format!("expected {count} values, found {after}"),
                TextFault::NotANumber { word, after } => {
                    format!("expected {count} values, found {word} after {after}")
                }
            })
        })?;
        match words.count() {
            0 => Ok(numbers),
            more => Err(self.fault(format!("expected {count} values, found {more} more"))),
        }
    }

    fn appended<'s>(&self, store: &Store<'s>) -> Result<Encoded<'s>, Fault> {
        let appended = store
            .appended
            .as_ref()
            .ok_or_else(|| self.fault("expected an AppendedData element, found none"))?;
        let offset = self.node.attribute("offset");
        let start = offset.and_then(|text| text.trim().parse::<usize>().ok()).ok_or_else(|| {
            self.fault(format!(
                "expected an offset into the appended data, found `{}`",
                offset.unwrap_or("none").escape_debug()
            ))
        })?;
        let bytes = appended.data.get(start..).ok_or_else(|| {
            let length = appended.data.len();
            self.fault(format!(
                "expected an offset inside the {length} bytes of appended data, found {start}"
            ))
        })?;
        Ok(if appended.base64 { Encoded::Base64(bytes.trim_ascii()) } else { Encoded::Raw(bytes) })
    }

    fn binary_numbers(
        &self,
        store: &Store<'_>,
        encoded: Encoded<'_>,
        kind: Kind,
        count: usize,
        bytes: usize,
        size: &str,
    ) -> Result<Numbers, Fault> {
        let fault = |why: String| self.fault(format!("{why} ({size})"));
        let opened = blocks::open(encoded, store.layout, bytes).map_err(fault)?;
        self.reserve(store, kind, count)?;
        let bytes = opened.bytes().map_err(fault)?;
        Ok(kind.decode(&bytes, count, store.layout.order))
    }

    /// Takes what `count` numbers need in memory from the allowance.
    fn reserve(&self, store: &Store<'_>, kind: Kind, count: usize) -> Result<(), Fault> {
        let left = kind.decoded_bytes_for(count).and_then(|bytes| store.allowance.get().checked_sub(bytes));
        match left {
            Some(left) => {
                store.allowance.set(left);
                Ok(())
            }
            None => {
                Err(self.fault(format!("{count} values would take far more memory than the file's size")))
            }
        }
    }
}

fn without_white_space(text: Cow<'_, str>) -> Cow<'_, str> {
    match text {
        Cow::Borrowed(text) if !text.trim_ascii().contains(|c: char| c.is_ascii_whitespace()) => {
            Cow::Borrowed(text.trim_ascii())
        }
        text => Cow::Owned(text.split_ascii_whitespace().collect()),
    }
}
