//! A planted device with the limits that Vulkan guarantees and no optional feature: it draws right
//! with default settings, or is refused by name.
#![allow(unsafe_code)]

use crate::calls::{Layer, Mask};
use crate::common::host::{borrow, open, open_with};
use crate::common::prelude::*;
use crate::common::ways::apart;
use crate::embedding::{hundred, three};
use crate::texturing::waves;
use crate::trouble::{picture, settings};

/// Grants what renderers need beyond the guaranteed limits of Vulkan.
pub fn grant(limits: &mut vk::PhysicalDeviceLimits) {
    limits.max_per_stage_descriptor_storage_buffers = 9;
    limits.max_fragment_combined_output_resources = 10;
}

/// A device of the least limits is refused, and the error names what it lacks and by how much.
#[test]
fn a_device_of_least_limits_is_refused_by_name() {
    let (layer, host) = (Layer::take(), open());
    type Change = fn(&mut vk::PhysicalDeviceLimits);
    let samplers = |kind: &str| format!("maxPerStageDescriptor{kind} of 16 (it has 15)");
    let lacks: [(Change, &str); 10] = [
        (|_| (), "(it has 4), maxFragmentCombinedOutputResources of"),
        (|_| (), "lacks maxPerStageDescriptorStorageBuffers of"),
        (
            |l| l.max_per_stage_descriptor_samplers = 15,
            &samplers("Samplers"),
        ),
        (
            |l| l.max_per_stage_descriptor_sampled_images = 15,
            &samplers("SampledImages"),
        ),
        (
            |l| l.max_bound_descriptor_sets = 2,
            "maxBoundDescriptorSets of 3 (it has 2)",
        ),
        (
            |l| l.max_push_constants_size = 16,
            "maxPushConstantsSize of 32 (it has 16)",
        ),
        (
            |l| l.max_compute_work_group_invocations = 32,
            "maxComputeWorkGroupInvocations of 64 (it has 32)",
        ),
        (
            |l| l.max_per_stage_descriptor_storage_images = 3,
            "maxPerStageDescriptorStorageImages of 4 (it has 3)",
        ),
        (
            |l| l.max_descriptor_set_uniform_buffers_dynamic = 1,
            "maxDescriptorSetUniformBuffersDynamic of 2 (it has 1)",
        ),
        (
            |l| l.max_uniform_buffer_range = 8192,
            "maxUniformBufferRange of 16384 (it has 8192)",
        ),
    ];
    for (change, lack) in lacks {
        let Err(error) = layer.poorer(&host, |m| m.limits = Some(change)) else {
            panic!("taken without {lack}");
        };
        assert_eq!(error.kind, ErrorKind::Unsupported, "{error}");
        assert!(error.to_string().contains(lack), "{error}");
    }
}

/// With these limits raised, and no other, it draws what the whole device draws.
#[test]
fn a_device_of_nearly_least_limits_draws_the_same() {
    let (layer, host) = (Layer::take(), open());
    let mut shadows = three();
    shadows.shadow = Shadow::Hard;
    let map = Solver::Live;
    for (stage, solver, scene) in [
        (DrawStage::Fragment, Solver::Exact, three()),
        (DrawStage::Compute, Solver::Exact, three()),
        (DrawStage::Fragment, map, shadows.clone()),
        (DrawStage::Compute, map, shadows),
    ] {
        let settings = Settings {
            width: 160,
            height: 120,
            solver,
            // Cells need more varyings than the least.
            proxy_min_pixels: u32::MAX,
            ..settings(stage)
        };
        let whole = borrow(&host);
        let wanted = picture(&whole, &scene, &settings);
        let least = layer.poorer(&host, |m| m.limits = Some(grant)).unwrap();
        let found = picture(&least, &scene, &settings);
        let (hits, edges, far) = apart(&wanted, &found);
        // Smaller uniform buffers and triangles in place of points change roundings.
        assert!(
            hits > 3000 && edges <= 4 && far == 0,
            "{stage:?}: {hits} {edges} {far}"
        );
    }
}

/// Scenes that use a feature or a limit where a device has it: objects with maps, a crowd, shadows by
/// the hierarchy, and replicas.
fn scenes() -> [(&'static str, Scene); 4] {
    let mut mapped = three();
    for (object, tint) in mapped.objects.iter_mut().zip([1.0, 2.0, 3.0]) {
        object.texturing.color_map = Some(waves(256, 128, tint));
    }
    let mut shadows = hundred();
    shadows.shadow = Shadow::Hard;
    let mut replicas = three();
    replicas.objects.truncate(1);
    replicas.objects[0].repeat = [2, 2, 1];
    [
        ("maps", mapped),
        ("crowd", hundred()),
        ("shadows", shadows),
        ("replicas", replicas),
    ]
}

/// Pixels of one surface in both pictures whose colours are apart by more than 0.02.
fn tinted(a: &Frame, b: &Frame) -> usize {
    let near = |&i: &usize| (a.distance[i] - b.distance[i]).abs() < 1e-3;
    let far = |&i: &usize| (0..3).any(|k| (a.color[i][k] - b.color[i][k]).abs() > 0.02);
    (0..a.pixels()).filter(near).filter(far).count()
}

/// The default settings draw the reference's surfaces in the colours of the whole device, whose
/// textures are filtered. The host's device is opened without optional features, so that the validation
/// layers object to a use of any.
#[test]
fn the_least_device_draws_right_by_default() {
    let layer = Layer::take();
    // Anisotropic filtering is sharper, so colours are compared without it.
    let plain = open_with(|features| features.with(|p| p.sampler_anisotropy = vk::FALSE));
    let plain = borrow(&plain);
    let needed = vk::PhysicalDeviceFeatures::default().fragment_stores_and_atomics(true);
    let host = open_with(|_| needed);
    let lacks = |m: &mut Mask| {
        m.limits = Some(grant);
        m.timestamps = true;
    };
    let least = layer.poorer(&host, lacks).unwrap();
    for (name, scene) in scenes() {
        let truth = reference(&scene, &sized(160, 120));
        for stage in [DrawStage::Fragment, DrawStage::Compute] {
            let settings = sized(160, 120).with(|s| s.stage = stage);
            let found = picture(&least, &scene, &settings);
            let whole = picture(&plain, &scene, &settings);
            let (hits, edges, far) = apart(&truth, &found);
            let tinted = tinted(&whole, &found);
            let what = format!(
                "{name}, {stage:?}: {hits} hits, {edges} at edges, {far} far, {tinted} tinted"
            );
            println!("{what}");
            assert!(hits > 2000 && edges + far <= 4 && tinted <= 2, "{what}");
        }
    }
}
