//! Device buffers that grow as pictures need it.

use std::ops::Range;

use bytemuck::{NoUninit, Pod};

use super::Gpu;
use super::ledger::Entry;
use crate::error::RenderError;

/// Buffers are a whole number of these many bytes.
const GRAIN: u64 = 16;
/// Bytes that are on their way to the device at a time: they take as much memory again until they are there.
const WRITE_AT_ONCE: usize = 64 << 20;

/// A buffer of numbers of one size, with room for at least one.
pub struct Buffer {
    label: &'static str,
    stride: u64,
    usage: wgpu::BufferUsages,
    buffer: wgpu::Buffer,
    entry: Entry,
}

/// A buffer, and the most elements that it may have.
pub(crate) type Room<'a> = (&'a mut Buffer, u64);

impl Buffer {
    /// An array for shaders to read and write, `stride` bytes an element.
    pub fn storage(gpu: &Gpu, label: &'static str, stride: u64) -> Buffer {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        Buffer::new(gpu, label, stride, usage)
    }

    /// Constants of type `T`.
    pub fn uniform<T>(gpu: &Gpu, label: &'static str) -> Buffer {
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        Buffer::new(gpu, label, size_of::<T>() as u64, usage)
    }

    fn new(gpu: &Gpu, label: &'static str, stride: u64, usage: wgpu::BufferUsages) -> Buffer {
        let (buffer, entry) = create(gpu, label, stride, usage);
        Buffer { label, stride, usage, buffer, entry }
    }

    /// Makes room for `count` elements; contents are lost where the buffer grows.
    pub fn reserve(&mut self, gpu: &Gpu, count: u64) -> Result<(), RenderError> {
        let needed = self.bytes_for(count);
        if needed <= self.buffer.size() {
            return Ok(());
        }
        let limit = gpu.binding_limit();
        if needed > limit {
            return Err(RenderError::BufferLimit { what: self.label, needed, limit });
        }
        self.replace(gpu, needed);
        // One that could not be had would pass for as large as it was to be.
        gpu.check().inspect_err(|_| self.replace(gpu, self.stride))
    }

    /// Gives the memory back where there is room for more than `most` elements; true if it did, and the
    /// contents are lost.
    pub(crate) fn give_back_above(&mut self, gpu: &Gpu, most: u64) -> bool {
        let gives = self.buffer.size() > self.bytes_for(most);
        if gives {
            self.replace(gpu, self.stride);
        }
        gives
    }

    /// Bytes of a buffer with room for `count` elements.
    pub(crate) fn bytes_for(&self, count: u64) -> u64 {
        (count.max(1) * self.stride).next_multiple_of(GRAIN)
    }

    /// The old memory goes before the new is taken: both may not fit side by side.
    fn replace(&mut self, gpu: &Gpu, bytes: u64) {
        self.buffer.destroy();
        self.entry = gpu.ledger.enter(0);
        (self.buffer, self.entry) = create(gpu, self.label, bytes, self.usage);
    }

    /// Makes room for `values` and writes them.
    pub fn write<T: NoUninit>(&mut self, gpu: &Gpu, values: &[T]) -> Result<(), RenderError> {
        debug_assert_eq!(size_of_val(values) as u64 % self.stride, 0);
        self.reserve(gpu, size_of_val(values) as u64 / self.stride)?;
        for (number, part) in bytemuck::cast_slice(values).chunks(WRITE_AT_ONCE).enumerate() {
            if number > 0 {
                gpu.queue.submit([]);
                gpu.wait()?;
            }
            gpu.queue.write_buffer(&self.buffer, (number * WRITE_AT_ONCE) as u64, part);
        }
        Ok(())
    }

    pub(crate) fn raw(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    pub fn binding(&self) -> wgpu::BindingResource<'_> {
        self.buffer.as_entire_binding()
    }

    /// Number of elements there is room for.
    pub(crate) fn capacity(&self) -> u64 {
        self.buffer.size() / self.stride
    }

    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }
}

/// A buffer, with its entry in the device's ledger.
fn create(gpu: &Gpu, label: &'static str, size: u64, usage: wgpu::BufferUsages) -> (wgpu::Buffer, Entry) {
    let size = size.next_multiple_of(GRAIN);
    let entry = gpu.ledger.enter(size);
    let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
    (gpu.device.create_buffer(&descriptor), entry)
}

/// A copy on its way to the host.
pub(crate) struct Readback {
    staging: wgpu::Buffer,
    /// Bytes that were asked for: the buffer may be larger.
    size: u64,
    _entry: Entry,
}

impl Buffer {
    /// Records a copy of the first `count` elements for [`Readback::take`] after the submission.
    pub(crate) fn read_back(&self, gpu: &Gpu, encoder: &mut wgpu::CommandEncoder, count: u64) -> Readback {
        self.read_range(gpu, encoder, 0..count)
    }

    /// Records a copy of the elements in `range`.
    pub(crate) fn read_range(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        range: Range<u64>,
    ) -> Readback {
        self.read_ranges(gpu, encoder, std::slice::from_ref(&range))
    }

    /// Records a copy of the elements in `ranges`, one range behind the other.
    pub(crate) fn read_ranges(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        ranges: &[Range<u64>],
    ) -> Readback {
        let bytes = |range: &Range<u64>| (range.end - range.start) * self.stride;
        let size = ranges.iter().map(bytes).sum();
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let (staging, entry) = create(gpu, "readback", size, usage);
        let mut place = 0;
        for range in ranges {
            let first = range.start * self.stride;
            encoder.copy_buffer_to_buffer(&self.buffer, first, &staging, place, bytes(range));
            place += bytes(range);
        }
        Readback { staging, size, _entry: entry }
    }
}

impl Readback {
    /// Waits for the copy. May be called once the encoder was submitted.
    pub(crate) fn take<T: Pod>(self, gpu: &Gpu) -> Result<Vec<T>, RenderError> {
        self.staging.map_async(wgpu::MapMode::Read, .., |_| {});
        gpu.wait()?;
        let view = self
            .staging
            .get_mapped_range(..self.size)
            .map_err(|error| RenderError::Device(error.to_string()))?;
        Ok(bytemuck::pod_collect_to_vec(&view))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::GpuOptions;

    #[test]
    fn a_buffer_that_could_not_be_had_is_not_taken_for_one() {
        let mut gpu = Gpu::new(&GpuOptions::default()).unwrap();
        // Then it is the device that finds it too large.
        (gpu.limits.max_buffer_size, gpu.limits.max_storage_buffer_binding_size) = (u64::MAX, u64::MAX);
        let mut buffer = Buffer::storage(&gpu, "numbers", 4);
        buffer.write(&gpu, &[1_u32]).unwrap();
        assert!(buffer.reserve(&gpu, 1 << 52).is_err());
        assert_eq!(buffer.bytes(), GRAIN);
        let numbers: Vec<u32> = (0..1000).collect();
        buffer.write(&gpu, &numbers).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let copy = buffer.read_back(&gpu, &mut encoder, 1000);
        gpu.queue.submit([encoder.finish()]);
        assert_eq!(copy.take::<u32>(&gpu).unwrap(), numbers);
    }
}
