//! Frames in several submissions, as on a GPU whose system limits the time of one.

use crate::common::prelude::*;
use crate::embedding::{hundred, three};

/// Three solids, with copies of one, or in each other's shadows.
fn scenes() -> [(&'static str, Scene); 3] {
    let mut shadows = three();
    shadows.shadow = Shadow::Hard;
    [
        ("three", three()),
        ("copies", hundred()),
        ("shadows", shadows),
    ]
}

/// Draws a frame in one submission, then in bands of 8 rows. Returns both, their look-ups apart.
pub fn both(
    device: &Device,
    scene: &Scene,
    settings: &Settings,
    samples: u32,
) -> [(Frame, f32); 2] {
    let options = OffscreenOptions {
        samples,
        submission_ms: Some(1e-6),
        ..OffscreenOptions::default()
    };
    let mut drawn = Offscreen::with(device, scene, settings, options).unwrap();
    let mut paths = Vec::new();
    // A first frame of few rays is one submission; its time divides the second.
    [1, settings.height.div_ceil(8)].map(|submissions| {
        assert_eq!(drawn.draw().unwrap().submissions, submissions);
        paths.push(drawn.renderer().draw_paths());
        assert_eq!(paths.last(), paths.first());
        let mut frame = drawn.read().unwrap();
        let steps = frame.steps.iter().sum();
        frame.steps.fill(0.0);
        (frame, steps)
    })
}

/// True if two frames differ by roundings: of a list of patches and of the tree.
fn rounded_alike(a: &Frame, b: &Frame) -> bool {
    let near = |(a, b): (&f32, &f32)| a == b || (a - b).abs() <= 4.0 * f32::EPSILON * a.abs();
    let alike = |(a, b): (&[f32; 4], &[f32; 4])| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3);
    a.distance.iter().zip(&b.distance).all(near) && a.color.iter().zip(&b.color).all(alike)
}

/// Bands of rows, drawn one by one, are the whole frame: in the fragment stage to the last bit of
/// every plane, in compute but for roundings, since a band may list patches where the whole frame
/// does not. Look-ups that hit nothing may differ: tiles are left out by the rows that are drawn.
#[test]
fn bands_are_the_whole_frame() {
    let kinds = [
        (DrawStage::Fragment, Planes::All, false, 1),
        (DrawStage::Fragment, Planes::Color, true, 1),
        (DrawStage::Fragment, Planes::Color, false, 4),
        (DrawStage::Compute, Planes::All, false, 1),
        (DrawStage::Compute, Planes::Color, true, 1),
    ];
    // By lists of patches or cells wherever there are any, and by none.
    let all = scenes()
        .into_iter()
        .flat_map(|s| kinds.map(|k| (s.clone(), k)));
    for ((name, scene), (stage, planes, antialias, samples)) in all {
        let least: &[u32] = match name {
            "three" => &[0, u32::MAX],
            "copies" => &[0],
            _ => &[u32::MAX],
        };
        for &proxy_min_pixels in least {
            let settings = Settings {
                stage,
                planes,
                antialias,
                proxy_min_pixels,
                ..sized(203, 150)
            };
            let [(whole, steps), (bands, steps_of_bands)] =
                both(device(), &scene, &settings, samples);
            let what = format!("{name}, {stage:?}, {planes:?}, {samples} samples");
            match (stage, whole.first_difference(&bands)) {
                (DrawStage::Compute, Some(_)) => assert!(rounded_alike(&whole, &bands), "{what}"),
                (_, Some(difference)) => panic!("{what}: {difference}"),
                (_, None) => {}
            }
            // The tree counts more look-ups than a list does; rows that are drawn twice count double.
            let more = steps_of_bands / steps.max(1.0);
            assert!(
                planes != Planes::All || (0.7..1.4).contains(&more),
                "{what}: {more}"
            );
        }
    }
}
