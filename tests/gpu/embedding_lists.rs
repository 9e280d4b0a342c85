//! Lists of planes, as for a G-buffer: each plane against a frame of all planes, motion against rays
//! into the last frame.
#![allow(unsafe_code)]

use crate::common::host::{self, Drawn, Host, Options, dynamic, opened};
use crate::common::prelude::*;
use crate::embedding::{options, three};
use revmap::cast::RayCaster;

type F = vk::Format;

/// Every plane, with a format of 32 bits a channel.
const PLANES: [(Plane, vk::Format); 7] = [
    (Plane::Material, F::R32G32_SFLOAT),
    (Plane::Identity, F::R32G32_UINT),
    (Plane::Motion, F::R32G32_SFLOAT),
    (Plane::Color, F::R32G32B32A32_SFLOAT),
    (Plane::Normal, F::R32G32B32A32_SFLOAT),
    (Plane::OctahedralNormal, F::R32G32_SFLOAT),
    (Plane::BaseColor, F::R32G32B32A32_SFLOAT),
];
/// A renderer of a list of planes, and what it draws into.
struct Lists<'a> {
    drawn: Drawn<'a>,
    planes: Vec<Plane>,
}

impl<'a> Lists<'a> {
    fn new(
        (host, device): (&'a Host, &Device),
        planes: &[Plane],
        scene: &Scene,
        settings: &SearchSettings,
    ) -> Self {
        let format = |plane: &Plane| PLANES.iter().find(|(p, _)| p == plane).unwrap().1;
        let formats: Vec<_> = planes.iter().map(format).collect();
        let list = Planes::List(PlaneList::new(planes).unwrap());
        let output = Output::Pass(PassFormats::new(dynamic(&formats), list));
        Self {
            drawn: Drawn::new(host, device, options(), (output, settings), scene),
            planes: planes.to_vec(),
        }
    }

    fn draw(&mut self, view: &View) {
        self.drawn.view = *view;
        self.drawn.picture();
    }

    /// The words of a plane, `N` a pixel.
    fn read<const N: usize>(&self, plane: Plane) -> Vec<[u32; N]> {
        let number = self.planes.iter().position(|p| *p == plane).unwrap();
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&self.drawn.canvas.planes()[number]);
        words.as_chunks().0.to_vec()
    }

    fn floats<const N: usize>(&self, plane: Plane) -> Vec<[f32; N]> {
        let words = self.read::<N>(plane);
        words.iter().map(|w| w.map(f32::from_bits)).collect()
    }
}

/// Three solids, one of them in copies.
fn scene() -> Scene {
    let mut scene = three();
    let copy = |x: f64| scaled([x, 0.7, 0.1], 0.5);
    scene.objects[1].instances = vec![copy(-0.4), copy(0.3)].into();
    scene.objects[2].material = Some(Material {
        roughness: 0.75,
        metalness: 1.0,
    });
    scene
}

/// Copies of an object have its number, whatever their levels.
#[test]
fn levels_of_copies_keep_the_identity() {
    let ((host, device), mut scene) = (opened(), three());
    let copy = |n: u32| Placement {
        position: DVec3::new(f64::from(n % 10) - 4.5, -4.0 * f64::from(n / 10), 0.0),
        ..Placement::default()
    };
    scene.objects[1].instances = (0..100).map(copy).collect();
    let settings = SearchSettings::exact().with(|s| s.tolerance = Tolerance::DEFAULT);
    let mut lists = Lists::new((&host, &device), &[Plane::Identity], &scene, &settings);
    lists.drawn.picture();
    let numbers: HashSet<u32> = lists.drawn.ids.iter().map(|id| id.number()).collect();
    let drawn = lists.read::<2>(Plane::Identity);
    let levels = lists.drawn.renderer.copy_levels().concat();
    let mut drawn_levels = HashSet::new();
    for [object, copy] in drawn.into_iter().filter(|pixel| *pixel != [u32::MAX; 2]) {
        assert!(numbers.contains(&object), "object {object}");
        if object == lists.drawn.ids[1].number() {
            drawn_levels.insert(levels[copy as usize]);
        }
    }
    assert!(drawn_levels.len() > 1, "{drawn_levels:?}");
}

fn far(a: &[f32], b: &[f32]) -> f32 {
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    apart.fold(0.0, f32::max)
}

/// Each plane of a list, in any order, is that of a frame of all planes; each object and copy has
/// its own identity.
#[test]
fn planes_of_a_list_are_those_of_a_frame() {
    let ((host, device), scene) = (opened(), scene());
    for solver in [Solver::Exact, Solver::Quadric, Solver::Live] {
        let size = (options().width, options().height);
        let frame = draw(&scene, &drawn_by(size, STAGES[0], solver));
        let settings = SearchSettings::exact().with(|s| s.solver = solver);
        let planes = PLANES.map(|p| p.0);
        let mut lists = Lists::new((&host, &device), &planes, &scene, &settings);
        lists.drawn.picture();
        let identity = lists.read::<2>(Plane::Identity);
        let [colors, base] = [Plane::Color, Plane::BaseColor].map(|p| lists.floats::<4>(p));
        let normals = lists.floats::<4>(Plane::Normal);
        let octahedral = lists.floats::<2>(Plane::OctahedralNormal);
        let material = lists.floats::<2>(Plane::Material);
        let (mut hits, mut wrong, mut off) = (0, 0, 0);
        let mut seen = HashSet::new();
        for n in 0..frame.pixels() {
            let hit = identity[n] != [u32::MAX; 2];
            if hit != frame.hits(n) {
                off += 1;
                continue;
            }
            if !hit {
                assert!(colors[n] == [0.0; 4], "a pixel without a hit is written");
                continue;
            }
            hits += 1;
            seen.insert(identity[n]);
            let [x, y] = octahedral[n].map(f64::from);
            let z = 1.0 - x.abs() - y.abs();
            let fold = DVec2::new(1.0 - y.abs(), 1.0 - x.abs());
            let sense = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
            let unfolded = match z < 0.0 {
                true => DVec3::new(fold.x * sense(x), fold.y * sense(y), z),
                false => DVec3::new(x, y, z),
            };
            let unfolded = unfolded.normalize().as_vec3().to_array();
            let glass = identity[n][0] == lists.drawn.ids[2].number();
            let wanted = if glass { [0.75, 1.0] } else { [0.4925, 0.0] };
            let apart = [
                far(&colors[n], &frame.color[n]),
                far(&base[n][..3], &frame.albedo[n]),
                far(&normals[n][..3], &frame.shading_normal[n]),
                far(&unfolded, &normals[n][..3]),
                far(&material[n], &wanted),
            ];
            wrong += usize::from(apart.iter().any(|a| *a > 2e-3));
        }
        println!("{solver}: {hits} hits, {wrong} wrong, {off} missed or ghosts");
        assert!(hits > 3000 && wrong <= hits / 500 && off <= 8, "{solver}");
        let wanted = [(0, 0), (1, 0), (1, 1), (2, 0)];
        let wanted =
            wanted.map(|(object, copy): (usize, u32)| [lists.drawn.ids[object].number(), copy]);
        assert_eq!(seen, wanted.into_iter().collect(), "{solver}");
    }
}

/// A list of one plane is that plane of the list of all, to the last bit: planes that are not drawn
/// change nothing. With shadows, too.
#[test]
fn a_plane_does_not_depend_on_the_others() {
    let ((host, device), mut scene) = (opened(), scene());
    for shadow in [Shadow::Off, Shadow::Hard] {
        scene.shadow = shadow;
        let planes = PLANES.map(|p| p.0);
        let exact = SearchSettings::exact();
        let mut all = Lists::new((&host, &device), &planes, &scene, &exact);
        let (_, depths) = all.drawn.picture();
        for plane in planes {
            let mut alone = Lists::new((&host, &device), &[plane], &scene, &exact);
            assert!(alone.drawn.picture().1 == depths, "{plane:?}");
            assert!(alone.read::<2>(plane) == all.read::<2>(plane), "{plane:?}");
        }
    }
}

/// A view by a host's matrices, with a jitter in pixels.
fn jittered(eye: DVec3, jitter: DVec2) -> (View, DMat4) {
    let options: Options = options();
    let [view, projection] = host::view_and_projection(eye, DVec3::new(0.0, 0.0, 0.5), &options);
    let size = DVec2::new(f64::from(options.width), f64::from(options.height));
    let shift = 2.0 * jitter / size;
    let shift = DMat4::from_translation(DVec3::new(shift.x, shift.y, 0.0));
    // A translation of clip space by a multiple of w.
    let projection = shift * projection;
    let made = host::view([view, projection], &options).unwrap();
    (made.with_jitter(jitter.to_array()), projection * view)
}

/// The ray through a position in the picture.
fn ray(clip_from_world: DMat4, at: DVec2) -> [DVec3; 2] {
    let size = DVec2::new(f64::from(options().width), f64::from(options().height));
    let ndc = 2.0 * at / size - 1.0;
    let back = clip_from_world.inverse();
    let point = |z: f64| {
        let p = back * DVec4::new(ndc.x, ndc.y, z, 1.0);
        p.truncate() / p.w
    };
    let [near, far] = [point(0.0), point(1.0)];
    [near, far - near]
}

/// Objects, ready for rays.
fn casters(scene: &Scene) -> Vec<(RayCaster, Placement)> {
    let of = |object: &Object| (RayCaster::new(object).unwrap(), object.placement);
    scene.objects.iter().map(of).collect()
}

/// The first hit of a ray: the object, and point and normal in its own space.
fn first_hit(
    objects: &[(RayCaster, Placement)],
    [origin, direction]: [DVec3; 2],
) -> Option<(usize, DVec3, DVec3)> {
    let hits = objects.iter().enumerate();
    let hits = hits.filter_map(|(n, (caster, _))| Some((n, caster.cast(origin, direction)?)));
    let (n, hit) = hits.min_by(|a, b| a.1.t.total_cmp(&b.1.t))?;
    let p = &objects[n].1;
    let point = origin + direction * hit.t;
    let own = p.rotation.conjugate() * (point - p.position) / p.scale;
    let normal = (p.rotation.conjugate() * hit.normal * p.scale).normalize();
    Some((n, own, normal))
}

/// Motion leads to the same point of the same solid in the last frame: rays there, in double
/// precision, meet it. Solids turn, move and swell, replicas too, the eye moves, both frames are
/// jittered.
#[test]
fn motion_leads_to_the_last_frames_point() {
    for shadow in [Shadow::Off, Shadow::Hard] {
        check_motion(shadow);
    }
}

fn check_motion(shadow: Shadow) {
    let (host, device) = opened();
    let mut scene = three();
    scene.objects[0].placement.scale = DVec3::new(1.0, 0.8, 1.1);
    let mut replicas = Object::new("replicas", shapes::vase().into());
    (replicas.repeat, replicas.mirror) = ([2, 1, 3], [false, false, true]);
    replicas.placement.position = DVec3::new(-0.9, 0.1, 0.1);
    scene.objects.push(replicas);
    // Rays towards the light meet other solids than the drawn one.
    scene.shadow = shadow;
    scene.lights = vec![Light::default().with(|l| l.direction = DVec3::new(-1.0, -0.1, -0.1))];
    let before = scene.clone();
    let planes = [Plane::Motion, Plane::Identity];
    let mut lists = Lists::new((&host, &device), &planes, &scene, &SearchSettings::exact());
    let eye = crate::common::eye(25.0, 3.0);
    let (first, first_clip) = jittered(eye, DVec2::new(0.25, -0.375));
    lists.draw(&first);
    // Without a last frame nothing moves but the jitter, which motion leaves out.
    let still = lists.floats::<2>(Plane::Motion);
    assert!(still.iter().all(|m| m.iter().all(|v| v.abs() < 1e-3)));
    lists.drawn.renderer.end_frame();

    let turn = DQuat::from_rotation_z(0.2) * DQuat::from_rotation_y(0.1);
    scene.objects[0].placement.rotation = turn;
    scene.objects[1].placement.position.x += 0.1;
    scene.objects[2].offset.extend = 0.05;
    scene.objects[3].offset.extend = 0.02;
    for (id, object) in lists.drawn.ids.iter().zip(&scene.objects) {
        lists.drawn.renderer.set(*id, object.clone()).unwrap();
    }
    let (second, second_clip) =
        jittered(eye + DVec3::new(0.05, 0.1, -0.02), DVec2::new(-0.25, 0.125));
    lists.draw(&second.with_last(&first));
    let motion = lists.floats::<2>(Plane::Motion);
    let identity = lists.read::<2>(Plane::Identity);
    let changes = before.objects.iter().zip(&scene.objects);
    let shifts: Vec<_> = changes
        .map(|(before, now)| before.offset.extend - now.offset.extend)
        .collect();
    let (was_there, is_there) = (casters(&before), casters(&scene));
    let (mut hits, mut occluded) = ([0; 4], 0);
    let mut apart: [Vec<f64>; 4] = Default::default();
    for (n, moved) in motion.iter().enumerate().step_by(7) {
        let pixel = DVec2::new(f64::from(n as u32 % 240), f64::from(n as u32 / 240)) + 0.5;
        let now = first_hit(&is_there, ray(second_clip, pixel));
        let drawn = identity[n][0] != u32::MAX;
        let Some((object, own, normal)) = now.filter(|_| drawn) else {
            continue;
        };
        let unjittered = pixel - DVec2::new(-0.25, 0.125);
        let landed = unjittered + DVec2::from(moved.map(f64::from)) + DVec2::new(0.25, -0.375);
        let count = DVec3::from(scene.objects[object].repeat.map(f64::from));
        let wanted = own + (normal / count).normalize() / count * shifts[object];
        match first_hit(&was_there, ray(first_clip, landed)) {
            // Pixels of the solid, unless another part of it was in front.
            Some((other, was, _)) if other == object && was.distance(wanted) < 0.05 => {
                hits[object] += 1;
                apart[object].push(was.distance(wanted));
            }
            _ => occluded += 1,
        }
    }
    let apart = apart.map(|mut all| {
        all.sort_unstable_by(f64::total_cmp);
        [all[all.len() / 2], all[all.len() * 98 / 100]]
    });
    println!("{hits:?} hits, {occluded} occluded before, apart {apart:?}");
    let all: usize = hits.iter().sum();
    assert!(hits.iter().all(|h| *h > 100) && occluded < all / 50);
    // Object units, half of the points and all but the most grazing ones.
    for [middle, most] in apart {
        assert!(middle < 1e-5 && most < 1e-3, "{middle:e} {most:e}");
    }

    // The frame after stands still again.
    lists.drawn.renderer.end_frame();
    lists.draw(&second.with_last(&second));
    let still = lists.floats::<2>(Plane::Motion);
    assert!(still.iter().all(|m| m.iter().all(|v| v.abs() < 1e-3)));
}
