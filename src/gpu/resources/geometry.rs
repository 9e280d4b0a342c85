//! Geometry that all renderers of a device share: solids, the tables and frusta of all surfaces in
//! one storage buffer, and the indices of proxies. A surface's parts keep their positions in the
//! buffer as long as they live.

use crate::error::{Error, ErrorKind, Result, lock};
use crate::gpu::device::Shared;
use crate::gpu::memory::buffers::{Buffer, Use, write_slice};
use crate::solid::cache::SolidCache;
use crate::solid::offset_surface::{OffsetSurface, Part, Slot};
use crate::solid::proxy_hull;
use range_alloc::RangeAllocator;
use rayon::prelude::*;
use std::sync::{Arc, Mutex, Weak};

pub(crate) struct Geometry {
    pub solids: SolidCache,
    buffers: TableBuffers,
    /// Free ranges of the tables, in vectors of 16 bytes.
    ranges: Arc<Mutex<RangeAllocator<u32>>>,
    /// Every slot is as long as so many vectors, or a multiple of it, and so begins where a window
    /// of a uniform buffer may.
    unit: u32,
    frusta: u32,
    device: Arc<Shared>,
}

/// The buffers of a frame. Parts that were stored for the frame keep their positions in these.
#[derive(Clone)]
pub(crate) struct TableBuffers {
    pub tables: Arc<Buffer>,
    pub indices: Arc<Buffer>,
}

const FIRST_UNITS: u32 = 1024;

impl Geometry {
    /// The geometry that `known` holds for a device; made now if there is none.
    pub fn of(device: &Arc<Shared>, known: &Mutex<Weak<Mutex<Self>>>) -> Result<Arc<Mutex<Self>>> {
        let mut known = lock(known)?;
        if let Some(geometry) = known.upgrade() {
            return Ok(geometry);
        }
        let align = device.limits().min_uniform_buffer_offset_alignment.max(16);
        let unit = u32::try_from(align / 16).unwrap_or(16);
        let vectors = FIRST_UNITS * unit;
        let made = Self {
            solids: SolidCache::default(),
            buffers: TableBuffers {
                tables: table_buffer(device, vectors)?,
                indices: indices(device, 0)?,
            },
            ranges: Arc::new(Mutex::new(RangeAllocator::new(0..vectors))),
            unit,
            frusta: 0,
            device: device.clone(),
        };
        let made = Arc::new(Mutex::new(made));
        *known = Arc::downgrade(&made);
        Ok(made)
    }

    /// Stores parts of surfaces. Frames that were prepared earlier keep their buffers.
    pub fn store<'a>(
        &mut self,
        surfaces: impl Iterator<Item = (&'a Arc<OffsetSurface>, [bool; 3])>,
    ) -> Result<TableBuffers> {
        let parts = surfaces.flat_map(|(surface, read)| {
            let parts = Part::ALL.into_iter().zip(read).filter(|(_, is)| *is);
            parts.map(move |(part, _)| (surface, part))
        });
        let is_new = |(surface, part): &(&Arc<OffsetSurface>, Part)| surface.slot(*part).is_none();
        let new: Vec<_> = parts.filter(is_new).collect();
        new.par_iter().for_each(|(surface, part)| {
            surface.vectors(*part);
        });
        for (surface, part) in new {
            self.store_part(surface, part)?;
        }
        Ok(self.buffers.clone())
    }

    pub fn bytes(&self) -> u64 {
        self.buffers.tables.bytes + self.buffers.indices.bytes
    }

    /// Makes indices for this many frusta, if there are fewer.
    fn fit(&mut self, frusta: u32) -> Result<()> {
        if frusta > self.frusta {
            let frusta = frusta.next_power_of_two();
            self.buffers.indices = indices(&self.device, frusta)?;
            self.frusta = frusta;
        }
        Ok(())
    }

    /// Writes a part of a surface to a free range, unless it has one.
    fn store_part(&mut self, surface: &OffsetSurface, part: Part) -> Result<()> {
        if surface.slot(part).is_some() {
            return Ok(());
        }
        let vectors = surface.vectors(part);
        let length = u32::try_from(vectors.len().max(1))
            .ok()
            .and_then(|length| length.checked_next_multiple_of(self.unit))
            .ok_or_else(full)?;
        let free = |of: &Self| Ok(lock(&of.ranges)?.allocate_range(length).ok());
        let mut range = free(self)?;
        if range.is_none() {
            self.grow(length)?;
            range = free(self)?;
        }
        let slot = Slot {
            range: range.ok_or_else(full)?,
            ranges: self.ranges.clone(),
        };
        self.write(slot.begin(), vectors)?;
        if let (Part::Frusta, Some(hull)) = (part, surface.hull()) {
            self.fit(hull.hull.frusta.len() as u32)?;
        }
        surface.keep_slot(part, slot);
        Ok(())
    }

    /// Makes twice the room, or as much as the device takes. Everything that lives keeps its
    /// position.
    fn grow(&mut self, more: u32) -> Result<()> {
        let end = lock(&self.ranges)?.initial_range().end;
        let limit = self.device.limits().max_storage_buffer_range / 16;
        let most = limit.saturating_sub(self.device.chosen.constants().own_vectors);
        let most = most - most % self.unit;
        let least = end.checked_add(more).filter(|least| *least <= most);
        let wanted = least.ok_or_else(full)?.max(end.saturating_mul(2)).min(most);
        self.buffers.tables = table_buffer(&self.device, wanted)?;
        lock(&self.ranges)?.grow_to(wanted);
        for surface in self.solids.surfaces()? {
            for part in Part::ALL {
                if let Some(slot) = surface.slot(part) {
                    self.write(slot.begin(), surface.vectors(part))?;
                }
            }
        }
        Ok(())
    }

    fn write(&self, begin: u32, vectors: &[[u32; 4]]) -> Result<()> {
        let bytes: &[u8] = bytemuck::cast_slice(vectors);
        // SAFETY: the range belongs to one surface, whose parts are written once in a buffer,
        // before any frame reads them; the geometry is behind a lock.
        unsafe { self.buffers.tables.write_shared(16 * begin as usize, bytes) }
    }
}

fn full() -> Error {
    let message = "the tables of all solids do not fit; draw fewer different ones";
    Error::new(ErrorKind::TooLarge, message)
}

/// The corners of a box and of this many frusta.
fn indices(device: &Arc<Shared>, frusta: u32) -> Result<Arc<Buffer>> {
    let all = proxy_hull::indices(frusta);
    let bytes = size_of_val(all.as_slice()) as u64;
    let mut buffer = Buffer::for_use(device, Use::Indices, "corners of proxies", bytes)?;
    write_slice(&mut buffer, &all)?;
    Ok(Arc::new(buffer))
}

/// Makes a buffer with a window's length after the last vector. The window on the last tables is
/// then as long as all others.
fn table_buffer(device: &Arc<Shared>, vectors: u32) -> Result<Arc<Buffer>> {
    let vectors = u64::from(vectors) + u64::from(device.chosen.constants().own_vectors);
    let buffer = Buffer::for_use(device, Use::Storage, "tables", 16 * vectors)?;
    Ok(Arc::new(buffer))
}
