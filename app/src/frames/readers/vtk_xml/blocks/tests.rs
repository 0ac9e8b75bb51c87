use std::io::Write;

use base64::Engine;
use base64::prelude::BASE64_STANDARD as BASE64;

use super::*;

const DATA: &[u8] = b"0123456789abcdefghijklmnopqrstuvwxyz";

fn decode(encoded: Encoded<'_>, layout: Layout, expected: usize) -> Result<Vec<u8>, String> {
    open(encoded, layout, expected)?.bytes().map(Cow::into_owned)
}

fn layout(word: usize, compressor: Option<Compressor>) -> Layout {
    Layout { word, order: Order::Little, compressor }
}

fn header(word: usize, numbers: &[u64]) -> Vec<u8> {
    numbers.iter().flat_map(|n| n.to_le_bytes()[..word].to_vec()).collect()
}

fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Header and body of `DATA` in blocks of `size`.
fn packed(word: usize, size: usize, compressor: Compressor) -> (Vec<u8>, Vec<u8>) {
    let blocks: Vec<Vec<u8>> = DATA
        .chunks(size)
        .map(|block| match compressor {
            Compressor::Zlib => zlib(block),
            Compressor::Lz4 => lz4_flex::block::compress(block),
        })
        .collect();
    let mut numbers = vec![blocks.len() as u64, size as u64, (DATA.len() % size) as u64];
    numbers.extend(blocks.iter().map(|block| block.len() as u64));
    (header(word, &numbers), blocks.concat())
}

#[test]
fn uncompressed_layouts_hold_the_same_bytes() {
    for word in [4, 8] {
        let head = header(word, &[DATA.len() as u64]);
        let raw = [head.as_slice(), DATA, b"more"].concat();
        assert_eq!(decode(Encoded::Raw(&raw), layout(word, None), DATA.len()).unwrap(), DATA);
        let whole = BASE64.encode([head.as_slice(), DATA].concat());
        let apart = BASE64.encode(&head) + &BASE64.encode(DATA);
        for text in [whole, apart] {
            let decoded = decode(Encoded::Base64(text.as_bytes()), layout(word, None), DATA.len());
            assert_eq!(decoded.unwrap(), DATA, "{text}");
        }
    }
}

#[test]
fn compressed_layouts_hold_the_same_bytes_and_no_cut_goes_unseen() {
    let all = [4, 8].into_iter().flat_map(|word| [7, 9, 36].map(|size| (word, size)));
    for (word, size) in all {
        for compressor in [Compressor::Zlib, Compressor::Lz4] {
            let (head, body) = packed(word, size, compressor);
            let layout = layout(word, Some(compressor));
            let raw = [head.as_slice(), &body].concat();
            assert_eq!(decode(Encoded::Raw(&raw), layout, DATA.len()).unwrap(), DATA);
            let text = BASE64.encode(&head) + &BASE64.encode(&body);
            assert_eq!(decode(Encoded::Base64(text.as_bytes()), layout, DATA.len()).unwrap(), DATA);
            for cut in 0..raw.len() {
                assert!(decode(Encoded::Raw(&raw[..cut]), layout, DATA.len()).is_err(), "{cut}");
            }
        }
    }
}

#[test]
fn headers_that_lie_are_faults() {
    let huge = u64::from(u32::MAX);
    let zlib = layout(4, Some(Compressor::Zlib));
    for numbers in [
        &[huge, 36, 0, 10][..],
        &[1, huge, huge, 10],
        &[1, 0, 36, 10],
        &[1, 7, 36, 10],
        &[2, 36, 0, 10, 10],
        &[1, 36, 0, huge],
        &[0, 36, 0],
    ] {
        let mut bytes = header(4, numbers);
        bytes.extend([0; 64]);
        assert!(decode(Encoded::Raw(&bytes), zlib, 36).is_err(), "{numbers:?}");
    }
    let full = header(8, &[u64::MAX; 10]);
    assert!(decode(Encoded::Raw(&full), layout(8, Some(Compressor::Zlib)), 36).is_err());
    assert!(decode(Encoded::Raw(&full), layout(8, None), 36).is_err());
    let why = decode(Encoded::Raw(&header(8, &[1 << 40])), layout(8, None), 1 << 40).unwrap_err();
    assert!(why.contains("truncated"), "{why}");
}

#[test]
fn a_bomb_is_refused_before_it_is_given_room() {
    let bytes = [header(8, &[1, 1 << 40, 0, 10]), vec![0; 10]].concat();
    let why = open(Encoded::Raw(&bytes), layout(8, Some(Compressor::Zlib)), 1 << 40).unwrap_err();
    assert!(why.contains("cannot hold"), "{why}");
}

#[test]
fn damaged_blocks_are_faults() {
    for compressor in [Compressor::Zlib, Compressor::Lz4] {
        let (head, mut body) = packed(4, 9, compressor);
        body[..4].fill(0xff);
        let raw = [head, body].concat();
        let why = decode(Encoded::Raw(&raw), layout(4, Some(compressor)), DATA.len()).unwrap_err();
        assert!(why.contains("block 0 is damaged"), "{why}");
    }
    assert!(decode(Encoded::Base64(b"AAAA*AAA"), layout(4, None), 0).is_err());
}
