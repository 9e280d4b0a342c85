//! Fragment and compute pictures of one scene are equal bit for bit, in every channel: also with all
//! textures, bumps and offsets.

use crate::common::prelude::*;

/// Scenes with different cameras, transforms and maps; several objects overlap, and one camera
/// is within an object.
fn scenes() -> Vec<(&'static str, Scene)> {
    let mut all = vec![
        ("side", scene_of(shapes::vase(), eye(0.0, 1.8))),
        ("oblique", scene_of(shapes::glass(), eye(25.0, 1.6))),
        ("steep", scene_of(shapes::discs(), eye(70.0, 1.7))),
        ("from below", scene_of(shapes::jewel(), eye(-50.0, 1.5))),
        ("wide lens close by", {
            let mut scene = scene_of(shapes::torus(), eye(35.0, 0.75));
            scene.camera.fov_y = 100.0;
            scene
        }),
        ("stretched and turned", {
            let mut scene = scene_of(shapes::column(), eye(20.0, 2.4));
            let (at, turn) = ([0.1, -0.2, 0.3], [0.7, -0.4, 1.1]);
            scene.objects[0].placement = placement(at, turn, [2.0, 0.5, 1.0]);
            scene
        }),
        ("small and far", {
            let mut scene = scene_of(shapes::cone(), eye(15.0, 4.0));
            scene.objects[0].placement = placement([0.4, 0.2, 0.4], [0.0, 0.3, 0.0], [0.3; 3]);
            scene
        }),
        (
            "within the box",
            scene_of(shapes::torus(), DVec3::new(0.02, 0.03, 0.52)),
        ),
        (
            "within the solid",
            scene_of(shapes::sphere(), DVec3::new(0.1, 0.05, 0.4)),
        ),
    ];
    // Texels as large as the solid's parts, and none of a solid that grows into its box.
    let coarse = scene_of(shapes::glass(), eye(25.0, 2.4)).with(|s| s.objects[0].map_rows = 24);
    let points = [[0.0, -0.5], [0.4, -0.5], [0.4, -0.05], [0.0, -0.05]];
    let below = scene_of(Profile::polygon(&points, 0.5).unwrap(), eye(25.0, 2.2));
    let below = below.with(|s| s.objects[0].offset.extend = 0.15);
    all.extend([("coarse", coarse), ("from below its box", below)]);
    let mut crowd = circle_of_shapes(shapes::all());
    crowd.background = [0.1, 0.2, 0.3, 1.0];
    for (n, object) in crowd.objects.iter_mut().enumerate() {
        let turn = n as f64 * 0.8;
        object.color = [0.2 + 0.1 * n as f32, 0.9 - 0.1 * n as f32, 0.5];
        // Copies that pass through one another.
        let at = [0.3 - 0.1 * turn, 0.2, 0.2];
        let copy = placement(at, [turn, 0.0, 0.4], [0.5, 0.5, 0.9]);
        object.instances = vec![object.placement, copy].into();
    }
    all.push(("crowd", crowd));
    all
}

/// Compares both stages in every channel. `counts`: look-ups, too. Those of copies differ: depths of
/// other objects end a search in compute, and the depth test comes after it in the fragment stage.
fn assert_agree(name: &str, scene: &Scene, settings: Settings, counts: bool) -> Frame {
    let settings = from_boxes(settings);
    let drawn = |settings| {
        draw(scene, settings).with(|f| f.steps.iter_mut().for_each(|s| *s *= f32::from(counts)))
    };
    let (fragment, compute) = (drawn(&settings), drawn(&in_compute(settings)));
    assert_sound(&fragment, name);
    if let Some(difference) = fragment.first_difference(&compute) {
        panic!("{name}, {:?}: {difference}", settings.solver);
    }
    fragment
}

const FORMATS: [MapFormat; 3] = [MapFormat::R16, MapFormat::R32, MapFormat::Rgba8];

#[test]
fn fragment_and_compute_agree_bit_for_bit() {
    // Cone maps hold only some of these solids, and a hull is drawn by two different methods: both
    // have their own tests.
    let others: Vec<_> = revmap_searches::ALL
        .into_iter()
        .filter(|s| !s.reads_own_table() && *s != Solver::Exact)
        .collect();
    // Each scene is drawn by the patches, by the library's search on maps and by a third search, and
    // every search draws at least one scene.
    for (n, (name, scene)) in scenes().into_iter().enumerate() {
        for solver in [Solver::Quadric, Solver::Live, others[n % others.len()]] {
            let settings = Settings {
                map_format: FORMATS[n % 3],
                solver,
                max_steps: Some(48),
                ..sized(400, 301)
            };
            let hits = hits(&assert_agree(name, &scene, settings, name != "crowd"));
            assert!(hits > 200, "{name}: only {hits} pixels are hit");
        }
    }
}

/// Copies of two looks, each with tables of its own, cast shadows.
#[test]
fn shadowed_copies_of_two_looks_agree() {
    let mut scene = scene_of(shapes::vase(), eye(25.0, 2.2));
    scene.shadow = Shadow::Hard;
    scene
        .objects
        .push(Object::new("jewel", Arc::new(shapes::jewel())));
    scene.objects[0].texturing.color_map = Some(colors());
    for (n, object) in (0..).zip(&mut scene.objects) {
        let copy = |k: i32| {
            let at = [0.3 * f64::from(k - n), 0.25 * f64::from(n + k % 2), 0.0];
            placement(at, [0.1 * f64::from(k), 0.0, 0.3], [0.7; 3])
        };
        object.instances = (-1..2).map(copy).collect();
    }
    let frame = assert_agree("copies", &scene, sized(320, 240), false);
    assert!(hits(&frame) > 10_000);
}

/// The comparison itself detects one bit.
#[test]
fn one_changed_bit_is_noticed() {
    let (_, scene) = scenes().remove(0);
    let settings = sized(64, 48).with(|s| s.solver = Solver::Quadric);
    let fragment = draw(&scene, &settings);
    let mut other = fragment.clone();
    let hit = other.distance.iter().position(|d| d.is_finite()).unwrap();
    let value = &mut other.normal[hit][1];
    *value = f32::from_bits(value.to_bits() ^ 1);
    let difference = fragment.first_difference(&other).unwrap().to_string();
    assert!(difference.starts_with("N.Y at pixel"), "{difference}");
}

fn colors() -> Arc<ColorMap> {
    color_map(32, 16, |x, y| [8 * x as u8, 15 * y as u8, 120, 255])
}

fn covered(projection: Projection, bump_form: BumpForm) -> Texturing {
    let height = |x: u32, y: u32| ((x % 4 + y % 8) * 29 % 64) as f32 / 64.0;
    Texturing {
        color_map: Some(colors()),
        displacement_map: Some(slope_map(32, height)),
        bump: 0.02,
        bump_form,
        projection,
        repeat: [2.0, 1.0],
        offset: [0.3, 0.1],
    }
}

const CHAMFERED: Offset = offset(-0.02, 0.7, 0.15);

/// Scenes with textures, bumps, offsets, replicas and shadows.
fn textured_scenes() -> Vec<(String, Scene)> {
    let mut all = Vec::new();
    let forms = [BumpForm::SurfaceGradient, BumpForm::Papers];
    for (n, (_, projection)) in Projection::NAMES.into_iter().enumerate() {
        let mut scene = scene_of(shapes::vase(), eye(20.0 + 15.0 * n as f64, 1.7));
        let object = &mut scene.objects[0];
        object.texturing = covered(projection, forms[n % 2]);
        object.offset = CHAMFERED;
        object.placement = placement([0.05, 0.0, 0.1], [0.3, -0.2, 0.4], [1.1, 0.8, 0.9]);
        all.push((format!("{projection:?}"), scene));
    }
    for (name, offset) in [
        ("extended", offset(0.04, 0.0, 1.0)),
        ("inset", offset(-0.01, 0.0, 1.0)),
        ("beveled", offset(0.01, 0.3, 1.0)),
    ] {
        let mut scene = scene_of(shapes::glass(), eye(30.0, 1.9));
        scene.objects[0].offset = offset;
        scene.objects[0].texturing = covered(Projection::Arc, BumpForm::SurfaceGradient);
        all.push((name.into(), scene));
    }
    for mirror in [false, true] {
        let mut scene = scene_of(shapes::jewel(), eye(25.0, 1.8));
        let object = &mut scene.objects[0];
        object.repeat = [3, 2, 2];
        object.mirror = [mirror; 3];
        object.axis = [0.4, 0.55];
        object.texturing = covered(Projection::Cylindrical, BumpForm::SurfaceGradient);
        all.push((format!("replicas, mirrored: {mirror}"), scene));
    }
    for shadow in [Shadow::Hard, Shadow::Soft] {
        let mut scene = scene_of(shapes::torus(), DVec3::new(1.9, 1.1, 1.6));
        scene.shadow = shadow;
        scene.objects[0].texturing = covered(Projection::Spherical, BumpForm::SurfaceGradient);
        scene.objects[0].texturing.bump = 0.005;
        let mut table = Object::new("table", Arc::new(shapes::cone()));
        table.placement = placement([0.0, 0.0, -0.3], [0.0; 3], [2.5, 2.5, 0.6]);
        let mut several = Object::new("several", Arc::new(shapes::discs()));
        several.repeat = [2, 2, 1];
        several.placement = placement([-0.5, 0.7, 0.1], [0.5, 0.3, 0.0], [0.8; 3]);
        several.offset.extend = 0.005;
        scene.objects.extend([table, several]);
        all.push((format!("{shadow:?} shadows"), scene));
    }
    all
}

#[test]
fn textures_agree_bit_for_bit() {
    for (n, (name, scene)) in textured_scenes().into_iter().enumerate() {
        let inset = scene.objects[0].offset.extend < 0.0; // the papers' format cannot hold this
        let settings = Settings {
            map_rows: Some(256),
            solver: [Solver::Live, CIRCLE, Solver::Quadric][n % 3],
            map_format: match inset {
                true => MapFormat::R16,
                false => FORMATS[(n + n / 3) % 3],
            },
            ..sized(200, 151)
        };
        let frame = assert_agree(&name, &scene, settings, true);
        let normals = frame.normal.iter().zip(&frame.shading_normal);
        let (hits, tilted) = (hits(&frame), normals.filter(|(a, b)| a != b).count());
        println!("{name}: {hits} hits, {tilted} with bumps");
        assert!(hits > 1500 && tilted > 300, "{name}: {hits}, {tilted}");
    }
}
