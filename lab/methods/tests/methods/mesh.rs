//! The mesh baseline: that it is the same solid, as exact as its tessellation lets it be, shaded as
//! the renderer shades, and that what it does not draw is refused. All under the validation layers.

use crate::scenes::{errors, eye, placement, scene_of};
use crate::shapes;
use revmap::error::ErrorKind;
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::maps::{Projection, SlopeFilter};
use revmap::scene::{Clip, Light, Object, Offset, Placement, Scene, Shadow};
use revmap::settings::{DrawStage, Planes, Solver};
use revmap_compare::{CompareOptions, Comparison, Reference};
use revmap_methods::renderer::{MethodDevice, MethodRenderer};
use revmap_methods::{Method, MethodSettings};
use std::sync::{Arc, OnceLock};

/// Depths are said in texels of a map of so many.
pub const ROWS: u32 = 512;

/// The device of these tests. Without a device or without the layers, tests fail.
fn device() -> &'static (Device, MethodDevice) {
    static DEVICE: OnceLock<(Device, MethodDevice)> = OnceLock::new();
    DEVICE.get_or_init(|| {
        let device = Device::open_validated(None).unwrap();
        (device.clone(), MethodDevice::new(device).unwrap())
    })
}

pub fn renderer(scene: &Scene, settings: &MethodSettings) -> revmap::Result<MethodRenderer> {
    device().1.renderer(scene, settings)
}

pub fn settings(segments: u32, rings: u32) -> MethodSettings {
    let mesh = Method::mesh(segments, rings).unwrap();
    MethodSettings::default().by(mesh).sized(240, 180)
}

/// Draws meshes; any message of the layers is a failure.
pub fn draw(scene: &Scene, settings: &MethodSettings) -> Frame {
    device().1.draw(scene, settings).unwrap()
}

/// Draws by the exact search.
pub fn searched(scene: &Scene, settings: &MethodSettings) -> Frame {
    draw(scene, &settings.by(Solver::Quadric))
}

pub fn reference(scene: &Scene, settings: &MethodSettings) -> Frame {
    revmap_reference::draw(scene, &settings.into(), &|_, _| {}).unwrap()
}

/// What a mesh of a scene errs: of the hits few are wrong, and 99 % of the depths are near.
fn held(scene: &Scene, settings: &MethodSettings, wrong: f64, p99: f64) -> Comparison {
    let found = errors(&reference(scene, settings), &draw(scene, settings), ROWS);
    let depth = found.depth.unwrap().p99;
    assert!(found.hits > 4000 && found.wrong() < wrong, "{found}");
    assert!(depth < p99, "{found}");
    found
}

pub const BEVELED: Offset = Offset {
    extend: -0.01,
    bevel: 0.3,
    chamfer: 0.25,
};

/// Both steps of a tessellation halved: errors of chords fall to a quarter.
#[test]
fn errors_fall_with_the_square_of_the_steps() {
    let solids = [
        ("vase", shapes::vase()),
        ("torus", shapes::torus()),
        ("glass", shapes::glass()),
        ("sphere", shapes::sphere()),
    ];
    for (name, profile) in solids {
        for offset in [Offset::default(), BEVELED] {
            let mut scene = scene_of(profile.clone(), eye(28.0, 2.0));
            scene.objects[0].offset = offset;
            let truth = reference(&scene, &settings(3, 2));
            let drawn = |n| errors(&truth, &draw(&scene, &settings(n, 2 * n)), ROWS);
            let found = [16, 32, 64, 128, 256].map(drawn);
            let p99 = found.each_ref().map(|c| c.depth.unwrap().p99);
            let wrong = found.each_ref().map(Comparison::wrong);
            println!("{name} {offset:?}: {p99:.4?} {wrong:.4?}");
            let falls = p99.windows(2).all(|pair| pair[1] < 0.5 * pair[0]);
            assert!(falls && p99[4] < p99[0] / 100.0 && p99[4] < 0.06, "{name}");
            assert!(wrong[0] > 0.003, "{name}: the coarsest is coarse");
            assert!(wrong[4] < wrong[0] / 20.0 + 2e-4, "{name}");
            assert!(found[4].silhouette_hausdorff <= 1.0, "{name}");
        }
    }
}

#[test]
fn eyes_may_be_inside() {
    // In the vase's solid; in the glass's hollow; through the torus's hole; just above a lid.
    let cases = [
        (shapes::vase(), [0.1, 0.05, 0.6], [0.3, 0.3, 0.2]),
        (shapes::glass(), [0.05, 0.0, 0.8], [-0.2, 0.1, 0.4]),
        (shapes::torus(), [0.02, 0.0, 0.5], [0.6, 0.1, 0.55]),
        (shapes::vase(), [0.05, 0.0, 0.953], [0.2, 0.1, 0.8]),
    ];
    for (profile, eye, target) in cases {
        let mut scene = scene_of(profile, eye.into());
        scene.camera.target = target.into();
        scene.camera.fov_y = 70.0;
        let found = held(&scene, &settings(256, 512), 2e-3, 0.1);
        assert!(found.hits > 10_000 && found.normal.unwrap().rms < 5.0);
        // Of a mesh that follows the view silhouettes are within, if not depths.
        held(&scene, &within(0.25), 5e-3, 8.0);
    }
}

/// A camera that is shifted by whole pixels draws what its neighbours drew, by every method.
#[test]
fn a_shift_moves_the_picture() {
    let plain = scene_of(shapes::vase(), eye(20.0, 1.8));
    let mut shifted = plain.clone();
    shifted.camera.shift = [3.0, -2.0];
    let mesh = settings(256, 512);
    let search = |stage| mesh.by(Method::DEFAULT).in_stage(stage);
    let [fragment, compute] = [DrawStage::Fragment, DrawStage::Compute].map(search);
    type Draw<'a> = &'a dyn Fn(&Scene) -> Frame;
    let by: [(&str, Draw); 4] = [
        ("reference", &|scene| reference(scene, &mesh)),
        ("fragment", &|scene| draw(scene, &fragment)),
        ("compute", &|scene| draw(scene, &compute)),
        ("mesh", &|scene| draw(scene, &mesh)),
    ];
    for (name, draw) in by {
        let (before, after) = (draw(&plain), draw(&shifted));
        let (w, h) = (before.width as usize, before.height as usize);
        let moved = (2..h).flat_map(|y| (0..w - 3).map(move |x| ((y - 2) * w + x + 3, y * w + x)));
        let pairs: Vec<(f32, f32)> = moved
            .map(|(from, to)| (before.distance[from], after.distance[to]))
            .collect();
        let hits = pairs.iter().filter(|p| p.0.is_finite()).count();
        let same = |(a, b): &&(f32, f32)| a == b || (a - b).abs() < 1e-4;
        let wrong = pairs.len() - pairs.iter().filter(same).count();
        assert!(hits > 4000 && wrong <= 3, "{name}: {wrong} of {hits}");
    }
}

fn crowd() -> Scene {
    let mut scene = scene_of(shapes::vase(), eye(20.0, 3.0));
    let place = |k: usize, z: f64| {
        let (x, y) = ((k % 4) as f64 - 1.5, (k / 4) as f64 - 1.5);
        let turn = [0.1 * x, 0.2 * y, 0.3];
        placement([0.8 * x, 0.8 * y, z], turn, [0.7, 0.7, 0.9])
    };
    scene.objects[0].instances = (0..16).map(|k| place(k, 0.0)).collect();
    let mut glass = Object::new("glass", Arc::new(shapes::glass()));
    glass.placement = placement([0.4, 0.3, 0.3], [0.4, 0.0, 0.0], [0.6; 3]);
    let mut second = scene.objects[0].clone();
    second.color = [0.2, 0.7, 0.3];
    second.instances = (0..5).map(|k| place(3 * k, 0.5)).collect();
    scene.objects.extend([glass, second]);
    scene
}

/// Offsets and cameras that move give what a new renderer gives, in both kinds of picture.
#[test]
fn updates_leave_nothing_behind() {
    for planes in [Planes::All, Planes::Color] {
        let settings = settings(48, 96).storing(planes);
        let mut scene = crowd();
        let mut mesh = renderer(&scene, &settings).unwrap();
        mesh.draw().unwrap();
        for (n, offset) in [BEVELED, Offset::default(), BEVELED]
            .into_iter()
            .enumerate()
        {
            scene.objects[0].offset = offset;
            scene.camera.eye = eye(40.0 + 20.0 * n as f64, 2.5);
            match n {
                // More copies than before; then an object less.
                1 => scene.objects[2].instances = (0..9).map(|_| Placement::default()).collect(),
                2 => drop(scene.objects.remove(0)),
                _ => {}
            }
            let before = mesh.rebuild_count();
            mesh.update(&scene).unwrap();
            // The first offset is new; the second is that of another object, the third is gone.
            assert_eq!(mesh.rebuild_count() - before, u64::from(n == 0));
            mesh.draw().unwrap();
            let fresh = draw(&scene, &settings);
            let kept = mesh.read().unwrap();
            assert!(kept.color == fresh.color && kept.distance == fresh.distance);
        }
        // What is refused leaves the frame before.
        let before = mesh.read().unwrap();
        let mut spoilt = scene.clone();
        spoilt.objects[0].repeat = [2, 1, 1];
        assert!(mesh.update(&spoilt).is_err());
        mesh.draw().unwrap();
        assert!(mesh.read().unwrap().color == before.color);
        let bytes = mesh.map_bytes()[0];
        assert!(bytes > 2 * 16 * 48 && bytes < 10_000_000, "{bytes}");
        drop(mesh);
        device().0.check().unwrap();
    }
}

/// An offset under which nothing is left draws nothing.
#[test]
fn nothing_is_a_mesh_too() {
    let mut scene = scene_of(shapes::glass(), eye(20.0, 2.0));
    scene.objects[0].offset.extend = -0.4;
    let frame = draw(&scene, &settings(16, 32));
    assert!((0..frame.pixels()).all(|k| !frame.hits(k)));
}

fn asset(name: &str) -> String {
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/").to_owned() + name
}

#[test]
fn what_a_mesh_cannot_draw_is_refused() {
    type Spoil<'a> = &'a dyn Fn(&mut Scene, &mut MethodSettings);
    let refused = |kind: ErrorKind, key: &str, spoil: Spoil| {
        let (mut scene, mut settings) = (crowd(), settings(16, 32));
        spoil(&mut scene, &mut settings);
        let error = renderer(&scene, &settings).err().unwrap();
        let found = error.key.as_deref().unwrap_or_default();
        assert_eq!((error.kind, found), (kind, key), "{error}");
        device().0.check().unwrap();
    };
    let colors = Arc::new(revmap_files::color_map(asset("colors/natural-earth.png")).unwrap());
    let heights = asset("heights/brick.png");
    let heights = revmap_files::displacement_map(heights, SlopeFilter::default()).unwrap();
    let heights = Some(Arc::new(heights));
    type Change<'a> = &'a dyn Fn(&mut Object);
    let changes: [(&str, Change); 7] = [
        ("object.0.repeat", &|o| o.repeat = [2, 1, 1]),
        ("object.0.color_map", &|o| {
            o.texturing.color_map = Some(colors.clone());
        }),
        ("object.0.height_map", &|o| {
            o.texturing.displacement_map.clone_from(&heights);
        }),
        ("object.0.projection", &|o| {
            o.texturing.projection = Projection::Arc;
        }),
        ("object.0.axis", &|o| o.axis = [0.9, 0.5]),
        ("object.0.extend", &|o| {
            (o.offset.extend, o.clip) = (0.3, Clip::Box);
        }),
        ("object.0.bevel", &|o| {
            (o.offset.bevel, o.clip) = (0.8, Clip::Box);
        }),
    ];
    for (key, change) in changes {
        refused(ErrorKind::Content, key, &|s, _| change(&mut s.objects[0]));
        // The key names the object.
        let last = key.replace('0', "2");
        refused(ErrorKind::Content, &last, &|s, _| change(&mut s.objects[2]));
    }
    let lit: Spoil = &|s, _| (s.shadow, s.lights) = (Shadow::Hard, vec![Light::default(); 3]);
    refused(ErrorKind::Content, "light", lit);
    let compute: Spoil = &|_, s| s.stage = DrawStage::Compute;
    refused(ErrorKind::Usage, "solver", compute);
    for (segments, rings) in [(2, 1), (0, 0), (99_999_999, 9), (u32::MAX, u32::MAX)] {
        let method = Method::Mesh { segments, rings };
        refused(ErrorKind::Usage, "", &|_, s| s.method = method);
    }
}

/// A mesh that keeps silhouettes within so many pixels.
pub fn within(pixels: f64) -> MethodSettings {
    settings(3, 2).by(Method::mesh_within(pixels).unwrap())
}

/// Pixels in which colours differ.
fn apart(a: &Frame, b: &Frame) -> usize {
    a.color.iter().zip(&b.color).filter(|(a, b)| a != b).count()
}

/// The silhouette of each is within its tolerance and the device's grid of 1/256 pixels, near and
/// far, and the meshes are not finer than they must be.
#[test]
fn silhouettes_are_within_the_tolerance() {
    const GRID: f64 = 0.5 * std::f64::consts::SQRT_2 / 256.0;
    let mut largest = 0.0f64;
    for (n, profile) in [
        shapes::vase(),
        shapes::torus(),
        shapes::glass(),
        shapes::sphere(),
    ]
    .into_iter()
    .enumerate()
    {
        for (k, distance) in [0.8, 2.0, 9.0].into_iter().enumerate() {
            let mut scene = scene_of(profile.clone(), eye(10.0 + 25.0 * n as f64, distance));
            scene.objects[0].offset = [Offset::default(), BEVELED][(n + k) % 2];
            let truth = reference(&scene, &settings(3, 2));
            let options = CompareOptions::default();
            let truth = Reference::new(&truth, &options).unwrap();
            let truth = truth.of_scene(&scene).unwrap();
            for pixels in [0.1, 0.25, 1.0] {
                let found = truth.compare(&draw(&scene, &within(pixels))).unwrap();
                let off = found.view.unwrap().silhouette_max;
                assert!(
                    off <= pixels + GRID,
                    "{n} from {distance}, {pixels}: {found}"
                );
                largest = largest.max(off / pixels);
            }
            let fine = truth.compare(&draw(&scene, &settings(3, 2).by(Method::DEFAULT)));
            assert!(fine.unwrap().view.unwrap().silhouette_max < 0.02, "{n}");
        }
    }
    assert!(largest > 0.5, "{largest}");
}

/// Copies of one size share a mesh; a nearer one has a finer one. A mesh that was left comes back
/// without being made anew.
#[test]
fn copies_share_the_meshes_of_their_sizes() {
    let mut scene = scene_of(shapes::vase(), eye(10.0, 3.0));
    let mut mesh = renderer(&scene, &within(0.25)).unwrap();
    let one = mesh.map_bytes()[0];
    let place = |k: u32| placement([0.0, 1e-4 * f64::from(k), 0.0], [0.0; 3], [1.0; 3]);
    scene.objects[0].instances = (0..20).map(place).collect();
    mesh.update(&scene).unwrap();
    assert_eq!((mesh.map_bytes()[0], mesh.rebuild_count()), (one, 1));
    scene.camera.eye = eye(10.0, 0.7);
    mesh.update(&scene).unwrap();
    let near = mesh.map_bytes()[0];
    assert!(near > 2 * one, "{near} {one}");
    let made = mesh.rebuild_count();
    for distance in [3.0, 0.7, 3.0] {
        scene.camera.eye = eye(10.0, distance);
        mesh.update(&scene).unwrap();
        mesh.draw().unwrap();
    }
    assert_eq!((mesh.map_bytes()[0], mesh.rebuild_count()), (one, made));
    let fresh = draw(&scene, &within(0.25));
    assert_eq!(apart(&mesh.read().unwrap(), &fresh), 0);
    drop(mesh);
    device().0.check().unwrap();
}

#[test]
fn copies_beside_the_picture_leave_no_trace() {
    let of = |count: usize| {
        let mut scene = scene_of(shapes::vase(), eye(10.0, 4.0));
        // The first in view; the others behind the eye, to its left and far below.
        let places = [
            [0.0; 3],
            [9.0, 3.7, 0.0],
            [0.0, -40.0, 0.0],
            [0.0, 0.0, -30.0],
        ];
        let copies = places[..count].iter();
        scene.objects[0].instances = copies.map(|&p| placement(p, [0.0; 3], [1.0; 3])).collect();
        draw(&scene, &within(0.25))
    };
    let (one, all) = (of(1), of(4));
    assert_eq!(apart(&one, &all), 0);
    // Had the copy in view been left out, both would be empty.
    assert!((0..one.pixels()).any(|k| one.hits(k)));
}
