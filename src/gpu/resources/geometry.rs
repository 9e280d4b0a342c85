//! Geometry that all renderers of a device share: solids, their tables in one buffer, and the
//! indices of proxies.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::memory::Buffer;
use crate::gpu::memory::buffers;
use crate::gpu::resources::arena::TableArena;
use crate::gpu::resources::solid_cache::SolidCache;
use crate::plan::Parts;
use crate::solid::offset_surface::OffsetSurface;
use crate::solid::proxy_hull;
use crate::solid::table_slot::Part;
use std::sync::{Arc, Mutex, MutexGuard};

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

/// The buffers of a frame. Parts that were placed for the frame stay at their places in these.
#[derive(Clone)]
pub(crate) struct Placed {
    pub tables: Arc<Buffer>,
    pub indices: Arc<Buffer>,
}

impl Geometry {
    /// The geometry of a device, made now if there is none.
    pub fn of(device: &Arc<Shared>) -> Result<Arc<Self>> {
        let mut known = device.geometry.lock().map_err(|_| poisoned())?;
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
    /// Gives parts of surfaces their places. Frames that were prepared earlier keep their buffers.
    pub fn place<'a>(
        &mut self,
        surfaces: impl Iterator<Item = (&'a Arc<OffsetSurface>, Parts)>,
    ) -> Result<Placed> {
        for (surface, parts) in surfaces {
            let wanted = [
                (parts.tables, Part::Tables),
                (parts.frusta, Part::Frusta),
                (parts.patches, Part::Patches),
            ];
            for (_, part) in wanted.into_iter().filter(|(is, _)| *is) {
                self.arena.place(surface, part)?;
            }
            if parts.frusta {
                self.fit(surface.hull().hull.frusta.len() as u32)?;
            }
        }
        Ok(Placed {
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
    let mut buffer = buffers::indices(device, 4 * all.len() as u64)?;
    buffers::write_slice(&mut buffer, &all)?;
    Ok(buffer)
}

fn poisoned() -> Error {
    Error::new(
        ErrorKind::Other,
        "the lock of the device's geometry is poisoned",
    )
}
