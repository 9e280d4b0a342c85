//! Rust and GLSL agree on shared bytes: block layouts, specialisation constants, the
//! catalogue of modules, and the stored SPIR-V for builds without shaderc.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::profile::Profile;
use crate::scene::{Lighting, Object};
use crate::search::unpacked;
use crate::settings::{Planes, SearchSettings, Solver};
use crate::shader::catalogue::{Entry, Features, Output, modules};
use crate::shader::{
    CasterNode, CrowdBlock, CrowdObject, FrameBlock, HostLook, InstanceBlock, Kind, LightBlock,
    Module, OBJECT_STRIDE, ObjectBlock, ShadowCasters, Variant, depth_less, generated as g, words,
};
use crate::surface::{ROWS, Tables};
use std::collections::{BTreeMap, BTreeSet};
use std::mem::{offset_of, size_of};
use std::sync::Arc;

/// The number of modules; nine of them list and draw crowds.
const MODULES: usize = 82;

/// Opcodes and decorations of the SPIR-V specification that these tests read.
pub(crate) mod op {
    pub const NAME: u32 = 5;
    pub const MEMBER_NAME: u32 = 6;
    pub const DECORATE: u32 = 71;
    pub const MEMBER_DECORATE: u32 = 72;
    pub const SPEC_ID: u32 = 1;
    pub const OFFSET: u32 = 35;
}

pub(crate) fn instructions(words: &[u32]) -> Vec<(u32, &[u32])> {
    let mut all = Vec::new();
    let mut rest = &words[5..];
    while let Some(first) = rest.first() {
        let (this, next) = rest.split_at((first >> 16) as usize);
        all.push((first & 0xffff, &this[1..]));
        rest = next;
    }
    all
}

fn text(words: &[u32]) -> String {
    let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
    let end = bytes.iter().position(|b| *b == 0).unwrap();
    String::from_utf8(bytes[..end].to_vec()).unwrap()
}

/// Offsets of the members of the struct called `name`, by member.
fn offsets(words: &[u32], name: &str) -> BTreeMap<String, u32> {
    let all = instructions(words);
    let id = all
        .iter()
        .filter(|(code, w)| *code == op::NAME && text(&w[1..]) == name)
        .map(|(_, w)| w[0])
        // A struct used both in a block and outside is two types. The type with offsets is the one
        // to read.
        .find(|id| {
            all.iter()
                .any(|(code, w)| *code == op::MEMBER_DECORATE && w[0] == *id && w[2] == op::OFFSET)
        })
        .unwrap_or_else(|| panic!("no struct {name}"));
    let names: BTreeMap<u32, String> = all
        .iter()
        .filter(|(code, w)| *code == op::MEMBER_NAME && w[0] == id)
        .map(|(_, w)| (w[1], text(&w[2..])))
        .collect();
    all.iter()
        .filter(|(code, w)| *code == op::MEMBER_DECORATE && w[0] == id && w[2] == op::OFFSET)
        .map(|(_, w)| (names[&w[1]].clone(), w[3]))
        .collect()
}

/// Words of a module that keeps its names.
fn layouts(file: &str) -> Vec<u32> {
    unpacked(&std::fs::read(kept_file(file)).unwrap()).unwrap()
}

macro_rules! assert_layout {
    ($words:expr, $name:literal, $block:ty { $($field:ident),+ $(,)? }) => {
        let rust: BTreeMap<String, u32> = [$((
            stringify!($field).to_owned(),
            u32::try_from(offset_of!($block, $field)).unwrap(),
        )),+].into();
        assert_eq!(offsets($words, $name), rust, $name);
    };
}

#[test]
fn blocks_have_the_same_layout_in_rust_and_glsl() {
    let crowds = &layouts("crowd_layouts.spv.z");
    assert_layout!(
        crowds,
        "CrowdObject",
        CrowdObject {
            axis,
            shape,
            heights,
            copies,
            pieces,
            limits,
            levels,
            outer,
            inner
        }
    );
    assert_layout!(
        crowds,
        "CrowdBlock",
        CrowdBlock {
            eye,
            forward,
            dir_00,
            clip_x,
            clip_y,
            row_x,
            row_y,
            row_z,
            limits,
            picture,
            size,
            counts,
            lists,
            copies,
            tiles,
            steps,
            objects_of
        }
    );
    let words = &layouts("layouts.spv.z");
    assert_layout!(
        words,
        "Frame",
        FrameBlock {
            clip_x,
            clip_y,
            dir_00,
            dir_x,
            dir_y,
            forward,
            ambient,
            size,
            pixels,
            caster_eye,
            caster_middle,
            caster_half_size,
            view,
            lights
        }
    );
    assert_layout!(words, "Light", LightBlock { towards, color });
    assert_layout!(
        words,
        "Object",
        ObjectBlock {
            map,
            bounds,
            offset,
            axis,
            albedo,
            specular,
            texturing,
            cells,
            instances,
            patches,
            parts
        }
    );
    assert_layout!(
        words,
        "CasterNode",
        CasterNode {
            middle,
            next,
            half_size,
            instance
        }
    );
    assert_layout!(
        words,
        "Instance",
        InstanceBlock {
            position_sx,
            rotation,
            scale_depth,
            origin,
            object
        }
    );
    assert_eq!(size_of::<InstanceBlock>(), 80);
    assert!(size_of::<ObjectBlock>() <= OBJECT_STRIDE as usize);
}

/// The comparison must fail when a member moves.
#[test]
#[should_panic(expected = "failed: Light")]
fn a_moved_member_is_noticed() {
    #[repr(C)]
    struct Moved {
        color: [f32; 4],
        towards: [f32; 4],
    }
    assert_layout!(&layouts("layouts.spv.z"), "Light", Moved { color, towards });
}

fn any(solver: Solver, planes: Planes) -> Variant {
    let profile = Profile::polygon(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.5).unwrap();
    let object = Object::new("any", Arc::new(profile));
    let settings = SearchSettings {
        solver,
        ..SearchSettings::exact()
    };
    let lighting = Lighting::default();
    Variant::new(
        &settings,
        planes,
        solver,
        &lighting,
        &object,
        ShadowCasters::default(),
        HostLook::default(),
    )
}

/// Identifiers of the specialisation constants that a module reads.
fn constants_of(words: &[u32]) -> BTreeSet<u32> {
    instructions(words)
        .iter()
        .filter(|(code, w)| *code == op::DECORATE && w[1] == op::SPEC_ID)
        .map(|(_, w)| w[2])
        .collect()
}

#[test]
fn a_variant_sets_every_specialisation_constant() {
    let set: BTreeSet<u32> = any(Solver::Exact, Planes::Color)
        .constants()
        .iter()
        .map(|(id, _)| *id)
        // Constants of the device and of the pass.
        .chain([g::OWN_VECTORS_ID, g::LARGE_POINTS_ID, g::FETCHED_CELLS_ID])
        .chain([g::VIEWS_ID, g::VIEW_INDEX_ID])
        .chain([g::SLOPE_BIAS_ID, g::SLOPE_BIAS_LIMIT_ID])
        .collect();
    let mut all = BTreeSet::new();
    for module in modules() {
        let used = constants_of(&words(&module).unwrap());
        assert!(used.is_subset(&set), "{}: {used:?}", module.name());
        all.extend(used);
    }
    // Searches of other crates read these.
    all.extend([g::SEARCH_FORM_ID, g::KNOWN_STEPS_ID]);
    assert_eq!(all, set);
}

fn kept_file(name: &str) -> String {
    format!("{}/shaders-spirv/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// The catalogue of modules is finite and of known length, so that any growth is visible.
#[test]
fn modules_are_few_and_small() {
    let all = modules();
    let names: BTreeSet<String> = all.iter().map(Module::name).collect();
    assert_eq!(names.len(), all.len());
    assert_eq!(all.len(), MODULES);
    let mut packed = 0;
    for module in &all {
        let bytes = 4 * words(module).unwrap().len();
        let most = match (module.entry, module.features, module.output) {
            // Traces twice, from the eye and towards lights, walks the hierarchy of casters, and
            // SPIR-V's optimiser inlines every call.
            (_, Features::Full, _) => 78_900,
            // Copies may also come from queues of the device.
            (Entry::TileCopies | Entry::Tiles, Features::Textured, _) => 43_000,
            // Tiles share an instance, and `live` has both forms of its steps.
            (_, Features::Textured, _) => 40_000,
            (Entry::Tree | Entry::Cells, Features::Plain, Output::Color) => 26_600,
            // Tiles of several copies read a solid for each copy.
            (Entry::TileCopies | Entry::Tiles, Features::Plain, _) => 37_900,
            _ => 33_200,
        };
        assert!(bytes <= most, "{}: {bytes} bytes", module.name());
        packed += std::fs::metadata(kept_file(&format!("{}.spv.z", module.name())))
            .unwrap()
            .len();
    }
    assert!(packed < 1_000_000, "{packed} bytes in all");
}

/// Locations of a module's inputs or outputs, by the SPIR-V number of the storage class.
fn locations(words: &[u32], class: u32) -> BTreeSet<u32> {
    const VARIABLE: u32 = 59;
    const LOCATION: u32 = 30;
    let all = instructions(words);
    let of_class: BTreeSet<u32> = all
        .iter()
        .filter(|(code, w)| *code == VARIABLE && w[2] == class)
        .map(|(_, w)| w[1])
        .collect();
    all.iter()
        .filter(|(code, w)| *code == op::DECORATE && w[1] == LOCATION && of_class.contains(&w[0]))
        .map(|(_, w)| w[2])
        .collect()
}

/// Vertices pass the inputs of their fragments and no more: validation layers report extra outputs.
#[test]
fn vertices_pass_what_fragments_read() {
    let mut count = 0;
    for module in modules() {
        let entries: &[Entry] = match module.entry {
            Entry::Tree if matches!(module.output, Output::Depth | Output::DepthOrtho) => {
                &[Entry::BoxVertex]
            }
            Entry::Tree => &[Entry::BoxVertex, Entry::QuadVertex],
            Entry::Tiles => &[Entry::TileVertex],
            Entry::Cells => &[Entry::CellVertex],
            _ => &[],
        };
        let taken = locations(&words(&module).unwrap(), 1);
        for &entry in entries {
            let vertices = words(&module.vertices(entry)).unwrap();
            assert_eq!(locations(&vertices, 3), taken, "{}", module.name());
            count += 1;
        }
    }
    assert!(count > 20);
}

/// Every pipeline that can be drawn with has its modules.
#[test]
fn reachable_variants_have_modules() {
    let kinds = [
        Kind::Cells,
        Kind::Boxes,
        Kind::Quads,
        Kind::Tiles,
        Kind::TileLists,
        Kind::TilePatches,
        Kind::TileTree,
        Kind::TileCopies,
    ];
    for planes in [Planes::Color, Planes::All] {
        for solver in Solver::ALL {
            let patches = matches!(solver, Solver::Exact);
            let has = |k: &Kind| patches || (k.walks() && *k != Kind::Tiles);
            for kind in kinds.into_iter().filter(has) {
                for outside in [0, 1] {
                    let variant = Variant {
                        outside,
                        ..any(solver, planes)
                    };
                    assert!(words(&variant.module(kind)).is_some(), "{variant:?}");
                    assert!(variant.vertices(kind).is_none_or(|v| words(&v).is_some()));
                }
            }
        }
    }
}

/// Fragments that set a depth declare its side of their triangle; for reversed depth, the other
/// side.
#[test]
fn depth_is_promised_greater_or_less() {
    const EXECUTION_MODE: u32 = 16;
    let promises = |words: &[u32]| -> Vec<u32> {
        instructions(words)
            .iter()
            .filter(|(code, _)| *code == EXECUTION_MODE)
            .map(|(_, w)| w[1])
            .filter(|mode| [14, 15].contains(mode))
            .collect()
    };
    let hull = any(Solver::Exact, Planes::Color);
    let hull = words(&hull.module(Kind::Cells)).unwrap();
    let less = depth_less(&hull);
    assert_eq!(promises(&hull), [14]);
    assert_eq!(promises(&less), [15]);
    let differing = hull.iter().zip(&less).filter(|(a, b)| a != b).count();
    assert_eq!((hull.len(), differing), (less.len(), 1));
}

/// The tree over the rows of tables has the size that searches assume.
#[test]
fn tables_have_the_rows_and_nodes_of_the_shaders() {
    let tables = Tables::new(&[], ROWS);
    assert_eq!(ROWS, g::PATCH_ROWS);
    assert_eq!(tables.nodes.len(), g::PATCH_NODES as usize);
}

/// The stored SPIR-V comes from the present sources. The words are equal if the same compiler is
/// available here.
#[test]
fn kept_spirv_is_what_the_sources_give() {
    let kept = |name: &str| {
        let path = kept_file(name);
        std::fs::read(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
    };
    let kept_hashes = String::from_utf8(kept("sources.fnv")).unwrap();
    let hashes: Vec<&str> = kept_hashes.lines().collect();
    let same_compiler = hashes[1] == format!("{:#018x}", g::COMPILER_HASH);
    assert_eq!(
        hashes[0],
        format!("{:#018x}", g::SOURCES_HASH),
        "shaders-glsl/ changed; renew shaders-spirv/ with REVMAP_KEEP_SPIRV=1 cargo build"
    );
    if same_compiler {
        for module in modules() {
            let name = module.name();
            let compiled = words(&module).unwrap();
            let kept = unpacked(&kept(&format!("{name}.spv.z"))).unwrap();
            assert!(
                kept == compiled,
                "{name}: kept words differ from the compiled"
            );
        }
    }
    let files = std::fs::read_dir(format!("{}/shaders-spirv", env!("CARGO_MANIFEST_DIR")));
    let files = files.unwrap().count();
    // Two layouts, and the hash of the sources.
    assert_eq!(files, modules().len() + 3, "files that nothing reads");
}
