//! What Rust and GLSL say of the same bytes agrees: block layouts, specialisation constants, and the SPIR-V that is kept for
//! builds without shaderc.

use glam::DVec3;
use revmap::gpu::blocks::{FrameBlock, InstanceBlock, LightBlock, ShadowBlock, SolidBlock};
use revmap::pieces::{ROWS, Tables};
use revmap::profile::Profile;
use revmap::scene::{Camera, Object, Scene};
use revmap::settings::Settings;
use revmap::shader::{Variant, generated as g};
use std::collections::{BTreeMap, BTreeSet};
use std::mem::{offset_of, size_of};
use std::sync::Arc;

/// Opcodes and decorations of the SPIR-V specification that matter here.
mod op {
    pub const NAME: u32 = 5;
    pub const MEMBER_NAME: u32 = 6;
    pub const DECORATE: u32 = 71;
    pub const MEMBER_DECORATE: u32 = 72;
    pub const FUNCTION: u32 = 54;
    pub const SPEC_OP: u32 = 52;
    pub const SPEC_ID: u32 = 1;
    pub const OFFSET: u32 = 35;
}

fn instructions(words: &[u32]) -> Vec<(u32, &[u32])> {
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
        // A struct used in and out of a block is two types; the one with offsets counts.
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
    let words = g::SHAPE_BOX_PLANES_FRAG;
    assert_layout!(
        words,
        "Frame",
        FrameBlock {
            clip_from_world,
            eye,
            dir_00,
            dir_x,
            dir_y,
            forward,
            ambient,
            size,
            lights
        }
    );
    assert_layout!(words, "Light", LightBlock { towards, color });
    assert_layout!(
        words,
        "Solid",
        SolidBlock {
            map,
            bounds,
            offset,
            axis,
            albedo,
            specular,
            texturing,
            cells,
            instances,
            pieces,
            hull,
            single
        }
    );
    assert_layout!(
        words,
        "ShadowBlock",
        ShadowBlock {
            shadow_batches,
            shadow_solids
        }
    );
    assert_layout!(
        words,
        "Instance",
        InstanceBlock {
            position_sx,
            rotation,
            scale_yz
        }
    );
    assert_eq!(size_of::<InstanceBlock>(), 48);
}

/// The same comparison must fail when a member moves.
#[test]
#[should_panic(expected = "failed: Light")]
fn a_moved_member_is_noticed() {
    #[repr(C)]
    struct Moved {
        color: [f32; 4],
        towards: [f32; 4],
    }
    assert_layout!(g::SHAPE_BOX_PLANES_FRAG, "Light", Moved { color, towards });
}

fn any_scene() -> Scene {
    let profile = Profile::polygon(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.5).unwrap();
    let mut scene = Scene::new(Camera::new(DVec3::X, DVec3::ZERO));
    scene.objects.push(Object::new("any", Arc::new(profile)));
    scene
}

#[test]
fn a_variant_sets_every_specialisation_constant() {
    let set: BTreeSet<u32> =
        Variant::new(&Settings::default(), &any_scene(), &any_scene().objects[0])
            .constants()
            .iter()
            .map(|(id, _)| *id)
            .collect();
    let mut all = BTreeSet::new();
    for words in [
        g::SHAPE_BOX_COLOR_FRAG,
        g::SHAPE_BOX_PLANES_FRAG,
        g::HULL_VERT,
        g::HULL_COLOR_FRAG,
        g::HULL_PLANES_FRAG,
        g::BEAM_COMP,
        g::TRACE_COLOR_COMP,
        g::TRACE_PLANES_COMP,
    ] {
        let used: BTreeSet<u32> = instructions(words)
            .iter()
            .filter(|(code, w)| *code == op::DECORATE && w[1] == op::SPEC_ID)
            .map(|(_, w)| w[2])
            .collect();
        assert!(used.is_subset(&set), "{used:?} of {set:?}");
        all.extend(used);
    }
    assert_eq!(all, set);
}

/// There is one pipeline of beam.comp, whatever the variant.
#[test]
fn no_variant_changes_how_tiles_are_listed() {
    let read = |words| {
        let all = instructions(words);
        let mut constants: BTreeSet<u32> = all
            .iter()
            .filter(|(code, w)| *code == op::DECORATE && w[1] == op::SPEC_ID)
            .map(|(_, w)| w[0])
            .collect();
        // And what is computed from them, in the order of the file.
        for (_, w) in all.iter().filter(|(code, _)| *code == op::SPEC_OP) {
            if w[3..].iter().any(|id| constants.contains(id)) {
                constants.insert(w[1]);
            }
        }
        let code = all.iter().skip_while(|(code, _)| *code != op::FUNCTION);
        code.flat_map(|(_, w)| w.iter())
            .filter(|word| constants.contains(word))
            .count()
    };
    assert_eq!(read(g::BEAM_COMP), 0);
    // Most uses elsewhere are of what is computed from constants.
    assert!(read(g::TRACE_COLOR_COMP) > 20);
}

/// The tree over the rows of tables, as beams and searches count on it.
#[test]
fn tables_have_the_rows_and_nodes_of_the_shaders() {
    let tables = Tables::new(&[], ROWS);
    assert_eq!(ROWS, g::PIECE_ROWS);
    assert_eq!(tables.nodes.len(), g::PIECE_NODES as usize);
    let [rows, beams] = [0, 1].map(|level| tables.levels[level]);
    assert_eq!((rows, beams), (0, g::BEAM_FIRST_NODE));
    assert_eq!(tables.levels[2] - beams, g::BEAM_NODES);
}

/// What is kept was made from today's sources; and word for word, where the same compiler makes it here.
#[test]
fn kept_spirv_is_what_the_sources_give() {
    let kept = |name: &str| {
        let path = format!("{}/shaders-spirv/{name}", env!("CARGO_MANIFEST_DIR"));
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
    for (name, words) in [
        ("shape_box.vert", g::SHAPE_BOX_VERT),
        ("shape_box_color.frag", g::SHAPE_BOX_COLOR_FRAG),
        ("shape_box_planes.frag", g::SHAPE_BOX_PLANES_FRAG),
        ("beam.comp", g::BEAM_COMP),
        ("hull.vert", g::HULL_VERT),
        ("hull_color.frag", g::HULL_COLOR_FRAG),
        ("hull_planes.frag", g::HULL_PLANES_FRAG),
        ("trace_color.comp", g::TRACE_COLOR_COMP),
        ("trace_planes.comp", g::TRACE_PLANES_COMP),
    ] {
        let kept: Vec<u32> = kept(&format!("{name}.spv"))
            .chunks_exact(4)
            .map(|b| u32::from_le_bytes(b.try_into().unwrap()))
            .collect();
        if same_compiler {
            assert!(kept == words, "{name}: kept words differ from the compiled");
        }
    }
}
