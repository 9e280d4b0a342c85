//! How each object is drawn: plain data, chosen from the view, the placements and the surface.

use super::bins::{Rectangle, Shown, rectangle};
use super::hulls;
use super::offset_surface::OffsetSurface;
use super::proxy_hull::{COMPONENTS, OUTPUTS};
use super::view::View;
use crate::scene::Object;
use crate::shader::generated::{GROUP_PIXELS, TILE_LISTS};
use ash::vk;
use std::ops::Range;

/// How an object is drawn; chosen anew when it, or the view, changes:
/// [`Renderer::draw_paths`](super::Renderer::draw_paths).
///
/// A search and what it searches are two things: a box may be drawn by any of the searches, a
/// rectangle or bins too; hulls and beams are what [`Solver::Hull`](crate::settings::Solver::Hull)
/// and [`Solver::Live`](crate::settings::Solver::Live) take where they can.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DrawPath {
    /// Not at all, as it is beside the picture, behind the eye or hidden. In the fragment stage the
    /// rasteriser finds that out for boxes and hulls, and of objects with several copies alone is
    /// it known here.
    Nothing,
    /// Fragment stage: the fragments of its boxes are searched.
    Box,
    /// Fragment stage: by the proxy hulls of its surface; of a search on the map the fragments of
    /// its convex hull are searched.
    Hull,
    /// Compute stage, a single copy: the pixels of its rectangle on the screen are searched.
    Rectangle,
    /// Several copies: the squares of the screen in which some may show are searched, each with a
    /// list of these copies, nearest first.
    Bins,
    /// Compute stage, one copy or a few large ones: the tiles of each rectangle that beams have
    /// found to be near the copy are searched.
    Beams,
}

/// A draw path with what it needs to be recorded.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Work {
    Nothing,
    Box,
    Hull {
        /// Runs of the hull's frusta that may be seen.
        frusta: Vec<Range<u32>>,
        /// Whether the box's sides cut it, and are drawn.
        cut: bool,
    },
    /// In work groups.
    Rectangle(Rectangle),
    /// What is shown is known once all objects are planned.
    Bins(Shown),
    Beams {
        /// One an instance that shows.
        copies: Vec<Tiles>,
        /// Whether the box's sides cut the solid.
        cut: bool,
    },
}

/// The tiles of one instance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Tiles {
    /// What beams choose from, in work groups.
    pub rectangle: Rectangle,
    /// The word where their list begins; counted from the end of all bins' words until these are
    /// known.
    pub at: u32,
    /// Number of the block that holds this instance alone; none where the object's own does.
    pub block: Option<u32>,
    /// Among the object's.
    pub instance: usize,
    /// Whether each comes with a list of patches.
    pub listed: bool,
}

impl Tiles {
    /// Where the dispatches of listed patches begin: see `patch_lists.glsl`.
    pub fn heads(&self) -> u32 {
        self.at + 4 + 4 * self.rectangle.padded()
    }

    /// Words of all its lists: a dispatch and four words a tile, or what `patch_lists.glsl` says.
    fn words(&self) -> u32 {
        if self.listed {
            list_words(self.rectangle.padded())
        } else {
            4 + 4 * self.rectangle.padded()
        }
    }
}

/// Words of the lists of patches of so many tiles: see `patch_lists.glsl`.
pub(crate) fn list_words(tiles: u32) -> u32 {
    4 + 4 * tiles + TILE_LISTS * (4 + 2 * tiles)
}

/// Whether patches may be listed for tiles of a surface.
pub(crate) fn takes_lists(subgroup_size: u32, surface: &OffsetSurface) -> bool {
    subgroup_size >= LEAST_SUBGROUP && surface.is_boundary() && !surface.listed().is_empty()
}

impl Shown {
    /// Runs of its bins of one copy, each with the word where their lists of patches begin.
    pub fn listed(&self) -> impl Iterator<Item = (Range<u32>, u32)> {
        let end = self.alone.end;
        let starts = self.alone.clone().step_by(MOST_LISTED as usize);
        starts.zip(0u32..).map(move |(start, n)| {
            let bins = start..end.min(start + MOST_LISTED);
            (bins, self.lists + n * list_words(MOST_LISTED))
        })
    }

    /// Words of all their lists.
    pub fn words(&self) -> u32 {
        let of = |(bins, _): (Range<u32>, u32)| list_words(listed_tiles(&bins));
        self.listed().map(of).sum()
    }
}

/// Bins that go through one dispatch: as many work groups as every device takes, and a multiple of
/// 4, so that the words behind their lists may be numbered as bins.
const MOST_LISTED: u32 = 65_532;

/// For how many tiles the lists of these bins have room.
pub(crate) fn listed_tiles(bins: &Range<u32>) -> u32 {
    (bins.end - bins.start).next_multiple_of(4)
}

impl Work {
    pub fn path(&self) -> DrawPath {
        match self {
            Self::Nothing => DrawPath::Nothing,
            Self::Box => DrawPath::Box,
            Self::Hull { .. } => DrawPath::Hull,
            Self::Rectangle(_) => DrawPath::Rectangle,
            Self::Bins(shown) if shown.copies.is_empty() => DrawPath::Nothing,
            Self::Bins(_) => DrawPath::Bins,
            Self::Beams { .. } => DrawPath::Beams,
        }
    }
}

/// What a choice depends on besides the object.
pub(crate) struct Planner<'a> {
    pub view: &'a View,
    pub limits: &'a vk::PhysicalDeviceLimits,
    /// Invocations that run together.
    pub subgroup_size: u32,
    /// Whether the device clips triangles by a box's sides.
    pub clips: bool,
    /// Whether the device is a processor, on which triangles are dear.
    pub software: bool,
    /// As [`SearchSettings::proxy_min_pixels`](crate::settings::SearchSettings::proxy_min_pixels).
    pub least_pixels: u32,
}

impl Planner<'_> {
    /// In the fragment stage. `proxy`: the surface or envelope whose hull may be drawn; `binned`:
    /// there is a pipeline for bins.
    pub fn fragment(&self, object: &Object, proxy: Option<&OffsetSurface>, binned: bool) -> Work {
        let fits = |surface: &&OffsetSurface| {
            !surface.is_boundary()
                || (self.limits.max_fragment_input_components >= COMPONENTS
                    && self.limits.max_vertex_output_components >= OUTPUTS)
        };
        let copies = object.placements().len();
        proxy
            .filter(|_| copies <= MOST_WRAPPED)
            .filter(fits)
            .and_then(|surface| {
                hulls::frusta(
                    object,
                    surface,
                    self.view,
                    self.least_pixels(object, surface),
                )
            })
            .filter(|(_, cut)| self.clips || !cut)
            .map_or_else(
                || {
                    if binned && copies > 1 && !self.view.parallel {
                        Work::Bins(Shown::default())
                    } else {
                        Work::Box
                    }
                },
                |(frusta, cut)| Work::Hull { frusta, cut },
            )
    }

    /// Pixels that the box covers for each frustum from which on the hull is cheaper. Measured of
    /// single solids drawn by patches; others keep the setting as it is.
    fn least_pixels(&self, object: &Object, surface: &OffsetSurface) -> u32 {
        if self.software && surface.is_boundary() && object.placements().len() == 1 {
            self.least_pixels.saturating_mul(SOFTWARE_FRUSTUM)
        } else {
            self.least_pixels
        }
    }

    /// In compute.
    pub fn compute(
        &self,
        object: &Object,
        proxy: Option<&OffsetSurface>,
        lists: &mut Lists,
    ) -> Work {
        let radius = object.profile.radius;
        let placements = object.placements();
        if let Some(surface) = proxy
            && placements.len() <= MOST_WRAPPED
            && hulls::takes_beams(object, surface, self.view)
        {
            let cut = !hulls::is_whole(object, surface);
            let shown: Vec<(usize, Rectangle)> = placements
                .iter()
                .enumerate()
                .filter_map(|(n, copy)| {
                    Some((n, rectangle(self.view, GROUP_PIXELS, radius, copy)?))
                })
                .collect();
            if shown.is_empty() {
                return Work::Nothing;
            }
            let listed = takes_lists(self.subgroup_size, surface)
                && !placements
                    .iter()
                    .any(|copy| hulls::is_lopsided(radius, copy));
            let tiles = lists.tiles(&shown, placements.len(), listed);
            // Of a solid that is cut, tiles without lists are searched as the rectangle is.
            if (listed || !cut) && self.beams_pay(&shown, &tiles, placements.len(), lists) {
                return lists.beams(tiles, cut);
            }
        }
        match placements {
            [one] => rectangle(self.view, GROUP_PIXELS, radius, one)
                .map_or(Work::Nothing, Work::Rectangle),
            _ => Work::Bins(Shown::default()),
        }
    }

    /// Most words of lists of tiles. All lists stand in one buffer, of which a quarter is for these:
    /// bins need the rest.
    pub fn room(&self) -> u64 {
        u64::from(self.limits.max_storage_buffer_range) / 16
    }

    fn beams_pay(
        &self,
        shown: &[(usize, Rectangle)],
        tiles: &[Tiles],
        copies: usize,
        lists: &Lists,
    ) -> bool {
        // A tile listed is a work group.
        let most = self.limits.max_compute_work_group_count[0];
        let words: u64 = tiles.iter().map(|t| u64::from(t.words())).sum();
        let fits = lists.tiles as u64 + words <= self.room()
            && shown.iter().all(|(_, r)| r.padded() <= most);
        let squares: u64 = shown.iter().map(|(_, r)| r.squares()).sum();
        fits && (copies == 1 || squares >= LEAST_TILES * shown.len() as u64)
    }
}

/// Most copies of an object that are drawn by hulls, or to which beams are sent one by one. Of
/// more, many are small or hidden, and bins leave out those.
const MOST_WRAPPED: usize = 64;

/// Fewer invocations than these, run together, walk a tree faster than they test a list: few of
/// them wait for the slowest, and branches are taken. SwiftShader has 4 and takes twice as long
/// over lists; llvmpipe has 8 and takes two thirds.
const LEAST_SUBGROUP: u32 = 8;

/// What a frustum costs a software driver, over what `proxy_min_pixels` says: its triangles are set
/// up by the processor that shades. Of five solids the box with its tree is as fast at 600 to 800
/// pixels a frustum.
const SOFTWARE_FRUSTUM: u32 = 5;

/// Tiles that each of several copies should cover for a list of its own to pay.
const LEAST_TILES: u64 = 64;

/// What the objects of a frame put into buffers that they share, in compute.
#[derive(Default)]
pub(crate) struct Lists {
    /// Words of the lists that beams fill, behind those of the bins.
    pub tiles: usize,
    /// Blocks of single copies, behind those of the objects.
    pub copies: u32,
}

impl Lists {
    /// Lists of tiles for the copies that show, not counted yet.
    fn tiles(&self, shown: &[(usize, Rectangle)], copies: usize, listed: bool) -> Vec<Tiles> {
        let (mut at, mut block) = (self.tiles as u32, self.copies);
        let of = |&(instance, rectangle): &(usize, Rectangle)| {
            let tiles = Tiles {
                rectangle,
                at,
                block: (copies > 1).then_some(block),
                instance,
                listed,
            };
            at += tiles.words();
            block += 1;
            tiles
        };
        shown.iter().map(of).collect()
    }

    fn beams(&mut self, copies: Vec<Tiles>, cut: bool) -> Work {
        self.tiles += copies.iter().map(|t| t.words() as usize).sum::<usize>();
        self.copies += copies.iter().filter(|t| t.block.is_some()).count() as u32;
        Work::Beams { copies, cut }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What goes through dispatches of one work group for each bin: no more of them than devices
    /// take, no bin left out, and no word of a list another's.
    #[test]
    fn bins_of_one_copy_go_through_dispatches_of_limited_size() {
        for count in [1, 5, MOST_LISTED, MOST_LISTED + 1, 3 * MOST_LISTED - 2] {
            let shown = Shown {
                alone: 7..7 + count,
                lists: 40,
                ..Shown::default()
            };
            let (mut bin, mut word) = (7, 40);
            for (bins, at) in shown.listed() {
                assert_eq!((bins.start, at), (bin, word));
                assert!(!bins.is_empty() && bins.end - bins.start <= 65_535);
                assert!(at % 4 == 0 && listed_tiles(&bins) >= bins.end - bins.start);
                bin = bins.end;
                word += list_words(listed_tiles(&bins));
            }
            assert_eq!((bin, word), (shown.alone.end, 40 + shown.words()));
        }
    }
}
