//! A planted device with the limits that Vulkan guarantees and no optional feature: it draws right
//! with default settings, or is refused by name.
#![allow(unsafe_code)]

use crate::calls::{Layer, Mask};
use crate::common::host::{borrow, open, open_with};
use crate::common::prelude::*;
use crate::common::ways::apart;
use crate::embedding::{hundred, three};
use crate::texturing::waves;
use crate::trouble::picture;

/// Grants what renderers need beyond the guaranteed limits of Vulkan.
pub fn grant(limits: &mut vk::PhysicalDeviceLimits) {
    limits.max_per_stage_descriptor_storage_buffers = 9;
    limits.max_fragment_combined_output_resources = 10;
}

/// A device that lacks what is needed is refused, and the error names what it lacks and by how
/// much.
#[test]
fn a_device_that_lacks_something_is_refused_by_name() {
    let (layer, host) = (Layer::take(), open());
    const HALF: Option<vk::Format> = Some(vk::Format::R16_SFLOAT);
    const FLOAT: Option<vk::Format> = Some(vk::Format::R32_SFLOAT);
    const FLOATS: Option<vk::Format> = Some(vk::Format::R32G32B32A32_SFLOAT);
    const DEPTH: Option<vk::Format> = Some(vk::Format::D32_SFLOAT);
    macro_rules! limit {
        ($limit:ident, $value:literal) => {
            |m| m.limits = Some(|l| l.$limit = $value)
        };
    }
    type Change = fn(&mut Mask);
    let lacks: [(Change, &str); 17] = [
        (|m| m.format = HALF, "lacks sampled 16-bit float images"),
        (|m| m.format = FLOAT, "lacks sampled 32-bit float images"),
        (
            |m| m.format = FLOATS,
            "lacks render targets and storage images",
        ),
        (|m| m.format = DEPTH, "lacks a 32-bit float depth buffer"),
        (
            |m| m.properties = Some(|p| p.api_version = vk::API_VERSION_1_1),
            "lacks Vulkan 1.2",
        ),
        (
            |m| m.features = Some(|f| f.fragment_stores_and_atomics = vk::FALSE),
            "lacks fragmentStoresAndAtomics",
        ),
        (
            |m| m.families = Some(|f| f.queue_flags &= !vk::QueueFlags::COMPUTE),
            "lacks a queue for graphics and compute",
        ),
        (
            |m| m.limits = Some(|_| ()),
            "(it has 4), maxFragmentCombinedOutputResources of",
        ),
        (
            |m| m.limits = Some(|_| ()),
            "lacks maxPerStageDescriptorStorageBuffers of",
        ),
        (
            limit!(max_per_stage_descriptor_samplers, 11),
            "maxPerStageDescriptorSamplers of 12 (it has 11)",
        ),
        (
            limit!(max_per_stage_descriptor_sampled_images, 15),
            "maxPerStageDescriptorSampledImages of 16 (it has 15)",
        ),
        (
            limit!(max_bound_descriptor_sets, 2),
            "maxBoundDescriptorSets of 3 (it has 2)",
        ),
        (
            limit!(max_push_constants_size, 16),
            "maxPushConstantsSize of 44 (it has 16)",
        ),
        (
            limit!(max_compute_work_group_invocations, 32),
            "maxComputeWorkGroupInvocations of 64 (it has 32)",
        ),
        (
            limit!(max_per_stage_descriptor_storage_images, 3),
            "maxPerStageDescriptorStorageImages of 4 (it has 3)",
        ),
        (
            limit!(max_descriptor_set_uniform_buffers_dynamic, 1),
            "maxDescriptorSetUniformBuffersDynamic of 2 (it has 1)",
        ),
        (
            limit!(max_uniform_buffer_range, 8192),
            "maxUniformBufferRange of 16384 (it has 8192)",
        ),
    ];
    for (change, lack) in lacks {
        let error = layer.poorer(&host, change).err().expect(lack);
        assert_eq!(error.kind, ErrorKind::Unsupported, "{error}");
        assert!(error.to_string().contains(lack), "{error}");
    }
}

/// Scenes that use a feature or a limit where a device has it: objects with maps, a crowd, shadows by
/// the hierarchy, and replicas.
fn scenes() -> [(&'static str, Solver, Scene); 5] {
    let mut mapped = three();
    for (object, tint) in mapped.objects.iter_mut().zip([1.0, 2.0, 3.0]) {
        object.texturing.color_map = Some(waves(256, 128, tint));
    }
    let mut shadows = hundred();
    shadows.shadow = Shadow::Hard;
    let mut by_maps = three();
    by_maps.shadow = Shadow::Hard;
    let mut replicas = three();
    replicas.objects.truncate(1);
    replicas.objects[0].repeat = [2, 2, 1];
    [
        ("maps", Solver::DEFAULT, mapped),
        ("crowd", Solver::DEFAULT, hundred()),
        ("shadows", Solver::DEFAULT, shadows),
        ("replicas", Solver::DEFAULT, replicas),
        ("live", Solver::Live, by_maps),
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
        m.families = Some(|f| f.timestamp_valid_bits = 0);
    };
    let least = layer.poorer(&host, lacks).unwrap();
    for (name, solver, scene) in scenes() {
        let truth = reference(&scene, &sized(160, 120));
        let settings = sized(160, 120);
        let mut timed = Offscreen::new(&least, &scene, &settings).unwrap();
        assert_eq!(timed.draw().unwrap().gpu_ms, None);
        drop(timed);
        for stage in [DrawStage::Fragment, DrawStage::Compute] {
            let settings = drawn_by((160, 120), stage, solver);
            let found = picture(&least, &scene, &settings);
            let whole = picture(&plain, &scene, &settings);
            // The map's search has errors of its own.
            let truth = if solver == Solver::Live {
                &whole
            } else {
                &truth
            };
            let (hits, edges, far) = apart(truth, &found);
            let tinted = tinted(&whole, &found);
            let what = format!(
                "{name}, {stage:?}: {hits} hits, {edges} at edges, {far} far, {tinted} tinted"
            );
            println!("{what}");
            assert!(hits > 2000 && edges + far <= 4 && tinted <= 2, "{what}");
        }
    }
}
