//! The mesh baseline: that it is the same solid, as exact as its tessellation lets it be, shaded as
//! the renderer shades, and that what it does not draw is refused. All under the validation layers.

use crate::mesh_shading::wrong_planes;
use crate::scenes::{errors, eye, placement, scene_of};
use crate::shapes;
use glam::DVec3;
use revmap::error::ErrorKind;
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::maps::{Projection, SlopeFilter};
use revmap::scene::{Clip, Object, Offset, Placement, Scene, Shadow};
use revmap::settings::{DrawStage, Planes, Settings, Solver};
use revmap_lab::compare::Comparison;
use revmap_lab::mesh::{MeshOffscreen, MeshPipelines};
use revmap_lab::method::{Method, MethodSettings};
use std::path::Path;
use std::sync::{Arc, OnceLock};

/// Depths are said in texels of a map of so many.
pub const ROWS: u32 = 512;

/// The device of these tests, and its pipelines. Without a device or without the layers, tests
/// fail.
fn pipelines() -> &'static Arc<MeshPipelines> {
    static PIPELINES: OnceLock<Arc<MeshPipelines>> = OnceLock::new();
    PIPELINES.get_or_init(|| {
        let device = Device::open_validated(None).unwrap();
        MeshPipelines::new(&device).unwrap()
    })
}

pub fn settings(segments: u32, rings: u32) -> MethodSettings {
    MethodSettings {
        width: 240,
        height: 180,
        method: Method::mesh(segments, rings).unwrap(),
        ..MethodSettings::default()
    }
}

/// Draws meshes; any message of the layers is a failure.
pub fn draw(scene: &Scene, settings: &MethodSettings) -> Frame {
    let mut mesh = MeshOffscreen::new(pipelines(), scene, settings).unwrap();
    mesh.draw().unwrap();
    let frame = mesh.read().unwrap();
    drop(mesh);
    pipelines().device().check().unwrap();
    frame
}

/// Draws by the exact search.
pub fn searched(scene: &Scene, settings: &MethodSettings) -> Frame {
    let settings = Settings {
        solver: Solver::Quadric,
        ..Settings::from(settings)
    };
    let drawn = revmap::gpu::draw(pipelines().device(), scene, &settings);
    drawn.unwrap().frame
}

pub fn reference(scene: &Scene, settings: &MethodSettings) -> Frame {
    revmap_reference::draw(scene, &settings.into(), &|_, _| {}).unwrap()
}

const PLAIN: Offset = Offset {
    extend: 0.0,
    bevel: 0.0,
    chamfer: 1.0,
};
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
        for offset in [PLAIN, BEVELED] {
            let mut scene = scene_of(profile.clone(), eye(28.0, 2.0));
            scene.objects[0].offset = offset;
            let truth = reference(&scene, &settings(3, 2));
            let found: Vec<Comparison> = [16, 32, 64, 128, 256]
                .map(|n| errors(&truth, &draw(&scene, &settings(n, 2 * n)), ROWS))
                .to_vec();
            let p99 = |c: &Comparison| c.depth.unwrap().p99;
            let said: Vec<_> = found
                .iter()
                .map(|c| (c.missed + c.ghost, p99(c), c.normal.unwrap().rms))
                .collect();
            println!("{name} {offset:?}: {said:.4?}");
            for pair in found.windows(2) {
                assert!(p99(&pair[1]) < 0.5 * p99(&pair[0]), "{name}: {said:?}");
            }
            let (first, last) = (&found[0], &found[4]);
            assert!(p99(last) < p99(first) / 100.0 && p99(last) < 0.06, "{name}");
            assert!(first.wrong() > 0.003, "{name}: the coarsest is coarse");
            assert!(
                last.wrong() < first.wrong() / 20.0 + 2e-4,
                "{name}: {said:?}"
            );
            assert_eq!(last.silhouette_hausdorff.max(1.0), 1.0, "{name}");
        }
    }
}

#[test]
fn eyes_may_be_inside() {
    // In the vase's solid; in the glass's hollow; through the torus's hole; just above a lid.
    let cases = [
        (
            shapes::vase(),
            DVec3::new(0.1, 0.05, 0.6),
            DVec3::new(0.3, 0.3, 0.2),
        ),
        (
            shapes::glass(),
            DVec3::new(0.05, 0.0, 0.8),
            DVec3::new(-0.2, 0.1, 0.4),
        ),
        (
            shapes::torus(),
            DVec3::new(0.02, 0.0, 0.5),
            DVec3::new(0.6, 0.1, 0.55),
        ),
        (
            shapes::vase(),
            DVec3::new(0.05, 0.0, 0.953),
            DVec3::new(0.2, 0.1, 0.8),
        ),
    ];
    for (n, (profile, eye, target)) in cases.into_iter().enumerate() {
        let mut scene = scene_of(profile, eye);
        scene.camera.target = target;
        scene.camera.fov_y = 70.0;
        let settings = settings(256, 512);
        let (truth, frame) = (reference(&scene, &settings), draw(&scene, &settings));
        let found = errors(&truth, &frame, ROWS);
        assert!(found.hits > 10_000 && found.wrong() < 2e-3, "{n}: {found}");
        assert!(found.normal.unwrap().rms < 5.0, "{n}: {found}");
        assert!(found.depth.unwrap().p99 < 0.1, "{n}: {found}");
    }
}

/// A camera that is shifted by whole pixels draws what its neighbours drew, by every method.
#[test]
fn a_shift_moves_the_picture() {
    let plain = scene_of(shapes::vase(), eye(20.0, 1.8));
    let mut shifted = plain.clone();
    shifted.camera.shift = [3.0, -2.0];
    let mesh = settings(256, 512);
    let search = |stage| {
        let settings = Settings {
            stage,
            ..Settings::from(&mesh)
        };
        move |scene: &Scene| {
            let drawn = revmap::gpu::draw(pipelines().device(), scene, &settings);
            drawn.unwrap().frame
        }
    };
    type Draw<'a> = &'a dyn Fn(&Scene) -> Frame;
    let by: [(&str, Draw); 4] = [
        ("reference", &|scene| reference(scene, &mesh)),
        ("fragment", &search(DrawStage::Fragment)),
        ("compute", &search(DrawStage::Compute)),
        ("mesh", &|scene| draw(scene, &mesh)),
    ];
    for (name, draw) in by {
        let (before, after) = (draw(&plain), draw(&shifted));
        let (mut hits, mut wrong) = (0, 0);
        for y in 2..before.height as usize {
            for x in 0..before.width as usize - 3 {
                let from = before.distance[(y - 2) * before.width as usize + x + 3];
                let to = after.distance[y * before.width as usize + x];
                hits += usize::from(from.is_finite());
                let same = from == to || (from - to).abs() < 1e-4;
                wrong += usize::from(!same);
            }
        }
        assert!(hits > 4000 && wrong <= 3, "{name}: {wrong} of {hits}");
    }
}

fn crowd() -> Scene {
    let mut scene = scene_of(shapes::vase(), eye(20.0, 3.0));
    let place = |k: usize, z: f64| {
        let (x, y) = ((k % 4) as f64 - 1.5, (k / 4) as f64 - 1.5);
        placement(
            [0.8 * x, 0.8 * y, z],
            [0.1 * x, 0.2 * y, 0.3],
            [0.7, 0.7, 0.9],
        )
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

#[test]
fn several_solids_hide_each_other() {
    let scene = crowd();
    let settings = settings(128, 256);
    let (truth, frame) = (reference(&scene, &settings), draw(&scene, &settings));
    let found = errors(&truth, &frame, ROWS);
    assert!(found.hits > 8000 && found.wrong() < 3e-3, "{found}");
    assert!(found.depth.unwrap().p99 < 0.3, "{found}");
    let wrong = wrong_planes(&truth, &frame);
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Offsets and cameras that move give what a new renderer gives, in both kinds of picture.
#[test]
fn updates_leave_nothing_behind() {
    for planes in [Planes::All, Planes::Color] {
        let settings = MethodSettings {
            planes,
            ..settings(48, 96)
        };
        let mut scene = crowd();
        let mut mesh = MeshOffscreen::new(pipelines(), &scene, &settings).unwrap();
        mesh.draw().unwrap();
        for (n, offset) in [BEVELED, PLAIN, BEVELED].into_iter().enumerate() {
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
        let bytes = mesh.mesh_bytes();
        assert!(bytes > 2 * 16 * 48 && bytes < 10_000_000, "{bytes}");
        drop(mesh);
        pipelines().device().check().unwrap();
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

fn asset(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../assets")
        .join(name)
}

#[test]
fn what_a_mesh_cannot_draw_is_refused() {
    #[track_caller]
    fn refused(kind: ErrorKind, key: &str, spoil: impl Fn(&mut Scene, &mut MethodSettings)) {
        let mut scene = crowd();
        let mut settings = settings(16, 32);
        spoil(&mut scene, &mut settings);
        let made = MeshOffscreen::new(pipelines(), &scene, &settings);
        let error = made.err().unwrap();
        assert_eq!(
            (error.kind, error.key.as_deref()),
            (kind, Some(key).filter(|k| !k.is_empty())),
            "{error}"
        );
        pipelines().device().check().unwrap();
    }
    refused(ErrorKind::Usage, "solver", |_, s| {
        s.stage = DrawStage::Compute
    });
    refused(ErrorKind::Content, "shadow", |s, _| s.shadow = Shadow::Hard);
    refused(ErrorKind::Content, "object.1.repeat", |s, _| {
        s.objects[1].repeat = [2, 1, 1]
    });
    refused(ErrorKind::Content, "object.2.color_map", |s, _| {
        let file = asset("colors/natural-earth.png");
        s.objects[2].texturing.color_map = Some(Arc::new(revmap_files::color_map(file).unwrap()));
    });
    refused(ErrorKind::Content, "object.0.height_map", |s, _| {
        let map =
            revmap_files::displacement_map(asset("heights/brick.png"), SlopeFilter::default())
                .unwrap();
        s.objects[0].texturing.displacement_map = Some(Arc::new(map));
    });
    refused(ErrorKind::Content, "object.0.projection", |s, _| {
        s.objects[0].texturing.projection = Projection::Arc
    });
    refused(ErrorKind::Usage, "solver", |_, s| {
        s.method = Method::DEFAULT
    });
    refused(ErrorKind::Content, "object.2.axis", |s, _| {
        s.objects[2].axis = [0.9, 0.5]
    });
    refused(ErrorKind::Content, "object.0.extend", |s, _| {
        (s.objects[0].offset.extend, s.objects[0].clip) = (0.3, Clip::Box);
    });
    refused(ErrorKind::Content, "object.0.bevel", |s, _| {
        (s.objects[0].offset.bevel, s.objects[0].clip) = (0.8, Clip::Box);
    });
    for (segments, rings) in [(2, 1), (0, 0), (99_999_999, 9), (u32::MAX, u32::MAX)] {
        refused(ErrorKind::Usage, "", |_, s| {
            s.method = Method::Mesh { segments, rings }
        });
    }
}

/// An axis off the middle is no obstacle while the solid stays in its box.
#[test]
fn an_axis_may_stand_off_the_middle() {
    let mut scene = scene_of(shapes::vase(), eye(30.0, 2.0));
    scene.objects[0].axis = [0.6, 0.45];
    let settings = settings(128, 256);
    let found = errors(
        &reference(&scene, &settings),
        &draw(&scene, &settings),
        ROWS,
    );
    assert!(
        found.wrong() < 2e-3 && found.depth.unwrap().p99 < 0.3,
        "{found}"
    );
}
