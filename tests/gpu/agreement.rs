//! Fragment and compute pictures of one scene are equal bit for bit, in every channel.

use crate::common::{draw, eye, placement, scene_of, shapes};
use glam::DVec3;
use revmap::maps::MapFormat;
use revmap::scene::{Camera, Object, Scene};
use revmap::settings::{DrawStage, Settings, Solver};
use std::sync::Arc;

/// Ten scenes with different cameras, transforms and maps; several objects overlap, and one camera
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
            scene.objects[0].placement =
                placement([0.1, -0.2, 0.3], [0.7, -0.4, 1.1], [2.0, 0.5, 1.0]);
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
    let mut crowd = Scene::new(Camera::new(
        DVec3::new(2.6, 1.9, 1.7),
        DVec3::new(0.0, 0.0, 0.3),
    ));
    crowd.background = [0.1, 0.2, 0.3, 1.0];
    for (n, (name, profile)) in shapes::all().into_iter().enumerate() {
        let mut object = Object::new(name, Arc::new(profile));
        let turn = n as f64 * 0.8;
        object.color = [0.2 + 0.1 * n as f32, 0.9 - 0.1 * n as f32, 0.5];
        object.placement = placement(
            [0.45 * turn.cos(), 0.45 * turn.sin(), 0.1 * turn],
            [0.2 * turn, 0.1, turn],
            [0.8, 1.1, 0.7],
        );
        // Copies that pass through one another.
        object.instances = vec![
            object.placement,
            placement(
                [0.3 - 0.1 * turn, 0.2, 0.2],
                [turn, 0.0, 0.4],
                [0.5, 0.5, 0.9],
            ),
        ]
        .into();
        crowd.objects.push(object);
    }
    all.push(("crowd", crowd));
    all
}

#[test]
fn fragment_and_compute_agree_bit_for_bit() {
    let formats = [MapFormat::R16, MapFormat::R32, MapFormat::Rgba8];
    let all: Vec<_> = scenes().into_iter().enumerate().collect();
    // Each scene is drawn by the patches and by a second search, and every search draws at least
    // one scene.
    let pairs = all.iter().flat_map(|(n, scene)| {
        // Cone maps hold only some of these solids, and a hull is drawn by two different methods:
        // both have their own tests.
        let others: Vec<_> = revmap_searches::ALL
            .into_iter()
            .filter(|s| !s.reads_own_table() && *s != Solver::Exact)
            .collect();
        let second = others[n % others.len()];
        [(*n, scene, Solver::Quadric), (*n, scene, second)]
    });
    for (n, (name, scene), solver) in pairs {
        let settings = Settings {
            width: 400,
            height: 301,
            map_format: formats[n % 3],
            solver,
            max_steps: Some(48),
            // Cells and lists of patches change where rays start; culled tiles count no steps.
            proxy_min_pixels: u32::MAX,
            occlusion_culling: false,
            ..Settings::exact()
        };
        let mut fragment = draw(scene, &settings);
        let mut compute = draw(
            scene,
            &Settings {
                stage: DrawStage::Compute,
                ..settings
            },
        );
        let hits = fragment.distance.iter().filter(|d| d.is_finite()).count();
        assert!(hits > 200, "{name}: only {hits} pixels are hit");
        if *name == "crowd" {
            // Depths of other objects end a search of copies in compute; the depth test comes after
            // it in the fragment stage.
            fragment.steps.fill(0.0);
            compute.steps.fill(0.0);
        }
        if let Some(difference) = fragment.first_difference(&compute) {
            panic!("{name}, {solver:?}: {difference}");
        }
        let mut culled = draw(
            scene,
            &Settings {
                stage: DrawStage::Compute,
                occlusion_culling: true,
                ..settings
            },
        );
        fragment.steps.fill(0.0);
        culled.steps.fill(0.0);
        culled.exhausted = fragment.exhausted;
        if let Some(difference) = fragment.first_difference(&culled) {
            panic!("{name}, {solver:?}, culled: {difference}");
        }
    }
}

/// The comparison itself detects one bit.
#[test]
fn one_changed_bit_is_noticed() {
    let (_, scene) = scenes().remove(0);
    let settings = Settings {
        width: 64,
        height: 48,
        solver: Solver::Quadric,
        ..Settings::exact()
    };
    let fragment = draw(&scene, &settings);
    let mut other = fragment.clone();
    let hit = other.distance.iter().position(|d| d.is_finite()).unwrap();
    let value = &mut other.normal[hit][1];
    *value = f32::from_bits(value.to_bits() ^ 1);
    let difference = fragment.first_difference(&other).unwrap().to_string();
    assert!(difference.starts_with("N.Y at pixel"), "{difference}");
}
