//! The choice of each object's draw path from the view, the placements and the surface.

use super::levels::CopyLevels;
use super::proxy;
use super::tiles::Cylinder;
use super::view::View;
use crate::scene::Object;
use crate::shader::generated::{
    GROUP_PIXELS, LONG_LIST, LONGEST_LIST, MIDDLE_LIST, SHORT_LIST, TREE_BIN,
};
use crate::shader::{Kind, Search, Variant};
use crate::solid::cache::Solid;
use crate::solid::offset_surface::OffsetSurface;
use glam::DVec2;
use std::f64::consts::SQRT_2;
use std::ops::Range;
use std::sync::Arc;

/// The way in which an object is drawn in a frame:
/// [`Renderer::draw_paths`](crate::gpu::Renderer::draw_paths).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DrawPath {
    /// The object is not drawn, because it is outside of the picture, behind the eye or hidden.
    /// Objects drawn by proxies never take this path: the rasteriser determines their visibility.
    Nothing,
    /// Fragment stage: the shape boxes are rasterised, and fragments search.
    Box,
    /// Fragment stage: cells of the surface are rasterised, and fragments solve their patches.
    Cells,
    /// Tiles of the screen that may show its copies are drawn. The fragment stage uses tiles for
    /// several copies and for single objects without cells, the compute stage for everything.
    Tiles,
}

/// A draw path with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Path {
    Box,
    /// Runs of frusta that may be seen: of cells that the box's sides cut, and of whole cells.
    Cells([Vec<Range<u32>>; 2]),
    Tiles,
}

/// One object, as input of a plan.
pub(crate) struct PlanObject<'a> {
    pub object: &'a Object,
    /// Number of its block among all solids.
    pub number: u32,
    /// The number of its first copy among all instances.
    pub first_instance: u32,
    pub variant: Variant,
    /// Identifies a set of textures.
    pub textures: usize,
    /// The surfaces that its search walks, from the finest level on.
    pub surfaces: &'a [Arc<OffsetSurface>],
    /// True if cells and lists may replace the tree.
    pub takes_patches: bool,
    /// The choice of each copy's level, if copies have levels of their own.
    pub levels: Option<&'a CopyLevels>,
    pub shape: Cylinder,
    /// The outline, and the largest distance of the surface from it in object units.
    pub outline: Option<(&'a Solid, f64)>,
}

/// Inputs of a plan other than view and objects.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Conditions {
    /// True if tiles are traced in compute; otherwise fragments draw proxies and tiles.
    pub compute: bool,
    /// True if the device passes a cell's components from vertices to fragments.
    pub passes_cells: bool,
    /// True if the device is a CPU, on which triangles are expensive.
    pub software: bool,
    /// Invocations of a subgroup, which run together.
    pub subgroup_size: u32,
    /// Most bytes in a storage buffer.
    pub most_storage: u32,
    /// Most vectors of one solid's tables that a uniform buffer holds.
    pub own_vectors: usize,
    /// Same value as
    /// [`SearchSettings::proxy_min_pixels`](crate::settings::SearchSettings::proxy_min_pixels).
    pub least_pixels: u32,
    /// Same value as
    /// [`SearchSettings::occlusion_culling`](crate::settings::SearchSettings::occlusion_culling).
    pub occlusion_culling: bool,
    /// Largest distance of a ray from its pixel's centre, pixels: 0 without rays through samples.
    pub ray_spread: f64,
    /// Largest distance of a copy's surface on the screen from the finest level, pixels.
    pub level_pixels: f64,
    /// True if shadows are cast: their rays may meet every copy of every object.
    pub casts: bool,
    /// True if depths are compared with the target's and written to it.
    pub host_depths: bool,
    /// True if all objects together, in any view, have one copy: then no pixel is drawn twice.
    pub single_copy: bool,
}

/// Most copies of an object that are drawn by cells. With more copies, many are small or hidden,
/// and tiles skip those.
pub(crate) const MOST_PROXIES: usize = 64;

/// Subgroup size below which walking a tree is faster than testing a list: fewer invocations wait
/// for the slowest one, and branches are taken. SwiftShader has 4 invocations, and its lists take 1.14
/// of the tree's instructions. Lists on llvmpipe, which has 8, take 0.70 to 0.94.
const LEAST_SUBGROUP: u32 = 8;

/// Factors on `proxy_min_pixels` for software drivers, where one processor sets up triangles and
/// shades. Rows: subgroups of at least [`LEAST_SUBGROUP`], smaller ones, which take three times as
/// long over a tree. Columns: one copy, several. On llvmpipe a single solid takes the same time by
/// cells as by tiles at 1,650 pixels per frustum; 16 large copies are faster by cells, 32 or 64
/// small ones by tiles. SwiftShader draws a solid equally fast at 340 pixels, extrapolated from
/// solids of 1,205 pixels and more.
const SOFTWARE_FRUSTUM: [[u32; 2]; 2] = [[11, 6], [2, 2]];

/// Least pixels of listed tiles for each patch of a mean object, in units of `proxy_min_pixels`.
/// Lists take 1.3 to 1.4 of the tree's time at 92 pixels for each patch, on lavapipe 22 and 25, 0.94
/// and 0.97 at 250, and 0.68 and 0.71 at 960. At 253 pixels, of 100 copies, they take 1.1 and 0.87.
const LISTED_PIXELS: u64 = 2;

/// Lengths of lists of patches; tiles with longer lists walk the tree.
pub(crate) const LIST_LENGTHS: [u32; TREE_BIN as usize] =
    [SHORT_LIST, MIDDLE_LIST, LONG_LIST, LONGEST_LIST];

impl Conditions {
    /// True if an object may be drawn by cells. The view may still rule that out.
    fn takes_cells(&self, of: &PlanObject) -> bool {
        let few = of.object.placements().len() <= MOST_PROXIES;
        self.shows_patches(of) && !self.compute && self.passes_cells && few
    }

    /// True if an object may be drawn by tiles. The box is as good as tiles for one copy whose
    /// outline is not used.
    fn takes_tiles(&self, of: &PlanObject) -> bool {
        let pays = of.object.placements().len() > 1 || self.uses_outline(of);
        self.compute || (of.variant.is_shaded() && pays)
    }

    /// True if fragments may search the queues of an object's tiles: it has the library's patches, no
    /// replicas and no shadows.
    pub fn takes_queues(of: &PlanObject) -> bool {
        of.variant.search == Search::Quadric && of.variant.is_single()
    }

    /// The path of an object in a view: cells, else tiles, else boxes.
    pub fn choose(&self, of: &PlanObject, view: &View) -> Path {
        let surface = of.surface().filter(|_| self.takes_cells(of));
        let cells = surface.and_then(|surface| {
            let least = self.least_pixels(of.object.placements().len());
            proxy::frusta(of.object, surface, view, least)
        });
        match cells {
            Some(frusta) => Path::Cells(frusta),
            _ if self.takes_tiles(of) && !view.parallel && !self.prefers_box(of) => Path::Tiles,
            _ => Path::Box,
        }
    }

    /// True if a box is faster than tiles: for one copy of a solid that fills its box.
    fn prefers_box(&self, of: &PlanObject) -> bool {
        let fills = |s: &Arc<OffsetSurface>| proxy::fills_box(of.object, s);
        !self.compute && of.object.placements().len() == 1 && of.surface().is_some_and(fills)
    }

    /// Whether tiles beside an object's outline are left out. Searches for comparison search all of
    /// the box, as published.
    pub fn uses_outline(&self, of: &PlanObject) -> bool {
        self.occlusion_culling && of.variant.search != Search::External
    }

    /// Least pixels of the box per frustum at which cells are cheaper.
    fn least_pixels(&self, copies: usize) -> u32 {
        let small = self.subgroup_size < LEAST_SUBGROUP;
        let factor = match self.software {
            true => SOFTWARE_FRUSTUM[usize::from(small)][usize::from(copies > 1)],
            false => 1,
        };
        self.least_pixels.saturating_mul(factor)
    }

    /// True if patches may be listed for tiles of an object.
    pub fn permits_lists(&self, of: &PlanObject) -> bool {
        self.may_permit_lists(of) && of.surface().is_some_and(|s| !s.listed().is_empty())
    }

    /// True if patches may be listed for tiles of an object under some offset.
    fn may_permit_lists(&self, of: &PlanObject) -> bool {
        self.shows_patches(of) && self.compute && self.subgroup_size >= LEAST_SUBGROUP
    }

    /// True if pixels may be solved from a few patches. With shadows the search is a small part of
    /// a pixel. Pixels of cells, which are shaded before their depth is tested, take 1.6 to 2.0 of
    /// the time of tiles then, and lists 1.0 to 1.2 of that of the tree.
    fn shows_patches(&self, of: &PlanObject) -> bool {
        of.takes_patches && !self.casts && of.object.repeat == [1; 3]
    }

    /// True if compute compares depths with those that are drawn already.
    pub fn compares_depths(&self) -> bool {
        self.host_depths || (self.compute && !self.single_copy)
    }

    /// True if so many tiles of objects with so many patches each are drawn faster by lists.
    pub fn gains_by_lists(&self, tiles: u64, patches: u64) -> bool {
        let least = LISTED_PIXELS * u64::from(self.least_pixels);
        pixels(tiles) >= least.saturating_mul(patches)
    }

    /// Most words that lists of tiles may take.
    pub fn room(&self) -> u64 {
        u64::from(self.most_storage) / 16
    }

    /// True if a uniform buffer holds an object's tables.
    pub fn holds_tables(&self, of: &PlanObject) -> bool {
        of.surface()
            .is_some_and(|surface| surface.tables().vectors.len() <= self.own_vectors)
    }

    /// Every pipeline that an object may need while parameters, lights, camera and placements
    /// change: the pipelines of all its paths. `variant`: the result of
    /// [`variants`](super::variants) for the object.
    pub fn reachable(&self, of: &PlanObject, variant: Variant) -> Vec<(Variant, Kind)> {
        let mut kinds: Vec<(Kind, &[u32])> = Vec::new();
        let may_cut = proxy::may_be_cut(of.object);
        let outside: &[u32] = if may_cut { &[0, 1] } else { &[1] };
        if self.takes_cells(of) {
            kinds.push((Kind::Cells, outside));
        }
        let takes_tiles = self.takes_tiles(of);
        if takes_tiles && !self.compute {
            kinds.push((Kind::Quads, &[0, 1]));
            if Self::takes_queues(of) && variant.one_instance == 0 {
                kinds.push((Kind::Tiles, &[0, 1]));
            }
        } else if takes_tiles {
            if self.may_permit_lists(of) {
                kinds.extend([(Kind::TileLists, outside), (Kind::TilePatches, outside)]);
            }
            kinds.push((Kind::TileTree, &[0, 1]));
            if !self.single_copy {
                kinds.push((Kind::TileCopies, &[0, 1]));
            }
        }
        if !self.compute {
            kinds.push((Kind::Boxes, &[0, 1]));
        }
        let counts: &[u32] = if self.casts { &[3] } else { &[1, 2, 3] };
        // An offset may move the size of the tables across the limit, and levels may lie apart.
        let large =
            (of.surface()).is_some_and(|s| 4 * s.tables().vectors.len() > 3 * self.own_vectors);
        let large = large || of.levels.is_some();
        let own: &[u32] = match (variant.one_object == 0, large) {
            (true, _) => &[0],
            (false, false) => &[1],
            (false, true) => &[0, 1],
        };
        type Axis<'a> = (&'a [u32], fn(&mut Variant) -> &mut u32);
        let axes: [Axis; 3] = [
            (counts, |v| &mut v.lights),
            (own, |v| &mut v.own_tables),
            (&LIST_LENGTHS, |v| &mut v.list_length),
        ];
        let along = |all: Vec<Variant>, (values, member): Axis| -> Vec<Variant> {
            let with = |mut v: Variant, value| {
                *member(&mut v) = value;
                v
            };
            let of = |v| values.iter().map(move |&value| with(v, value));
            all.into_iter().flat_map(of).collect()
        };
        let mut all = Vec::new();
        for (kind, outside) in kinds {
            let first: Axis = (outside, |v| &mut v.outside);
            for v in [first].into_iter().chain(axes).fold(variant.forms(), along) {
                let key = (v.of_kind(kind), kind);
                if !all.contains(&key) {
                    all.push(key);
                }
            }
        }
        all
    }
}

/// Pixels of so many tiles.
fn pixels(tiles: u64) -> u64 {
    tiles * u64::from(GROUP_PIXELS * GROUP_PIXELS)
}

impl<'a> PlanObject<'a> {
    /// The surface of the finest level.
    pub fn surface(&self) -> Option<&'a Arc<OffsetSurface>> {
        self.surfaces.first()
    }

    /// Number of patches that lists of its tiles are made from: those of the second level if its
    /// copies have levels of their own, as few have the finest.
    pub fn listed_patches(&self) -> u64 {
        let surface = self.surfaces.iter().take(2).next_back();
        surface.map_or(0, |surface| surface.patches() as u64)
    }

    /// True if the box shows no more than the surface's patches.
    pub fn is_whole(&self) -> bool {
        self.surface()
            .is_some_and(|surface| proxy::is_whole(self.object, surface))
    }
}

/// The part of an object's box that can be solid. `bounds`: half of the box's side, then the clip
/// cylinder's radius, lowest `z` and highest `z`.
pub(crate) fn shape_of(object: &Object, bounds: [f64; 4]) -> Cylinder {
    let [side, radius, low, high] = bounds;
    if object.repeat == [1; 3] {
        Cylinder {
            axis: DVec2::from(object.axis_offset()),
            radius,
            low,
            high,
        }
    } else {
        Cylinder {
            axis: DVec2::ZERO,
            radius: side * SQRT_2,
            low: 0.0,
            high: 1.0,
        }
    }
}
