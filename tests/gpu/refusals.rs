//! Errors that a renderer returns when it is made or before it records, and their kinds. No invalid
//! call is passed to Vulkan.
#![allow(unsafe_code)]

use crate::calls::Layer;
use crate::common::host::{self, borrow, once, open, open_with, opened};
use crate::common::prelude::*;
use ash::vk::Handle as _;
use revmap::error::ErrorKind::{Unsupported, Usage};

const COLOR: vk::Format = vk::Format::R8G8B8A8_SRGB;
const FLOAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
const BOTH: vk::Format = vk::Format::D32_SFLOAT_S8_UINT;
const NONE: vk::Format = vk::Format::UNDEFINED;

fn pass(begun: PassKind, samples: u32, planes: Planes) -> Output {
    Output::Pass(PassFormats::new(begun, planes).with(|p| p.samples = samples))
}

fn dynamic(
    color: &[vk::Format],
    depth: vk::Format,
    stencil: vk::Format,
    planes: Planes,
    samples: u32,
) -> Output {
    let begun = PassKind::Dynamic {
        color: color.to_vec(),
        depth,
        stencil,
    };
    pass(begun, samples, planes)
}

/// A pass of colours and depths.
fn color() -> Output {
    dynamic(&[COLOR], DEPTH, NONE, Planes::Color, 1)
}

fn renderer(device: &Device) -> Renderer {
    Renderer::new(device, color(), &SearchSettings::exact(), 1).unwrap()
}

fn single_subpass(color: &[vk::Format], depth: vk::Format, planes: Planes, samples: u32) -> Output {
    let color = color.to_vec();
    pass(PassKind::SingleSubpass { color, depth }, samples, planes)
}

/// Outputs of these formats; only dynamic rendering names the stencil apart.
fn kinds(
    color: &[vk::Format],
    depth: vk::Format,
    stencil: vk::Format,
    planes: Planes,
    samples: u32,
) -> Vec<Output> {
    let mut all = vec![dynamic(color, depth, stencil, planes, samples)];
    if stencil == NONE {
        all.push(single_subpass(color, depth, planes, samples));
    }
    all
}

/// The kind and key of the refusal; `None` if a renderer is made.
fn refused(device: &Device, output: Output) -> Option<(ErrorKind, Option<String>)> {
    refused_by(device, output, &SearchSettings::exact())
}

fn refused_by(
    device: &Device,
    output: Output,
    search: &SearchSettings,
) -> Option<(ErrorKind, Option<String>)> {
    let made = Renderer::new(device, output, search, 1);
    made.err().map(|error| (error.kind, error.key))
}

#[track_caller]
fn assert_refused(device: &Device, output: Output, kind: ErrorKind, key: Option<&str>) {
    let found = refused(device, output.clone());
    assert_eq!(found, Some((kind, key.map(str::to_owned))), "{output:?}");
}

/// Planes that a search, a format or a stage does not draw, and biases of other planes than depths.
#[test]
fn planes_that_do_not_fit_are_refused() {
    use vk::Format as F;
    let twice = PlaneList::new(&[Plane::Color, Plane::Color]);
    assert_eq!(twice.unwrap_err().kind, Usage);
    for [factor, limit] in [
        [-1.0, 1.0],
        [f32::NAN, 1.0],
        [1.0, f32::INFINITY],
        [1.0, 0.0],
    ] {
        assert_eq!(SlopeBias::new(factor, limit).unwrap_err().kind, Usage);
    }
    let list = |plane| Planes::List(PlaneList::new(&[plane]).unwrap());
    let of = |plane, format| dynamic(&[format], DEPTH, NONE, list(plane), 1);
    let depth_alone = Planes::Depth { parallel: false };
    let biased = PassFormats {
        slope_bias: SlopeBias::new(1.0, 1.0).unwrap(),
        ..host::color_pass()
    };
    let exact = SearchSettings::exact();
    let circle = exact.with(|s| s.solver = CIRCLE);
    let rgba8 = exact.with(|s| (s.solver, s.map_format) = (Solver::Live, MapFormat::Rgba8));
    for (output, search, key) in [
        (of(Plane::Identity, F::R32G32_SFLOAT), exact, "color"),
        (of(Plane::Identity, F::R32_UINT), exact, "color"),
        (of(Plane::Motion, F::R8G8_UNORM), exact, "color"),
        (of(Plane::Motion, F::R16_SFLOAT), exact, "color"),
        (of(Plane::Normal, F::R16G16_SFLOAT), exact, "color"),
        (of(Plane::Normal, F::R8G8B8A8_UNORM), exact, "color"),
        (of(Plane::Color, F::R8G8B8A8_UINT), exact, "color"),
        (of(Plane::Color, FLOAT), rgba8, "map_format"),
        (of(Plane::Color, FLOAT), circle, "planes"),
        (Output::Compute(list(Plane::Color)), exact, "planes"),
        (dynamic(&[], DEPTH, NONE, depth_alone, 1), circle, "planes"),
        (Output::Compute(depth_alone), exact, "planes"),
        (Output::Pass(biased), exact, "slope_bias"),
    ] {
        let found = refused_by(device(), output.clone(), &search);
        assert_eq!(found, Some((Usage, Some(key.to_owned()))), "{output:?}");
    }
}

#[test]
fn attachments_that_do_not_fit_are_refused() {
    let depth_alone = Planes::Depth { parallel: false };
    for (color, depth, stencil, planes, samples) in [
        (&[COLOR][..], DEPTH, NONE, Planes::Color, 1),
        (&[COLOR], BOTH, NONE, Planes::Color, 4),
        (&[COLOR], BOTH, BOTH, Planes::Color, 1),
        (&[FLOAT; 4], DEPTH, NONE, Planes::All, 1),
        (&[], vk::Format::D16_UNORM, NONE, depth_alone, 1),
    ] {
        for output in kinds(color, depth, stencil, planes, samples) {
            assert_eq!(refused(device(), output.clone()), None, "{output:?}");
        }
    }
    let unsigned = vk::Format::R8G8B8A8_UINT;
    let signed = vk::Format::R32G32B32A32_SINT;
    let packed = vk::Format::BC1_RGB_UNORM_BLOCK;
    let stencil_alone = vk::Format::S8_UINT;
    let mixed = [FLOAT, FLOAT, FLOAT, signed];
    for (color, depth, stencil, planes, key) in [
        (&[][..], DEPTH, NONE, Planes::Color, "color"),
        (&[COLOR, COLOR], DEPTH, NONE, Planes::Color, "color"),
        (&[FLOAT; 3], DEPTH, NONE, Planes::All, "color"),
        (&[FLOAT; 5], DEPTH, NONE, Planes::All, "color"),
        (&[COLOR], DEPTH, NONE, depth_alone, "color"),
        (&[NONE], DEPTH, NONE, Planes::Color, "color"),
        (&[DEPTH], DEPTH, NONE, Planes::Color, "color"),
        (&[stencil_alone], DEPTH, NONE, Planes::Color, "color"),
        (&[unsigned], DEPTH, NONE, Planes::Color, "color"),
        (&mixed, DEPTH, NONE, Planes::All, "color"),
        (&[COLOR], NONE, NONE, Planes::Color, "depth"),
        (&[COLOR], COLOR, NONE, Planes::Color, "depth"),
        (&[COLOR], stencil_alone, NONE, Planes::Color, "depth"),
        (&[COLOR], DEPTH, DEPTH, Planes::Color, "stencil"),
        (&[COLOR], DEPTH, BOTH, Planes::Color, "stencil"),
        (&[COLOR], DEPTH, COLOR, Planes::Color, "stencil"),
    ] {
        for output in kinds(color, depth, stencil, planes, 1) {
            assert_refused(device(), output, Usage, Some(key));
        }
    }
    for output in kinds(&[packed], DEPTH, NONE, Planes::Color, 1) {
        assert_refused(device(), output, Unsupported, None);
    }
    let null = PassKind::RenderPass {
        // SAFETY: the renderer refuses this handle before any use.
        pass: unsafe { HostPass::new(vk::RenderPass::null()) },
        subpass: 0,
    };
    assert_refused(device(), pass(null, 1, Planes::Color), Usage, Some("pass"));
    device().check().unwrap();
}

#[test]
fn samples_that_the_device_has_not_are_refused() {
    for samples in [0, 3, 16] {
        let output = dynamic(&[COLOR], DEPTH, NONE, Planes::Color, samples);
        assert_refused(device(), output, Usage, Some("samples"));
    }
    let (layer, host) = (Layer::take(), open());
    let poorer = layer.poorer(&host, |m| m.one_sample = true).unwrap();
    let own = PassKind::RenderPass {
        // SAFETY: the renderer refuses this handle before any use.
        pass: unsafe { HostPass::new(vk::RenderPass::from_raw(1)) },
        subpass: 0,
    };
    for samples in [2, 4, 8] {
        let output = dynamic(&[COLOR], DEPTH, NONE, Planes::Color, samples);
        assert_refused(&poorer, output, Unsupported, Some("samples"));
        let output = pass(own.clone(), samples, Planes::Color);
        assert_refused(&poorer, output, Unsupported, Some("samples"));
    }
    assert_eq!(refused(&poorer, color()), None);
}

#[test]
fn all_planes_need_their_feature_and_their_buffer() {
    let all = || dynamic(&[FLOAT; 4], DEPTH, NONE, Planes::All, 1);
    let bare = open_with(|_| vk::PhysicalDeviceFeatures::default());
    assert_refused(&borrow(&bare), all(), Unsupported, None);

    let (host, device) = opened();
    let camera = Camera::new(DVec3::new(2.0, 0.0, 0.5), DVec3::new(0.0, 0.0, 0.5));
    let view = View::from_camera(&camera, (16, 16), [1.0, 4.0]).unwrap();
    // The renderer refuses these handles before any use.
    let (words, image) = (vk::Buffer::from_raw(1), vk::ImageView::from_raw(1));
    let (compute, none) = (Output::Compute, vk::ImageView::null());
    for (output, words, images, key) in [
        (all(), vk::Buffer::null(), &[][..], "words"),
        (all(), words, &[image], "images"),
        (color(), words, &[], "target"),
        (compute(Planes::Color), vk::Buffer::null(), &[], "words"),
        (compute(Planes::Color), words, &[image], "images"),
        (compute(Planes::All), words, &[image; 3], "images"),
        (compute(Planes::All), words, &[none; 4], "images"),
    ] {
        let made = Renderer::new(&device, output.clone(), &SearchSettings::exact(), 1);
        let mut renderer = made.unwrap();
        let target = ComputeTarget {
            words,
            images: images.to_vec(),
            depths: true,
        };
        // SAFETY: the target is refused.
        let set = unsafe { renderer.set_compute_target(target) };
        let mut errors = vec![(set.unwrap_err(), key)];
        once(&host, |cmd| {
            // SAFETY: `cmd` is recording outside of a pass.
            let prepared = unsafe { renderer.prepare(cmd, 0, &view) };
            errors.extend(prepared.err().map(|error| (error, "target")));
        });
        assert_eq!(errors.len(), if output == color() { 1 } else { 2 });
        for (error, key) in errors {
            let found = (error.kind, error.key.as_deref());
            assert_eq!(found, (Usage, Some(key)), "{error}");
        }
    }
}

/// Two renderers number their objects alike.
#[test]
fn another_renderers_object_is_refused() {
    let [mut one, mut other] = [(); 2].map(|()| renderer(device()));
    let object = Object::new("vase", shapes::vase().into());
    let id = one.add(object.clone()).unwrap();
    let twin = other.add(object.clone()).unwrap();
    assert_ne!(id.to_bits(), twin.to_bits());
    for id in [id, ObjectId::from_bits(id.to_bits())] {
        let kinds = [
            other.object(id).unwrap_err().kind,
            other.set(id, object.clone()).unwrap_err().kind,
            other.set_offset(id, object.offset).unwrap_err().kind,
            other.remove(id).unwrap_err().kind,
        ];
        assert_eq!(kinds, [Usage; 4]);
        // Reading takes no exclusive reference.
        let (read, again) = (&one, &one);
        let names = [read, again].map(|one| &one.object(id).unwrap().name);
        assert_eq!(names[0], names[1]);
    }
    assert!(other.object(twin).is_ok());
    one.remove(id).unwrap();
    assert_ne!(one.add(object).unwrap(), id);
    assert_eq!(one.object(id).unwrap_err().kind, Usage);
    for bits in [0, u64::MAX] {
        let error = one.object(ObjectId::from_bits(bits)).unwrap_err();
        assert_eq!(error.kind, Usage);
    }
}

/// A message about values names the object: its key, with its place among all, and its name.
#[test]
fn setters_name_the_object() {
    let mut renderer = renderer(device());
    let profile = Arc::new(shapes::vase());
    let mut add = |name: &str| renderer.add(Object::new(name, profile.clone())).unwrap();
    let [first, _, vase] = ["first", "second", "vase"].map(&mut add);
    renderer.remove(first).unwrap();
    let mut flat = Object::new("another name", profile.clone());
    flat.placement.scale.y = 0.0;
    let offset = Offset::default().with(|o| o.extend = f64::NAN);
    let copies = vec![Placement::default(), flat.placement];
    let last = "instances.1.scale";
    for (found, key) in [
        (renderer.set_offset(vase, offset), "extend"),
        (renderer.set_placement(vase, flat.placement), "scale"),
        (renderer.set_instances(vase, copies), last),
        (renderer.set(vase, flat.clone()), "scale"),
    ] {
        let error = found.unwrap_err();
        assert_eq!(error.kind, ErrorKind::Content);
        assert_eq!(error.key, Some(format!("object.1.{key}")), "{error}");
        assert!(error.message.contains("vase"), "{error}");
    }
    let error = renderer.add(flat).unwrap_err();
    assert_eq!(error.key.as_deref(), Some("object.2.scale"));
    assert!(error.message.contains("another name"), "{error}");
    // The number is all that is known of an object that is not there.
    for error in [
        renderer.set_offset(first, Offset::default()).unwrap_err(),
        renderer.set_offset(first, offset).unwrap_err(),
        renderer.set_mask(first, 1).unwrap_err(),
        renderer.set_color_image(first, None).unwrap_err(),
        renderer.remove(first).unwrap_err(),
    ] {
        assert_eq!(error.kind, Usage);
        let number = first.to_bits().to_string();
        assert!(error.message.contains(&number), "{error}");
    }
}

/// Shadows between too many shapes are refused in each frame, until the host takes them back. The
/// lights stay as they were set, so no other change is lost with them.
#[test]
fn a_refusal_repeats_until_it_is_mended() {
    let live = SearchSettings::exact().with(|s| s.solver = Solver::Live);
    let mut renderer = Renderer::new(device(), color(), &live, 1).unwrap();
    for n in 0..13 {
        let mut object = Object::new(format!("{n}"), Arc::new(shapes::sphere()));
        object.placement.position.y = f64::from(n);
        renderer.add(object).unwrap();
    }
    let camera = Camera::new(DVec3::new(9.0, 0.0, 2.0), DVec3::ZERO);
    let view = View::from_camera(&camera, (64, 48), [0.1, 100.0]).unwrap();
    renderer.plan(&view).unwrap();
    let before = renderer.lighting().clone();
    let shadows = before.clone().with(|l| l.shadow = Shadow::Hard);
    renderer.set_lighting(&shadows).unwrap();
    for _ in 0..2 {
        let refused = renderer.plan(&view).unwrap_err();
        assert_eq!(refused.key.as_deref(), Some("shadow"), "{refused}");
        assert_eq!(*renderer.lighting(), shadows);
    }
    renderer.set_lighting(&before).unwrap();
    renderer.plan(&view).unwrap();
    assert_eq!(renderer.object_costs().len(), 13);
}
