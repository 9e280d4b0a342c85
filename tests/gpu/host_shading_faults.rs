//! Shading by a host's function: what is refused, what validation reports, and that pipelines are
//! prewarmed, hidden and told apart.
#![allow(unsafe_code)]

use crate::calls::Layer;
use crate::common::host::{Checked, Drawn, UniformSet, add, borrow, open, opened};
use crate::common::prelude::*;
use crate::embedding::options;
use crate::host_shading::{COPY, lights, made, pass, picture, scene, shaded, shading};
use crate::least_device::grant;
use revmap::shading::Shading;

const SRGB: vk::Format = vk::Format::R8G8B8A8_SRGB;

fn colors() -> Output {
    pass(Planes::Color, &[SRGB])
}

/// A function of `count` textures of the host's set.
fn of_textures(count: u32) -> Arc<Shading> {
    let text = format!(
        "layout(set = 3, binding = 0) uniform sampler2D host_maps[{count}];\n\
         vec4 host_shade(Surface s) {{ return texture(host_maps[0], s.uv); }}\n"
    );
    shading(DrawStage::Fragment, &text)
}

/// A device of 16 textures and views in a stage leaves 8 to the host's set, and more are refused by name.
#[test]
fn textures_beyond_the_device_are_refused() {
    let (layer, host) = (Layer::take(), open());
    let least = layer.poorer(&host, |m| m.limits = Some(grant)).unwrap();
    let layout = |count| {
        let binding = vk::DescriptorSetLayoutBinding::default()
            .descriptor_type(vk::DescriptorType::COMBINED_IMAGE_SAMPLER)
            .descriptor_count(count)
            .stage_flags(vk::ShaderStageFlags::FRAGMENT);
        let bindings = [binding];
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: a plain creation, destroyed below.
        unsafe { host.device.create_descriptor_set_layout(&info, None) }.unwrap()
    };
    for (count, message) in [
        (8, None),
        (
            9,
            Some("maxPerStageDescriptorSampledImages of 17 (it has 16)"),
        ),
    ] {
        let set_layout = layout(count);
        let by = of_textures(count);
        let made = shaded(&least, colors(), &SearchSettings::exact(), &by, set_layout);
        match message {
            None => drop(made.unwrap()),
            Some(message) => {
                let error = made.err().unwrap();
                assert_eq!(error.kind, ErrorKind::Unsupported, "{error}");
                assert!(error.to_string().contains(message), "{error}");
            }
        }
        // SAFETY: no renderer with the layout is left.
        unsafe { host.device.destroy_descriptor_set_layout(set_layout, None) };
    }
}

/// A shading is refused where it would not shade, each time with the key and the remedy.
#[test]
fn what_does_not_fit_is_refused() {
    let (host, device) = opened();
    let set = UniformSet::of(&host, &[[0f32; 4]; 8]).unwrap();
    let copy = shading(DrawStage::Fragment, COPY);
    let exact = SearchSettings::exact();
    let in_compute = shading(DrawStage::Compute, COPY);
    let refused =
        |output, settings: &SearchSettings, by: &Arc<Shading>, layout, key: &str, words: &str| {
            let made = shaded(&device, output, settings, by, layout);
            let error = made.err().expect(key);
            assert_eq!(error.kind, ErrorKind::Usage, "{error}");
            assert_eq!(error.key.as_deref(), Some(key), "{error}");
            assert!(error.message.contains(words), "{error}");
        };
    let null = vk::DescriptorSetLayout::null();
    refused(colors(), &exact, &copy, null, "set_layout", "reads set 3");
    let list = Planes::List(PlaneList::new(&[Plane::Motion]).unwrap());
    let motion = pass(list, &[vk::Format::R16G16_SFLOAT]);
    let depths = pass(Planes::Depth { parallel: false }, &[]);
    let compute = Output::Compute(Planes::Color);
    let circle = exact.with(|s| s.solver = CIRCLE);
    let rgba8 = exact.with(|s| s.map_format = MapFormat::Rgba8);
    for (output, settings, by, key, words) in [
        (compute, exact, &copy, "shading", "needs compute"),
        (colors(), exact, &in_compute, "shading", "needs fragment"),
        (motion, exact, &copy, "planes", "with colour"),
        (depths, exact, &copy, "planes", "with colour"),
        (colors(), circle, &copy, "solver", "exact, quadric or live"),
        (colors(), rgba8, &copy, "solver", "r16"),
    ] {
        refused(output, &settings, by, set.layout, key, words);
    }
    for (name, binding) in [("set = 4", 0), ("set = 1", 9)] {
        let text = format!(
            "layout({name}, binding = {binding}) uniform Other {{ vec4 value; }} other;\n\
             vec4 host_shade(Surface s) {{ return other.value; }}\n"
        );
        let by = shading(DrawStage::Fragment, &text);
        refused(colors(), &exact, &by, set.layout, "shading", "in set 3");
    }
    let mut fits = shaded(&device, colors(), &exact, &copy, set.layout).unwrap();
    let lighting = Lighting::default().with(|l| l.shadow = Shadow::Hard);
    let error = fits.set_lighting(&lighting).unwrap_err();
    assert_eq!(error.key.as_deref(), Some("shadow"), "{error}");
}

/// Messages of validation while every pipeline of a scene is compiled.
fn messages(host: &Checked, text: &str) -> Vec<String> {
    let device = borrow(host);
    let set = UniformSet::of(host, &[[0f32; 4]; 8]).unwrap();
    let by = shading(DrawStage::Fragment, text);
    let exact = SearchSettings::exact();
    let mut renderer = shaded(&device, colors(), &exact, &by, set.layout).unwrap();
    add(&mut renderer, &scene());
    renderer.prewarm().unwrap().compile().unwrap();
    host.take_messages()
}

/// The layers report a function that reads a binding that the layout lacks, or has of another kind;
/// they are silent on one that fits.
#[test]
fn validation_reports_a_binding_that_the_layout_lacks() {
    let host = open();
    let silent = messages(&host, COPY);
    assert!(silent.is_empty(), "{silent:?}");
    for declared in [
        "binding = 1, std140) uniform",
        "binding = 0, std430) readonly buffer",
    ] {
        let wrong = format!(
            "layout(set = 3, {declared} Other {{ vec4 value; }} other;\n\
             vec4 host_shade(Surface s) {{ return other.value; }}\n"
        );
        let found = messages(&host, &wrong);
        let of_layout = |text: &String| text.contains("VkGraphicsPipelineCreateInfo-layout");
        assert!(found.iter().any(of_layout), "{declared}: {found:?}");
    }
}

/// A renderer that hides compiles nothing while it prepares; what was prewarmed shows. Two shadings
/// on one device have pipelines of their own, and none of the library's.
#[test]
fn pipelines_are_prewarmed_and_told_apart() {
    let (host, device) = opened();
    let scene = scene();
    let set = UniformSet::of(&host, &lights(&scene)).unwrap();
    let red = "vec4 host_shade(Surface s) { return vec4(1.0, 0.0, 0.0, 1.0); }\n";
    let [copy, red] = [COPY, red].map(|text| shading(DrawStage::Fragment, text));
    let exact = SearchSettings::exact();
    let mut shown = Vec::new();
    for by in [&copy, &red] {
        let mut renderer = made(&device, colors(), &exact, Some((by, &set)));
        renderer.hide_until_compiled(true);
        let mut drawn = Drawn::by(&host, renderer, options(), &colors(), &scene);
        let before = device.pipelines_compiled();
        let (hidden, _) = drawn.picture_by(Some(&set));
        assert!(hidden.iter().all(|byte| *byte == 0), "drawn");
        assert_eq!(device.pipelines_compiled(), before);
        let warm = drawn.renderer.prewarm().unwrap();
        std::thread::scope(|scope| scope.spawn(|| warm.compile()).join().unwrap()).unwrap();
        let compiled = device.pipelines_compiled();
        assert!(compiled > before);
        shown.push(drawn.picture_by(Some(&set)).0);
        assert_eq!(device.pipelines_compiled(), compiled, "compiled in a frame");
    }
    let ours = picture(&host, &device, &scene, &exact, DrawStage::Fragment, None).0;
    // Two modules may round differently: SwiftShader's do.
    let alike = |(a, b): (&u8, &u8)| a.abs_diff(*b) <= 1;
    assert!(shown[0].len() == ours.len() && shown[0].iter().zip(&ours).all(alike));
    let drawn = || shown[1].chunks(4).filter(|pixel| pixel[3] != 0);
    assert!(drawn().count() > 3000 && drawn().all(|pixel| pixel == [255, 0, 0, 255]));
}
