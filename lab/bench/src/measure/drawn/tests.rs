#![allow(clippy::unwrap_used)]
use super::*;
use crate::plan::suite::{self, Extent};
use crate::plan::view::Framing;
use crate::plan::view::tests::spindle;
use revmap::maps::{ColorMap, DisplacementMap};
use revmap::profile::{Profile, Raster};
use revmap::scene::{Environment, Light, Material, Placement};
use std::sync::Arc;

/// A change of a view, and the key under which it is told.
type Change = (&'static str, fn(&mut View));

fn drawn(view: &View) -> Drawn {
    Drawn::of(&Plan::new(vec![view.clone()]))
}

/// What is told about the changes of one view in another run.
fn changes_to(view: &View, new: &View) -> Vec<String> {
    let (old, new) = (drawn(view), drawn(new));
    let others = old.other_scenes(&new);
    others.into_values().next().unwrap_or_default()
}

fn profile(view: &mut View, change: impl FnOnce(&mut Profile)) {
    change(Arc::make_mut(&mut view.scene.objects[0].profile));
}

#[test]
fn every_value_of_a_scene_is_told_by_its_key() {
    let changes: &[Change] = &[
        (
            "camera.eye (old [2.0, 0.0, 0.5], new [2.0, 0.0, 0.25])",
            |v| v.scene.camera.eye.z = 0.25,
        ),
        ("camera.target", |v| v.scene.camera.target.x = 0.1),
        ("camera.fov_y", |v| v.scene.camera.fov_y = 41.0),
        ("background", |v| v.scene.background[3] = 0.5),
        ("ambient", |v| v.scene.ambient[0] = 0.11),
        ("environment.down (old not set, new ", |v| {
            let (up, down) = ([1.0; 3], [0.5; 3]);
            v.scene.environment = Some(Environment { up, down });
        }),
        ("shadow (old \"off\", new \"soft\")", |v| {
            v.scene.shadow = revmap::scene::Shadow::Soft
        }),
        ("light.0.direction", |v| v.scene.lights[0].direction.x = 1.0),
        ("light.2.color (old not set, new ", |v| {
            v.scene.lights.push(Light::default())
        }),
        ("object.0.profile (old \"", |v| {
            profile(v, |p| p.outline.loops[0][1].x += 1e-6)
        }),
        ("object.0.profile", |v| profile(v, |p| p.radius = 0.6)),
        ("object.0.profile", |v| {
            let (columns, rows, coverage) = (1, 1, vec![0.5]);
            profile(v, |p| {
                p.raster = Some(Raster {
                    columns,
                    rows,
                    coverage,
                })
            });
        }),
        ("object.0.map_rows (old not set, new 256)", |v| {
            v.scene.objects[0].map_rows = 256
        }),
        ("object.0.bevel (old not set, new 0.4)", |v| {
            v.scene.objects[0].offset.bevel = 0.4
        }),
        ("object.0.color", |v| {
            v.scene.objects[0].color = [0.8, 0.8, 0.7]
        }),
        ("object.0.roughness", |v| {
            let (roughness, metalness) = (0.3, 0.0);
            v.scene.objects[0].material = Some(Material {
                roughness,
                metalness,
            });
        }),
        ("object.0.color_map (old not set, new \"1x1 texels", |v| {
            let map = ColorMap::from_texels(1, 1, vec![[1, 2, 3, 255]]).unwrap();
            v.scene.objects[0].texturing.color_map = Some(Arc::new(map));
        }),
        ("object.0.height_map", |v| {
            let map = DisplacementMap::from_slopes(1, 1, vec![[0.5, 0.0]]).unwrap();
            v.scene.objects[0].texturing.displacement_map = Some(Arc::new(map));
        }),
        ("object.0.rotation", |v| {
            v.scene.objects[0].placement.rotation = glam::DQuat::from_rotation_x(0.1);
        }),
        ("object.0.instances (old not set, new \"2 copies", |v| {
            v.scene.objects[0].instances = vec![Placement::default(); 2].into();
        }),
        ("object.1.profile (old not set", |v| {
            let twin = v.scene.objects[0].clone();
            v.scene.objects.push(twin);
        }),
    ];
    let plain = spindle();
    assert_eq!(changes_to(&plain, &plain.clone()), [""; 0]);
    for (told, change) in changes {
        let mut other = plain.clone();
        change(&mut other);
        let found = changes_to(&plain, &other);
        assert!(
            found.iter().any(|f| f.starts_with(told)),
            "{told}: {found:?}"
        );
        // One more value of the same list changes its digest.
        if told.starts_with("object.0.instances") {
            let mut moved = other.clone();
            moved.scene.objects[0].instances[1].position.x += 1e-6;
            assert_eq!(changes_to(&other, &moved).len(), 1);
        }
    }
}

/// Other systems' sines err in the last digits, and a scene has no more keys than it needs.
#[test]
fn roundings_are_no_changes() {
    let mut turned = spindle();
    turned.scene.camera.eye.y += 1e-17;
    turned.scene.camera.eye.x *= 1.0 + f64::EPSILON;
    profile(&mut turned, |p| p.outline.loops[0][1] *= 1.0 + f64::EPSILON);
    assert_eq!(changes_to(&spindle(), &turned), [""; 0]);
    let text = drawn(&spindle()).text().unwrap();
    assert!(text.contains("ambient = [0.1, 0.1, 0.1]"), "{text}");
    assert!(!text.contains("bevel"), "{text}");
}

#[test]
fn a_file_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(Drawn::load(folder.path()).unwrap(), None);
    let file = "camera.eye = [2, 0, 0.5]\nobject = [{ polygon = [[0, 0], [0.4, 0.5], [0, 1]] }]\n";
    let views = suite::views(&Extent::ALL, &[25.0]).unwrap();
    let close = views.iter().map(|v| v.clone().in_framing(Framing::Close));
    let mut all: Vec<View> = views.iter().cloned().chain(close).collect();
    all.push(spindle().of_file(file));
    let one = Drawn::of(&Plan::new(all));
    std::fs::write(folder.path().join(FILE), one.text().unwrap()).unwrap();
    let read = Drawn::load(folder.path()).unwrap().unwrap();
    assert_eq!(read, one);
    assert_eq!(read.other_scenes(&one), BTreeMap::new());
    let digests: BTreeSet<String> = one.digests().into_values().collect();
    assert_eq!(digests.len(), 2 * views.len() + 1);
    assert!(
        one.text()
            .unwrap()
            .contains("[view.file.camera]\neye = [2, 0, 0.5]")
    );
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
