//! The limits that every renderer needs of a device. The counts of descriptors follow from
//! [`SETS`], and the rest from what shaders declare.

use crate::gpu::vk::descriptors::{EVERY, SETS, count};
use crate::shader::generated::{GROUP_PIXELS, MOST_GROUPS, PATCH_VECTORS};
use crate::shader::{FrameBlock, Pushed};
use ash::vk;
use vk::DescriptorType as Kind;
use vk::ShaderStageFlags as Stages;

/// Kinds of descriptors that count together under one limit.
const UNIFORMS: &[Kind] = &[Kind::UNIFORM_BUFFER, Kind::UNIFORM_BUFFER_DYNAMIC];
const DYNAMIC: &[Kind] = &[Kind::UNIFORM_BUFFER_DYNAMIC];
const BUFFERS: &[Kind] = &[Kind::STORAGE_BUFFER];
const SAMPLERS: &[Kind] = &[Kind::COMBINED_IMAGE_SAMPLER];
const SAMPLED: &[Kind] = &[Kind::COMBINED_IMAGE_SAMPLER, Kind::UNIFORM_TEXEL_BUFFER];
const IMAGES: &[Kind] = &[Kind::STORAGE_IMAGE];

/// The number of descriptors of some kinds in all sets, of the stage that may read the most.
fn count_of_stage(kinds: &[Kind]) -> u32 {
    let stages = [Stages::VERTEX, Stages::FRAGMENT, Stages::COMPUTE];
    let counts = stages.map(|stage| count(kinds, stage));
    counts.into_iter().max().unwrap_or_default()
}

/// Storage buffers and images of a fragment shader, which share a limit with its attachments.
pub(crate) fn fragment_resources() -> u32 {
    count(&[BUFFERS, IMAGES].concat(), Stages::FRAGMENT)
}

/// Each limit that these limits fall short of: its name in Vulkan, the needed number, and the
/// device's.
pub(crate) fn lacking(l: &vk::PhysicalDeviceLimits) -> Vec<String> {
    let kinds = [UNIFORMS, BUFFERS, SAMPLED, IMAGES].concat();
    let frame = size_of::<FrameBlock>() as u32;
    let stage = |name: &'static str, kinds: &[Kind], has: u32| {
        (format!("maxPerStage{name}"), count_of_stage(kinds), has)
    };
    let layout = |name: &'static str, kinds: &[Kind], has: u32| {
        (format!("maxDescriptorSet{name}"), count(kinds, EVERY), has)
    };
    let one = |name: &str, needed: u32, has: u32| (name.to_owned(), needed, has);
    let [across, down, _] = l.max_compute_work_group_size;
    let [groups, ..] = l.max_compute_work_group_count;
    let all = [
        one(
            "maxBoundDescriptorSets",
            SETS.len() as u32,
            l.max_bound_descriptor_sets,
        ),
        stage(
            "DescriptorUniformBuffers",
            UNIFORMS,
            l.max_per_stage_descriptor_uniform_buffers,
        ),
        stage(
            "DescriptorStorageBuffers",
            BUFFERS,
            l.max_per_stage_descriptor_storage_buffers,
        ),
        stage(
            "DescriptorSamplers",
            SAMPLERS,
            l.max_per_stage_descriptor_samplers,
        ),
        stage(
            "DescriptorSampledImages",
            SAMPLED,
            l.max_per_stage_descriptor_sampled_images,
        ),
        stage(
            "DescriptorStorageImages",
            IMAGES,
            l.max_per_stage_descriptor_storage_images,
        ),
        stage("Resources", &kinds, l.max_per_stage_resources),
        layout(
            "UniformBuffers",
            UNIFORMS,
            l.max_descriptor_set_uniform_buffers,
        ),
        layout(
            "UniformBuffersDynamic",
            DYNAMIC,
            l.max_descriptor_set_uniform_buffers_dynamic,
        ),
        layout(
            "StorageBuffers",
            BUFFERS,
            l.max_descriptor_set_storage_buffers,
        ),
        layout("Samplers", SAMPLERS, l.max_descriptor_set_samplers),
        layout(
            "SampledImages",
            SAMPLED,
            l.max_descriptor_set_sampled_images,
        ),
        layout("StorageImages", IMAGES, l.max_descriptor_set_storage_images),
        one(
            "maxFragmentCombinedOutputResources",
            // One attachment; PassFormats::check counts more of them.
            fragment_resources() + 1,
            l.max_fragment_combined_output_resources,
        ),
        one(
            "maxPushConstantsSize",
            size_of::<Pushed>() as u32,
            l.max_push_constants_size,
        ),
        one(
            "maxUniformBufferRange",
            frame.max(16 * PATCH_VECTORS),
            l.max_uniform_buffer_range,
        ),
        one(
            "maxComputeWorkGroupInvocations",
            GROUP_PIXELS * GROUP_PIXELS,
            l.max_compute_work_group_invocations,
        ),
        one("maxComputeWorkGroupSize", GROUP_PIXELS, across.min(down)),
        one("maxComputeWorkGroupCount", MOST_GROUPS, groups),
    ];
    let short = all.into_iter().filter(|(_, needed, has)| has < needed);
    short
        .map(|(name, needed, has)| format!("{name} of {needed} (it has {has})"))
        .collect()
}
