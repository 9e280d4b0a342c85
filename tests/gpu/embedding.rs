//! The renderer in a host that owns device, pass, depth buffer and frames in flight. The host is
//! that of `examples/host`, with the validation layers' synchronization checks.
#![allow(unsafe_code)]

use crate::common::host::{self, Drawn, Host, Mesh, Options, Picture, Stage, frame, opened};
use crate::common::prelude::*;

pub const BACKGROUND: [f32; 4] = [0.2, 0.25, 0.3, 1.0];

pub fn options() -> Options {
    Options::new(240, 180)
}

fn renderer(device: &Device, stage: &Stage) -> Renderer {
    host::renderer(device, stage, &SearchSettings::exact(), host::FRAMES)
}

/// The matrices of a scene's camera.
pub fn matrices(scene: &Scene) -> [DMat4; 2] {
    host::view_and_projection(scene.camera.eye, scene.camera.target, &options())
}

pub fn three() -> Scene {
    let mut scene = scene_of(shapes::vase(), eye(25.0, 3.0));
    scene.background = BACKGROUND;
    let mut ball = Object::new("ball", shapes::sphere().into());
    ball.placement.position.y = 0.7;
    ball.color = [0.7, 0.2, 0.1];
    let mut glass = Object::new("glass", shapes::glass().into());
    glass.placement.position.y = -0.9;
    glass.offset.extend = 0.01;
    scene.objects.extend([ball, glass]);
    scene
}

/// The same scene with a hundred copies of the ball.
pub fn hundred() -> Scene {
    let mut scene = three();
    let place = |n: u32| {
        let (x, y) = (f64::from(n / 10), f64::from(n % 10));
        scaled([-0.4 * x, 0.3 * y - 1.5, 0.0], 0.4)
    };
    scene.objects[1].instances = (0..100).map(place).collect();
    scene
}

/// Scenes that every draw path takes some of: cells, tiles of copies, boxes of replicas, what the
/// box cuts, shadows, an eye within.
pub fn every_way() -> Vec<(&'static str, Scene)> {
    let with = |change: fn(&mut Scene)| {
        let mut scene = three();
        change(&mut scene);
        scene
    };
    vec![
        ("three", three()),
        ("copies", hundred()),
        ("replicas", with(|s| s.objects[0].repeat = [2, 3, 1])),
        (
            "cut by the box",
            with(|s| {
                s.objects[0].clip = Clip::Box;
                s.objects[0].axis = [0.45, 0.5];
                s.objects[0].offset.extend = 0.3;
            }),
        ),
        ("shadows", with(|s| s.shadow = Shadow::Hard)),
        (
            "one",
            with(|s| {
                s.objects.truncate(1);
                s.objects[0].profile = shapes::glass().into();
            }),
        ),
        (
            "an eye within",
            with(|s| {
                s.camera.eye = DVec3::new(0.02, 0.01, 0.5);
                s.camera.target = DVec3::new(-0.3, 0.4, 0.45);
            }),
        ),
    ]
}

/// The host's picture of this scene only, in a pass of colours by the exact search.
pub fn drawn(
    host: &Host,
    device: &Device,
    options: Options,
    scene: &Scene,
    view: &View,
) -> Picture {
    let output = host::pass(&options, &[host::COLOR], Planes::Color);
    let by = (output, &SearchSettings::exact());
    Drawn::new(host, device, options, by, scene)
        .seen(view)
        .picture()
}

#[test]
fn alone_it_draws_the_off_screen_frame() {
    let (host, device) = opened();
    let scene = three();
    let settings = sized(options().width, options().height).with(|s| s.planes = Planes::Color);
    let mut offscreen = Offscreen::new(&device, &scene, &settings).unwrap();
    let wanted = revmap_files::Picture::of(&next_frame(&mut offscreen));
    let wanted = wanted.unwrap().rgba.concat();
    let view = *offscreen.view();
    let drawn = |options: Options| {
        let mut stage = Stage::new(&host, options).unwrap();
        let mut renderer = renderer(&device, &stage);
        host::add(&mut renderer, &scene);
        for _ in 0..3 {
            frame(&mut stage, &mut renderer, &view, DMat4::IDENTITY, &[]);
        }
        stage.read().unwrap().0
    };
    for dynamic in [true, false] {
        let options = options().with(|o| o.dynamic = dynamic);
        let one = drawn(options);
        assert!(one == wanted, "dynamic {dynamic}: pixels differ");
        // All four samples use the ray through the pixel's centre, so pixels away from silhouettes
        // are equal.
        let four = drawn(options.with(|o| o.samples = 4));
        let differ = (0..wanted.len() / 4)
            .filter(|n| one[4 * n..4 * n + 4] != four[4 * n..4 * n + 4])
            .count();
        println!("dynamic {dynamic}: {differ} pixels of four samples differ");
        assert!(differ < wanted.len() / 4 / 50, "{differ}");
    }
}

/// The object visible at a pixel: the solid, the host's sphere, or neither.
fn kind(pixel: &[u8]) -> u8 {
    match pixel[0] {
        255 => 1,
        0 => 2,
        _ => 0,
    }
}

/// The host's sphere intersects a cylinder drawn by the renderer. Their intersection curve has an
/// exact formula.
#[test]
fn meshes_meet_solids_where_they_should() {
    let (host, device) = opened();
    let (middle, radius, wide) = (DVec3::new(0.35, -0.1, 0.45), 0.3, 0.3);
    let mut object = Object::new("cylinder", shapes::column_of(wide).into());
    object.color = [1.0, 0.0, 0.0];
    let lighting = Lighting::default().with(|l| (l.ambient, l.lights) = ([1.0; 3], Vec::new()));
    let (from, to) = (DVec3::new(2.6, 0.9, 1.6), DVec3::new(0.0, 0.0, 0.45));
    let outside = [(false, true), (false, false), (true, true), (true, false)];
    let outside = outside.map(|(reversed, dynamic)| (reversed, dynamic, false));
    // An eye within the solid: drawn by the box.
    for (reversed, dynamic, inside) in outside.into_iter().chain([(true, true, true)]) {
        let options = options().with(|o| (o.dynamic, o.reversed) = (dynamic, reversed));
        let (from, to) = match inside {
            true => (DVec3::new(-0.1, 0.0, 0.5), DVec3::new(0.3, -0.6, 0.5)),
            false => (from, to),
        };
        let mut stage = Stage::new(&host, options).unwrap();
        let mut renderer = renderer(&device, &stage);
        renderer.set_lighting(&lighting).unwrap();
        renderer.add(object.clone()).unwrap();
        let sphere = Mesh::sphere(&host, 256, middle.as_vec3(), radius as f32, Vec3::Z).unwrap();
        let [view, projection] = host::view_and_projection(from, to, &options);
        let seen = host::view([view, projection], &options).unwrap();
        for _ in 0..2 {
            let meshes = std::slice::from_ref(&sphere);
            frame(&mut stage, &mut renderer, &seen, projection * view, meshes);
        }
        let (pixels, depths) = stage.read().unwrap();
        let camera = Camera::new(from, to);
        let rays = CameraFrame::new(&camera, options.width, options.height).unwrap();
        let (w, h) = (options.width as usize, options.height as usize);
        let truth: Vec<(u8, f64)> = (0..w * h)
            .map(|n| {
                let v = rays.pixel((n % w) as u32, (n / w) as u32);
                let ball = ball(from - middle, v, radius);
                let solid = upright(from, v, wide);
                match ball.min(solid) {
                    f64::INFINITY => (0, f64::INFINITY),
                    t => (if ball < solid { 2 } else { 1 }, t),
                }
            })
            .collect();
        let (mut off, mut hits, mut worst) = (0, [0; 3], 0.0f64);
        for n in 0..w * h {
            let found = kind(&pixels[4 * n..4 * n + 4]);
            hits[usize::from(found)] += 1;
            if found == truth[n].0 {
                if found == 1 {
                    let wanted = seen.depth_at(truth[n].1);
                    let inverse = seen.t_at(wanted) / truth[n].1;
                    assert!((inverse - 1.0).abs() < 1e-9, "{inverse}");
                    worst = worst.max((f64::from(depths[n]) - wanted).abs());
                }
                continue;
            }
            // One neighbour must be of this kind: the curve is within a pixel.
            let (x, y) = ((n % w) as i64, (n / w) as i64);
            let near = (-1..=1).any(|dy| {
                (-1..=1).any(|dx| {
                    let (x, y) = (x + dx, y + dy);
                    let within = x >= 0 && y >= 0 && x < w as i64 && y < h as i64;
                    within && truth[(y as usize) * w + x as usize].0 == found
                })
            });
            off += usize::from(!near);
        }
        println!("reversed {reversed}, dynamic {dynamic}: {hits:?}, depth {worst:e}");
        assert!(hits[1] > 2000 && hits[2] > 1000, "{hits:?}");
        assert_eq!(off, 0, "reversed {reversed}, dynamic {dynamic}");
        // Bound of one part in 2^20, as for a host's own rasterised depths.
        assert!(worst <= 2f64.powi(-20), "{worst:e}");
    }
}

/// The nearest t >= 0 at which a ray meets a sphere about the origin.
fn ball(o: DVec3, v: DVec3, radius: f64) -> f64 {
    let (a, b, c) = (v.dot(v), o.dot(v), o.dot(o) - radius * radius);
    let under = b * b - a * c;
    let roots = [(-b - under.sqrt()) / a, (-b + under.sqrt()) / a];
    // The host culls nothing, so an eye within the sphere sees its back.
    let seen = roots.into_iter().find(|t| *t >= 0.1);
    seen.unwrap_or(f64::INFINITY)
}

/// The nearest hit of the cylinder `x^2 + y^2 <= r^2, 0 <= z <= 1`; its back for an eye within.
pub fn upright(o: DVec3, v: DVec3, radius: f64) -> f64 {
    let (of, vf): (DVec2, DVec2) = (o.truncate(), v.truncate());
    let (a, b, c) = (vf.dot(vf), of.dot(vf), of.dot(of) - radius * radius);
    let under = b * b - a * c;
    if under < 0.0 {
        return f64::INFINITY;
    }
    let mut span = [(-b - under.sqrt()) / a, (-b + under.sqrt()) / a];
    let mut levels = [-o.z / v.z, (1.0 - o.z) / v.z];
    levels.sort_by(f64::total_cmp);
    span = [span[0].max(levels[0]), span[1].min(levels[1])];
    if span[0] > span[1] {
        return f64::INFINITY;
    }
    let seen = span.into_iter().find(|t| *t >= 0.1);
    seen.unwrap_or(f64::INFINITY)
}
