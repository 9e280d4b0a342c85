//! Statistics of a renderer.

use super::{Recorder, RevmapRenderer};
use crate::fault::{Fault, RevmapResult, enter};
use crate::handle::with;
use crate::pointers::put;
use crate::structures::{described, fill, sized};
use revmap::gpu::DrawPath;
use std::ffi::{CString, c_char};

/// Contents and work of a renderer.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevmapStatistics {
    /// sizeof(RevmapStatistics).
    pub size: u32,
    /// Objects.
    pub objects: u32,
    /// Surfaces made so far: one for each profile under each offset that no object had in the frame
    /// before.
    pub surfaces_made: u64,
    /// Bytes of shape maps with their tables of lengths, on the device.
    pub shape_map_bytes: u64,
    /// Bytes of colour and height maps, on the device.
    pub texture_bytes: u64,
    /// Objects that the last prepared frame does not draw at all.
    pub drawn_not: u32,
    /// Number of objects drawn by their boxes.
    pub drawn_by_box: u32,
    /// Number of objects drawn by hulls.
    pub drawn_by_hull: u32,
    /// Number of objects drawn by rays that walk to copies: all of them in compute.
    pub drawn_by_tiles: u32,
    /// Notes that revmap_renderer_note() gives.
    pub notes: u32,
    /// 0.
    pub padding: u32,
}

/// What the frame that was prepared for a slot records.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RevmapFrameStatistics {
    /// sizeof(RevmapFrameStatistics).
    pub size: u32,
    /// Objects of which a part may show.
    pub objects: u32,
    /// Draws, those of one indirect command counted one by one.
    pub draws: u32,
    /// Dispatches.
    pub dispatches: u32,
    /// Draws and dispatches that are left out, because their pipelines are not compiled; see
    /// revmap_renderer_hide_until_compiled().
    pub hidden: u32,
    /// Tiles of fragments, and work groups of dispatches whose number the host knows.
    pub tiles: u32,
    /// Bytes of the slot's buffers.
    pub slot_bytes: u64,
    /// CPU time of the preparation, milliseconds of the clock.
    pub prepare_ms: f64,
    /// CPU time of the last recording of the frame, milliseconds; 0 before.
    pub record_ms: f64,
}

described! {
    RevmapStatistics {
        0 => [
            size, objects, surfaces_made, shape_map_bytes, texture_bytes, drawn_not, drawn_by_box,
            drawn_by_hull, drawn_by_tiles, notes, padding,
        ]
    }
    RevmapFrameStatistics {
        0 => [size, objects, draws, dispatches, hidden, tiles, slot_bytes]
        5 => [prepare_ms, record_ms]
    }
}

impl Recorder {
    fn statistics(&self) -> RevmapStatistics {
        let number = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        let paths = self.renderer.draw_paths();
        let drawn = |path| number(paths.iter().filter(|p| **p == path).count());
        let [shape_map_bytes, texture_bytes] = self.renderer.map_bytes();
        RevmapStatistics {
            objects: number(self.renderer.object_count()),
            surfaces_made: self.renderer.rebuild_count(),
            shape_map_bytes,
            texture_bytes,
            drawn_not: drawn(DrawPath::Nothing),
            drawn_by_box: drawn(DrawPath::Box),
            drawn_by_hull: drawn(DrawPath::Cells),
            drawn_by_tiles: drawn(DrawPath::Walk),
            notes: number(self.renderer.notes().len()),
            ..sized()
        }
    }
}

/// Returns the contents and work of a renderer. The size of statistics must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_statistics(
    renderer: *const RevmapRenderer,
    statistics: *mut RevmapStatistics,
) -> RevmapResult {
    enter(|| {
        let value = with(renderer, |r| Ok(r.statistics()))?;
        fill(statistics, value)
    })
}

/// Returns what the frame that was prepared for a slot records. The size of statistics must be set.
///
/// Fails with REVMAP_RESULT_USAGE if the slot is not prepared.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_frame_statistics(
    renderer: *const RevmapRenderer,
    slot: u32,
    statistics: *mut RevmapFrameStatistics,
) -> RevmapResult {
    enter(|| {
        let of = with(renderer, |r| Ok(r.prepared(slot)?.statistics()))?;
        let value = RevmapFrameStatistics {
            objects: of.objects,
            draws: of.draws,
            dispatches: of.dispatches,
            hidden: of.hidden,
            tiles: of.tiles,
            slot_bytes: of.slot_bytes,
            prepare_ms: of.prepare_ms,
            record_ms: of.record_ms,
            ..sized()
        };
        fill(statistics, value)
    })
}

/// Returns a note: a deviation from the settings, and its reason. The text lasts as long as the
/// renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_note(
    renderer: *const RevmapRenderer,
    number: u32,
    note: *mut *const c_char,
) -> RevmapResult {
    put(note, "note", || {
        with(renderer, |r| {
            let Recorder {
                renderer, notes, ..
            } = r;
            for text in &renderer.notes()[notes.len()..] {
                notes.push(CString::new(text.replace('\0', " ")).unwrap_or_default());
            }
            let note = notes.get(number as usize).map(|text| text.as_ptr());
            note.ok_or_else(|| Fault::usage(format!("there is no note {number}")))
        })
    })
}
