#![allow(clippy::unwrap_used)]
use super::layer::pipelines::{generated as g, shader};
use super::tessellation::Mesh;
use super::{Fineness, MeshLayer, MeshPipelines};
use glam::{DVec3, Vec3};
use revmap::gpu::Device;
use revmap::profile::Profile;
use revmap::scene::{Camera, Object, Offset, Placement, Scene};
use revmap::search::unpacked;
use revmap::settings::Settings;
use revmap::surface::{Contour, ContourSource};
use revmap_compare::{CompareOptions, compare};
use revmap_offscreen::Offscreen;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

#[path = "../../../src/shader/tests/kept.rs"]
mod kept;
use kept::assert_kept;

pub(super) fn contour(points: &[[f64; 2]], offset: &Offset) -> Contour {
    let profile = Profile::polygon(points, 0.5).unwrap();
    let source = ContourSource::new(&profile.outline).unwrap();
    source.contour(offset).unwrap()
}

pub(super) fn ring(n: u32) -> Vec<[f64; 2]> {
    (0..n)
        .map(|k| {
            let angle = TAU * f64::from(k) / f64::from(n);
            [0.28 + 0.12 * angle.cos(), 0.5 + 0.12 * angle.sin()]
        })
        .collect()
}

pub(super) const CUP: [[f64; 2]; 6] = [
    [0.0, 0.1],
    [0.2, 0.1],
    [0.3, 0.9],
    [0.28, 0.9],
    [0.18, 0.15],
    [0.0, 0.14],
];

pub(super) fn triangles(mesh: &Mesh) -> Vec<[Vec3; 3]> {
    mesh.indices
        .chunks_exact(3)
        .map(|t| [0, 1, 2].map(|k| Vec3::from(mesh.vertices[t[k] as usize].position)))
        .collect()
}

/// Six times the signed volume: positive when triangles are counter-clockwise from outside.
fn volume(mesh: &Mesh) -> f64 {
    triangles(mesh)
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(Vec3::as_dvec3);
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

pub(super) fn is_closed(mesh: &Mesh) -> bool {
    let key = |p: Vec3| p.to_array().map(|v| (v + 0.0).to_bits());
    let mut edges: HashMap<_, i32> = HashMap::new();
    for t in triangles(mesh) {
        for k in 0..3 {
            let (a, b) = (key(t[k]), key(t[(k + 1) % 3]));
            *edges.entry((a, b)).or_default() += 1;
            *edges.entry((b, a)).or_default() -= 1;
        }
    }
    edges.values().all(|n| *n == 0)
}

#[test]
fn meshes_are_closed_and_hold_the_volume() {
    let bevel = Offset {
        extend: 0.01,
        bevel: 0.05,
        chamfer: 0.6,
    };
    let pappus = TAU * 0.28 * PI * 0.12 * 0.12;
    let torus = contour(&ring(512), &Offset::default());
    for (segments, rings, within) in [(16, 16, 2e-2), (64, 64, 1.5e-3), (256, 256, 1e-4)] {
        let mesh = Mesh::new(&torus, segments, rings);
        assert!(is_closed(&mesh));
        assert_eq!(mesh.segments, segments);
        assert!(mesh.rings <= rings && 2 * mesh.rings > rings);
        let off = volume(&mesh) / pappus - 1.0;
        assert!(off.abs() < within, "{segments}x{rings}: {off}");
    }
    for offset in [Offset::default(), bevel] {
        let mesh = Mesh::new(&contour(&CUP, &offset), 48, 64);
        assert!(is_closed(&mesh) && volume(&mesh) > 0.0);
    }
}

/// Straight walls are one frustum each, and creases stay sharp.
#[test]
fn no_ring_is_wasted_and_no_corner_lost() {
    let mesh = Mesh::new(&contour(&CUP, &Offset::default()), 24, 100);
    assert_eq!(mesh.rings, 5);
    // All but the two poles have a vertex on either side of the crease; no other is kept.
    assert_eq!(mesh.vertices.len(), 4 * 2 * 24 + 2);
    let coarse = Mesh::new(&contour(&CUP, &Offset::default()), 24, 2);
    assert_eq!(coarse.rings, 5);
}

/// The polygon's corners lie as far outside the circle as the middles of its sides inside.
#[test]
fn errors_are_even_on_both_sides() {
    let mesh = Mesh::new(&contour(&CUP, &Offset::default()), 12, 8);
    let [mut corner, mut middle] = [0.0f64, 1.0];
    for t in triangles(&mesh) {
        for k in 0..3 {
            let [a, b] = [t[k], t[(k + 1) % 3]].map(Vec3::as_dvec3);
            if (a.z - 0.9).abs() < 1e-6 && (b.z - 0.9).abs() < 1e-6 {
                let m: DVec3 = 0.5 * (a + b);
                corner = corner.max(a.truncate().length());
                if (a.truncate().length() - b.truncate().length()).abs() < 1e-6
                    && a.x.hypot(a.y) > 0.29
                {
                    middle = middle.min(m.truncate().length());
                }
            }
        }
    }
    assert!(
        (corner - 0.3 - (0.3 - middle)).abs() < 1e-6,
        "{corner} {middle}"
    );
}

#[test]
fn drawing_starts_before_the_eye() {
    let mesh = Mesh::new(&contour(&CUP, &Offset::default()), 64, 8);
    let per_segment = mesh.indices.len() as u32 / 64;
    assert_eq!(mesh.start(0.5 * PI + 1e-9), 0);
    assert_eq!(mesh.start(PI + 1e-9), 16 * per_segment);
    assert_eq!(mesh.start(0.0), 48 * per_segment);
    assert_eq!(Mesh::default().start(1.0), 0);
}

/// A bend of 8 degrees between straight walls: a shared normal would be wrong all along both.
#[test]
fn straight_walls_keep_their_normals() {
    let bend = [
        [0.0, 0.1],
        [0.2, 0.1],
        [0.2, 0.5],
        [0.25, 0.86],
        [0.0, 0.86],
    ];
    let mesh = Mesh::new(&contour(&bend, &Offset::default()), 16, 64);
    assert_eq!(mesh.rings, 4);
    let upright = mesh.vertices.iter().filter(|v| v.normal == [i16::MAX, 0]);
    assert_eq!(upright.count(), 2 * 16);
}

/// A wall jagged by a tenth of a pixel has no corners.
#[test]
fn jags_are_no_corners() {
    let mut jagged = vec![[0.0, 0.1], [0.2, 0.1]];
    let jag = |k: u32| 0.2 + 0.1 / 512.0 * f64::from(k % 2);
    jagged.extend((1..600).map(|k| [jag(k), 0.1 + f64::from(k) / 2.0 / 512.0]));
    jagged.extend([[0.2, 0.7], [0.0, 0.7]]);
    let mesh = Mesh::new(&contour(&jagged, &Offset::default()), 16, 8);
    assert!(mesh.rings <= 8, "{}", mesh.rings);
    assert!(is_closed(&mesh));
}

/// Tori by the default search before, behind and through a torus as a mesh: all share one depth
/// buffer, and the picture is the reference's of all of them.
#[test]
fn meshes_and_searches_hide_each_other() {
    let device = Device::open_validated(None).unwrap();
    let profile = Arc::new(Profile::polygon(&ring(256), 0.5).unwrap());
    let torus = |x: f64, color| {
        let mut object = Object::new("torus", profile.clone());
        object.placement = Placement {
            position: DVec3::new(x, 0.1 * x, -0.2 * x),
            ..Placement::default()
        };
        object.color = color;
        object
    };
    let camera = Camera::new(DVec3::new(2.2, 0.4, 1.3), DVec3::new(0.0, 0.0, 0.5));
    let mut all = Scene::new(camera);
    let searched = [torus(0.45, [0.8, 0.1, 0.1]), torus(-0.45, [0.1, 0.8, 0.1])];
    let meshed = torus(0.0, [0.1, 0.1, 0.8]);
    all.objects = [searched.as_slice(), std::slice::from_ref(&meshed)].concat();
    let mut ours = all.clone();
    ours.objects = searched.to_vec();
    let mut theirs = all.clone();
    theirs.objects = vec![meshed];

    let own = Settings {
        width: 240,
        height: 180,
        ..Settings::exact()
    };
    let fineness = Fineness::Quads {
        segments: 256,
        rings: 512,
    };
    let mut offscreen = Offscreen::new(&device, &ours, &own).unwrap();
    let pipelines = MeshPipelines::new(&device).unwrap();
    let mut meshes = MeshLayer::new(&pipelines, &offscreen, fineness, &own, 1).unwrap();
    meshes.update(&theirs, || Ok(*offscreen.view())).unwrap();

    let truth = revmap_reference::draw(&all, &own, &|_, _| {}).unwrap();
    let options = CompareOptions::default();
    offscreen.draw().unwrap();
    let alone = compare(&truth, &offscreen.read().unwrap(), &options).unwrap();
    offscreen.draw_with(Some(&meshes)).unwrap();
    let both = compare(&truth, &offscreen.read().unwrap(), &options).unwrap();
    assert!(both.wrong() < 2e-3, "{both}");
    assert!(both.depth.unwrap().p99 < 0.3, "{both}");
    assert!(
        alone.wrong() > 0.1 && alone.depth.unwrap().p99 > 10.0,
        "{alone}"
    );
    drop((meshes, offscreen));
    device.check().unwrap();
}

/// Stored SPIR-V was made from today's sources; by the same compiler word for word.
#[test]
fn kept_spirv_is_what_the_sources_give() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders/spirv");
    let hashes = [g::SOURCES_HASH, g::COMPILER_HASH];
    let names = [
        "mesh.vert",
        "mesh_color.frag",
        "mesh_planes.frag",
        "shadowed_color.frag",
        "shadowed_planes.frag",
        "caster.vert",
    ];
    let all = names.into_iter().enumerate();
    let all = all.map(|(n, name)| (name.to_owned(), shader(n)));
    assert_kept(
        (folder, "as build.rs says"),
        hashes,
        all.collect(),
        unpacked,
    );
}
