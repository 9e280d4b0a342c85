//! Walks: pictures of crowds whose copies rays find in a hierarchy are those of the reference.

use super::crowds::{army, seen, separate};
use super::embedding::options;
use super::embedding_outputs::{depth_only, depths};
use crate::common::host::{color_pass, opened, view_of};
use crate::common::prelude::*;
use crate::common::ways::apart;

fn settings(stage: DrawStage, tolerance: Tolerance) -> Settings {
    Settings {
        width: 233,
        height: 131,
        stage,
        planes: Planes::All,
        tolerance,
        ..Settings::default()
    }
}

/// Draws by this path.
#[track_caller]
fn drawn(scene: &Scene, settings: &Settings, path: DrawPath) -> Frame {
    let mut offscreen = Offscreen::new(device(), scene, settings).unwrap();
    offscreen.draw().unwrap();
    assert_eq!(offscreen.renderer().draw_paths()[0], path);
    offscreen.read().unwrap()
}

/// Pixels that differ: hit in one frame alone, seen elsewhere, or of another colour.
fn differing(a: &Frame, b: &Frame) -> (usize, usize) {
    let (hits, edge, far) = apart(a, b);
    let colors = a.color.iter().zip(&b.color);
    let shaded = colors.filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > 0.01));
    (hits, edge + far + shaded.count())
}

/// Walks to a crowd in both stages, and to its copies as separate objects, which the host places and
/// which have other levels where errors are allowed. Rounding decides for at most one pixel in 10,000
/// hits, and for two.
#[track_caller]
fn assert_alike(what: &str, scene: &Scene) {
    let draw =
        |scene: &Scene, stage, tolerance| drawn(scene, &settings(stage, tolerance), DrawPath::Walk);
    for tolerance in [Tolerance::EXACT, Tolerance::DEFAULT] {
        let walks = STAGES.map(|stage| draw(scene, stage, tolerance));
        let mut pairs = vec![("stages", walks[0].clone(), &walks[1])];
        if tolerance == Tolerance::EXACT {
            let separate = draw(&separate(scene), STAGES[0], tolerance);
            pairs.push(("separate", separate, &walks[0]));
        }
        for (pair, one, other) in pairs {
            assert_sound(other, what);
            let (hits, differ) = differing(&one, other);
            assert!(hits > 100, "{what}");
            assert!(
                differ <= 2 + hits / 10_000,
                "{what}, {tolerance:?}, {pair}: {differ} of {hits} pixels"
            );
        }
    }
    device().check().unwrap();
}

#[test]
fn walks_see_what_the_reference_sees() {
    for (view, scene) in seen(&army(700)) {
        assert_alike(view, &scene);
        let of = settings(DrawStage::Compute, Tolerance::EXACT);
        let walk = drawn(&scene, &of, DrawPath::Walk);
        let (hits, differ) = differing(&reference(&scene, &of), &walk);
        assert!(
            differ <= 2 + hits / 2000,
            "{view}: {differ} of {hits} pixels"
        );
    }
}

/// Pictures of any few pixels show what the reference shows: points over squares of pixels are drawn
/// only if their middle is in the picture.
#[test]
fn narrow_pictures_are_walked() {
    let (_, mut scene) = seen(&army(200)).nth(1).unwrap();
    scene.camera.fov_y = 20.0;
    let mut seen = 0;
    for (width, height) in [(1, 1), (3, 90), (90, 7), (8, 8), (9, 17), (31, 64)] {
        for stage in STAGES {
            let of = Settings {
                width,
                height,
                ..settings(stage, Tolerance::EXACT)
            };
            let walk = drawn(&scene, &of, DrawPath::Walk);
            let (hits, differ) = differing(&reference(&scene, &of), &walk);
            assert!(
                differ <= 1 + hits / 1000,
                "{width} x {height}, {stage:?}: {differ}"
            );
            seen += hits;
        }
    }
    assert!(seen > 1000, "{seen} hits");
    device().check().unwrap();
}

/// The count that the other tests bound sees one copy in ten that is a hundredth of its size higher.
#[test]
fn moved_copies_are_noticed() {
    let (_, scene) = seen(&army(700)).nth(1).unwrap();
    let mut moved = scene.clone();
    let mut copies: Vec<Placement> = moved.objects[0].instances.iter().copied().collect();
    for copy in copies.iter_mut().step_by(10) {
        copy.position.z += 0.01;
    }
    moved.objects[0].instances = copies.into();
    let of = settings(DrawStage::Compute, Tolerance::EXACT);
    let [a, b] = [scene, moved].map(|scene| drawn(&scene, &of, DrawPath::Walk));
    let (hits, differ) = differing(&a, &b);
    assert!(differ > 2 + hits / 1000, "{differ} of {hits}");
}

/// A crowd far from the world's origin, seen from a thousand times its size through a narrow lens:
/// the device places copies with the digits of the host's double numbers.
#[test]
fn far_crowds_keep_their_digits() {
    let (_, mut scene) = seen(&army(700)).nth(1).unwrap();
    let shift = DVec3::new(3e7, -2e7, 1e6);
    for object in &mut scene.objects {
        let far = |p: &Placement| Placement {
            position: p.position + shift,
            ..*p
        };
        object.instances = object.instances.iter().map(far).collect();
    }
    let target = shift + DVec3::new(5.0, 5.0, 0.3);
    scene.camera = Camera::new(target + DVec3::new(-9000.0, -7000.0, 6000.0), target);
    scene.camera.fov_y = 0.1;
    assert_alike("narrow", &scene);
    scene.camera.eye = target + DVec3::new(-9.0, -7.0, 6.0);
    scene.camera.fov_y = 60.0;
    assert_alike("near", &scene);
}

/// Copies that the device places throw shadows on each other and on a solid that the host places.
/// Rays along a surface begin at points that differ by roundings, so the reference judges.
#[test]
fn walks_and_proxies_shadow_each_other() {
    let (_, mut scene) = seen(&army(300)).nth(1).unwrap();
    let mut ground = Object::new("ground", Arc::new(shapes::discs()));
    ground.placement = scaled([5.0, 5.0, -1.2], 14.0);
    scene.objects.push(ground);
    for shadow in [Shadow::Hard, Shadow::Soft] {
        scene.shadow = shadow;
        let of = STAGES.map(|stage| settings(stage, Tolerance::EXACT));
        let truth = reference(&scene, &of[0]);
        let separate = drawn(&separate(&scene), &of[0], DrawPath::Walk);
        let (hits, by_host) = differing(&truth, &separate);
        for of in of {
            let (_, differ) = differing(&truth, &drawn(&scene, &of, DrawPath::Walk));
            let most = by_host + 2 + hits / 10_000;
            assert!(
                differ <= most,
                "{:?}: {differ} of {hits}, {by_host} where the host places",
                of.stage
            );
        }
    }
    device().check().unwrap();
}

/// A prepass of depths has those of the main pass to the last bit: both walk.
#[test]
fn a_prepass_has_the_depths_of_the_main_pass() {
    let (host, device) = opened();
    let (_, scene) = seen(&army(200)).nth(1).unwrap();
    let view = view_of(&scene, &options());
    let search = SearchSettings::default();
    let [(before, paths), (main, _)] = [depth_only(false), color_pass()]
        .map(|pass| depths(&host, &device, &scene, &view, &search, &pass));
    assert_eq!(paths, [DrawPath::Walk; 3]);
    assert!(before == main && before.iter().filter(|d| **d < 1.0).count() > 3000);
}

/// The same renderer draws views and copies that change as a new one does.
#[test]
fn changes_are_seen() {
    let (_, first) = seen(&army(400)).next().unwrap();
    for stage in STAGES {
        let of = settings(stage, Tolerance::DEFAULT);
        let mut offscreen = Offscreen::new(device(), &first, &of).unwrap();
        let mut scene = first.clone();
        for step in 0..5 {
            match step {
                0 | 1 => scene.camera.eye += DVec3::new(-1.0, -0.5, 0.7),
                2 => {
                    let copies = scene.objects[1].instances.iter().copied();
                    scene.objects[1].instances = copies.skip(150).collect();
                }
                3 => {
                    scene.objects.remove(0);
                }
                _ => scene.objects[0].offset.extend = 0.02,
            }
            let same = updated(&mut offscreen, &scene);
            let new = drawn(&scene, &of, DrawPath::Walk);
            assert_eq!(same.first_difference(&new), None, "{stage:?}, step {step}");
        }
    }
    device().check().unwrap();
}

/// Each look has a walk of its own, over the rows of the picture that may show it.
#[test]
fn many_looks_are_walked() {
    let (_, mut scene) = seen(&army(1)).nth(1).unwrap();
    scene.shadow = Shadow::Hard;
    let first = separate(&scene).objects[0].clone();
    let of_look = |n: u8| {
        let map = ColorMap::from_texels(1, 1, vec![[n, 0, 0, 255]]).unwrap();
        first.clone().with(|object| {
            object.texturing.color_map = Some(Arc::new(map));
            object.placement.position = DVec3::new(f64::from(n % 6), f64::from(n / 6), 0.0);
        })
    };
    scene.objects = (0..30).map(of_look).collect();
    let of = STAGES.map(|stage| settings(stage, Tolerance::EXACT));
    let truth = reference(&scene, &of[0]);
    for of in of {
        let walk = drawn(&scene, &of, DrawPath::Walk);
        let (hits, differ) = differing(&truth, &walk);
        assert!(hits > 1000, "{hits}");
        assert!(
            differ <= 2 + hits / 1000,
            "{:?}: {differ} of {hits}",
            of.stage
        );
    }
    device().check().unwrap();
}

/// Open pixels are those of the whole picture, and no other is drawn.
#[test]
fn open_pixels_are_drawn_alone() {
    let (_, crowd) = seen(&army(100)).nth(1).unwrap();
    let of = settings(DrawStage::Compute, Tolerance::DEFAULT);
    let mut offscreen = Offscreen::new(device(), &crowd, &of).unwrap();
    let whole = next_frame(&mut offscreen);
    for open in [|_| true, |n: usize| n.is_multiple_of(3)] {
        let all: Vec<bool> = (0..whole.pixels()).map(open).collect();
        offscreen.open(Some(&all)).unwrap();
        let opened = next_frame(&mut offscreen);
        for n in 0..whole.pixels() {
            let wanted = if open(n) {
                whole.distance[n]
            } else {
                f32::INFINITY
            };
            assert_eq!(opened.distance[n].to_bits(), wanted.to_bits(), "{n}");
        }
    }
    offscreen.open(None).unwrap();
    let again = next_frame(&mut offscreen);
    assert_eq!(whole.first_difference(&again), None);
    device().check().unwrap();
}
