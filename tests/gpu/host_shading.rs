//! Shading by a host's function: a copy of the library's gives the library's pictures, its inputs are
//! the planes of a frame, its set is the host's.
#![allow(unsafe_code)]

use crate::common::host::{self, Drawn, Host, UniformSet, dynamic, opened};
use crate::common::prelude::*;
use crate::embedding::{options, three};
use crate::environment::SKY;
use revmap::shading::Shading;

/// The library's own light, from the host's set.
pub const COPY: &str = include_str!("../common/copy.glsl");

/// A value of the surface, by the number in the host's set.
const VALUES: &str = "
layout(set = 3, binding = 0, std140) uniform HostChoice { vec4 choice; } host;

vec4 host_shade(Surface s)
{
    switch (int(host.choice.x)) {
    case 0: return vec4(s.position, s.depth);
    case 1: return vec4(s.to_eye, s.roughness);
    case 2: return vec4(s.normal, s.metalness);
    case 3: return vec4(s.shading_normal, 1.0);
    case 4: return vec4(s.base_color, 1.0);
    case 5: return vec4(s.uv, s.pixel);
    case 6: return vec4(s.uv_right, s.uv_down);
    default: return vec4(float(s.object), float(s.copy), 0.0, 1.0);
    }
}
";

pub fn shading(stage: DrawStage, text: &str) -> Arc<Shading> {
    Arc::new(Shading::compile(stage, &[("shade.glsl", text)]).unwrap_or_else(|e| panic!("{e}")))
}

/// The lights of a scene as `COPY` reads them.
pub fn lights(scene: &Scene) -> Vec<[f32; 4]> {
    let lighting = scene.lighting();
    let four = |[x, y, z]: [f32; 3]| [x, y, z, 0.0];
    let towards = lighting.lights.iter().map(|l| -l.direction.normalize());
    let towards = towards.map(|d| four(d.as_vec3().to_array()));
    let radiance = lighting.lights.iter().map(|l| four(l.color));
    let specular = scene.objects[0].specular;
    let mut all = vec![four(lighting.ambient)];
    all.extend(towards.chain(radiance));
    all.push([specular.strength, specular.shininess, 0.0, 0.0]);
    assert_eq!(all.len(), 8, "three lights");
    all
}

/// Plain, textured and repeated solids, and copies.
pub fn scene() -> Scene {
    let mut scene = three();
    let color = |n: u32| [(n * 37 % 256) as u8, (n * 91 % 256) as u8, 120, 255];
    let height = |x, y| ((8 * y + x) * 29 % 64) as f32 / 64.0;
    let object = &mut scene.objects[0];
    object.texturing.color_map = Some(color_map(16, 8, |x, y| color(16 * y + x)));
    object.texturing.displacement_map = Some(slope_map(8, height));
    object.texturing.bump = 0.02;
    object.texturing.repeat = [3.0, 2.0];
    object.texturing.offset = [-0.25, 0.125];
    object.texturing.projection = Projection::Arc;
    scene.objects[1].material = Some(Material {
        roughness: 0.75,
        metalness: 1.0,
    });
    let copy = |x: f64| Placement {
        position: DVec3::new(x, 0.7, 0.1),
        scale: DVec3::new(0.5, 0.4, 0.6),
        ..Placement::default()
    };
    scene.objects[1].instances = vec![copy(-0.4), copy(0.3)].into();
    let mut comb = Object::new("comb", shapes::vase().into());
    comb.repeat = [2, 1, 2];
    comb.mirror = [true, false, true];
    comb.placement.position = DVec3::new(-0.6, 1.2, 0.2);
    scene.objects.push(comb);
    scene
}

fn view_forward(scene: &Scene) -> Vec3 {
    let camera = &scene.camera;
    (camera.target - camera.eye).normalize().as_vec3()
}

pub fn pass(planes: Planes, formats: &[vk::Format]) -> Output {
    Output::Pass(PassFormats::new(dynamic(formats), planes))
}

/// A renderer by the function, or by the library's.
pub fn made(
    device: &Device,
    output: Output,
    settings: &SearchSettings,
    by: Option<(&Arc<Shading>, &UniformSet)>,
) -> Renderer {
    let Some((shading, set)) = by else {
        return Renderer::new(device, output, settings, 1).unwrap();
    };
    shaded(device, output, settings, shading, set.layout).unwrap()
}

/// A renderer by the function.
pub fn shaded(
    device: &Device,
    output: Output,
    settings: &SearchSettings,
    shading: &Arc<Shading>,
    layout: vk::DescriptorSetLayout,
) -> revmap::Result<Renderer> {
    // SAFETY: the layout is live until the renderer is dropped; the faults of tests draw nothing.
    unsafe { host::shaded(device, output, settings, 1, shading, layout) }
}

/// The picture of a scene in a stage, and the path of each object.
pub fn picture(
    host: &Host,
    device: &Device,
    scene: &Scene,
    settings: &SearchSettings,
    stage: DrawStage,
    by: Option<(&Arc<Shading>, &UniformSet)>,
) -> (Vec<u8>, Vec<DrawPath>) {
    let output = match stage {
        DrawStage::Fragment => pass(Planes::Color, &[host::COLOR]),
        DrawStage::Compute => Output::Compute(Planes::Color),
    };
    let renderer = made(device, output.clone(), settings, by);
    let mut drawn = Drawn::by(host, renderer, options(), &output, scene);
    let (colors, _) = drawn.picture_by(by.map(|by| by.1));
    (colors, drawn.renderer.draw_paths())
}

/// The number of bytes that differ by more than one, and of those that are drawn.
pub fn apart(a: &[u8], b: &[u8]) -> (usize, usize) {
    assert_eq!(a.len(), b.len());
    let differ = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 1);
    (differ.count(), a.iter().filter(|byte| **byte != 0).count())
}

/// A copy of the library's function gives the library's picture, by every path and in both stages.
#[test]
fn a_copy_of_our_function_gives_our_picture() {
    let (host, device) = opened();
    let (scene, mut alone) = (scene(), scene());
    alone.objects.truncate(1);
    let set = UniformSet::of(&host, &lights(&scene)).unwrap();
    let exact = SearchSettings::exact();
    let [cells, boxes] = [1, u32::MAX].map(|proxy_min_pixels| SearchSettings {
        proxy_min_pixels,
        ..exact
    });
    let live = exact.with(|s| s.solver = Solver::Live);
    let mut paths = HashSet::new();
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let shading = shading(stage, COPY);
        let all = [exact, cells, boxes, live];
        for (settings, scene) in all.iter().flat_map(|s| [(s, &scene), (s, &alone)]) {
            let picture = |by| picture(&host, &device, scene, settings, stage, by);
            let (ours, theirs) = (picture(None), picture(Some((&shading, &set))));
            let (differ, drawn) = apart(&ours.0, &theirs.0);
            println!("{stage:?}: {differ} of {drawn} bytes differ, {:?}", ours.1);
            assert_eq!(ours.1, theirs.1);
            assert!(drawn > 10_000 && differ == 0, "{differ} of {drawn}");
            paths.extend(ours.1.into_iter().map(|path| format!("{stage:?} {path:?}")));
        }
    }
    // Without the library's environment, which changes the library's own picture.
    let bright = alone.clone().with(|s| s.environment = Some(SKY));
    let (stage, by) = (DrawStage::Compute, shading(DrawStage::Compute, COPY));
    let of = |scene, by| picture(&host, &device, scene, &exact, stage, by).0;
    assert!(of(&alone, Some((&by, &set))) == of(&bright, Some((&by, &set))));
    assert!(of(&alone, None) != of(&bright, None));
    // The compute stage has no other path.
    assert_eq!(paths.len(), 3, "{paths:?}");
    // The check can fail: less light is another picture.
    let mut dark = lights(&scene);
    dark[0] = [0.0; 4];
    let dark = UniformSet::of(&host, &dark).unwrap();
    let (stage, shading) = (DrawStage::Fragment, shading(DrawStage::Fragment, COPY));
    let [light, dark] = [&set, &dark]
        .map(|set| picture(&host, &device, &scene, &exact, stage, Some((&shading, set))).0);
    assert!(apart(&light, &dark).0 > 10_000);
}

/// The values that the function gets are the planes of a frame.
#[test]
fn values_of_the_surface_are_the_planes_of_a_frame() {
    let (host, device) = opened();
    let scene = scene();
    let frame = draw(&scene, &sized(options().width, options().height));
    let shading = shading(DrawStage::Fragment, VALUES);
    let listed = Planes::List(PlaneList::new(&[Plane::Color, Plane::Identity]).unwrap());
    let formats = [vk::Format::R32G32B32A32_SFLOAT, vk::Format::R32G32_UINT];
    let mut ids = Vec::new();
    let mut values = |choice: f32, planes: Planes| -> Vec<[f32; 4]> {
        let set = UniformSet::of(&host, &[[choice, 0.0, 0.0, 0.0]]).unwrap();
        let formats = &formats[..if planes == Planes::Color { 1 } else { 2 }];
        let output = pass(planes, formats);
        let by = Some((&shading, &set));
        let renderer = made(&device, output.clone(), &SearchSettings::exact(), by);
        let mut drawn = Drawn::by(&host, renderer, options(), &output, &scene);
        ids.clone_from(&drawn.ids);
        let (bytes, _) = drawn.picture_by(Some(&set));
        let words: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
        words.as_chunks().0.to_vec()
    };
    let all: Vec<_> = (0..8u8)
        .map(|n| values(f32::from(n), Planes::Color))
        .collect();
    // Modules of lists give the same.
    for n in [0u8, 5, 7] {
        assert!(values(f32::from(n), listed) == all[usize::from(n)], "{n}");
    }
    let forward = view_forward(&scene);
    let repeat = |n: usize| scene.objects[n].texturing.repeat.map(|r| r as f32);
    let offset = |n: usize| scene.objects[n].texturing.offset.map(|o| o as f32);
    let number = |id: f32| ids.iter().position(|i| i.number() as f32 == id).unwrap();
    let (mut hits, mut wrong, mut copies) = (0, 0, HashSet::new());
    for n in (0..frame.pixels()).filter(|n| frame.hits(*n) && all[4][*n][3] == 1.0) {
        hits += 1;
        let [position, to_eye, normal, bumped, base, uv, _, identity] =
            [0, 1, 2, 3, 4, 5, 6, 7].map(|k: usize| all[k][n]);
        let three = |v: [f32; 4]| Vec3::new(v[0], v[1], v[2]);
        let object = number(identity[0]);
        copies.insert((object, identity[1] as u32));
        let ([across, down], [left, up]) = (repeat(object), offset(object));
        let facing = Vec3::from(frame.normal[n]).dot(three(to_eye)).signum();
        let material = scene.objects[object].material();
        let pixel = [n as u32 % options().width, n as u32 / options().width];
        let apart = [
            three(position).length() - frame.distance[n],
            position[3] - three(position).dot(forward),
            (three(position).normalize() + three(to_eye)).length(),
            to_eye[3] - material.roughness,
            normal[3] - material.metalness,
            (three(normal) - facing * Vec3::from(frame.normal[n])).length(),
            (three(bumped) - Vec3::from(frame.shading_normal[n])).length(),
            (three(base) - Vec3::from(frame.albedo[n])).length(),
            uv[0] - (frame.uv[n][0] * across - left),
            uv[1] - ((1.0 - frame.uv[n][1]) * down + up),
            uv[2] - pixel[0] as f32 - 0.5,
            uv[3] - pixel[1] as f32 - 0.5,
        ];
        wrong += usize::from(apart.iter().any(|a| a.abs().is_nan() || a.abs() > 3e-3));
    }
    println!("{hits} hits, {wrong} wrong, {copies:?}");
    assert!(hits > 3000 && wrong <= hits / 200, "{wrong} of {hits}");
    let wanted = [(0, 0), (1, 0), (1, 1), (2, 0), (3, 0)];
    assert_eq!(copies, wanted.into_iter().collect());
    assert_steps(&all, &frame);
}

/// The change of uv is that to the next pixel, where both are on one smooth part.
fn assert_steps(all: &[Vec<[f32; 4]>], frame: &Frame) {
    let steps = (0..frame.pixels() - 1).filter_map(|n| {
        let [here, there] = [n, n + 1].map(|n| (all[7][n], all[5][n], all[6][n]));
        let same = frame.hits(n) && frame.hits(n + 1) && here.0 == there.0;
        let found = (there.1[0] - here.1[0], there.1[1] - here.1[1]);
        let mean = [0, 1].map(|k: usize| 0.5 * (here.2[k] + there.2[k]));
        let off = (found.0 - mean[0]).hypot(found.1 - mean[1]);
        same.then(|| off / (1e-3 + found.0.hypot(found.1)))
    });
    let mut steps: Vec<f32> = steps.collect();
    steps.sort_by(f32::total_cmp);
    let median = steps[steps.len() / 2];
    println!("uv changes by {median} of the change to the next pixel, median");
    assert!(median < 0.05, "{median}");
}
