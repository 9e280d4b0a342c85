//! Geometry that all renderers of a device share: solids, the tables and frusta of all surfaces in
//! one storage buffer, and the indices of proxies. A surface's parts keep their positions in the
//! buffer as long as they live.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::memory::buffers::{Buffer, Use, write_slice};
use crate::gpu::resources::solid_cache::SolidCache;
use crate::plan::Parts;
use crate::solid::offset_surface::OffsetSurface;
use crate::solid::proxy_hull;
use crate::solid::table_slot::{Part, Ranges, Slot};
use range_alloc::RangeAllocator;
use std::sync::{Arc, Mutex, MutexGuard, Weak};

/// The shared state, behind one lock.
pub(crate) struct Geometry {
    state: Mutex<State>,
}

/// Solids and buffers.
pub(crate) struct State {
    pub solids: SolidCache,
    arena: TableArena,
    indices: Arc<Buffer>,
    /// The number of frusta that have indices.
    frusta: u32,
    device: Arc<Shared>,
}

/// The buffers of a frame. Parts that were stored for the frame keep their positions in these.
#[derive(Clone)]
pub(crate) struct TableBuffers {
    pub tables: Arc<Buffer>,
    pub indices: Arc<Buffer>,
}

impl Geometry {
    /// The geometry that `known` holds for a device; made now if there is none.
    pub fn of(device: &Arc<Shared>, known: &Mutex<Weak<Self>>) -> Result<Arc<Self>> {
        let mut known = known.lock().map_err(|_| poisoned())?;
        if let Some(geometry) = known.upgrade() {
            return Ok(geometry);
        }
        let made = Arc::new(Self {
            state: Mutex::new(State {
                solids: SolidCache::default(),
                arena: TableArena::new(device)?,
                indices: Arc::new(indices(device, 0)?),
                frusta: 0,
                device: device.clone(),
            }),
        });
        *known = Arc::downgrade(&made);
        Ok(made)
    }

    pub fn lock(&self) -> Result<MutexGuard<'_, State>> {
        self.state.lock().map_err(|_| poisoned())
    }
}

impl State {
    /// Stores parts of surfaces. Frames that were prepared earlier keep their buffers.
    pub fn store<'a>(
        &mut self,
        surfaces: impl Iterator<Item = (&'a Arc<OffsetSurface>, Parts)>,
    ) -> Result<TableBuffers> {
        for (surface, parts) in surfaces {
            let wanted = [
                (parts.tables, Part::Tables),
                (parts.frusta, Part::Frusta),
                (parts.patches, Part::Patches),
            ];
            for (_, part) in wanted.into_iter().filter(|(is, _)| *is) {
                self.arena.store(surface, part)?;
            }
            if parts.frusta {
                self.fit(surface.hull().hull.frusta.len() as u32)?;
            }
        }
        Ok(TableBuffers {
            tables: self.arena.buffer.clone(),
            indices: self.indices.clone(),
        })
    }

    /// Bytes of the shared buffers.
    pub fn bytes(&self) -> u64 {
        self.arena.buffer.bytes + self.indices.bytes
    }

    /// Makes indices for this many frusta, if there are fewer.
    fn fit(&mut self, frusta: u32) -> Result<()> {
        if frusta > self.frusta {
            let frusta = frusta.next_power_of_two();
            self.indices = Arc::new(indices(&self.device, frusta)?);
            self.frusta = frusta;
        }
        Ok(())
    }
}

fn indices(device: &Arc<Shared>, frusta: u32) -> Result<Buffer> {
    let all = proxy_hull::indices(frusta);
    let mut buffer = Buffer::for_use(
        device,
        Use::Indices,
        "corners of proxies",
        4 * all.len() as u64,
    )?;
    write_slice(&mut buffer, &all)?;
    Ok(buffer)
}

fn poisoned() -> Error {
    Error::new(
        ErrorKind::Other,
        "the lock of the device's geometry is poisoned",
    )
}

/// The buffer and its free ranges.
struct TableArena {
    pub buffer: Arc<Buffer>,
    ranges: Ranges,
    /// The number of 16-byte vectors in a unit. Every slot begins at a whole unit.
    unit: u32,
    stored: Vec<(Weak<OffsetSurface>, Part)>,
    /// The length of `stored` above which dead entries are removed.
    crowded: usize,
    device: Arc<Shared>,
}

/// Units of a new arena.
const FIRST_UNITS: u32 = 1024;

impl TableArena {
    pub fn new(device: &Arc<Shared>) -> Result<Self> {
        let align = device.limits().min_uniform_buffer_offset_alignment.max(16);
        let unit = u32::try_from(align / 16).unwrap_or(16);
        Ok(Self {
            buffer: Arc::new(table_buffer(device, unit, FIRST_UNITS)?),
            ranges: Arc::new(Mutex::new(RangeAllocator::new(0..FIRST_UNITS))),
            unit,
            stored: Vec::new(),
            crowded: 64,
            device: device.clone(),
        })
    }

    /// Writes a part of a surface to a free range, unless it has one.
    pub fn store(&mut self, surface: &Arc<OffsetSurface>, part: Part) -> Result<()> {
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
        self.stored.push((Arc::downgrade(surface), part));
        if self.stored.len() > self.crowded {
            self.stored
                .retain(|(surface, _)| surface.strong_count() > 0);
            self.crowded = 2 * self.stored.len().max(32);
        }
        Ok(())
    }

    fn ranges(&self) -> Result<std::sync::MutexGuard<'_, RangeAllocator<u32>>> {
        self.ranges.lock().map_err(|_| full())
    }

    /// Makes at least twice the room. Everything that lives keeps its position.
    fn grow(&mut self, more: u32) -> Result<()> {
        let units = self.ranges()?.initial_range().end;
        let wanted = units.saturating_mul(2).max(units.saturating_add(more));
        let bigger = table_buffer(&self.device, self.unit, wanted)?;
        self.ranges()?.grow_to(wanted);
        self.buffer = Arc::new(bigger);
        let stored = std::mem::take(&mut self.stored);
        for (surface, part) in &stored {
            if let Some(surface) = surface.upgrade()
                && let Some(slot) = surface.slot(*part)
            {
                self.write(slot.begin(), surface.vectors(*part))?;
            }
        }
        self.stored = stored;
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
fn table_buffer(device: &Arc<Shared>, unit: u32, units: u32) -> Result<Buffer> {
    let vectors =
        u64::from(unit) * u64::from(units) + u64::from(device.chosen.constants().own_vectors);
    Buffer::for_use(device, Use::Storage, "tables", 16 * vectors)
}
