//! OpenEXR, block of rows after block of rows.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

use exr::block::writer::ChunksWriter;
use exr::block::{BlockIndex, UncompressedBlock, chunk::Chunk};
use exr::error::Error;
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, ChannelDescription, LineOrder, SampleType, Text};
use exr::meta::{BlockDescription, Headers, MetaData, header::Header as ExrHeader};
use rayon::prelude::*;

use super::{Header, ROWS, Refused, Rows, Sink};

/// Blocks that are compressed at a time, and held until they are written.
const BLOCKS: usize = 64;

/// Name of the attribute with the record.
const KEY: &str = "sphcast";

/// Channels of the colour in the order of the file, and their places in a pixel.
const COLOUR: [(&str, usize); 4] = [("A", 3), ("B", 2), ("G", 1), ("R", 0)];

/// Writes the rows that `produce` gives; it returns whether it gave all of them.
pub fn write(
    file: &mut File,
    header: &Header,
    produce: impl FnOnce(&mut Sink) -> bool,
) -> anyhow::Result<()> {
    let headers: Headers = std::iter::once(described(header)).collect();
    let mut failure = None;
    let mut whole = false;
    let finished = exr::block::write(BufWriter::new(file), headers, true, |meta, writer| {
        let mut first_row = 0;
        whole = produce(&mut |rows: Rows| {
            let size = header.width as usize * ROWS as usize * BLOCKS;
            for start in (0..rows.pixels.len()).step_by(size) {
                let part = rows.part(start..rows.pixels.len().min(start + size));
                let write = |chunks: Vec<(usize, Chunk)>| {
                    chunks.into_iter().try_for_each(|(index, chunk)| writer.write_chunk(index, chunk))
                };
                compressed(&meta, header, first_row, &part).and_then(write).map_err(|error| {
                    failure = Some(error);
                    Refused
                })?;
                first_row += part.pixels.len() / header.width as usize;
            }
            Ok(())
        });
        whole &= first_row == header.height as usize;
        // To complete a file without all blocks would be a mistake of the program.
        if whole { Ok(()) } else { Err(Error::Aborted) }
    });
    match failure {
        Some(Error::Io(error)) => Err(error.into()),
        Some(error) => Err(error.into()),
        None if !whole => Err(Refused.into()),
        None => Ok(finished?),
    }
}

fn described(header: &Header) -> ExrHeader {
    let names = COLOUR.iter().map(|(name, _)| *name).chain(header.channels.iter().copied());
    let channels = names.map(|name| ChannelDescription::named(name, SampleType::F32)).collect();
    let size = (header.width as usize, header.height as usize);
    let mut described = ExrHeader::new(Text::from("sphcast"), size, channels).with_encoding(
        exr::compression::Compression::ZIP16,
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    );
    // A file of one layer has no name for it, and programs show none.
    described.own_attributes.layer_name = None;
    if let Some(text) = header.record.as_ref().and_then(Text::new_or_none) {
        described.own_attributes.other.insert(Text::from(KEY), AttributeValue::Text(text));
    }
    described
}

/// The blocks of `rows`, of which the first is row `first_row` of the picture, with their numbers.
fn compressed(
    meta: &MetaData,
    header: &Header,
    first_row: usize,
    rows: &Rows,
) -> exr::error::Result<Vec<(usize, Chunk)>> {
    let width = header.width as usize;
    let block = ROWS as usize;
    let height = rows.pixels.len() / width;
    let blocks = (0..height).into_par_iter().step_by(block).map(|top| {
        let lines = top..height.min(top + block);
        let index = BlockIndex {
            layer: 0,
            pixel_position: Vec2(0, first_row + top),
            pixel_size: Vec2(width, lines.len()),
            level: Vec2(0, 0),
        };
        let mut data = Vec::with_capacity(lines.len() * width * 4 * (COLOUR.len() + rows.channels.len()));
        for line in lines {
            let line = line * width..(line + 1) * width;
            for (_, place) in COLOUR {
                data.extend(rows.pixels[line.clone()].iter().flat_map(|pixel| pixel[place].to_ne_bytes()));
            }
            for channel in &rows.channels {
                data.extend(channel[line.clone()].iter().flat_map(|value| value.to_ne_bytes()));
            }
        }
        let chunk = UncompressedBlock { index, data }.compress_to_chunk(&meta.headers)?;
        Ok(((first_row + top) / block, chunk))
    });
    blocks.collect()
}

pub fn record(path: &Path) -> Option<String> {
    let file = std::io::BufReader::new(File::open(path).ok()?);
    let meta = exr::block::read(file, false).ok()?.meta_data().clone();
    match meta.headers.first()?.own_attributes.other.get(&Text::from(KEY))? {
        AttributeValue::Text(text) => Some(text.to_string()),
        _ => None,
    }
}
