#![allow(clippy::unwrap_used)]
use super::*;
use crate::plan::suite::{self, Extent};
use crate::plan::view::Framing;
use crate::plan::view::tests::spindle;
use revmap::profile::Raster;
use std::sync::Arc;

fn drawn(view: &View) -> Drawn {
    Drawn::of(&Plan::new(vec![view.clone()]))
}

/// What is told about the changes of one view in another run.
fn changes_to(view: &View, new: &View) -> Vec<String> {
    let (old, new) = (drawn(view), drawn(new));
    let others = old.other_scenes(&new);
    others.into_values().next().unwrap_or_default()
}

/// A scene file, and its view with a key changed.
const FILE_TEXT: &str = "\
camera.eye = [2, 0, 0.5]
camera.target = [0, 0, 0.5]
environment = { up = [1, 1, 1], down = [0, 0, 0] }
light = [{ direction = [0, 0, -1] }]
object = [{ polygon = [[0, 0], [0.4, 0.5], [0, 1]], roughness = 0.5, metalness = 0 }]
";

fn view(text: &str, set: &str) -> View {
    let sets = [set.to_owned()];
    let sets = if set.is_empty() { &[][..] } else { &sets };
    let assets = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets");
    let scene = revmap_files::SceneFile::parse(text, assets)
        .unwrap()
        .scene(sets);
    View::new("spindle", scene.unwrap())
}

/// Keys of scene files with another value, and what is told of each.
const CHANGES: &str = "
camera.eye=[2,0,0.25] => camera.eye (old [2.0, 0.0, 0.5], new [2.0, 0.0, 0.25])
camera.target=[0.1,0,0.5] => camera.target
camera.up=[0,1,0] => camera.up
camera.fov_y=41 => camera.fov_y
background=[0,0,0,0.5] => background
ambient=[0.11,0.1,0.1] => ambient
environment.down=[1,0,0] => environment.down
shadow=\"soft\" => shadow (old \"off\", new \"soft\")
light.0.direction=[1,0,-1] => light.0.direction
light.0.radius=1 => light.0.radius
object.0.polygon=[[0,0],[0.4,0.500001],[0,1]] => object.0.profile (old \"
object.0.radius=0.6 => object.0.profile
object.0.map_rows=256 => object.0.map_rows (old not set, new 256)
object.0.bevel=0.4 => object.0.bevel (old not set, new 0.4)
object.0.color=[0.8,0.8,0.7] => object.0.color
object.0.roughness=0.3 => object.0.roughness
object.0.color_map=\"colors/natural-earth.png\" => object.0.color_map (old not set, new \"
object.0.height_map=\"heights/brick.png\" => object.0.height_map
object.0.rotation=[1,0,0,0] => object.0.rotation
object.0.repeat=[2,1,1] => object.0.repeat
object.0.clip=\"box\" => object.0.clip
";

#[test]
fn every_value_of_a_scene_is_told_by_its_key() {
    let plain = view(FILE_TEXT, "");
    assert_eq!(changes_to(&plain, &plain.clone()), [""; 0]);
    for line in CHANGES.trim().lines() {
        let (set, told) = line.split_once(" => ").unwrap();
        let found = changes_to(&plain, &view(FILE_TEXT, set));
        assert!(
            found.iter().any(|f| f.starts_with(told)),
            "{told}: {found:?}"
        );
    }
    // Pixels, one more value of a list, one more object, no sky.
    let mut other = plain.clone();
    let (columns, rows, coverage) = (1, 1, vec![0.5]);
    let raster = Raster {
        columns,
        rows,
        coverage,
    };
    Arc::make_mut(&mut other.scene.objects[0].profile).raster = Some(raster);
    other.scene.objects[0].instances = vec![Default::default(); 2].into();
    let mut moved = other.clone();
    moved.scene.objects[0].instances[1].position.x += 1e-6;
    assert_eq!(changes_to(&other, &moved).len(), 1);
    let twin = other.scene.objects[0].clone();
    other.scene.objects.push(twin);
    other.scene.environment = None;
    let found = changes_to(&plain, &other).join("; ");
    for told in [
        "environment.down (old [",
        "object.0.instances (old not set, new \"2 copies",
        "object.0.profile",
        "object.1.profile (old not set",
    ] {
        assert!(found.contains(told), "{told}: {found}");
    }
}

/// Other systems' sines err in the last digits, and a scene has no more keys than it needs.
#[test]
fn roundings_are_no_changes() {
    let mut turned = spindle();
    turned.scene.camera.eye.y += 1e-17;
    turned.scene.camera.eye.x *= 1.0 + f64::EPSILON;
    let profile = Arc::make_mut(&mut turned.scene.objects[0].profile);
    profile.outline.loops[0][1] *= 1.0 + f64::EPSILON;
    assert_eq!(changes_to(&spindle(), &turned), [""; 0]);
    let text = drawn(&spindle()).text().unwrap();
    assert!(text.contains("ambient = [0.1, 0.1, 0.1]"), "{text}");
    assert!(!text.contains("bevel"), "{text}");
}

#[test]
fn a_file_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(Drawn::load(folder.path()).unwrap(), None);
    let views = suite::views(&Extent::ALL, &[25.0]).unwrap();
    let close = views.iter().map(|v| v.clone().in_framing(Framing::Close));
    let mut all: Vec<View> = views.iter().cloned().chain(close).collect();
    all.push(spindle().of_file(FILE_TEXT));
    let one = Drawn::of(&Plan::new(all));
    std::fs::write(folder.path().join(FILE), one.text().unwrap()).unwrap();
    let read = Drawn::load(folder.path()).unwrap().unwrap();
    assert_eq!(read, one);
    assert_eq!(read.other_scenes(&one), BTreeMap::new());
    let digests: BTreeSet<String> = one.digests().into_values().collect();
    assert_eq!(digests.len(), 2 * views.len() + 1);
    let text = one.text().unwrap();
    assert!(text.contains("[view.file.camera]\neye = [2, 0, 0.5]"));
    std::fs::write(folder.path().join(FILE), "view = 3").unwrap();
    let error = Drawn::load(folder.path()).unwrap_err();
    assert!(error.to_string().contains("measure again"), "{error}");
}

/// The camera of a suite is told as well, and many views in one sentence.
#[test]
fn many_views_are_told_in_one_sentence() {
    let suite = |elevation| {
        Drawn::of(&Plan::new(
            suite::views(&Extent::ALL, &[elevation]).unwrap(),
        ))
    };
    let (old, new) = (suite(25.0), suite(60.0));
    let text = told(&old.other_scenes(&new)).unwrap();
    assert!(
        text.starts_with("different scenes as bishop and 10 other views: camera.eye (old ["),
        "{text}"
    );
    assert!(!text.contains('\n') && text.len() < 400, "{text}");
    assert_eq!(told(&old.other_scenes(&old)), None);
    let mut rays = Plan::new(Vec::new());
    rays.truth_rays = 64;
    let found = Drawn::of(&Plan::new(Vec::new())).other_settings(&Drawn::of(&rays));
    assert_eq!(found, ["truth_rays (old 1, new 64)"]);
}

/// Vectors of <http://www.isthe.com/chongo/tech/comp/fnv/>.
#[test]
fn the_published_vectors() {
    for (text, sum) in [
        ("", 0xcbf2_9ce4_8422_2325),
        ("a", 0xaf63_dc4c_8601_ec8c),
        ("foobar", 0x8594_4171_f739_67e8),
    ] {
        assert_eq!(fnv1a_64(text.bytes()), sum, "{text}");
    }
}
