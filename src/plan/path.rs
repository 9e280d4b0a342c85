//! The choice of each object's draw path from the view, the placements and the surface.

use super::levels::CopyLevels;
use super::projector::Cylinder;
use super::proxy;
use super::view::View;
use crate::scene::Object;
use crate::settings::Tolerance;
use crate::shader::generated::{
    CULLED_PIXELS, GROUP_PIXELS, LONG_LIST, LONGEST_LIST, MIDDLE_LIST, SHORT_LIST, WALK_BIN,
};
use crate::shader::{Kind, Lights, SearchCode, Technique};
use crate::solid::offset_surface::OffsetSurface;
use glam::DVec2;
use std::f64::consts::SQRT_2;
use std::ops::Range;
use std::sync::Arc;

/// The way in which an object is drawn in a frame:
/// [`Renderer::draw_paths`](crate::gpu::Renderer::draw_paths).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DrawPath {
    /// The object is not drawn: the view's mask leaves it out, or no view was planned since it was
    /// added.
    Nothing,
    /// Fragment stage: the shape boxes are rasterised, and fragments search.
    Box,
    /// Fragment stage: cells of the surface are rasterised, and fragments solve their patches.
    Cells,
    /// Rays walk a hierarchy of the copies of many objects: in the compute stage, and in the fragment
    /// stage those of crowds and those that cast shadows.
    Walk,
}

/// Runs of frusta that may be seen: of cells that the box's sides cut, and of whole cells.
pub(super) type CellRuns = [Vec<Range<u32>>; 2];

pub(crate) struct PlanObject<'a> {
    pub object: &'a Object,
    /// Number of its block among all solids.
    pub number: u32,
    /// The number of its first copy among all instances.
    pub first_instance: u32,
    pub technique: Technique,
    /// Identifies a set of textures.
    pub textures: usize,
    /// Number of copies of all objects of this technique and these textures.
    pub look_copies: usize,
    /// The surfaces that its search walks, from the finest level on.
    pub surfaces: &'a [Arc<OffsetSurface>],
    pub levels: Option<&'a CopyLevels>,
    pub shape: Cylinder,
}

/// Inputs of a plan other than view and objects. Each member is one fact; a plan is used again while all
/// are equal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Conditions {
    /// True if compute draws; otherwise fragments do.
    pub compute: bool,
    /// True if the device passes a cell's components from vertices to fragments.
    pub passes_cells: bool,
    /// True if the device is a CPU, on which triangles are expensive.
    pub software: bool,
    pub subgroup_size: u32,
    pub group_invocations: u32,
    pub most_storage: u32,
    /// Same value as
    /// [`SearchSettings::proxy_min_pixels`](crate::settings::SearchSettings::proxy_min_pixels).
    pub least_pixels: u32,
    /// Largest distance of a ray from its pixel's centre, pixels: 0 without rays through samples.
    pub ray_spread: f64,
    /// What the levels of surfaces may be off by.
    pub tolerance: Tolerance,
    /// True if rays are parallel. Nothing walks then.
    pub parallel: bool,
    /// True if cells and lists of patches may replace the tree.
    pub takes_patches: bool,
    pub lights: Lights,
    /// True if shadows are cast: their rays may meet every copy of every object.
    pub casts: bool,
    /// True if depths are compared with the target's and written to it.
    pub host_depths: bool,
    /// True if all objects together, in any view, have one copy: then no pixel is drawn twice.
    pub single_copy: bool,
}

/// Most copies of an object that are drawn by proxies. With more copies, many are small or hidden.
/// On lavapipe 64 copies take 0.8 of the time of a walk by proxies from above, and 1.3 from the side.
/// On an NVIDIA H100 cells took 0.60 to 0.88 of the time of tiles that the CPU found (until c9ef987c)
/// with 64 copies, 0.80 to 1.28 with 256 and 0.93 to 0.97 with 1,024.
pub(crate) const MOST_PROXIES: usize = 64;

/// Subgroup size below which walking a tree is faster than testing a list: fewer invocations wait
/// for the slowest one, and branches are taken. SwiftShader has 4 invocations, and its lists take 1.14
/// of the tree's instructions. Lists on llvmpipe, which has 8, take 0.70 to 0.94.
const LEAST_SUBGROUP: u32 = 8;

/// Factors on `proxy_min_pixels` for software drivers, where one processor sets up triangles and
/// shades. Rows: subgroups of at least [`LEAST_SUBGROUP`], smaller ones, which take three times as
/// long over a tree. Columns: one copy, several. On llvmpipe a single solid takes the same time by
/// cells as by such tiles at 1,650 pixels per frustum; 16 large copies are faster by cells, 32 or 64
/// small ones by tiles. SwiftShader draws a solid equally fast at 340 pixels, extrapolated from
/// solids of 1,205 pixels and more.
const SOFTWARE_FRUSTUM: [[u32; 2]; 2] = [[11, 6], [2, 2]];

/// Least pixels of listed tiles for each patch of a mean object, in units of `proxy_min_pixels`.
/// Lists take 1.3 to 1.4 of the tree's time at 92 pixels for each patch, on lavapipe 22 and 25, 0.94
/// and 0.97 at 250, and 0.68 and 0.71 at 960. At 253 pixels, of 100 copies, they take 1.1 and 0.87.
const LISTED_PIXELS: u64 = 2;

/// Radius of a solid, in heights, from which lists pay with fewer pixels: the tree visits a ray's
/// patches by height. A record of 75 takes 4.5 times as long by the tree on an H100, and 21 times on
/// lavapipe 22; a plate of 10 takes as long as others.
const FLAT: f64 = 32.0;

/// Lengths of lists of patches; tiles with longer lists walk the tree.
pub(crate) const LIST_LENGTHS: [u32; WALK_BIN as usize] =
    [SHORT_LIST, MIDDLE_LIST, LONG_LIST, LONGEST_LIST];

impl Conditions {
    /// The surface of an object that may be drawn by cells, and the least pixels of its box per
    /// frustum at which cells are cheaper. The view may still rule them out.
    fn celled<'a>(&self, of: &PlanObject<'a>) -> Option<(&'a Arc<OffsetSurface>, u32)> {
        let copies = of.object.placements().len();
        let few = copies <= MOST_PROXIES && !self.walks_to(of);
        let surface = of.surface().filter(|_| few && self.passes_cells)?;
        (self.shows_patches(of)).then(|| (surface, self.least_pixels(copies)))
    }

    /// True if rays walk a hierarchy of an object's copies, in any view: all of them in compute.
    /// Fragments draw few copies by proxies, but where shadows are cast, in which a walk shades no
    /// hidden pixel.
    pub fn walks_to(&self, of: &PlanObject) -> bool {
        let many = of.look_copies > MOST_PROXIES;
        let pays = many || (self.casts && !self.single_copy);
        let may = of.surface().is_some() && self.may_walk(&of.technique);
        !self.parallel && (self.compute || pays && may)
    }

    fn may_walk(&self, technique: &Technique) -> bool {
        let patches = technique.search == SearchCode::Quadric;
        !self.parallel && (self.compute || patches && !technique.replicas)
    }

    /// The surface of an object whose path follows from its hull, if the hull is not made yet.
    pub fn lacks_hull(&self, of: &PlanObject, view: &View) -> Option<Arc<OffsetSurface>> {
        let (surface, least) = self.celled(of)?;
        let lacks = surface.hull().is_none() && proxy::may_pay(of.object, surface, view, least);
        lacks.then(|| surface.clone())
    }

    /// The cells of an object in a view; `None` if a walk or boxes draw it.
    pub fn cells(&self, of: &PlanObject, view: &View) -> Option<CellRuns> {
        let (surface, least) = self.celled(of)?;
        proxy::frusta(of.object, surface, view, least)
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
        let lists = self.shows_patches(of) && self.compute && self.lists_patches();
        lists && of.surface().is_some_and(|s| !s.listed().is_empty())
    }

    fn lists_patches(&self) -> bool {
        self.subgroup_size >= LEAST_SUBGROUP
    }

    /// True if work groups may cull the patches of a solid, 256 invocations together. On CPUs they
    /// run one after another, and lists take half of the time.
    pub fn has_wide_groups(&self) -> bool {
        !self.software && self.group_invocations >= CULLED_PIXELS * CULLED_PIXELS
    }

    /// True if pixels may be solved from a few patches. With shadows the search is a small part of
    /// a pixel. Pixels of cells, which are shaded before their depth is tested, take 1.6 to 2.0 of
    /// the time of tiles then, and lists 1.0 to 1.2 of that of the tree.
    fn shows_patches(&self, of: &PlanObject) -> bool {
        let patches = self.takes_patches && of.technique.search == SearchCode::Quadric;
        patches && of.surface().is_some() && !self.casts && of.object.repeat == [1; 3]
    }

    /// True if compute compares depths with those that are drawn already.
    pub fn compares_depths(&self) -> bool {
        self.host_depths || (self.compute && !self.single_copy)
    }

    /// True if so many tiles of objects with so many patches each are drawn faster by lists.
    /// `flat`: true if one of the objects is.
    pub fn gains_by_lists(&self, tiles: u64, patches: u64, flat: impl Fn() -> bool) -> bool {
        let least = LISTED_PIXELS * u64::from(self.least_pixels);
        let least = least.saturating_mul(patches);
        pixels(tiles) >= least && (self.software || self.least_pixels == 0 || flat())
    }

    pub fn room(&self) -> u64 {
        u64::from(self.most_storage) / 4
    }

    /// The kinds of pipelines that may draw a technique, whatever the view, the offsets and the other
    /// objects are. They depend on the technique, the device, and the members `compute`,
    /// `parallel`, `takes_patches` and `casts`.
    pub fn kinds(&self, technique: &Technique) -> Vec<Kind> {
        let patches = technique.search == SearchCode::Quadric && self.takes_patches;
        let patches = patches && technique.is_single() && !self.casts;
        let of_pass = [
            (Kind::Boxes, true),
            (Kind::Walk, self.may_walk(technique)),
            (Kind::Cells, patches && self.passes_cells),
            (Kind::CutCells, patches && self.passes_cells),
        ];
        if !self.compute {
            let taken = of_pass.into_iter().filter(|(_, is)| *is);
            return taken.map(|(kind, _)| kind).collect();
        }
        let mut all = vec![Kind::WalkLists, Kind::WalkTiles];
        if patches && self.lists_patches() {
            all.push(Kind::TileLists);
            all.extend(LIST_LENGTHS.map(Kind::TilePatches));
            if self.has_wide_groups() {
                all.push(Kind::CulledTiles);
            }
        }
        all
    }
}

fn pixels(tiles: u64) -> u64 {
    tiles * u64::from(GROUP_PIXELS * GROUP_PIXELS)
}

impl<'a> PlanObject<'a> {
    pub fn surface(&self) -> Option<&'a Arc<OffsetSurface>> {
        self.surfaces.first()
    }
}

/// True if an object's solid is far wider than high.
pub(crate) fn is_flat(object: &Object) -> bool {
    let bounds = object.profile.outline.bounds();
    bounds.is_some_and(|b| b.r_max > FLAT * (b.z_max - b.z_min))
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
        Cylinder::centred(side * SQRT_2, 0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::profile::Profile;

    #[test]
    fn a_record_is_flat_and_a_plate_is_not() {
        for (radius, flat) in [(75.0, true), (10.0, false)] {
            let points = [[0.0, 0.1], [radius, 0.3], [radius, 0.7], [0.0, 0.9]];
            let disc = Profile::polygon(&points, radius).unwrap_or_else(|e| panic!("{e}"));
            assert_eq!(is_flat(&Object::new("disc", Arc::new(disc))), flat);
        }
    }

    #[test]
    fn gpus_list_patches_for_flat_solids() {
        let with = |software, least_pixels| Conditions {
            software,
            least_pixels,
            ..Conditions::default()
        };
        let [cpu, gpu, any] = [with(true, 150), with(false, 150), with(false, 0)];
        let gains =
            |of: &Conditions, pixels: u64, flat| of.gains_by_lists(pixels / 64, 96, || flat);
        assert!(!gains(&cpu, 25_600, false) && gains(&cpu, 32_000, false));
        assert!(!gains(&gpu, 6_000_000, false));
        assert!(!gains(&gpu, 25_600, true) && gains(&gpu, 32_000, true));
        assert!(gains(&any, 64, false));
    }
}
