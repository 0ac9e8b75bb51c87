//! Pictures in files: PNG for the eye, EXR for measuring. Written whole or not at all.

mod exr;
mod png;

use std::io::Cursor;
use std::path::Path;

use crate::io_error::describe;
use crate::whole_file::write_file;
use anyhow::{Context, anyhow, bail};
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};

/// Premultiplied linear RGBA, row 0 on top.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    pub width: u32,
    pub height: u32,
    /// width·height pixels, row after row.
    pub data: Vec<[f32; 4]>,
}

/// The formats that pictures are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// sRGB, 8 bits a channel, straight alpha.
    Png,
    /// 32-bit floats, linear, premultiplied.
    Exr,
}

impl Format {
    /// How names of such files end.
    pub fn ending(self) -> &'static str {
        match self {
            Format::Png => ".png",
            Format::Exr => ".exr",
        }
    }

    /// The format that a file name ends in, in any case; `None` for other endings.
    pub fn of(path: &Path) -> Option<Format> {
        match path.extension()?.to_str()?.to_lowercase().as_str() {
            "png" => Some(Format::Png),
            "exr" => Some(Format::Exr),
            _ => None,
        }
    }
}

/// What a picture file is told before its rows.
#[derive(Clone, Debug, Default)]
pub struct Header<'a> {
    pub width: u32,
    pub height: u32,
    /// Linear: a PNG shows the picture over it, opaque, an EXR never does.
    pub background: Option<[f32; 3]>,
    /// ASCII that [`record`] finds again.
    pub record: Option<String>,
    /// Names of what an EXR holds for each pixel beside its colour, in ascending order, after `R`.
    pub channels: &'a [&'a str],
}

/// Whole rows of a picture, from the top: [`ROWS`] or a multiple of them, or all that are left.
pub struct Rows<'a> {
    pub pixels: &'a [[f32; 4]],
    /// As the header names them; a value a pixel.
    pub channels: Vec<&'a [f32]>,
}

impl<'a> Rows<'a> {
    /// The pixels in a range, with their channels.
    fn part(&self, range: std::ops::Range<usize>) -> Rows<'a> {
        let channels = self.channels.iter().map(|channel| &channel[range.clone()]).collect();
        Rows { pixels: &self.pixels[range], channels }
    }
}

/// Rows that come together.
pub const ROWS: u32 = 16;

/// Bytes of pixels that a byte of a file can stand for: deflate reaches 1032, and an EXR of half floats is
/// taken for one of twice their size.
const DENSEST: f64 = 2100.0;

/// Takes rows on their way to a file.
pub type Sink<'a> = dyn FnMut(Rows) -> anyhow::Result<()> + 'a;

/// Writes a picture in the format that the name of `path` ends in. A PNG shows it over `background`
/// (linear), opaque, where there is one; an EXR never does.
///
/// # Errors
/// Another ending, a picture without pixels, or whatever the system has against the file; the path
/// comes first.
pub fn write(path: &Path, pixels: &Pixels, background: Option<[f32; 3]>) -> anyhow::Result<()> {
    let header = Header { width: pixels.width, height: pixels.height, background, ..Header::default() };
    write_rows(path, &header, |sink| sink(Rows { pixels: &pixels.data, channels: Vec::new() }))
}

/// Writes the rows that `produce` makes, in the format that the name of `path` ends in: never more of
/// them are held than `produce` gives at once.
///
/// # Errors
/// Those of `produce`, as they are; and those of [`write`].
pub fn write_rows<T>(
    path: &Path,
    header: &Header,
    produce: impl FnOnce(&mut Sink) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    let Some(format) = Format::of(path) else {
        bail!("{}: a picture's name ends in .png or .exr", path.display());
    };
    // An encoder's own errors are those of the file; those of the producer are about something else.
    let mut made = None;
    let written = write_file(path, |file| {
        let produce = |sink: &mut Sink| {
            let result = produce(sink);
            let ok = result.is_ok();
            made = Some(result);
            ok
        };
        match format {
            Format::Png => png::write(file, header, produce),
            Format::Exr => exr::write(file, header, produce),
        }
    });
    match (written, made) {
        (Ok(()), Some(result)) => result,
        (Err(_), Some(Err(error))) if !error.is::<Refused>() => Err(error),
        (Err(error), _) => Err(error),
        (Ok(()), None) => bail!("{}: the picture is not whole", path.display()),
    }
}

/// The error by which a producer learns that the file takes no more rows.
#[derive(Debug, thiserror::Error)]
#[error("the file takes no more rows")]
struct Refused;

/// What [`Header::record`] of the picture said; `None` for a picture without, or one that is not whole.
pub fn record(path: &Path) -> Option<String> {
    match Format::of(path)? {
        Format::Png => png::record(path),
        Format::Exr => exr::record(path),
    }
}

/// Reads a picture back: an EXR as it is (opaque where it has no alpha), a PNG to premultiplied
/// linear light.
///
/// # Errors
/// A file that cannot be read, or is neither; the path comes first.
pub fn read(path: &Path) -> anyhow::Result<Pixels> {
    let name = || path.display().to_string();
    let bytes = std::fs::read(path).map_err(|error| anyhow!(describe(&error))).with_context(name)?;
    let size = bytes.len();
    // The content tells the format, whatever the name says.
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().with_context(name)?;
    // Pictures may be larger than what the library takes for one.
    reader.no_limits();
    let linear = match reader.format() {
        Some(ImageFormat::OpenExr) => true,
        Some(ImageFormat::Png) => false,
        _ => bail!("{}: is neither a PNG nor an EXR picture", path.display()),
    };
    let decoder = reader.into_decoder().with_context(name)?;
    let (width, height) = decoder.dimensions();
    let bits = f64::from(decoder.original_color_type().bits_per_pixel());
    if f64::from(width) * f64::from(height) * bits / 8.0 > DENSEST * size as f64 {
        bail!("{}: claims {width} × {height} pixels in {size} bytes", path.display());
    }
    let image = DynamicImage::from_decoder(decoder).with_context(name)?.into_rgba32f();
    let straight = |[r, g, b, a]: [f32; 4]| {
        let [r, g, b] = [r, g, b].map(|c| to_linear(c) * a);
        [r, g, b, a]
    };
    let data = image.pixels().map(|pixel| if linear { pixel.0 } else { straight(pixel.0) }).collect();
    Ok(Pixels { width, height, data })
}

/// One pixel of a PNG: over the background and opaque, or with straight alpha.
pub fn to_srgb8([r, g, b, a]: [f32; 4], background: Option<[f32; 3]>) -> [u8; 4] {
    let a = a.clamp(0.0, 1.0);
    let (rgb, alpha) = match background {
        Some(behind) => (std::array::from_fn(|i| [r, g, b][i] + (1.0 - a) * behind[i]), 1.0),
        None if a > 0.0 => ([r, g, b].map(|c| c / a), a),
        None => ([0.0; 3], 0.0),
    };
    let byte = |c: f32| (c.clamp(0.0, 1.0) * 255.0).round() as u8;
    let [r, g, b] = rgb.map(|c: f32| byte(to_srgb(c)));
    [r, g, b, byte(alpha)]
}

/// The transfer curve of IEC 61966-2-1.
pub fn to_srgb(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// From a channel of sRGB to linear light.
pub fn to_linear(srgb: f32) -> f32 {
    if srgb <= 0.040_45 { srgb / 12.92 } else { ((srgb + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient() -> Pixels {
        let pixel = |i: u32| {
            let a = i as f32 / 63.0;
            [0.9 * a, 0.5 * a * a, 0.1 * a, a]
        };
        Pixels { width: 8, height: 8, data: (0..64).map(pixel).collect() }
    }

    fn largest_difference(a: &Pixels, b: &Pixels) -> f32 {
        let pairs = a.data.as_flattened().iter().zip(b.data.as_flattened());
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    }

    #[test]
    fn a_picture_that_claims_more_than_its_file_can_hold_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write(&path, &gradient(), None).unwrap();
        let mut bytes = std::fs::read(&path).unwrap();
        // Width and height, and the checksum of the first chunk.
        bytes[16..20].copy_from_slice(&60_000_u32.to_be_bytes());
        bytes[20..24].copy_from_slice(&60_000_u32.to_be_bytes());
        let checksum = crc32(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&checksum.to_be_bytes());
        std::fs::write(&path, &bytes).unwrap();
        let told = format!("{:#}", read(&path).unwrap_err());
        let expected = format!("a.png: claims 60000 × 60000 pixels in {} bytes", bytes.len());
        assert!(told.ends_with(&expected), "{told}");
        // The densest there is: one colour over and over.
        let even = Pixels { width: 3000, height: 3000, data: vec![[0.0; 4]; 9_000_000] };
        for name in ["even.png", "even.exr"] {
            write(&folder.path().join(name), &even, None).unwrap();
            assert_eq!(read(&folder.path().join(name)).unwrap(), even);
        }
    }

    /// The checksum of PNG.
    fn crc32(bytes: &[u8]) -> u32 {
        let step = |crc: u32, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 };
        !bytes.iter().fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
    }

    #[test]
    fn exr_keeps_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let mut pixels = gradient();
        pixels.data[5] = [1e-30, 1.5, 3.0e5, 0.25];
        write(&path, &pixels, Some([1.0; 3])).unwrap();
        assert_eq!(read(&path).unwrap(), pixels);
    }

    #[test]
    fn png_keeps_what_eight_bits_can() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.PNG");
        write(&path, &gradient(), None).unwrap();
        let back = read(&path).unwrap();
        assert!(largest_difference(&back, &gradient()) < 0.01);
        assert!(largest_difference(&back, &gradient()) > 0.0);
    }

    #[test]
    fn a_background_makes_it_opaque() {
        assert_eq!(to_srgb8([0.0; 4], Some([1.0, 0.0, 0.214_041_14])), [255, 0, 128, 255]);
        assert_eq!(to_srgb8([0.0; 4], None), [0; 4]);
        assert_eq!(to_srgb8([0.25, 0.0, 0.0, 0.25], None), [255, 0, 0, 64]);
        assert_eq!(to_srgb8([f32::NAN, 2.0, -1.0, 1.0], None), [0, 255, 0, 255]);
    }

    /// A picture of 40 rows with a channel, written 16 rows at a time.
    fn in_parts(path: &Path, whole: &Pixels, channel: &[f32]) -> anyhow::Result<()> {
        let channels: &[&str] =
            if Format::of(path) == Some(Format::Exr) { &["predicted_error"] } else { &[] };
        let Pixels { width, height, data } = whole;
        let record = Some("made from {}".to_owned());
        let header = Header { width: *width, height: *height, background: None, record, channels };
        write_rows(path, &header, |sink| {
            let step = (width * ROWS) as usize;
            for start in (0..data.len()).step_by(step) {
                let range = start..data.len().min(start + step);
                let channels = channels.iter().map(|_| &channel[range.clone()]).collect();
                sink(Rows { pixels: &data[range.clone()], channels })?;
            }
            Ok(())
        })
    }

    #[test]
    fn rows_that_come_in_parts_are_the_picture() {
        let folder = tempfile::tempdir().unwrap();
        let pixel = |i: u32| [i as f32 / 2000.0, 0.25, 0.0, 0.5 + i as f32 / 2000.0];
        let whole = Pixels { width: 21, height: 40, data: (0..21 * 40).map(pixel).collect() };
        let charges: Vec<f32> = (0..21 * 40).map(|i| i as f32).collect();
        for name in ["parts.png", "parts.exr"] {
            let [parts, once] = [name, &format!("once-{name}")].map(|name| folder.path().join(name));
            in_parts(&parts, &whole, &charges).unwrap();
            write(&once, &whole, None).unwrap();
            assert_eq!(read(&parts).unwrap(), read(&once).unwrap());
            assert_eq!(record(&parts).as_deref(), Some("made from {}"));
            assert_eq!(record(&once), None);
        }
        use ::exr::prelude::{ReadChannels, ReadLayers};
        let layer = ::exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer();
        let image = layer.all_attributes().from_file(folder.path().join("parts.exr")).unwrap();
        let list = &image.layer_data.channel_data.list;
        let names: Vec<String> = list.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(names, ["A", "B", "G", "R", "predicted_error"]);
        assert!(list[4].sample_data.values_as_f32().eq(charges));
    }

    #[test]
    fn a_picture_without_its_last_rows_is_no_file() {
        let folder = tempfile::tempdir().unwrap();
        let first = [[0.5; 4]; 8 * ROWS as usize];
        for name in ["a.png", "a.exr", "b.exr"] {
            let header = Header { width: 8, height: 40, ..Header::default() };
            let cut = write_rows(&folder.path().join(name), &header, |sink| {
                sink(Rows { pixels: &first, channels: Vec::new() })?;
                if name == "b.exr" { bail!("no more") } else { Ok(()) }
            });
            let told = format!("{:#}", cut.unwrap_err());
            assert_eq!(told == "no more", name == "b.exr", "{told}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn errors_name_the_file_and_leave_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let wrong = write(&folder.path().join("a.jpg"), &gradient(), None).unwrap_err();
        assert!(format!("{wrong:#}").contains("a.jpg: a picture's name ends in"));
        let missing = write(&folder.path().join("no/a.png"), &gradient(), None).unwrap_err();
        assert!(format!("{missing:#}").contains("a.png: cannot be written"));
        let target = folder.path().join("b.png");
        std::fs::create_dir(&target).unwrap();
        assert!(write(&target, &gradient(), None).is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        std::fs::write(folder.path().join("c.png"), "no picture").unwrap();
        assert!(read(&folder.path().join("c.png")).is_err());
    }
}
