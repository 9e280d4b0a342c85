//! Which pixels the compute stage visits for an object: its rectangle, bins that its copies share, or tiles that beams choose.

use super::bins::{Rectangle, rectangle};
use super::cuts::Cut;
use super::hulls;
use super::renderer::Renderer;
use super::update::{Lists, Plan};
use super::work::{MOST_BEAMED, Tiles, Work};
use crate::error::Result;
use crate::scene::Object;
use crate::shader::generated::GROUP_PIXELS;
use std::sync::Arc;

/// Words of the list of a rectangle's tiles: the dispatch, and four a tile.
fn words_of(rectangle: Rectangle) -> usize {
    4 + 4 * rectangle.padded() as usize
}

/// Tiles that each of several copies should cover for a list of its own to pay.
const LEAST_TILES: u64 = 64;

impl Renderer {
    /// How the compute stage draws object `number`; `at` of beams counts from the last bin's words on.
    pub(super) fn compute_work(
        &mut self,
        number: usize,
        object: &Object,
        wrapped: Option<&Arc<Cut>>,
        plan: &Plan,
        lists: &mut Lists,
    ) -> Result<Work> {
        let size = (self.settings.width, self.settings.height);
        let radius = object.profile.radius;
        let placements = object.placements();
        if let Some(cut) = wrapped
            && placements.len() <= MOST_BEAMED
            && hulls::takes_beams(object, cut, &plan.camera)
        {
            let shown: Vec<(usize, Rectangle)> = placements
                .iter()
                .enumerate()
                .filter_map(|(n, copy)| {
                    let seen = rectangle(&plan.camera, size, GROUP_PIXELS, radius, copy)?;
                    Some((n, seen))
                })
                .collect();
            if shown.is_empty() {
                return Ok(Work::Nothing);
            }
            // A tile listed is a work group.
            let most = self.device.limits.max_compute_work_group_count[0];
            // All lists stand in one buffer, of which a quarter is for them: bins need the rest.
            let words: u64 = shown.iter().map(|(_, r)| words_of(*r) as u64).sum();
            let room = u64::from(self.device.limits.max_storage_buffer_range) / 16;
            let fits =
                lists.tiles as u64 + words <= room && shown.iter().all(|(_, r)| r.padded() <= most);
            let squares: u64 = shown.iter().map(|(_, r)| r.squares()).sum();
            let pays = placements.len() == 1 || squares >= LEAST_TILES * shown.len() as u64;
            if fits && pays {
                return self.beams(number, placements.len(), &shown, lists);
            }
        }
        Ok(match placements {
            [one] => match rectangle(&plan.camera, size, GROUP_PIXELS, radius, one) {
                Some(rectangle) => Work::Rectangle(rectangle),
                None => Work::Nothing,
            },
            _ => {
                let first = self.batches[number].instances.start;
                let bins = lists
                    .bins
                    .add(&plan.camera, size, radius, first, placements);
                if bins.is_empty() {
                    Work::Nothing
                } else {
                    Work::Bins(bins)
                }
            }
        })
    }

    /// Lists of tiles for the copies of object `number` that show.
    fn beams(
        &mut self,
        number: usize,
        copies: usize,
        shown: &[(usize, Rectangle)],
        lists: &mut Lists,
    ) -> Result<Work> {
        let mut tiles = Vec::with_capacity(shown.len());
        for &(instance, rectangle) in shown {
            let at = lists.tiles as u32;
            lists.tiles += words_of(rectangle);
            let mut block = number as u32;
            if copies > 1 {
                block = lists.blocks;
                lists.blocks += 1;
            }
            tiles.push(Tiles {
                rectangle,
                at,
                block_offset: block * self.buffers.stride,
                instance,
            });
        }
        Ok(Work::Beams {
            list: self.pipelines.beam()?,
            copies: tiles,
        })
    }
}
