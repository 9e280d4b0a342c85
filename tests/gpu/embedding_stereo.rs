//! Several views in one pass by multiview: each has the bits of a pass of its own.
#![allow(unsafe_code)]

use crate::common::host::{self, Attachments, Host, borrow, dynamic, once, open};
use crate::embedding::{options, three};
use ash::vk;
use glam::{DQuat, DVec3};
use revmap::error::ErrorKind;
use revmap::gpu::{Device, Output, PassFormats, Renderer, View};
use revmap::scene::{Clip, Object, Placement, Scene, Shadow};
use revmap::settings::{Planes, SearchSettings};

/// Bytes of colours and depths of all views.
type Picture = (Vec<u8>, Vec<f32>);

fn renderer(device: &Device, scene: &Scene, views: u32, slots: usize) -> Renderer {
    let output = Output::Pass(PassFormats {
        views,
        ..host::color_pass()
    });
    host::renderer_of(device, output, &SearchSettings::default(), slots, scene)
}

/// Draws views, one slot each, in one pass.
fn drawn(host: &Host, renderer: &mut Renderer, views: &[View]) -> Picture {
    let formats = [(host::COLOR, 4)];
    let into = Attachments::of_views(host, options(), &formats, views.len() as u32).unwrap();
    once(host, |cmd| {
        // SAFETY: `cmd` is recording; no frame is in flight; the pass has the output's formats.
        unsafe {
            let frames: Vec<_> = (0u32..)
                .zip(views)
                .map(|(n, view)| {
                    renderer
                        .prepare(cmd, n as usize, &view.with_layer(n))
                        .unwrap()
                })
                .collect();
            let record = || {
                for frame in &frames {
                    renderer.record(cmd, frame).unwrap();
                }
            };
            into.draw(cmd, &[vk::ClearColorValue::default()], false, record);
            into.copy(cmd);
        }
    });
    (into.color(0), into.depths())
}

/// Cells, boxes, cut cells and quads of copies.
fn scene(shadow: Shadow) -> Scene {
    let mut scene = three();
    scene.shadow = shadow;
    scene.objects[1].repeat = [2, 1, 1];
    scene.objects[2].clip = Clip::Box;
    scene.objects[2].offset.extend = 0.1;
    let mut copies = Object::new("copies", crate::common::shapes::jewel().into());
    copies.instances = (0..300)
        .map(|n| Placement {
            position: DVec3::new(
                f64::from(n % 20) * 0.2 - 3.0,
                f64::from(n / 20) * 0.2 - 1.5,
                -0.4,
            ),
            rotation: DQuat::from_rotation_x(0.1 * f64::from(n)),
            scale: DVec3::splat(0.15),
        })
        .collect();
    scene.objects.push(copies);
    scene
}

/// The views of two eyes, and of one that looks from elsewhere.
fn views(scene: &Scene, count: usize) -> Vec<View> {
    let size = (options().width, options().height);
    let of = |beside: DVec3| {
        let mut camera = scene.camera;
        camera.eye += beside;
        camera.target += 0.5 * beside;
        View::from_camera(&camera, size, [0.1, 50.0]).unwrap()
    };
    [0.03, -0.03, 0.9][..count]
        .iter()
        .map(|x| of(DVec3::new(0.0, *x, 0.5 * x)))
        .collect()
}

#[test]
fn views_of_one_pass_have_the_bits_of_single_passes() {
    let host = open();
    let device = borrow(&host);
    for (shadow, count) in [(Shadow::Off, 2), (Shadow::Hard, 2), (Shadow::Off, 3)] {
        let scene = scene(shadow);
        let views = views(&scene, count);
        let mut both = renderer(&device, &scene, count as u32, count);
        let found = drawn(&host, &mut both, &views);
        let mut one = renderer(&device, &scene, 1, 1);
        let mut wanted = Picture::default();
        for view in &views {
            let (colors, depths) = drawn(&host, &mut one, &[*view]);
            assert!(depths.iter().filter(|depth| **depth < 1.0).count() > 5000);
            assert!(wanted.0.is_empty() || !wanted.0.ends_with(&colors));
            wanted.0.extend(colors);
            wanted.1.extend(depths);
        }
        assert!(found == wanted, "{shadow:?}, {count} views");
    }
}

#[test]
fn wrong_views_are_refused() {
    let host = open();
    let device = borrow(&host);
    let output = |views, planes| {
        Output::Pass(PassFormats {
            views,
            ..PassFormats::new(dynamic(&[host::COLOR]), planes)
        })
    };
    let settings = SearchSettings::default();
    for views in [0, 7, u32::MAX] {
        let made = Renderer::new(&device, output(views, Planes::Color), &settings, 1);
        let error = made.err().unwrap();
        assert_eq!(error.kind, ErrorKind::Usage);
        assert_eq!(error.key.as_deref(), Some("views"));
    }
    let scene = scene(Shadow::Off);
    let mut renderer = renderer(&device, &scene, 2, 1);
    let view = views(&scene, 1)[0].with_layer(2);
    once(&host, |cmd| {
        // SAFETY: `cmd` is recording; no frame is in flight.
        let refused = unsafe { renderer.prepare(cmd, 0, &view) };
        assert_eq!(refused.unwrap_err().kind, ErrorKind::Usage);
    });
}
