//! Crowds: objects with many copies, whose tiles the device lists. The host's part does not grow
//! with the number of copies.
//!
//! The device projects all copies and puts them in ranges of depth. Range by range, the nearest
//! first, it lists the copies in the tiles of 8 x 8 pixels that may show them, and marks the pixels
//! that they are sure to hide from later ranges (hierarchical occlusion maps, Zhang et al. 1997,
//! with proven cover in place of drawn depths). A tile's queue has the order of ranges. Nothing
//! comes from an earlier frame. `crowd.glsl` names the passes and the lists.

use super::tiles::Projector;
use super::{Call, Conditions, FramePlan, Layer, Path, PlanObject, Step, View, projector};
use crate::scene::Placement;
use crate::shader::generated as g;
use crate::shader::{CrowdBlock, CrowdObject, Kind, Pushed, Variant};
use crate::solid::offset_surface::Part;
use crate::surface::CylinderPiece;
use glam::DVec3;

/// The crowds of a frame.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Crowds {
    /// Steps that make the lists, in order. Each waits for the one before.
    pub steps: Vec<Step>,
    pub block: CrowdBlock,
    pub objects: Vec<CrowdObject>,
    /// Their positions among the plan's objects, in the order of their copies.
    pub members: Vec<u32>,
    /// Words of the bins that begin as zero: the first one, and their number.
    pub zeroed: [u32; 2],
    /// Words that tiles and bins need in all.
    pub tile_words: u32,
    pub bin_words: u32,
}

/// Pixels of a tile, and invocations of a work group.
const PIXELS: u32 = g::GROUP_PIXELS * g::GROUP_PIXELS;
/// Entries that are reserved for each tile and layer, and for each copy. A frame that needs more
/// searches all visible copies of a layer in each of its pixels.
const ENTRIES: [u32; 2] = [16, 2];
/// Most copies for which entries are reserved: more of them are small or hidden.
const MOST_RESERVED: u32 = 1 << 19;

/// Adds the crowds of a frame.
pub(super) fn add(
    plan: &mut FramePlan,
    view: &View,
    objects: &[PlanObject],
    (paths, variants): (&[Path], &[Variant]),
    with: &Conditions,
) {
    let members: Vec<u32> = (0u32..)
        .zip(paths)
        .filter(|(_, path)| **path == Path::Crowd)
        .map(|(n, _)| n)
        .collect();
    if members.is_empty() {
        return;
    }
    let [.., kind] = with.crowd_kinds();
    let mut layers = Vec::new();
    let mut layer_of = Vec::with_capacity(members.len());
    for &n in &members {
        let layer = Layer::of(&mut layers, objects, n, (variants[n as usize], kind));
        layer_of.push(layer as u32);
        plan.parts[n as usize][Part::Tables as usize] = true;
        plan.copies[n as usize] = Some(Vec::new());
    }

    let projector = projector(view, objects, with);
    let [across, down] = projector.tiles();
    let counts: Vec<u32> = (members.iter())
        .map(|&n| objects[n as usize].object.placements().len() as u32)
        .collect();
    let lists = layers.len() as u32 * across * down;
    let copies: u32 = counts.iter().sum();
    let places = Places::new(plan, with, lists, copies, layers.len() as u32);

    let mut first = 0;
    let mut records = Vec::with_capacity(members.len());
    for ((&n, &count), &layer) in members.iter().zip(&counts).zip(&layer_of) {
        let of = &objects[n as usize];
        records.push(crowd_object(of, [first, first + count], layer, with));
        first += count;
    }
    add_draws(plan, objects, &layers, &places, with);
    plan.crowds = Some(Crowds {
        steps: list_steps(copies, lists, &places, layers[0].objects[0]),
        block: block(
            view,
            &projector,
            with,
            &places,
            [layers.len(), members.len()].map(|n| n as u32),
            copies,
        ),
        objects: records,
        members,
        zeroed: [places.head, places.of_tiles[3] - places.head],
        tile_words: places.tile_words,
        bin_words: places.bin_words,
    });
}

/// Adds the steps that draw the crowds of each layer.
fn add_draws(
    plan: &mut FramePlan,
    objects: &[PlanObject],
    layers: &[Layer],
    places: &Places,
    with: &Conditions,
) {
    let [.., kind] = with.crowd_kinds();
    let call_of = |layer: u32| {
        let command = places.head + g::CROWD_HEAD + g::LAYER_HEAD * layer;
        if with.compute {
            let of = &objects[layers[layer as usize].objects[0] as usize];
            Call::Indirect(
                command,
                Pushed {
                    records: places.records + 3 * PIXELS * layer * places.tiles,
                    heads: command + LAYER_RECORDS,
                    object: of.number,
                    instance: of.first_instance,
                    ..Pushed::default()
                },
            )
        } else {
            Call::IndirectTiles(command)
        }
    };
    let first_phase = plan.steps.last().map_or(2, |step| step.phase.max(1) + 1);
    for (n, layer) in (0u32..).zip(layers) {
        plan.steps.push(Step {
            phase: if with.compute { first_phase + n } else { 0 },
            variant: layer.variant.of_kind(kind),
            kind,
            object: layer.objects[0],
            call: call_of(n),
        });
    }
}

/// First words of the lists.
struct Places {
    /// Tiles of the picture.
    tiles: u32,
    entries_most: u32,
    // Bins.
    head: u32,
    cover: u32,
    /// Of each tile of each layer: number of entries, nearest depth, marked pixels, first place.
    of_tiles: [u32; 4],
    /// Copies in the picture, their order, listed copies; entries.
    copies: [u32; 4],
    bin_words: u32,
    // Tiles.
    records: u32,
    listed: u32,
    queues: u32,
    tile_words: u32,
}

impl Places {
    fn new(plan: &FramePlan, with: &Conditions, lists: u32, copies: u32, layers: u32) -> Self {
        let tiles = lists / layers;
        let wanted = ENTRIES[0] * lists + ENTRIES[1] * copies.min(MOST_RESERVED);
        let entries_most = wanted.min((with.room() / 8) as u32);
        let places = |mut next: u32| {
            move |words: u32| {
                let first = next;
                next += words;
                first
            }
        };
        let mut bins = places(plan.bin_words);
        // Records have four words each, from the first word on.
        let mut words = places((plan.words.len() as u32).next_multiple_of(4));
        Self {
            tiles,
            entries_most,
            head: bins(g::CROWD_HEAD + g::LAYER_HEAD * layers),
            cover: bins(g::GROUP_PIXELS * tiles),
            of_tiles: [lists, lists, 2 * lists, lists].map(&mut bins),
            copies: [
                g::VISIBLE_WORDS * copies,
                copies,
                copies,
                g::ENTRY_WORDS * entries_most,
            ]
            .map(&mut bins),
            bin_words: bins(0),
            records: words(if with.compute { 3 * PIXELS } else { 4 } * lists),
            listed: words(g::QUEUE_WORDS * copies.next_multiple_of(g::QUEUE_BLOCK)),
            // The queue of each tile begins with a new block.
            queues: words(g::QUEUE_WORDS * (entries_most + (g::QUEUE_BLOCK - 1) * lists)),
            tile_words: words(0),
        }
    }
}

/// The passes that list the copies.
fn list_steps(copies: u32, lists: u32, places: &Places, object: u32) -> Vec<Step> {
    let step = |kind, call| Step {
        phase: 0,
        variant: Variant::LISTS,
        kind,
        object,
        call,
    };
    let pass = |bin| Pushed {
        bin,
        ..Pushed::default()
    };
    let of = |kind, count: u32, bin| {
        let groups = count.div_ceil(PIXELS);
        let across = g::GROUPS_ACROSS;
        let wide = [groups.min(across), groups.div_ceil(across), 1];
        step(kind, Call::Groups(wide, pass(bin)))
    };
    let over = |kind, list: u32, bin| step(kind, Call::Indirect(places.head + list, pass(bin)));
    let mut steps = vec![
        of(Kind::CrowdCopies, copies, g::COPY_BOUNDS),
        of(Kind::CrowdOrder, 1, g::ORDER_RANGES),
        over(Kind::CrowdOrder, VISIBLE, g::ORDER_COPIES),
    ];
    let range = |n| over(Kind::CrowdTiles, RANGES + 4 * n, n);
    steps.extend((0..g::CROWD_RANGES).map(range));
    steps.extend([
        over(Kind::CrowdCopies, LISTED, g::COPY_RECORDS),
        of(Kind::CrowdOrder, 1, g::ORDER_TILES),
        of(Kind::CrowdOrder, lists, g::ORDER_RECORDS),
        over(Kind::CrowdOrder, ENTRIES_LIST, g::ORDER_ENTRIES),
    ]);
    steps
}

fn crowd_object(
    of: &PlanObject,
    [first, end]: [u32; 2],
    layer: u32,
    with: &Conditions,
) -> CrowdObject {
    let shape = of.shape;
    let surface = of.surface().filter(|_| with.occlusion_culling);
    let whole = [CylinderPiece {
        radius: shape.radius,
        low: shape.low,
        high: shape.high,
    }];
    let rows = MIDDLE_ROWS;
    let outer = surface.and_then(|s| s.outer()).map(|outer| outer.of(rows));
    let outer = outer.filter(|o| o.len() <= g::CROWD_PIECES as usize);
    let outer = outer.unwrap_or(&whole);
    let inner = surface.and_then(|s| s.inner()).map(|inner| inner.of(rows));
    let inner = inner.unwrap_or_default();
    let packed = |pieces: &[CylinderPiece]| {
        let mut all = [[0.0f32; 4]; g::CROWD_PIECES as usize];
        for (to, piece) in all.iter_mut().zip(pieces) {
            *to = [piece.radius, piece.low, piece.high, 0.0].map(|v| v as f32);
        }
        all
    };
    let [x, y] = [shape.axis.x, shape.axis.y].map(words_of);
    // Without levels every copy has the finest one.
    let (limits, finest) = of
        .levels
        .map_or(([f32::INFINITY; 4], 0), |of| (of.limits, of.first as u32));
    CrowdObject {
        axis: [x[0], x[1], y[0], y[1]],
        shape: [
            shape.axis.x as f32,
            shape.axis.y as f32,
            shape.radius as f32,
            0.0,
        ],
        heights: [shape.low as f32, shape.high as f32, 0.0, 0.0],
        copies: [first, end, of.first_instance, of.number],
        pieces: [
            layer,
            outer.len() as u32,
            inner.len().min(g::CROWD_PIECES as usize) as u32,
            finest,
        ],
        limits,
        outer: packed(outer),
        inner: packed(inner),
    }
}

/// The words of a double in GLSL.
fn words_of(value: f64) -> [u32; 2] {
    let bits = value.to_bits();
    [bits as u32, (bits >> 32) as u32]
}

/// A placement in the layout of `crowd_copies.comp`.
pub(crate) fn placement_words(placement: &Placement) -> [[u32; 2]; 10] {
    let (p, q, s) = (
        placement.position,
        placement.rotation.normalize(),
        placement.scale,
    );
    [p.x, p.y, p.z, q.x, q.y, q.z, q.w, s.x, s.y, s.z].map(words_of)
}

/// Word of a layer's number of records after its command: `crowd.glsl`.
const LAYER_RECORDS: u32 = 4;
/// First words of the lists in the head: `crowd.glsl`.
const VISIBLE: u32 = 0;
const LISTED: u32 = 4;
const ENTRIES_LIST: u32 = 8;
const RANGES: u32 = 12;

/// Rows of pixels for which cylinders are chosen: the middle one of three numbers of cylinders.
const MIDDLE_ROWS: u32 = 32;

fn block(
    view: &View,
    projector: &Projector,
    with: &Conditions,
    places: &Places,
    [layers, objects]: [u32; 2],
    copies: u32,
) -> CrowdBlock {
    let doubles = |v: DVec3| {
        let [[a, b], [c, d], [e, f]] = v.to_array().map(words_of);
        [a, b, c, d, e, f, 0, 0]
    };
    let [clip_x, clip_y] = view.clip_rows();
    let ([row_x, row_y, row_z], limits) = projector.for_crowds();
    let [across, down] = projector.tiles();
    CrowdBlock {
        eye: doubles(view.eye),
        forward: doubles(view.forward),
        dir_00: doubles(view.dir_00),
        clip_x: doubles(clip_x),
        clip_y: doubles(clip_y),
        row_x,
        row_y,
        row_z,
        limits,
        picture: projector.picture(),
        size: [across, down, layers, objects],
        counts: [copies, places.entries_most, places.head, places.cover],
        lists: places.of_tiles,
        copies: places.copies,
        tiles: [
            places.records,
            places.listed,
            places.queues,
            u32::from(with.compute),
        ],
        steps: [
            (view.near as f32).to_bits() >> g::CROWD_STEP_SHIFT,
            (across * down).div_ceil(g::MOST_GROUPS),
            0,
            0,
        ],
        objects_of: [],
    }
}
