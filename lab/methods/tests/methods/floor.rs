//! The floor: no search can return less. All under the validation layers.

use crate::mesh::{draw, renderer};
use crate::scenes::{eye, scene_of};
use crate::shapes;
use glam::DVec3;
use revmap::error::ErrorKind;
use revmap::frame::Frame;
use revmap::scene::{Placement, Scene, Shadow};
use revmap::settings::{DrawStage, Planes, Solver};
use revmap_methods::{Method, MethodSettings};

fn drawn(scene: &Scene, method: Method, stage: DrawStage, planes: Planes) -> Frame {
    let settings = MethodSettings::default().by(method).in_stage(stage);
    draw(scene, &settings.sized(240, 180).storing(planes))
}

/// Each pixel that the search hits is hit, no farther away, without a look-up.
fn is_first_possible_point(scene: &Scene) {
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let floor = drawn(scene, Method::Floor, stage, Planes::All);
        let found = drawn(scene, Solver::Exact.into(), stage, Planes::All);
        let (mut nearer, mut farther) = (0, 0);
        for (k, (first, hit)) in floor.distance.iter().zip(&found.distance).enumerate() {
            assert!(
                *first <= hit * 1.001,
                "{stage:?}, pixel {k}: {first} > {hit}"
            );
            farther += usize::from(*first > hit + 1e-4);
            nearer += usize::from(*first < hit - 1e-3);
        }
        // It is no search: most of its points lie before the surface.
        let hits = found.distance.iter().filter(|d| d.is_finite()).count();
        assert!(
            hits > 2000 && nearer > hits / 4,
            "{stage:?}: {nearer} of {hits}"
        );
        // Rasterisers snap corners, so that depths slip along slanted triangles: lavapipe keeps all
        // pixels within 1e-4, SwiftShader 95 of 100, and the worst within 6e-4 of the distance.
        assert!(
            farther <= hits / 15,
            "{stage:?}: {farther} of {hits} farther"
        );
        assert!(floor.steps.iter().all(|steps| *steps == 0.0));
        // Frames that are timed hold colour alone.
        let color = drawn(scene, Method::Floor, stage, Planes::Color);
        for (k, (a, b)) in color.color.iter().zip(&floor.color).enumerate() {
            assert!((a[3] - b[3]).abs() < 1e-3, "{stage:?}, pixel {k}");
        }
    }
}

#[test]
fn the_floor_is_the_first_possible_point() {
    is_first_possible_point(&scene_of(shapes::vase(), eye(25.0, 2.6)));
}

/// A few copies, drawn like single solids, and many, to which fragments walk.
#[test]
fn the_floor_of_copies() {
    for across in [2, 12] {
        let mut scene = scene_of(shapes::vase(), eye(25.0, 4.0));
        scene.objects[0].instances = (0..across * across)
            .map(|k| Placement {
                position: DVec3::new(f64::from(k / across), f64::from(k % across), 0.0)
                    - DVec3::new(1.0, 1.0, 0.0) * (0.5 * f64::from(across)),
                ..Placement::default()
            })
            .collect();
        is_first_possible_point(&scene);
    }
}

#[test]
fn what_has_no_floor_is_refused() {
    let mut scene = scene_of(shapes::vase(), eye(25.0, 2.6));
    scene.shadow = Shadow::Hard;
    let settings = MethodSettings::default().by(Method::Floor);
    let error = renderer(&scene, &settings).err().unwrap();
    assert_eq!(error.kind, ErrorKind::Usage);
    assert!(error.to_string().contains("shadows"), "{error}");
}
