//! Walks: pictures of crowds whose copies rays find in a hierarchy are those of the reference. The
//! random host (`tests/soak`) changes crowds.

use crate::common::prelude::*;
use crate::common::ways::apart;
use std::f64::consts::TAU;

/// Positions that are irregular but evenly distributed.
fn spots(count: u32, seed: u32) -> impl Iterator<Item = [f64; 4]> {
    (0..count).map(move |k| {
        let part = |step: f64| (f64::from(k + 1000 * seed) * step).fract();
        [0.754_877_666, 0.569_840_291, 0.618_034, 0.414_214].map(part)
    })
}

/// Three solids, `count` copies of each.
fn army(count: u32) -> Scene {
    let mut scene = Scene::new(Camera::new(
        DVec3::new(0.0, 0.0, 1.4),
        DVec3::new(6.0, 6.0, 0.4),
    ));
    scene.lights.push(Light {
        direction: DVec3::new(0.7, 0.5, -0.4),
        color: [0.8, 0.7, 0.6],
        ..Light::default()
    });
    let profiles = [shapes::sphere(), shapes::vase(), shapes::cone()];
    for (seed, profile) in (0u32..).zip(profiles) {
        let mut object = Object::new("test", Arc::new(profile));
        object.color = [0.3 + 0.3 * seed as f32, 0.7, 0.9 - 0.3 * seed as f32];
        let place = |[x, y, turn, size]: [f64; 4]| Placement {
            position: DVec3::new(12.0 * x - 1.0, 12.0 * y - 1.0, 0.0),
            rotation: DQuat::from_rotation_z(TAU * turn)
                * DQuat::from_rotation_x(0.4 * (size - 0.5)),
            scale: DVec3::new(0.7, 0.8, 0.6 + 0.6 * size),
        };
        object.instances = spots(count, seed).map(place).collect();
        scene.objects.push(object);
    }
    scene
}

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

/// Views from within, from above, from straight above and from afar, where most copies are smaller
/// than a pixel.
const VIEWS: [(&str, [f64; 3], [f64; 3]); 4] = [
    ("within", [0.0, 0.0, 0.9], [6.0, 6.0, 0.4]),
    ("above", [-5.0, -4.0, 7.0], [5.0, 5.0, 0.0]),
    ("straight down", [5.0, 5.0, 9.0], [5.0, 5.01, 0.0]),
    ("afar", [-70.0, -50.0, 30.0], [5.0, 5.0, 0.0]),
];

/// A scene from each of these views.
fn seen(scene: &Scene) -> impl Iterator<Item = (&'static str, Scene)> {
    VIEWS.into_iter().map(|(name, eye, target)| {
        let mut scene = scene.clone();
        (scene.camera.eye, scene.camera.target) = (eye.into(), target.into());
        (name, scene)
    })
}

/// The same copies as separate objects, which the host places.
fn separate(scene: &Scene) -> Scene {
    let alone = |object: &Object| {
        let object = object.clone().with(|o| o.instances = Copies::default());
        move |placement: &Placement| object.clone().with(|o| o.placement = *placement)
    };
    let objects = scene.objects.iter();
    let separate = objects.flat_map(|o| o.placements().iter().map(alone(o)));
    scene.clone().with(|s| s.objects = separate.collect())
}

/// Settings of a search without lists of patches: in compute others list them in any picture.
fn by_tree(stage: DrawStage) -> Settings {
    settings(stage, Tolerance::EXACT).with(|s| s.solver = Solver::Quadric)
}

/// The same without look-ups, which include those of hidden copies.
fn picture(scene: &Scene, settings: &Settings) -> Frame {
    draw(scene, settings).with(|frame| frame.steps.fill(0.0))
}

/// A solid behind the eye takes no part in the range of depths, so hits keep their order.
#[test]
fn a_solid_behind_the_eye_changes_no_pixel() {
    let (_, scene) = seen(&army(700)).next().unwrap();
    let (eye, target) = (scene.camera.eye, scene.camera.target);
    let mut behind = scene.clone();
    let mut object = Object::new("behind", Arc::new(shapes::vase()));
    object.placement.position = eye + 10.0 * (eye - target);
    behind.objects.push(object);
    for stage in STAGES {
        let [with, without] = [&behind, &scene].map(|scene| picture(scene, &by_tree(stage)));
        assert_eq!(with.first_difference(&without), None, "{stage:?}");
    }
}

/// Of few copies fragments draw boxes, and compute lists patches. The host places 60 copies, and the
/// device 120: these are near to single objects, which the host places.
#[test]
fn few_copies_are_as_many_single_objects() {
    for (view, scene) in seen(&army(20)) {
        let frames = STAGES.map(|stage| picture(&scene, &by_tree(stage)));
        let listed = by_tree(DrawStage::Compute).with(|s| s.solver = Solver::Exact);
        let listed = picture(&scene, &listed.with(|s| s.proxy_min_pixels = 0));
        for (what, one) in [("stages", &frames[0]), ("lists", &listed)] {
            let (hits, differ) = differing(one, &frames[1]);
            assert!(
                hits > 50 && differ <= 1,
                "{view}, {what}: {differ} of {hits}"
            );
        }
    }
    for stage in STAGES {
        for (count, most) in [(20, 0), (40, 1)] {
            let crowd = army(count);
            let both = [&crowd, &separate(&crowd)].map(|s| picture(s, &by_tree(stage)));
            let same = both[0].first_difference(&both[1]).is_none();
            let (_, differ) = differing(&both[0], &both[1]);
            assert!(
                differ <= most && (same || most > 0),
                "{stage:?}, {count}: {differ}"
            );
        }
    }
    device().check().unwrap();
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

/// Each look has a walk of its own, over the rows of the picture that may show it.
#[test]
fn many_looks_are_walked() {
    let (_, mut scene) = seen(&army(1)).nth(1).unwrap();
    scene.shadow = Shadow::Hard;
    let first = separate(&scene).objects[0].clone();
    let of_look = |n: u8| {
        first.clone().with(|object| {
            object.texturing.color_map = Some(color_map(1, 1, |_, _| [n, 0, 0, 255]));
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
