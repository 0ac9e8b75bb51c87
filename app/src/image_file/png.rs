//! PNG, row after row.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::path::Path;

use rayon::prelude::*;

use super::{Header, Refused, Rows, Sink, to_srgb8};

/// Key of the text chunk with the record.
const KEY: &str = "sphcast";

/// Bytes that are compressed at a time.
const CHUNK: usize = 1 << 20;

/// What a whole PNG ends with: an empty chunk of that name, and its checksum.
const END: [u8; 12] = *b"\0\0\0\0IEND\xaeB`\x82";

/// Writes the rows that `produce` gives; it returns whether it gave all of them.
pub fn write(
    file: &mut File,
    header: &Header,
    produce: impl FnOnce(&mut Sink) -> bool,
) -> anyhow::Result<()> {
    let mut encoder = png::Encoder::new(BufWriter::new(file), header.width, header.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    if let Some(record) = &header.record {
        encoder.add_itxt_chunk(KEY.to_owned(), record.clone())?;
    }
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer_with_size(CHUNK)?;
    let mut failure = None;
    let whole = produce(&mut |rows: Rows| {
        let bytes: Vec<[u8; 4]> =
            rows.pixels.par_iter().map(|&pixel| to_srgb8(pixel, header.background)).collect();
        stream.write_all(bytes.as_flattened()).map_err(|error| {
            failure = Some(error);
            Refused.into()
        })
    });
    match failure {
        Some(error) => Err(error.into()),
        // A picture that is cut short is of no use: how it ends does not matter.
        None if !whole => Err(Refused.into()),
        None => {
            stream.finish()?;
            Ok(writer.finish()?)
        }
    }
}

pub fn record(path: &Path) -> Option<String> {
    let mut file = File::open(path).ok()?;
    let mut end = [0; END.len()];
    file.seek(SeekFrom::End(-(END.len() as i64))).ok()?;
    file.read_exact(&mut end).ok()?;
    file.rewind().ok()?;
    let reader = png::Decoder::new(BufReader::new(file)).read_info().ok().filter(|_| end == END)?;
    let text = reader.info().utf8_text.iter().find(|text| text.keyword == KEY)?;
    text.get_text().ok()
}
