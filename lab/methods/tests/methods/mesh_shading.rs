//! The planes and colours of the mesh baseline are those of the reference and of the renderer.

use crate::mesh::{BEVELED, ROWS, draw, reference, searched, settings};
use crate::scenes::{errors, eye, placement, scene_of};
use crate::shapes;
use revmap::frame::Frame;
use revmap::maps::Projection;
use revmap::profile::Profile;
use revmap::scene::{Light, Specular};
use revmap::settings::Planes;
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
