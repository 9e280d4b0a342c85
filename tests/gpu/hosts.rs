//! The hosts of the examples: G-buffer and temporal anti-aliasing, light on meshes and solids, and the
//! shadow map of a sun, which is held to rays on the CPU.

use crate::common::prelude::*;
use revmap::cast::RayCaster;
use shadowed::map::TEXEL;
use shadowed::{OPTIONS, scene};

#[path = "../../examples/deferred/main.rs"]
mod deferred;
#[path = "../../examples/forward/main.rs"]
mod forward;
#[path = "../../examples/shadowed/main.rs"]
mod shadowed;

/// With motion vectors the picture is much nearer to the mean of 64 frames; validation is silent.
#[test]
fn motion_vectors_prevent_ghosts() {
    let folder = tempfile::tempdir().unwrap();
    let [with, without] = deferred::run(folder.path().to_str().unwrap(), true).unwrap();
    println!("FLIP {with:.4} with motion vectors, {without:.4} without");
    assert!(with < 0.02 && with < 0.6 * without, "{with}, {without}");
}

/// A revolved ball and a mesh of a ball look alike under the host's light; validation is silent.
#[test]
fn solids_are_lit_like_meshes() {
    let folder = tempfile::tempdir().unwrap();
    let [mesh, none] = forward::run(folder.path().to_str().unwrap(), true).unwrap();
    println!("pixels that differ: {mesh} with a mesh, {none} without a ball");
    assert!(mesh < 50 && none > 10_000, "{mesh}, {none}");
}

/// Distance from the edge of a shadow, in texels: the filter reaches 2, the host's move along the
/// normal 2.83.
const ASIDE: f64 = 5.0;
/// Distance from a surface to what shades it, in texels: the move and the bias pass below it.
const ABOVE: f64 = 4.0;
/// A texel's depth may be so many texels above the plane of a surface in the sun.
const FLAT: f64 = 0.5;
/// The cosine below which the sun grazes a surface. The edge of the surface's own shade is there.
const TERMINATOR: f64 = 0.01;
/// Silhouettes may be off by so many pixels.
const SILHOUETTE: f64 = 0.25;

/// The scene on the CPU: solids by their patches, spheres and floor by their equations.
struct Truth(Vec<RayCaster>);

/// Light of the sun at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sun {
    /// All of it is visible, or none: how much of 255.
    Is(u8),
    /// An edge is near.
    Edge,
    /// The surface is turned away from it.
    Behind,
    /// No surface.
    Nothing,
}

impl Truth {
    fn new() -> Self {
        let objects = scene::objects(shadowed::COUNT - 1).unwrap();
        Self(objects.iter().map(|o| RayCaster::new(o).unwrap()).collect())
    }

    /// The first hit of a ray of unit direction: distance and outward normal.
    fn first(&self, origin: DVec3, way: DVec3) -> Option<(f64, DVec3)> {
        let solids = (self.0.iter()).filter_map(|of| of.cast(origin, way));
        let spheres = scene::SPHERES.iter().filter_map(|&(middle, radius)| {
            let from = origin - middle;
            let b = from.dot(way);
            let root = (b * b - from.length_squared() + radius * radius).sqrt();
            let t = -b - root; // not a number where the ray misses
            (t >= 0.0).then(|| (t, (from + t * way) / radius))
        });
        let t = -origin.z / way.z;
        let at = (origin + t * way).truncate().abs().max_element();
        let floor = (t >= 0.0 && at <= 2.5).then_some((t, DVec3::Z));
        (solids.map(|hit| (hit.t, hit.normal)))
            .chain(spheres)
            .chain(floor)
            .min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Light of the sun at the first hit of a ray from the eye, the point and the normal.
    fn seen(&self, way: DVec3) -> (Sun, DVec3, DVec3) {
        let Some((t, normal)) = self.first(scene::EYE, way) else {
            return (Sun::Nothing, DVec3::ZERO, DVec3::ZERO);
        };
        let (point, sun) = (scene::EYE + t * way, scene::towards_sun());
        let facing = normal.dot(sun);
        let at_point = if facing.abs() < TERMINATOR {
            Sun::Edge
        } else if facing < 0.0 {
            Sun::Behind
        } else if self.first(point + 1e-6 * normal, sun).is_some() {
            Sun::Is(0)
        } else {
            Sun::Is(255)
        };
        (at_point, point, normal)
    }

    /// True if rays from the sun, too, find that it is so at a point, and around it.
    fn is_clear(&self, at_point: Sun, point: DVec3, normal: DVec3) -> bool {
        let (sun, far) = (scene::towards_sun(), 8.0);
        let (u, v) = sun.any_orthonormal_pair();
        (0..16).all(|n| {
            let ring = DVec2::from_angle(std::f64::consts::TAU * f64::from(n % 8) / 8.0);
            let [x, y] = (ring * ASIDE * TEXEL * if n < 8 { 1.0 } else { 0.5 }).to_array();
            let aside = u * x + v * y;
            // The point of the surface's plane that the sun sees there.
            let beside = point + aside - sun * (aside.dot(normal) / normal.dot(sun));
            let hit = self.first(beside + far * sun, -sun);
            let above = hit.map_or(f64::NEG_INFINITY, |(t, _)| (far - t) * normal.dot(sun));
            match at_point {
                Sun::Is(0) => above >= ABOVE * TEXEL,
                _ => above <= FLAT * TEXEL,
            }
        })
    }

    /// The sun at a pixel, by the ray through its middle and rays aside.
    fn sun(&self, [way, aside @ ..]: [DVec3; 5]) -> Sun {
        let (at_point, point, normal) = self.seen(way);
        let alike = aside.iter().all(|way| self.seen(*way).0 == at_point);
        match at_point {
            _ if !alike => Sun::Edge,
            Sun::Is(_) if !self.is_clear(at_point, point, normal) => Sun::Edge,
            _ => at_point,
        }
    }

    /// The sun at every third pixel of the picture, each with its index.
    fn picture(&self) -> Vec<(usize, Sun)> {
        let [view, projection] = shadowed::view_and_projection();
        let back = (projection * view).inverse();
        let (width, height) = (OPTIONS.width as usize, OPTIONS.height as usize);
        let pixels = (0..width * height)
            .step_by(3)
            .map(|n| (n % width, n / width));
        let seen = pixels.map(|(x, y)| {
            let way = |[dx, dy]: [f64; 2]| {
                let at = |size: usize, k: f64| 2.0 * k / size as f64 - 1.0;
                let on = DVec2::new(
                    at(width, x as f64 + 0.5 + dx),
                    at(height, y as f64 + 0.5 + dy),
                );
                (back.project_point3(on.extend(1.0)) - scene::EYE).normalize()
            };
            let q = SILHOUETTE;
            let ways = [[0.0; 2], [-q, 0.0], [q, 0.0], [0.0, -q], [0.0, q]].map(way);
            (y * width + x, self.sun(ways))
        });
        seen.collect()
    }
}

/// Shadows are those of rays on the CPU, a mesh in place of a solid casts the same shadow, and
/// validation is silent. Both checks see a solid that is left out of the map.
#[test]
fn solids_and_meshes_shadow_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().to_str().unwrap();
    let [all, mesh, empty, fault] = shadowed::run(folder, true).unwrap();
    let truth = Truth::new().picture();
    let count = |of: Sun| truth.iter().filter(|(_, sun)| *sun == of).count();
    let [lit, shadow] = [255, 0].map(|alpha| count(Sun::Is(alpha)));
    let [edge, behind] = [Sun::Edge, Sun::Behind].map(count);
    println!("truth: {lit} in the sun, {shadow} in shadow, {edge} near an edge, {behind} behind");
    let wrong = |picture: &[u8]| {
        let is_wrong = |(n, sun): &&(usize, Sun)| match sun {
            Sun::Is(alpha) => picture[4 * n + 3] != *alpha,
            Sun::Behind => picture[4 * n + 3] != 0,
            Sun::Edge | Sun::Nothing => false,
        };
        truth.iter().filter(is_wrong).count()
    };
    let counts = [&all, &mesh, &empty, &fault].map(|picture| {
        let differing = shadowed::differing(&all, picture);
        println!("{differing} pixels differ, {} are wrong", wrong(picture));
        [differing, wrong(picture)]
    });
    assert!(lit > 33_000 && shadow > 6600, "{lit}, {shadow}");
    assert!(edge < (lit + shadow) / 10, "{edge} near an edge");
    assert!(counts[0][1] == 0 && counts[1][1] == 0, "{counts:?}");
    // 16 on lavapipe 22, 25 on lavapipe 25, 88 on SwiftShader.
    assert!(counts[1][0] < 150, "{counts:?}");
    // All pixels may differ, and a third is compared with the truth.
    let shows = |[differing, wrong]: [usize; 2], most| differing > most && wrong > most / 3;
    assert!(shows(counts[2], 20_000), "{counts:?}");
    assert!(shows(counts[3], 4000), "{counts:?}");
}

/// The bytes of the examples are what their GLSL gives.
#[test]
#[cfg(feature = "shaderc")] // compiles GLSL at run time
fn kept_bytes_are_what_the_glsl_gives() {
    for (example, lights, kept) in [
        ("forward", "light.glsl", forward::SHADING),
        ("shadowed", "sun.glsl", shadowed::SHADING),
    ] {
        let path = |name: &str| format!("examples/{example}/{name}");
        let [shade, light] =
            ["shade.glsl", lights].map(|name| std::fs::read_to_string(path(name)).unwrap());
        let files = [(&*path("shade.glsl"), &*shade), (lights, &*light)];
        let made = revmap::shading::Shading::compile(DrawStage::Fragment, &files).unwrap();
        assert!(
            made.to_bytes().unwrap() == kept,
            "shaders changed; renew shade.shading by the command that {} names",
            path("main.rs")
        );
    }
}
