//! On GPUs work groups cull the patches of a lone solid. A device that says it is one draws so here.
#![allow(unsafe_code)]

use crate::calls::{Layer, Mask};
use crate::common::host::open;
use crate::common::outlines::outline;
use crate::common::prelude::*;
use crate::common::random::Random;
use crate::common::ways::apart;
use crate::submissions::both;
use crate::trouble::picture;

/// A solid from this eye, with these changes of its object.
fn solid(profile: Profile, eye: DVec3, change: impl FnOnce(&mut Object)) -> Scene {
    let mut scene = scene_of(profile, eye);
    change(&mut scene.objects[0]);
    scene
}

/// Shapes from several sides and distances, cut by their boxes, bevelled, offset, flat, tall, and
/// with tips; and close corners of outlines with short edges.
fn scenes() -> Vec<(String, Scene)> {
    let mut all = Vec::new();
    for (n, (name, profile)) in shapes::all().into_iter().enumerate() {
        for (elevation, distance) in [(10.0, 2.0), (70.0, 1.2 + 0.3 * n as f64), (-35.0, 9.0)] {
            let scene = solid(profile.clone(), eye(elevation, distance), |_| ());
            all.push((format!("{name} from {elevation}"), scene));
        }
        let cut = solid(profile.clone(), eye(30.0, 1.4), |object| {
            object.clip = Clip::Box;
            object.offset.extend = 0.1;
        });
        all.push((format!("{name}, cut"), cut));
        let changed = solid(profile, eye(20.0, 1.6), |object| {
            object.offset = offset(-0.02, 0.1, 1.0);
        });
        all.push((format!("{name}, bevelled"), changed));
    }
    for (name, scale) in [("flat", [40.0, 40.0, 0.2]), ("tall", [0.2, 0.2, 30.0])] {
        let scene = solid(shapes::jewel(), eye(20.0, 12.0), |object| {
            object.placement = placement([0.0; 3], [0.3, 0.2, 0.1], scale);
        });
        all.push((name.to_owned(), scene));
    }
    for seed in 1..40 {
        let mut random = Random(seed);
        let points = outline(seed % 6, &mut random);
        if let Ok(profile) = Profile::polygon(&points, 0.5) {
            let corner = points[random.below(points.len())];
            let mut scene = scene_of(profile, eye(random.between(-80.0, 80.0), 2.5));
            scene.camera.target = DVec3::new(0.0, corner[0], corner[1]);
            scene.camera.fov_y = random.between(2.0, 12.0);
            all.push((format!("outline {seed}"), scene));
        }
    }
    all
}

fn says_gpu(mask: &mut Mask) {
    mask.properties = Some(|p| p.device_type = vk::PhysicalDeviceType::DISCRETE_GPU);
}

fn says_cpu(mask: &mut Mask) {
    mask.properties = Some(|p| p.device_type = vk::PhysicalDeviceType::CPU);
}

/// Squares of 16 pixels draw the rows of their band alone, here 8 at a time.
#[test]
fn culled_tiles_keep_to_their_rows() {
    let (layer, host) = (Layer::take(), open());
    let gpu = layer.poorer(&host, says_gpu).unwrap();
    let settings = Settings {
        planes: Planes::All,
        ..drawn_by((203, 150), DrawStage::Compute, Solver::Exact)
    };
    let scene = scene_of(shapes::vase(), eye(20.0, 1.8));
    let [(whole, steps), (bands, steps_of_bands)] = both(&gpu, &scene, &settings, 1);
    assert_eq!(whole.first_difference(&bands), None);
    assert_eq!(steps, steps_of_bands);
}

/// They show what walks of the tree show: for rounding one pixel in 10,000 hits may differ, and two.
#[test]
fn culled_tiles_show_what_the_tree_shows() {
    let (layer, host) = (Layer::take(), open());
    let cpu = layer.poorer(&host, says_cpu).unwrap();
    let gpu = layer.poorer(&host, says_gpu).unwrap();
    let (mut seen, mut culled) = (0, 0);
    for (n, (name, scene)) in scenes().into_iter().enumerate() {
        // The tree: no lists of patches, whatever the size.
        let settings = Settings {
            proxy_min_pixels: u32::MAX - 1,
            tolerance: [Tolerance::EXACT, Tolerance::DEFAULT][n % 2],
            planes: [Planes::All, Planes::Color][n / 2 % 2],
            ..drawn_by((331, 249), DrawStage::Compute, Solver::Exact)
        };
        let [by_tree, found] = [&cpu, &gpu].map(|device| picture(device, &scene, &settings));
        let what = |differ| format!("{name}: {differ} of {} pixels", hits(&by_tree));
        if settings.planes == Planes::All {
            let (hits, edges, far) = apart(&by_tree, &found);
            println!("{}", what(edges + far));
            assert!(edges + far <= 2 + hits / 10_000, "{}", what(edges + far));
            assert_sound(&found, &name);
            culled += usize::from(by_tree.steps != found.steps);
            seen += hits;
        } else {
            let pairs = by_tree.color.iter().zip(&found.color);
            let differ = pairs.filter(|(a, b)| (0..3).any(|k| (a[k] - b[k]).abs() > 0.02));
            let differ = differ.count();
            println!("{}", what(differ));
            assert!(differ <= 2, "{}", what(differ));
        }
    }
    assert!(
        seen > 100_000 && culled > 20,
        "{seen} hits, {culled} culled"
    );
}
