//! The least device of Vulkan 1.2.

use ash::vk;

/// The limits that Vulkan 1.2 guarantees (table "Required Limits" of the specification), and no more.
/// Alignments are the largest. Limits that the library and its allocator do not read are 0.
pub fn least_limits() -> vk::PhysicalDeviceLimits {
    use vk::SampleCountFlags as Count;
    let four = Count::TYPE_1 | Count::TYPE_4;
    vk::PhysicalDeviceLimits {
        max_image_dimension2_d: 4096,
        max_texel_buffer_elements: 65_536,
        max_uniform_buffer_range: 16_384,
        max_storage_buffer_range: 1 << 27,
        max_push_constants_size: 128,
        max_memory_allocation_count: 4096,
        buffer_image_granularity: 131_072,
        max_bound_descriptor_sets: 4,
        max_per_stage_descriptor_samplers: 16,
        max_per_stage_descriptor_uniform_buffers: 12,
        max_per_stage_descriptor_storage_buffers: 4,
        max_per_stage_descriptor_sampled_images: 16,
        max_per_stage_descriptor_storage_images: 4,
        max_per_stage_resources: 128,
        max_descriptor_set_samplers: 96,
        max_descriptor_set_uniform_buffers: 72,
        max_descriptor_set_uniform_buffers_dynamic: 8,
        max_descriptor_set_storage_buffers: 24,
        max_descriptor_set_sampled_images: 96,
        max_descriptor_set_storage_images: 24,
        max_vertex_output_components: 64,
        max_fragment_input_components: 64,
        max_fragment_combined_output_resources: 4,
        max_compute_work_group_count: [65_535; 3],
        max_compute_work_group_invocations: 128,
        max_compute_work_group_size: [128, 128, 64],
        sub_texel_precision_bits: 4,
        max_draw_indirect_count: 1,
        max_sampler_anisotropy: 1.0,
        max_viewport_dimensions: [4096; 2],
        viewport_bounds_range: [-8192.0, 8191.0],
        min_uniform_buffer_offset_alignment: 256,
        min_storage_buffer_offset_alignment: 256,
        max_framebuffer_width: 4096,
        max_framebuffer_height: 4096,
        framebuffer_color_sample_counts: four,
        framebuffer_depth_sample_counts: four,
        max_color_attachments: 4,
        timestamp_period: 1.0,
        point_size_range: [1.0; 2],
        non_coherent_atom_size: 256,
        ..Default::default()
    }
}
