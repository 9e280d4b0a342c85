//! The planes and colours of the mesh baseline are those of the reference and of the renderer.

use crate::mesh::{BEVELED, ROWS, draw, reference, searched, settings, within};
use crate::scenes::{errors, eye, placement, scene_of};
use crate::shapes;
use glam::DVec3;
use revmap::frame::Frame;
use revmap::maps::Projection;
use revmap::profile::Profile;
use revmap::scene::{Camera, Environment, Light, Material, Object, Scene, Shadow, Specular};
use revmap::settings::Planes;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Names of planes that are wrong in more pixels than edges have.
pub fn wrong_planes(truth: &Frame, frame: &Frame) -> Vec<&'static str> {
    let both: Vec<usize> = (0..truth.pixels())
        .filter(|&k| truth.hits(k) && frame.hits(k))
        .collect();
    assert!(both.len() > 2000);
    let mut wrong = Vec::new();
    let mut check = |name, most: f32, difference: &dyn Fn(usize) -> f32| {
        let beyond = both.iter().filter(|&&k| difference(k) > most).count();
        println!(
            "{name}: {:.3} % beyond {most}",
            100.0 * beyond as f64 / both.len() as f64
        );
        if beyond * 33 > both.len() {
            wrong.push(name);
        }
    };
    fn apart<const N: usize>(a: [f32; N], b: [f32; N]) -> f32 {
        let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f32::max)
    }
    let hits = |k: usize| truth.hits(k) != frame.hits(k);
    let strayed = (0..truth.pixels()).filter(|&k| hits(k)).count();
    check("distance", 1e-3, &|k| {
        (truth.distance[k] - frame.distance[k]).abs()
    });
    check("normal", 0.05, &|k| apart(truth.normal[k], frame.normal[k]));
    check("shading normal", 0.08, &|k| {
        apart(truth.shading_normal[k], frame.shading_normal[k])
    });
    check("albedo", 0.03, &|k| apart(truth.albedo[k], frame.albedo[k]));
    check("uv", 4e-3, &|k| {
        let [u, v] = [0, 1].map(|i| (truth.uv[k][i] - frame.uv[k][i]).abs());
        u.min(1.0 - u).max(v)
    });
    check("color", 0.05, &|k| apart(truth.color[k], frame.color[k]));
    if strayed * 300 > both.len() {
        wrong.push("hits");
    }
    wrong
}

#[test]
fn every_plane_is_the_reference_s() {
    for projection in [
        Projection::Planar,
        Projection::Cylindrical,
        Projection::Spherical,
    ] {
        let mut scene = scene_of(shapes::vase(), eye(33.0, 1.9));
        let object = &mut scene.objects[0];
        object.texturing.projection = projection;
        object.color = [0.7, 0.3, 0.1];
        object.offset = BEVELED;
        object.placement = placement([0.05, 0.0, 0.1], [0.3, -0.2, 0.4], [1.1, 0.8, 0.9]);
        let settings = settings(256, 512);
        let frame = draw(&scene, &settings);
        for pixel in 0..frame.pixels() {
            let infinite = |v: &f32| !v.is_finite();
            let wrong = frame.pixel(pixel).iter().filter(|v| infinite(v)).count();
            assert_eq!(wrong, usize::from(!frame.hits(pixel)), "only Z of no hit");
        }
        assert!(frame.steps.iter().all(|s| *s == 0.0), "nothing is searched");
        let wrong = wrong_planes(&reference(&scene, &settings), &frame);
        assert!(wrong.is_empty(), "{projection:?}: {wrong:?}");
    }
}

/// A cone's normals are the same on both: so are its colours, under any number of lights.
#[test]
fn shading_is_the_renderer_s() {
    let mut scene = scene_of(shapes::cone(), eye(30.0, 1.6));
    scene.ambient = [0.05, 0.1, 0.2];
    scene.background = [0.2, 0.1, 0.0, 0.5];
    let object = &mut scene.objects[0];
    object.color = [0.2, 0.6, 0.4];
    object.specular = Specular {
        strength: 0.8,
        shininess: 9.0,
    };
    object.placement = placement([0.1, 0.0, 0.0], [0.3, 0.1, 0.0], [0.9, 0.8, 1.0]);
    let all = [
        ([-0.4, -0.6, -0.7], [0.9, 0.2, 0.1]),
        ([-0.9, 0.3, -0.1], [0.1, 0.8, 0.2]),
        ([0.1, -0.8, 0.3], [0.2, 0.2, 0.9]),
        ([-0.3, 0.2, -0.9], [0.3, 0.3, 0.0]),
    ];
    for count in 0..=all.len() {
        let light = |(direction, color): ([f64; 3], _)| Light {
            direction: direction.into(),
            color,
            ..Light::default()
        };
        scene.lights = all[..count].iter().copied().map(light).collect();
        // In 8 bits a rounding the other way is a step of sRGB, at most 0.009.
        for (planes, bound) in [(Planes::All, 1e-4), (Planes::Color, 1e-2)] {
            let settings = settings(512, 8).storing(planes);
            let apart = colors_apart(&draw(&scene, &settings), &searched(&scene, &settings));
            let most = apart[apart.len() * 99 / 100];
            println!("{count} lights, {planes:?}: 99 % below {most}");
            assert!(
                apart.len() > 5000 && most < bound,
                "{count} lights, {planes:?}"
            );
        }
    }
    // A highlight that is a little narrower is seen.
    let settings = settings(512, 8);
    let frame = draw(&scene, &settings);
    scene.objects[0].specular.shininess = 10.0;
    let apart = colors_apart(&frame, &searched(&scene, &settings));
    assert!(apart[apart.len() * 99 / 100] > 1e-2);
}

/// How far colours are apart where both frames hit, in rising order.
fn colors_apart(a: &Frame, b: &Frame) -> Vec<f32> {
    let mut apart: Vec<f32> = (a.color.iter().zip(&b.color))
        .filter(|(a, b)| a[3] == 1.0 && b[3] == 1.0)
        .map(|(a, b)| (a.iter().zip(b)).fold(0.0, |most, (a, b)| f32::max(most, (a - b).abs())))
        .collect();
    apart.sort_by(f32::total_cmp);
    apart
}

/// [`shapes::torus`] of other steps. Reflections show the edges of few.
fn torus(steps: u32) -> Object {
    let angles = (0..steps).map(|k| TAU * f64::from(k) / f64::from(steps));
    let points: Vec<_> = angles
        .map(|angle| [0.28 + 0.12 * angle.cos(), 0.5 + 0.12 * angle.sin()])
        .collect();
    Object::new("torus", Arc::new(Profile::polygon(&points, 0.5).unwrap()))
}

/// The part of the pixels whose colours differ by more than this part of the light.
fn wrong(truth: &Frame, frame: &Frame, most: f32) -> f64 {
    let pixels = truth.color.iter().zip(&frame.color);
    let far = |(a, b): &(&[f32; 4], &[f32; 4])| (0..3).any(|c| (a[c] - b[c]).abs() > most);
    pixels.filter(far).count() as f64 / truth.color.len() as f64
}

/// A torus over a plate, lit from the side: shadow maps put shadows where the reference has them,
/// but for some pixels at their edges.
#[test]
fn shadow_maps_agree_with_rays() {
    let plate = [[0.0, 0.02], [0.9, 0.02], [0.9, 0.1], [0.0, 0.1]];
    let plate = Profile::polygon(&plate, 1.0).unwrap();
    let mut scene = Scene::new(Camera::new(DVec3::new(2.2, 0.4, 1.8), DVec3::ZERO));
    scene.objects = vec![Object::new("plate", Arc::new(plate)), torus(256)];
    scene.lights = vec![Light {
        direction: DVec3::new(0.5, 1.0, -0.8),
        radius: 4.0,
        ..Light::default()
    }];
    let settings = within(0.25).sized(320, 240);
    let unshaded = draw(&scene, &settings);
    for (shadow, most) in [(Shadow::Hard, 0.01), (Shadow::Soft, 0.02)] {
        scene.shadow = shadow;
        let truth = reference(&scene, &settings);
        let wrong = |frame: &Frame| wrong(&truth, frame, 0.1);
        let [with, without] = [wrong(&draw(&scene, &settings)), wrong(&unshaded)];
        assert!(with < most, "{shadow:?}: {with}");
        assert!(without > 0.04, "{shadow:?}: {without}");
    }
}

/// A metal and a glazed solid reflect the sky as in the reference.
#[test]
fn meshes_reflect_the_environment() {
    let mut scene = Scene::new(Camera::new(DVec3::new(2.2, 0.4, 1.8), DVec3::ZERO));
    let [mut metal, mut glazed] = [64, 256].map(torus);
    metal.specular.strength = 0.8;
    metal.material = Some(Material {
        roughness: 0.2,
        metalness: 1.0,
    });
    glazed.specular.strength = 2.0;
    glazed.placement.position.x = -1.2;
    scene.objects = vec![metal, glazed];
    scene.environment = Some(Environment {
        up: [0.4, 0.6, 0.9],
        down: [0.3, 0.1, 0.0],
    });
    let settings = within(0.25).sized(320, 240);
    let truth = reference(&scene, &settings);
    let wrong = |scene: &Scene| wrong(&truth, &draw(scene, &settings), 0.03);
    let with = wrong(&scene);
    scene.objects[0].material = None;
    let dull = wrong(&scene);
    scene.environment = None;
    // Reflections are strongest at the silhouette, which keeps a quarter of a pixel.
    let without = wrong(&scene);
    assert!(
        with < 0.03 && dull > 0.06 && without > 0.09,
        "{with} {dull} {without}"
    );
}

/// The checks above can fail.
#[test]
fn planted_faults_are_found() {
    let mut scene = scene_of(shapes::glass(), eye(25.0, 1.9));
    let settings = settings(256, 512);
    let truth = reference(&scene, &settings);
    let good = draw(&scene, &settings);
    assert_eq!(wrong_planes(&truth, &good), [""; 0]);

    let mut turned = good.clone();
    for n in &mut turned.normal {
        *n = n.map(|v| -v);
    }
    assert_eq!(wrong_planes(&truth, &turned), ["normal"]);
    assert!(errors(&truth, &turned, ROWS).normal.unwrap().rms > 170.0);

    // Every seventh pixel too deep, as where a far face covers a near one.
    let mut behind = good.clone();
    for (k, z) in behind.distance.iter_mut().enumerate() {
        *z += if k % 7 == 0 { 0.01 } else { 0.0 };
    }
    assert_eq!(wrong_planes(&truth, &behind), ["distance"]);

    // One ring of the glass a texel too wide.
    let mut points = shapes::GLASS;
    points[6][0] += 1.0 / f64::from(ROWS);
    let bent = Profile::polygon(&points, 0.5).unwrap();
    scene.objects[0].profile = Arc::new(bent);
    let bent = errors(&truth, &draw(&scene, &settings), ROWS)
        .depth
        .unwrap();
    let straight = errors(&truth, &good, ROWS).depth.unwrap();
    assert!(bent.p99 > 10.0 * straight.p99, "{bent:?} {straight:?}");
}
