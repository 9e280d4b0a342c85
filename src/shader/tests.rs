//! Rust and GLSL agree on shared bytes: block layouts, specialisation constants, the
//! catalogue of modules, and the stored SPIR-V for builds without shaderc.

use crate::profile::Profile;
use crate::scene::{Lighting, Object};
use crate::search::unpacked;
use crate::settings::{Planes, SearchSettings, Solver};
use crate::shader::catalogue::{SearchCode, modules};
use crate::shader::textures::{varying_textures, with_constant_textures, with_varying_textures};
use crate::shader::{
    Demands, HostLook, Kind, Module, ShadowCasters, Technique, Variant, depth_less, generated as g,
    instructions, op, words,
};
use crate::surface::{ROWS, Tables};
use std::collections::BTreeSet;
use std::sync::Arc;

mod kept;
use kept::assert_kept;

const MODULES: usize = 28;

fn any(solver: Solver, planes: Planes) -> Technique {
    let profile = Profile::polygon(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.5).unwrap();
    let object = Object::new("any", Arc::new(profile));
    let settings = SearchSettings {
        solver,
        ..SearchSettings::exact()
    };
    let demands = Demands {
        settings: &settings,
        planes,
        host_shades: false,
        lighting: &Lighting::default(),
    };
    let casters = ShadowCasters::default();
    Technique::new(&demands, solver, &object, casters, HostLook::default())
}

/// Identifiers of the specialisation constants that a module reads.
fn constants_of(words: &[u32]) -> BTreeSet<u32> {
    instructions(words)
        .filter(|(code, one)| *code == op::DECORATE && one[2] == op::SPEC_ID)
        .map(|(_, one)| one[3])
        .collect()
}

#[test]
fn a_variant_sets_every_specialisation_constant() {
    let set: BTreeSet<u32> = Variant::general(any(Solver::Exact, Planes::Color))
        .constants(Kind::Cells)
        .iter()
        .map(|(id, _)| *id)
        // Constants of the device and of the pass.
        .chain([
            g::OWN_VECTORS_ID,
            g::LARGE_POINTS_ID,
            g::FETCHED_CELLS_ID,
            g::TEXELS_ID,
        ])
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

/// The catalogue of modules is finite and of known length, so that any growth is visible.
#[test]
fn modules_are_few_and_small() {
    let all = modules();
    let names: BTreeSet<String> = all.iter().map(Module::name).collect();
    assert_eq!(names.len(), all.len());
    assert_eq!(all.len(), MODULES);
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders-spirv");
    let packed = |module: &Module| format!("{folder}/{}.spv.z", module.name());
    let bytes = |module| std::fs::metadata(packed(module)).unwrap().len();
    let packed: u64 = all.iter().map(bytes).sum();
    assert!(packed < 560_000, "{packed} bytes in all");
}

/// Only shadows of searches on maps index an array of textures by a number that varies. Devices
/// without that feature get the module with constants in its place.
#[test]
fn pipelines_index_textures_by_constants() {
    let mut varying = 0;
    for module in modules() {
        let words = words(&module).unwrap();
        let found = varying_textures(&words);
        assert!(
            found == 0 || module.search == SearchCode::Live,
            "{}",
            module.name()
        );
        varying += found;
        let constant = with_constant_textures(&words);
        assert_eq!(varying_textures(&constant), 0, "{}", module.name());
        assert!(found > 0 || constant == words, "{}", module.name());
        let declared = with_varying_textures(&words).len() - words.len();
        assert_eq!(declared, if found > 0 { 2 } else { 0 }, "{}", module.name());
    }
    assert!(varying > 0);
}

/// Every pipeline that can be drawn with has its modules.
#[test]
fn reachable_variants_have_modules() {
    let kinds = [
        Kind::Cells,
        Kind::CutCells,
        Kind::Boxes,
        Kind::TileLists,
        Kind::TilePatches(g::LONGEST_LIST),
        Kind::CulledTiles,
        Kind::Place,
        Kind::WalkLists,
        Kind::Walk,
        Kind::WalkTiles,
    ];
    for planes in [Planes::Color, Planes::All] {
        for solver in Solver::ALL {
            let patches = matches!(solver, Solver::Exact);
            let maps = [Kind::Boxes, Kind::WalkTiles];
            let has = |k: &Kind| patches || maps.contains(k);
            for kind in kinds.into_iter().filter(has) {
                let variant = Variant::general(any(solver, planes));
                assert!(words(&variant.module(kind)).is_some(), "{variant:?}");
                assert!(variant.vertices(kind).is_none_or(|v| words(&v).is_some()));
            }
        }
    }
}

/// Fragments that set a depth declare its side of their triangle; for reversed depth, the other
/// side.
#[test]
fn depth_is_promised_greater_or_less() {
    let promises = |words: &[u32]| -> Vec<u32> {
        instructions(words)
            .filter(|(code, _)| *code == op::EXECUTION_MODE)
            .map(|(_, one)| one[2])
            .filter(|mode| [op::DEPTH_GREATER, op::DEPTH_LESS].contains(mode))
            .collect()
    };
    let cells = Variant::general(any(Solver::Exact, Planes::Color)).module(Kind::Cells);
    let cells = words(&cells).unwrap();
    let less = depth_less(&cells);
    assert_eq!(promises(&cells), [op::DEPTH_GREATER]);
    assert_eq!(promises(&less), [op::DEPTH_LESS]);
    let differing = cells.iter().zip(&less).filter(|(a, b)| a != b).count();
    assert_eq!((cells.len(), differing), (less.len(), 1));
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
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders-spirv");
    let renew = "with REVMAP_KEEP_SPIRV=1 cargo build";
    let hashes = [g::SOURCES_HASH, g::COMPILER_HASH];
    let all = modules().iter().map(|m| (m.name(), words(m))).collect();
    assert_kept((folder, renew), hashes, all, unpacked);
}
