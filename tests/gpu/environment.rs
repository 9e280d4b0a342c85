//! The environment: in both stages the colours are the reference's. The random host (`tests/soak`)
//! changes it, and a function of the host shades without it (`host_shading.rs`).

use crate::common::prelude::*;

pub const SKY: Environment = Environment {
    up: [0.5, 0.7, 1.1],
    down: [0.3, 0.2, 0.1],
};

fn with_sky(mut scene: Scene, change: impl FnOnce(&mut Object)) -> Scene {
    scene.environment = Some(SKY);
    scene.objects[0].color = [0.8, 0.5, 0.2];
    scene.objects[0].specular.strength = 0.6;
    change(&mut scene.objects[0]);
    scene
}

fn of(roughness: f32, metalness: f32) -> Option<Material> {
    Some(Material {
        roughness,
        metalness,
    })
}

/// Materials, a turned and stretched solid, an eye within, a texture, bumps and shadows.
fn cases() -> Vec<(&'static str, Scene)> {
    let above = || scene_of(shapes::vase(), eye(25.0, 1.8));
    let below = || scene_of(shapes::torus(), eye(-40.0, 1.8));
    vec![
        ("default", with_sky(above(), |_| {})),
        ("mirror", with_sky(below(), |o| o.material = of(0.0, 0.0))),
        ("metal", with_sky(above(), |o| o.material = of(0.1, 1.0))),
        ("rough", with_sky(below(), |o| o.material = of(1.0, 0.5))),
        (
            "turned",
            with_sky(above(), |o| {
                o.material = of(0.2, 0.3);
                o.placement = placement([0.1, -0.2, 0.3], [0.7, -0.4, 1.1], [1.4, 0.6, 1.0]);
            }),
        ),
        (
            "within",
            with_sky(
                scene_of(shapes::sphere(), DVec3::new(0.1, 0.05, 0.4)),
                |o| o.material = of(0.0, 0.0),
            ),
        ),
        (
            "textured and bumped",
            with_sky(above(), |o| {
                o.texturing.color_map = Some(color_map(2, 2, |_, _| [200, 90, 40, 255]));
                o.texturing.displacement_map = Some(slope_map(8, |x, _| x as f32 / 16.0));
                o.texturing.bump = 0.02;
                o.material = of(0.0, 1.0);
            }),
        ),
        (
            "in shadow",
            with_sky(above(), |o| o.material = of(0.1, 0.0)).with(|s| {
                let mut table = Object::new("table", Arc::new(shapes::cone()));
                table.placement = placement([0.0, 0.0, -0.3], [0.0; 3], [2.5, 2.5, 0.6]);
                s.objects.push(table);
                s.shadow = Shadow::Hard;
            }),
        ),
    ]
}

/// Over the pixels whose normals agree, the part of pixels whose colours differ by more than a
/// two-hundredth of the light, the mean difference, and the number of pixels.
fn apart(truth: &Frame, frame: &Frame) -> (f64, f64, usize) {
    let (mut far, mut sum, mut count) = (0, 0.0, 0);
    for i in (0..truth.pixels()).filter(|&i| truth.hits(i) && frame.hits(i)) {
        let normal = |f: &Frame| Vec3::from(f.shading_normal[i]);
        if normal(truth).distance(normal(frame)) < 2e-3 {
            let differ = |c: usize| (truth.color[i][c] - frame.color[i][c]).abs();
            let most = differ(0).max(differ(1)).max(differ(2));
            far += usize::from(most > 0.005);
            sum += f64::from(most);
            count += 1;
        }
    }
    (far as f64 / count as f64, sum / count as f64, count)
}

#[test]
fn reflections_are_the_references() {
    for (name, scene) in cases() {
        let settings = sized(160, 120);
        let truth = reference(&scene, &settings);
        for stage in STAGES {
            for solver in [Solver::Quadric, Solver::Live] {
                let settings = Settings { solver, ..settings }.with(|s| s.stage = stage);
                let (far, mean, count) = apart(&truth, &draw(&scene, &settings));
                let what = format!("{name}, {stage:?}, {solver}: {far} far, mean {mean:.6}");
                println!("{what} of {count}");
                // An edge of a shadow may be a pixel aside.
                assert!(far < 0.01 && mean < 2e-3 && count > 800, "{what}");
            }
        }
    }
}

/// Each value of the sky and of the material changes the pictures of the test above.
#[test]
fn every_value_is_seen() {
    type Change = (&'static str, fn(&mut Scene));
    let changes: [Change; 6] = [
        ("no sky", |s| s.environment = None),
        ("up", |s| s.environment.as_mut().unwrap().up[2] = 0.5),
        ("down", |s| s.environment.as_mut().unwrap().down[0] = 0.6),
        ("specular", |s| s.objects[0].specular.strength = 0.4),
        ("roughness", |s| s.objects[0].material = of(1.0, 0.9)),
        ("metalness", |s| s.objects[0].material = of(0.0, 0.0)),
    ];
    let base = with_sky(scene_of(shapes::vase(), eye(25.0, 1.8)), |o| {
        o.material = of(0.0, 0.9);
    });
    let settings = sized(80, 60);
    let truth = reference(&base, &settings);
    for (name, change) in changes {
        let changed = reference(&base.clone().with(change), &settings);
        let drawn = draw(&base.clone().with(change), &settings);
        let [seen, right] = [&truth, &changed].map(|other| apart(other, &drawn).1);
        assert!(seen > 0.02 && right < 1e-3, "{name}: {seen} and {right}");
    }
}
