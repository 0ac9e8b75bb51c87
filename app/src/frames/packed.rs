//! A run in few bytes: positions and one scalar of particles that stay the same from frame to
//! frame, quantised, predicted, and compressed. The embedded demo is such a file.
//!
//! ```text
//! "SPHRUN 1"   8 bytes
//! length       of the header in bytes, u32, little-endian
//! header       JSON, see [`Header`]
//! residuals    zlib: for each frame and channel (x, y, z, scalar) the low bytes, then the high bytes
//! ```
//!
//! A number is `low + step·q` with a q of 16 bits. What is stored is q minus its prediction, modulo
//! 2¹⁶, with the sign in the lowest bit: q of the particle before in frame 0, of the frame before in
//! frame 1, and beyond that the straight continuation of the last two frames.

use std::io::{Read, Write};

use anyhow::{Context, bail, ensure};
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};

use super::{Column, Field, Frame, Metadata};

/// What a packed run says about itself. Lengths in its own unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Header {
    pub particles: usize,
    /// One a frame.
    pub times: Vec<f64>,
    pub support_radius: f64,
    pub particle_radius: f64,
    /// Name of the scalar.
    pub scalar: String,
    /// x, y, z, scalar.
    pub channels: [Quantiser; 4],
}

/// `low + step·q`
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Quantiser {
    pub low: f64,
    pub step: f64,
}

/// A run in memory, quantised: 8 bytes for a particle in a frame.
pub struct PackedRun {
    header: Header,
    /// Numbers of one channel of one frame: channel c of frame t is number 4·t + c.
    planes: Vec<Vec<u16>>,
}

const MAGIC: &[u8; 8] = b"SPHRUN 1";
const CHANNELS: usize = 4;
/// Levels of a coordinate along the longest side of the box: the error is at most a 32,766th of that side.
const POSITION_LEVELS: f64 = 16_383.0;
/// Levels of the scalar: the error is at most an 8190th of its range.
const SCALAR_LEVELS: f64 = 4095.0;

impl PackedRun {
    /// Quantises `frames`, which hold the same particles: rows are put in the order of the field
    /// `id`. `times` has one entry a frame; lengths in the unit of the run.
    ///
    /// # Errors
    /// A frame without `id` or `scalar`, with other particles than the first, or with numbers that are not finite.
    pub fn new(
        frames: &[Frame],
        scalar: &str,
        times: Vec<f64>,
        [support_radius, particle_radius]: [f64; 2],
    ) -> anyhow::Result<PackedRun> {
        ensure!(times.len() == frames.len(), "{} times for {} frames", times.len(), frames.len());
        let rows: Vec<Vec<[f64; CHANNELS]>> =
            frames.iter().map(|frame| ordered(frame, scalar)).collect::<Result<_, _>>()?;
        let particles = rows.first().map_or(0, Vec::len);
        ensure!(rows.iter().all(|rows| rows.len() == particles), "the number of particles changes");
        let channels = quantisers(&rows);
        let plane = |rows: &[[f64; CHANNELS]], c: usize| -> Vec<u16> {
            let Quantiser { low, step } = channels[c];
            rows.iter().map(|row| ((row[c] - low) / step).round() as u16).collect()
        };
        let planes = rows.iter().flat_map(|rows| (0..CHANNELS).map(move |c| plane(rows, c))).collect();
        let scalar = scalar.to_owned();
        let header = Header { particles, times, support_radius, particle_radius, scalar, channels };
        Ok(PackedRun { header, planes })
    }

    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Reads the header of a packed run and nothing else.
    pub fn read_header(bytes: &[u8]) -> anyhow::Result<Header> {
        Ok(split(bytes)?.0)
    }

    /// Unpacks a run.
    pub fn from_bytes(bytes: &[u8]) -> anyhow::Result<PackedRun> {
        let (header, residuals) = split(bytes)?;
        let mut decoder = ZlibDecoder::new(residuals);
        let mut planes: Vec<Vec<u16>> = Vec::new();
        for number in 0..CHANNELS * header.times.len() {
            let mut stored = vec![0; 2 * header.particles];
            decoder.read_exact(&mut stored).with_context(|| format!("frame {}", number / CHANNELS))?;
            let (low, high) = stored.split_at(header.particles);
            let mut plane = vec![0_u16; header.particles];
            for i in 0..header.particles {
                let residual = unfold(u16::from_le_bytes([low[i], high[i]]));
                plane[i] = predict(&planes, &plane, i).wrapping_add(residual);
            }
            planes.push(plane);
        }
        // Reading past the last number makes the decoder look at its checksum.
        ensure!(decoder.read(&mut [0])? == 0, "goes on after the last frame");
        Ok(PackedRun { header, planes })
    }

    /// Packs the run.
    pub fn to_bytes(&self) -> anyhow::Result<Vec<u8>> {
        let header = serde_json::to_vec(&self.header)?;
        let mut bytes = MAGIC.to_vec();
        bytes.extend(u32::try_from(header.len())?.to_le_bytes());
        bytes.extend(header);
        let mut encoder = ZlibEncoder::new(bytes, Compression::best());
        for (number, plane) in self.planes.iter().enumerate() {
            let before = &self.planes[..number];
            let residual = |i: usize| fold(plane[i].wrapping_sub(predict(before, plane, i)));
            let (low, high): (Vec<u8>, Vec<u8>) =
                (0..plane.len()).map(|i| residual(i).to_le_bytes()).map(|[low, high]| (low, high)).unzip();
            encoder.write_all(&low)?;
            encoder.write_all(&high)?;
        }
        Ok(encoder.finish()?)
    }

    /// Frame `index` of the run.
    pub fn frame(&self, index: usize) -> anyhow::Result<Frame> {
        let Some(time) = self.header.times.get(index) else {
            bail!("there is no frame {index}");
        };
        let planes = &self.planes[CHANNELS * index..CHANNELS * (index + 1)];
        let value = |c: usize, i: usize| {
            let Quantiser { low, step } = self.header.channels[c];
            (low + step * f64::from(planes[c][i])) as f32
        };
        let rows = 0..self.header.particles;
        let positions: Vec<f32> =
            rows.clone().flat_map(|i| [value(0, i), value(1, i), value(2, i)]).collect();
        let scalar: Vec<f32> = rows.map(|i| value(3, i)).collect();
        let metadata = Metadata {
            time: Some(*time),
            support_radius: Some(self.header.support_radius),
            particle_radius: Some(self.header.particle_radius),
            ..Metadata::default()
        };
        let positions = Column::new(3, positions).context("positions are not whole")?;
        let field = Field { name: self.header.scalar.clone(), column: Column::scalars(scalar) };
        Ok(Frame::new(positions, vec![field], metadata)?)
    }
}

fn split(bytes: &[u8]) -> anyhow::Result<(Header, &[u8])> {
    let rest = bytes.strip_prefix(MAGIC).context("is no packed run")?;
    let (length, rest) = rest.split_first_chunk::<4>().context("ends in the header")?;
    let length = u32::from_le_bytes(*length) as usize;
    let (header, residuals) = rest.split_at_checked(length).context("ends in the header")?;
    Ok((serde_json::from_slice(header)?, residuals))
}

/// What number `i` of the plane that follows `before` should be, from what lies before it.
fn predict(before: &[Vec<u16>], plane: &[u16], i: usize) -> u16 {
    let earlier = |frames: usize| before.len().checked_sub(CHANNELS * frames).map(|number| before[number][i]);
    match (earlier(1), earlier(2)) {
        (Some(last), Some(second_last)) => last.wrapping_mul(2).wrapping_sub(second_last),
        (Some(last), None) => last,
        (None, _) => i.checked_sub(1).map_or(0, |previous| plane[previous]),
    }
}

/// 0, −1, 1, −2, ... becomes 0, 1, 2, 3, ...: small numbers of either sign have a high byte of 0.
fn fold(residual: u16) -> u16 {
    let signed = residual as i16;
    ((signed << 1) ^ (signed >> 15)) as u16
}

fn unfold(folded: u16) -> u16 {
    (folded >> 1) ^ (folded & 1).wrapping_neg()
}

/// Rows of position and scalar in the order of the ids.
fn ordered(frame: &Frame, scalar: &str) -> anyhow::Result<Vec<[f64; CHANNELS]>> {
    let column =
        |name: &str| frame.field(name).map(|field| &field.column).context(format!("no field {name}"));
    let (ids, values) = (column("id")?, column(scalar)?);
    let mut rows: Vec<(f64, [f64; CHANNELS])> = Vec::with_capacity(frame.len());
    for row in 0..frame.len() {
        let [x, y, z] = frame.position(row);
        let numbers = [x, y, z, values.get(row, 0)];
        ensure!(numbers.iter().all(|x| x.is_finite()), "row {row} holds a number that is not finite");
        rows.push((ids.get(row, 0), numbers));
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    Ok(rows.into_iter().map(|(_, numbers)| numbers).collect())
}

/// One step for the three axes, so that the error is the same in every direction.
fn quantisers(rows: &[Vec<[f64; CHANNELS]>]) -> [Quantiser; CHANNELS] {
    let all = || rows.iter().flatten();
    let low = |c: usize| all().map(|row| row[c]).fold(f64::INFINITY, f64::min);
    let high = |c: usize| all().map(|row| row[c]).fold(f64::NEG_INFINITY, f64::max);
    let side = (0..3).map(|c| high(c) - low(c)).fold(0.0, f64::max);
    std::array::from_fn(|c| {
        let step = if c < 3 { side / POSITION_LEVELS } else { (high(c) - low(c)) / SCALAR_LEVELS };
        // Without particles, and where all are in one place, any step will do.
        let step = if step.is_finite() && step > 0.0 { step } else { 1.0 };
        let low = low(c);
        Quantiser { low: if low.is_finite() { low } else { 0.0 }, step }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Particles on circles, with the rows of every frame in another order.
    fn run(particles: usize, frames: usize) -> Vec<Frame> {
        let frame = |t: usize| {
            let order: Vec<usize> = (0..particles).map(|i| (i * 7 + t) % particles.max(1)).collect();
            let angle = |i: usize| 0.1 * t as f64 * (1.0 + i as f64 / particles as f64) + i as f64;
            let position = |&i: &usize| [angle(i).sin(), 3.0 + angle(i).cos(), -0.01 * i as f64];
            let positions: Vec<f64> = order.iter().flat_map(position).collect();
            let field =
                |name: &str, values: Vec<f64>| Field { name: name.into(), column: Column::scalars(values) };
            let fields = vec![
                field("ID", order.iter().map(|&i| i as f64).collect()),
                field("dye", order.iter().map(|&i| angle(i).sin()).collect()),
            ];
            Frame::new(Column::new(3, positions).unwrap(), fields, Metadata::default()).unwrap()
        };
        (0..frames).map(frame).collect()
    }

    #[test]
    fn a_round_trip_stays_within_half_a_step() {
        let frames = run(101, 4);
        let packed = PackedRun::new(&frames, "dye", vec![0.0, 0.1, 0.2, 0.3], [0.5, 0.125]).unwrap();
        let bytes = packed.to_bytes().unwrap();
        let back = PackedRun::from_bytes(&bytes).unwrap();
        assert_eq!(back.header().particles, 101);
        assert_eq!(PackedRun::read_header(&bytes).unwrap().times.len(), 4);
        let step = packed.header().channels[0].step;
        for (t, original) in frames.iter().enumerate() {
            let frame = back.frame(t).unwrap();
            let rows = ordered(original, "dye").unwrap();
            for (row, expected) in rows.iter().enumerate() {
                let [x, y, z] = frame.position(row);
                let dye = frame.field("dye").unwrap().column.get(row, 0);
                for (c, value) in [x, y, z, dye].into_iter().enumerate() {
                    let step = packed.header().channels[c].step;
                    assert!((value - expected[c]).abs() <= 0.5 * step + 1e-6, "frame {t}, row {row}");
                }
            }
            assert_eq!(frame.metadata.support_radius, Some(0.5));
        }
        assert!(step < 2.0 / 16_000.0);
        assert!(back.frame(4).is_err());
    }

    #[test]
    fn folding_has_an_inverse() {
        for residual in 0..=u16::MAX {
            assert_eq!(unfold(fold(residual)), residual);
        }
        assert_eq!([fold(0), fold(u16::MAX), fold(1), fold(u16::MAX - 1)], [0, 1, 2, 3]);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert!(PackedRun::from_bytes(b"SPHRUN 2").is_err());
        let bytes = PackedRun::new(&run(50, 2), "dye", vec![0.0, 1.0], [1.0; 2]).unwrap().to_bytes().unwrap();
        for length in [0, 5, 10, 30, bytes.len() - 5] {
            assert!(PackedRun::from_bytes(&bytes[..length]).is_err(), "{length}");
        }
        let uneven = [run(50, 1), run(51, 1)].concat();
        assert!(PackedRun::new(&uneven, "dye", vec![0.0, 1.0], [1.0; 2]).is_err());
        assert!(PackedRun::new(&run(5, 1), "no such", vec![0.0], [1.0; 2]).is_err());
        let empty = PackedRun::new(&run(0, 1), "dye", vec![0.0], [1.0; 2]).unwrap();
        assert!(PackedRun::from_bytes(&empty.to_bytes().unwrap()).unwrap().frame(0).unwrap().is_empty());
    }
}
