//! VTK XML files of particles: `.vtu` and `.vtp`, with arrays as text, base64 or appended bytes,
//! compressed or not.

mod arrays;
mod blocks;
mod document;
mod encoded;
mod pieces;

use std::cell::Cell;

use roxmltree::Node;

use crate::frames::{Frame, Metadata};

use super::error::{Fault, Place};
use super::vtk_numbers::Order;
pub(super) use document::tree;

use arrays::{Appended, Array, Store};
use blocks::{Compressor, Layout};

/// Reads a `.vtu` or `.vtp` file.
pub fn parse(bytes: &[u8]) -> Result<Frame, Fault> {
    if !bytes.trim_ascii_start().starts_with(b"<") && !bytes.starts_with(b"\xef\xbb\xbf") {
        return Err(Fault::at("expected a VTK XML file, found no `<` at its start", Place::Byte(0)));
    }
    let parts = document::split(bytes)?;
    let document = tree(&parts.xml)?;
    let root = document.root_element();
    let data = data_set(root)?;
    let store = Store {
        layout: layout(root)?,
        appended: parts.appended.map(|data| appended(root, data)).transpose()?,
        allowance: Cell::new(allowance(bytes.len())),
    };
    let metadata = Metadata { time: time(data, &store)?, ..Metadata::default() };
    let points = pieces::read(data, &store)?;
    let mut frame = Frame::new(points.positions, points.fields, metadata)
        .map_err(|error| Fault::at(error.to_string(), Place::Part("PointData".into())))?;
    if !points.cell_arrays.is_empty() {
        let names = points.cell_arrays.join(", ");
        frame.warnings.push(format!("arrays over cells left out, particles are points: {names}"));
    }
    if !points.text_arrays.is_empty() {
        frame.warnings.push(format!("arrays of strings left out: {}", points.text_arrays.join(", ")));
    }
    Ok(frame)
}

/// Bytes that all arrays of a file of this size may take in memory. Real runs take a few times
/// their size; 256 MiB more let small files of constant arrays through.
fn allowance(file: usize) -> usize {
    file.saturating_mul(64).saturating_add(256 << 20)
}

/// The element of the data set, where it is one of particles.
fn data_set<'a, 'i>(root: Node<'a, 'i>) -> Result<Node<'a, 'i>, Fault> {
    let place = || Place::Part("VTKFile type".into());
    let kind = root.attribute("type").unwrap_or("none");
    match kind {
        "UnstructuredGrid" | "PolyData" => {
            root.children().find(|node| node.has_tag_name(kind)).ok_or_else(|| {
                Fault::at(format!("expected an element `{kind}`, found none"), Place::Part("VTKFile".into()))
            })
        }
        "Collection" => Err(Fault::at(
            "expected UnstructuredGrid or PolyData, found a Collection (a .pvd file?)",
            place(),
        )),
        _ => {
            let shown = kind.escape_debug();
            let why = match kind {
                "PUnstructuredGrid" | "PPolyData" => ": it only names other files, open those",
                "ImageData" | "RectilinearGrid" | "StructuredGrid" => ": a grid, not particles",
                _ => "",
            };
            Err(Fault::at(format!("expected UnstructuredGrid or PolyData, found `{shown}`{why}"), place()))
        }
    }
}

fn layout(root: Node<'_, '_>) -> Result<Layout, Fault> {
    let unknown = |attribute: &str, expected: &str, found: &str| {
        let what = format!("expected {expected}, found `{}`", found.escape_debug());
        Err(Fault::at(what, Place::Part(format!("VTKFile {attribute}"))))
    };
    let word = match root.attribute("header_type") {
        None | Some("UInt32") => 4,
        Some("UInt64") => 8,
        Some(other) => return unknown("header_type", "UInt32 or UInt64", other),
    };
    let order = match root.attribute("byte_order") {
        None | Some("LittleEndian") => Order::Little,
        Some("BigEndian") => Order::Big,
        Some(other) => return unknown("byte_order", "LittleEndian or BigEndian", other),
    };
    let compressor = match root.attribute("compressor") {
        None | Some("") => None,
        Some("vtkZLibDataCompressor") => Some(Compressor::Zlib),
        Some("vtkLZ4DataCompressor") => Some(Compressor::Lz4),
        Some(other) => {
            return unknown("compressor", "vtkZLibDataCompressor, vtkLZ4DataCompressor or none", other);
        }
    };
    Ok(Layout { word, order, compressor })
}

fn appended<'a>(root: Node<'_, '_>, data: &'a [u8]) -> Result<Appended<'a>, Fault> {
    let element = root.children().find(|node| node.has_tag_name("AppendedData"));
    match element.and_then(|element| element.attribute("encoding")) {
        Some("raw") => Ok(Appended { data, base64: false }),
        Some("base64") => Ok(Appended { data, base64: true }),
        other => {
            let what = format!("expected raw or base64, found `{}`", other.unwrap_or("none").escape_debug());
            Err(Fault::at(what, Place::Part("AppendedData encoding".into())))
        }
    }
}

/// The time in the data set's `<FieldData>`.
fn time(data: Node<'_, '_>, store: &Store<'_>) -> Result<Option<f64>, Fault> {
    let array = data
        .children()
        .filter(|node| node.has_tag_name("FieldData"))
        .flat_map(|field| field.children())
        .filter(|node| node.has_tag_name("DataArray"))
        .map(|node| Array::new(node, "FieldData"))
        .find(|array| {
            array.name.eq_ignore_ascii_case("TimeValue") || array.name.eq_ignore_ascii_case("TIME")
        });
    match array {
        Some(array) => Ok(Some(array.column(store, 1)?.get(0, 0))),
        None => Ok(None),
    }
}

#[cfg(test)]
mod tests;
