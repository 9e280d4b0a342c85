//! One storage buffer for the tables and frusta of all surfaces. A surface's parts keep their
//! places as long as they live.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::memory::Buffer;
use crate::gpu::memory::buffers::storage;
use crate::solid::offset_surface::OffsetSurface;
use crate::solid::table_slot::{Part, Ranges, Slot};
use range_alloc::RangeAllocator;
use std::sync::{Arc, Mutex, Weak};

/// The buffer and its free ranges.
pub(crate) struct TableArena {
    pub buffer: Arc<Buffer>,
    ranges: Ranges,
    /// The number of 16-byte vectors in a unit. Every slot begins at a whole unit.
    unit: u32,
    placed: Vec<(Weak<OffsetSurface>, Part)>,
    /// The length of `placed` above which dead entries are removed.
    crowded: usize,
    device: Arc<Shared>,
}

/// Units of a new arena.
const FIRST_UNITS: u32 = 1024;

impl TableArena {
    pub fn new(device: &Arc<Shared>) -> Result<Self> {
        let align = device.limits.min_uniform_buffer_offset_alignment.max(16);
        let unit = u32::try_from(align / 16).unwrap_or(16);
        Ok(Self {
            buffer: Arc::new(buffer(device, unit, FIRST_UNITS)?),
            ranges: Arc::new(Mutex::new(RangeAllocator::new(0..FIRST_UNITS))),
            unit,
            placed: Vec::new(),
            crowded: 64,
            device: device.clone(),
        })
    }

    /// Gives a part of a surface a place and writes it there, if it has no place yet.
    pub fn place(&mut self, surface: &Arc<OffsetSurface>, part: Part) -> Result<()> {
        if surface.slot(part).is_some() {
            return Ok(());
        }
        let vectors = surface.vectors(part);
        let units = u32::try_from(vectors.len().max(1))
            .unwrap_or(u32::MAX)
            .div_ceil(self.unit);
        let free = self.ranges()?.allocate_range(units);
        let range = match free {
            Ok(range) => range,
            Err(_) => {
                self.grow(units)?;
                self.ranges()?.allocate_range(units).map_err(|_| full())?
            }
        };
        let slot = Slot::new(range, self.unit, &self.ranges);
        let begin = slot.begin();
        self.write(begin, vectors)?;
        surface.keep_slot(part, slot);
        self.placed.push((Arc::downgrade(surface), part));
        if self.placed.len() > self.crowded {
            self.placed
                .retain(|(surface, _)| surface.strong_count() > 0);
            self.crowded = 2 * self.placed.len().max(32);
        }
        Ok(())
    }

    fn ranges(&self) -> Result<std::sync::MutexGuard<'_, RangeAllocator<u32>>> {
        self.ranges.lock().map_err(|_| full())
    }

    /// Makes at least twice the room. Everything that lives keeps its place.
    fn grow(&mut self, more: u32) -> Result<()> {
        let units = self.ranges()?.initial_range().end;
        let wanted = units.saturating_mul(2).max(units.saturating_add(more));
        let bigger = buffer(&self.device, self.unit, wanted)?;
        self.ranges()?.grow_to(wanted);
        self.buffer = Arc::new(bigger);
        let placed = std::mem::take(&mut self.placed);
        for (surface, part) in &placed {
            if let Some(surface) = surface.upgrade()
                && let Some(slot) = surface.slot(*part)
            {
                self.write(slot.begin(), surface.vectors(*part))?;
            }
        }
        self.placed = placed;
        Ok(())
    }

    fn write(&mut self, begin: u32, vectors: &[[u32; 4]]) -> Result<()> {
        let bytes: &[u8] = bytemuck::cast_slice(vectors);
        // SAFETY: the range belongs to one surface, whose parts are written once in a buffer,
        // before any frame reads them; the arena is behind a lock.
        unsafe { self.buffer.write_shared(16 * begin as usize, bytes) }
    }
}

fn full() -> Error {
    Error::new(
        ErrorKind::TooLarge,
        "the tables of all solids do not fit; draw fewer different ones",
    )
}

/// Makes a buffer with a window's length after the last unit. The window on the last tables is then
/// as long as all others.
fn buffer(device: &Arc<Shared>, unit: u32, units: u32) -> Result<Buffer> {
    let vectors = u64::from(unit) * u64::from(units) + u64::from(device.constants.own_vectors);
    storage(device, "tables", 16 * vectors)
}
