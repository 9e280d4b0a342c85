//! A small engine of its own: instance, device, images, two frames in flight, meshes. Nothing here is revmap's.

use ash::{ext, vk};
use glam::{DMat4, DVec3, DVec4, Vec3, Vec4};
use std::error::Error;
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

pub type Fallible<T> = Result<T, Box<dyn Error>>;

/// How a host draws.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    pub width: u32,
    pub height: u32,
    /// Dynamic rendering, or a render pass.
    pub dynamic: bool,
    /// 1 or 4.
    pub samples: u32,
    /// Depth 1 is near.
    pub reversed: bool,
}

pub const COLOR: vk::Format = vk::Format::R8G8B8A8_SRGB;
pub const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
pub const FRAMES: usize = 2;

/// An instance and a device, with the validation layers where asked for.
pub struct Host {
    pub instance: ash::Instance,
    pub physical: vk::PhysicalDevice,
    pub device: ash::Device,
    pub family: u32,
    pub queue: vk::Queue,
    pub features: vk::PhysicalDeviceFeatures,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Mutex<Vec<String>>>,
    _entry: ash::Entry,
}

unsafe extern "system" fn keep(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    store: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layers hand over a live message, and the store that was registered with it.
    unsafe {
        let text = CStr::from_ptr((*data).p_message)
            .to_string_lossy()
            .into_owned();
        if let Ok(mut all) = (*store.cast::<Mutex<Vec<String>>>()).lock() {
            all.push(text);
        }
    }
    vk::FALSE
}

impl Host {
    /// Opens a device; `requirements` says what has to be enabled on it.
    pub fn open(
        validate: bool,
        requirements: impl Fn(
            &ash::Instance,
            vk::PhysicalDevice,
        ) -> Fallible<(u32, vk::PhysicalDeviceFeatures)>,
    ) -> Fallible<Self> {
        // SAFETY: plain creations in order; everything is destroyed in Drop.
        unsafe {
            let entry = ash::Entry::load()?;
            let layer = [c"VK_LAYER_KHRONOS_validation".as_ptr()];
            let extensions = [
                ext::debug_utils::NAME.as_ptr(),
                ext::validation_features::NAME.as_ptr(),
            ];
            let checks = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
            let mut checked =
                vk::ValidationFeaturesEXT::default().enabled_validation_features(&checks);
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let mut info = vk::InstanceCreateInfo::default().application_info(&application);
            if validate {
                info = info
                    .enabled_layer_names(&layer)
                    .enabled_extension_names(&extensions)
                    .push_next(&mut checked);
            }
            let instance = entry.create_instance(&info, None)?;
            let messages = Box::<Mutex<Vec<String>>>::default();
            let messenger = if validate {
                let functions = ext::debug_utils::Instance::new(&entry, &instance);
                type Severity = vk::DebugUtilsMessageSeverityFlagsEXT;
                type Kind = vk::DebugUtilsMessageTypeFlagsEXT;
                let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
                    .message_severity(Severity::WARNING | Severity::ERROR)
                    .message_type(Kind::GENERAL | Kind::VALIDATION | Kind::PERFORMANCE)
                    .pfn_user_callback(Some(keep))
                    .user_data((&raw const *messages).cast_mut().cast());
                let messenger = functions.create_debug_utils_messenger(&info, None)?;
                Some((functions, messenger))
            } else {
                None
            };
            let mut refused: Box<dyn Error> = "no Vulkan device".into();
            for physical in instance.enumerate_physical_devices()? {
                let (family, features) = match requirements(&instance, physical) {
                    Ok(found) => found,
                    Err(error) => {
                        refused = error;
                        continue;
                    }
                };
                let priorities = [1.0];
                let queues = [vk::DeviceQueueCreateInfo::default()
                    .queue_family_index(family)
                    .queue_priorities(&priorities)];
                let mut newer =
                    vk::PhysicalDeviceVulkan13Features::default().dynamic_rendering(true);
                let info = vk::DeviceCreateInfo::default()
                    .queue_create_infos(&queues)
                    .enabled_features(&features)
                    .push_next(&mut newer);
                let device = instance.create_device(physical, &info, None)?;
                let queue = device.get_device_queue(family, 0);
                return Ok(Self {
                    instance,
                    physical,
                    device,
                    family,
                    queue,
                    features,
                    messenger,
                    messages,
                    _entry: entry,
                });
            }
            Err(refused)
        }
    }

    /// What the validation layers have said since the last call.
    pub fn take_messages(&self) -> Vec<String> {
        self.messages
            .lock()
            .map(|mut all| std::mem::take(&mut *all))
            .unwrap_or_default()
    }

    fn memory(
        &self,
        needs: vk::MemoryRequirements,
        wanted: vk::MemoryPropertyFlags,
    ) -> Fallible<vk::DeviceMemory> {
        // SAFETY: plain query and creation.
        unsafe {
            let all = self
                .instance
                .get_physical_device_memory_properties(self.physical);
            let kind = (0..all.memory_type_count)
                .find(|&n| {
                    needs.memory_type_bits & (1 << n) != 0
                        && all.memory_types[n as usize].property_flags.contains(wanted)
                })
                .ok_or("no such memory")?;
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(kind);
            Ok(self.device.allocate_memory(&info, None)?)
        }
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        // SAFETY: everything made on the device is gone.
        unsafe {
            self.device.destroy_device(None);
            if let Some((functions, messenger)) = &self.messenger {
                functions.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}

/// A buffer in host memory, mapped for as long as it lives.
pub struct HostBuffer<'a> {
    raw: vk::Buffer,
    memory: vk::DeviceMemory,
    mapped: *mut u8,
    bytes: usize,
    host: &'a Host,
}

impl<'a> HostBuffer<'a> {
    fn new(host: &'a Host, bytes: usize, usage: vk::BufferUsageFlags) -> Fallible<Self> {
        type Flags = vk::MemoryPropertyFlags;
        // SAFETY: plain creations; bound once, destroyed in Drop.
        unsafe {
            let info = vk::BufferCreateInfo::default()
                .size(bytes as u64)
                .usage(usage);
            let raw = host.device.create_buffer(&info, None)?;
            let needs = host.device.get_buffer_memory_requirements(raw);
            let memory = host.memory(needs, Flags::HOST_VISIBLE | Flags::HOST_COHERENT)?;
            host.device.bind_buffer_memory(raw, memory, 0)?;
            let mapped =
                host.device
                    .map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty())?;
            Ok(Self {
                raw,
                memory,
                mapped: mapped.cast(),
                bytes,
                host,
            })
        }
    }

    fn of<T: bytemuck::Pod>(
        host: &'a Host,
        values: &[T],
        usage: vk::BufferUsageFlags,
    ) -> Fallible<Self> {
        let bytes: &[u8] = bytemuck::cast_slice(values);
        let buffer = Self::new(host, bytes.len(), usage)?;
        // SAFETY: the mapping is as long as the bytes, and the device does not read it yet.
        unsafe {
            buffer
                .mapped
                .copy_from_nonoverlapping(bytes.as_ptr(), bytes.len())
        };
        Ok(buffer)
    }

    fn bytes(&self) -> Vec<u8> {
        // SAFETY: the device has written it and is done.
        unsafe { std::slice::from_raw_parts(self.mapped, self.bytes).to_vec() }
    }
}

impl Drop for HostBuffer<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is done with it.
        unsafe {
            self.host.device.destroy_buffer(self.raw, None);
            self.host.device.free_memory(self.memory, None);
        }
    }
}

struct HostImage<'a> {
    raw: vk::Image,
    view: vk::ImageView,
    memory: vk::DeviceMemory,
    host: &'a Host,
}

impl<'a> HostImage<'a> {
    fn new(host: &'a Host, options: &Options, format: vk::Format, samples: u32) -> Fallible<Self> {
        use vk::ImageUsageFlags as U;
        let (aspect, usage) = if format == DEPTH {
            (vk::ImageAspectFlags::DEPTH, U::DEPTH_STENCIL_ATTACHMENT)
        } else {
            (vk::ImageAspectFlags::COLOR, U::COLOR_ATTACHMENT)
        };
        // SAFETY: as for buffers.
        unsafe {
            let info = vk::ImageCreateInfo::default()
                .image_type(vk::ImageType::TYPE_2D)
                .format(format)
                .extent(vk::Extent3D {
                    width: options.width,
                    height: options.height,
                    depth: 1,
                })
                .mip_levels(1)
                .array_layers(1)
                .samples(vk::SampleCountFlags::from_raw(samples))
                .usage(
                    usage
                        | if samples == 1 {
                            U::TRANSFER_SRC
                        } else {
                            U::empty()
                        },
                );
            let raw = host.device.create_image(&info, None)?;
            let needs = host.device.get_image_memory_requirements(raw);
            let memory = host.memory(needs, vk::MemoryPropertyFlags::DEVICE_LOCAL)?;
            host.device.bind_image_memory(raw, memory, 0)?;
            let range = vk::ImageSubresourceRange::default()
                .aspect_mask(aspect)
                .level_count(1)
                .layer_count(1);
            let info = vk::ImageViewCreateInfo::default()
                .image(raw)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(range);
            let view = host.device.create_image_view(&info, None)?;
            Ok(Self {
                raw,
                view,
                memory,
                host,
            })
        }
    }
}

impl Drop for HostImage<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is done with it.
        unsafe {
            self.host.device.destroy_image_view(self.view, None);
            self.host.device.destroy_image(self.raw, None);
            self.host.device.free_memory(self.memory, None);
        }
    }
}

/// Triangles of the host's own.
pub struct Mesh<'a> {
    vertices: HostBuffer<'a>,
    count: u32,
    pub offset_scale: Vec4,
    pub color: Vec3,
}

impl<'a> Mesh<'a> {
    /// A square floor at `z`, of half side `half`.
    pub fn floor(host: &'a Host, half: f32, z: f32, color: Vec3) -> Fallible<Self> {
        let corner = |x: f32, y: f32| [[x, y, 0.0], [0.0, 0.0, 1.0]];
        let square = [
            (-1.0, -1.0),
            (1.0, -1.0),
            (1.0, 1.0),
            (-1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 1.0),
        ];
        let vertices: Vec<[[f32; 3]; 2]> = square.map(|(x, y)| corner(x, y)).to_vec();
        Self::of(host, &vertices, Vec4::new(0.0, 0.0, z, half), color)
    }

    /// A sphere of `2 n` segments and `n` rings.
    pub fn sphere(
        host: &'a Host,
        n: u32,
        middle: Vec3,
        radius: f32,
        color: Vec3,
    ) -> Fallible<Self> {
        let point = |i: u32, j: u32| {
            let (theta, phi) = (
                std::f32::consts::PI * j as f32 / n as f32,
                std::f32::consts::PI * i as f32 / n as f32,
            );
            let p = Vec3::new(
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            );
            [p.to_array(), p.to_array()]
        };
        let mut vertices = Vec::new();
        for j in 0..n {
            for i in 0..2 * n {
                let [a, b, c, d] = [
                    point(i, j),
                    point(i, j + 1),
                    point(i + 1, j + 1),
                    point(i + 1, j),
                ];
                vertices.extend([a, b, c, a, c, d]);
            }
        }
        Self::of(host, &vertices, middle.extend(radius), color)
    }

    fn of(
        host: &'a Host,
        vertices: &[[[f32; 3]; 2]],
        offset_scale: Vec4,
        color: Vec3,
    ) -> Fallible<Self> {
        Ok(Self {
            count: vertices.len() as u32,
            vertices: HostBuffer::of(host, vertices, vk::BufferUsageFlags::VERTEX_BUFFER)?,
            offset_scale,
            color,
        })
    }
}

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Pushed {
    clip_from_world: [[f32; 4]; 4],
    offset_scale: [f32; 4],
    color: [f32; 4],
    towards_light: [f32; 4],
}

struct InFlight {
    commands: vk::CommandBuffer,
    fence: vk::Fence,
}

/// The images of a frame, the pass that draws into them, and commands for the frames in flight.
pub struct Stage<'a> {
    pub options: Options,
    pub pass: vk::RenderPass,
    framebuffer: vk::Framebuffer,
    /// What is read back: of one sample.
    color: HostImage<'a>,
    /// Of several samples, where there are.
    multisampled: Option<HostImage<'a>>,
    depth: HostImage<'a>,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
    pool: vk::CommandPool,
    frames: Vec<InFlight>,
    next: usize,
    read: [HostBuffer<'a>; 2],
    host: &'a Host,
}

impl<'a> Stage<'a> {
    pub fn new(host: &'a Host, options: Options) -> Fallible<Self> {
        let device = &host.device;
        let pixels = (options.width * options.height) as usize;
        let color = HostImage::new(host, &options, COLOR, 1)?;
        let multisampled = if options.samples > 1 {
            Some(HostImage::new(host, &options, COLOR, options.samples)?)
        } else {
            None
        };
        let depth = HostImage::new(host, &options, DEPTH, options.samples)?;
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let read = [
            HostBuffer::new(host, 4 * pixels, usage)?,
            HostBuffer::new(host, 4 * pixels, usage)?,
        ];
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            let pool = vk::CommandPoolCreateInfo::default()
                .queue_family_index(host.family)
                .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
            let pool = device.create_command_pool(&pool, None)?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(FRAMES as u32);
            let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
            let mut frames = Vec::new();
            for commands in device.allocate_command_buffers(&info)? {
                let fence = device.create_fence(&signaled, None)?;
                frames.push(InFlight { commands, fence });
            }
            let push = [vk::PushConstantRange::default()
                .stage_flags(vk::ShaderStageFlags::VERTEX)
                .size(size_of::<Pushed>() as u32)];
            let info = vk::PipelineLayoutCreateInfo::default().push_constant_ranges(&push);
            let layout = device.create_pipeline_layout(&info, None)?;
            let mut stage = Self {
                options,
                pass: vk::RenderPass::null(),
                framebuffer: vk::Framebuffer::null(),
                color,
                multisampled,
                depth,
                layout,
                pipeline: vk::Pipeline::null(),
                pool,
                frames,
                next: 0,
                read,
                host,
            };
            if !options.dynamic {
                stage.make_pass()?;
            }
            stage.make_pipeline()?;
            Ok(stage)
        }
    }

    unsafe fn make_pass(&mut self) -> Fallible<()> {
        let device = &self.host.device;
        let samples = vk::SampleCountFlags::from_raw(self.options.samples);
        let attachment = |format, samples, layout| {
            vk::AttachmentDescription::default()
                .format(format)
                .samples(samples)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .initial_layout(vk::ImageLayout::UNDEFINED)
                .final_layout(layout)
        };
        let (color, depth) = (
            vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
            vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        );
        let mut attachments = vec![
            attachment(COLOR, samples, color),
            attachment(DEPTH, samples, depth),
        ];
        let mut views = vec![self.color.view, self.depth.view];
        if let Some(several) = &self.multisampled {
            attachments.push(attachment(COLOR, vk::SampleCountFlags::TYPE_1, color));
            views = vec![several.view, self.depth.view, self.color.view];
        }
        let reference = |n, layout| {
            vk::AttachmentReference::default()
                .attachment(n)
                .layout(layout)
        };
        let (colors, depths) = ([reference(0, color)], reference(1, depth));
        let resolves = [reference(2, color)];
        let mut subpass = vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colors)
            .depth_stencil_attachment(&depths);
        if self.multisampled.is_some() {
            subpass = subpass.resolve_attachments(&resolves);
        }
        let subpasses = [subpass];
        let info = vk::RenderPassCreateInfo::default()
            .attachments(&attachments)
            .subpasses(&subpasses);
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            self.pass = device.create_render_pass(&info, None)?;
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(self.pass)
                .attachments(&views)
                .width(self.options.width)
                .height(self.options.height)
                .layers(1);
            self.framebuffer = device.create_framebuffer(&info, None)?;
        }
        Ok(())
    }

    unsafe fn make_pipeline(&mut self) -> Fallible<()> {
        let device = &self.host.device;
        let words = |bytes: &[u8]| ash::util::read_spv(&mut std::io::Cursor::new(bytes));
        let codes = [
            words(include_bytes!("mesh.vert.spv"))?,
            words(include_bytes!("mesh.frag.spv"))?,
        ];
        // SAFETY: plain creations; modules are not needed once the pipeline is made.
        unsafe {
            let module = |code: &[u32]| {
                device.create_shader_module(&vk::ShaderModuleCreateInfo::default().code(code), None)
            };
            let modules = [module(&codes[0])?, module(&codes[1])?];
            let stage = |stage, module| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(stage)
                    .module(module)
                    .name(c"main")
            };
            let stages = [
                stage(vk::ShaderStageFlags::VERTEX, modules[0]),
                stage(vk::ShaderStageFlags::FRAGMENT, modules[1]),
            ];
            let bindings = [vk::VertexInputBindingDescription::default().stride(24)];
            let attribute = |n| {
                vk::VertexInputAttributeDescription::default()
                    .location(n)
                    .format(vk::Format::R32G32B32_SFLOAT)
                    .offset(12 * n)
            };
            let attributes = [attribute(0), attribute(1)];
            let input = vk::PipelineVertexInputStateCreateInfo::default()
                .vertex_binding_descriptions(&bindings)
                .vertex_attribute_descriptions(&attributes);
            let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
                .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
            let viewport = vk::PipelineViewportStateCreateInfo::default()
                .viewport_count(1)
                .scissor_count(1);
            let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
            let samples = vk::PipelineMultisampleStateCreateInfo::default()
                .rasterization_samples(vk::SampleCountFlags::from_raw(self.options.samples));
            let nearer = if self.options.reversed {
                vk::CompareOp::GREATER
            } else {
                vk::CompareOp::LESS
            };
            let depth = vk::PipelineDepthStencilStateCreateInfo::default()
                .depth_test_enable(true)
                .depth_write_enable(true)
                .depth_compare_op(nearer);
            let blends = [vk::PipelineColorBlendAttachmentState::default()
                .color_write_mask(vk::ColorComponentFlags::RGBA)];
            let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
            let states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
            let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
            let mut rendering = vk::PipelineRenderingCreateInfo::default()
                .color_attachment_formats(std::slice::from_ref(&COLOR))
                .depth_attachment_format(DEPTH);
            let mut info = vk::GraphicsPipelineCreateInfo::default()
                .stages(&stages)
                .vertex_input_state(&input)
                .input_assembly_state(&assembly)
                .viewport_state(&viewport)
                .rasterization_state(&raster)
                .multisample_state(&samples)
                .depth_stencil_state(&depth)
                .color_blend_state(&blend)
                .dynamic_state(&dynamic)
                .layout(self.layout)
                .render_pass(self.pass);
            if self.options.dynamic {
                info = info.push_next(&mut rendering);
            }
            let made = device.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None);
            self.pipeline = made.map_err(|(_, code)| code)?[0];
            for module in modules {
                device.destroy_shader_module(module, None);
            }
        }
        Ok(())
    }

    /// Draws one frame: `before` records outside of the pass, `within` after the host's meshes. Waits for the frame before the last
    /// alone.
    pub fn frame(
        &mut self,
        clip_from_world: DMat4,
        towards_light: Vec3,
        meshes: &[Mesh<'_>],
        before: impl FnOnce(vk::CommandBuffer, usize) -> Fallible<()>,
        within: impl FnOnce(vk::CommandBuffer, usize),
    ) -> Fallible<()> {
        let device = &self.host.device;
        let slot = self.next;
        self.next = (slot + 1) % FRAMES;
        let InFlight {
            commands: cmd,
            fence,
        } = self.frames[slot];
        // SAFETY: the fence tells that the commands have run; the rest is plain recording.
        unsafe {
            device.wait_for_fences(&[fence], true, u64::MAX)?;
            device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
            before(cmd, slot)?;
            self.begin_pass(cmd);
            device.cmd_bind_pipeline(cmd, vk::PipelineBindPoint::GRAPHICS, self.pipeline);
            for mesh in meshes {
                let pushed = Pushed {
                    clip_from_world: clip_from_world.as_mat4().to_cols_array_2d(),
                    offset_scale: mesh.offset_scale.to_array(),
                    color: mesh.color.extend(1.0).to_array(),
                    towards_light: towards_light.normalize().extend(0.0).to_array(),
                };
                let bytes = bytemuck::bytes_of(&pushed);
                device.cmd_push_constants(cmd, self.layout, vk::ShaderStageFlags::VERTEX, 0, bytes);
                device.cmd_bind_vertex_buffers(cmd, 0, &[mesh.vertices.raw], &[0]);
                device.cmd_draw(cmd, mesh.count, 1, 0, 0);
            }
            within(cmd, slot);
            if self.options.dynamic {
                device.cmd_end_rendering(cmd);
            } else {
                device.cmd_end_render_pass(cmd);
            }
            device.end_command_buffer(cmd)?;
            device.reset_fences(&[fence])?;
            let buffers = [cmd];
            let submits = [vk::SubmitInfo::default().command_buffers(&buffers)];
            device.queue_submit(self.host.queue, &submits, fence)?;
        }
        Ok(())
    }

    unsafe fn begin_pass(&self, cmd: vk::CommandBuffer) {
        let device = &self.host.device;
        let extent = vk::Extent2D {
            width: self.options.width,
            height: self.options.height,
        };
        let area = vk::Rect2D {
            offset: vk::Offset2D::default(),
            extent,
        };
        let color = vk::ClearValue {
            color: vk::ClearColorValue {
                float32: [0.2, 0.25, 0.3, 1.0],
            },
        };
        let far = if self.options.reversed { 0.0 } else { 1.0 };
        let depth = vk::ClearValue {
            depth_stencil: vk::ClearDepthStencilValue {
                depth: far,
                stencil: 0,
            },
        };
        // SAFETY: `cmd` is recording; the images live as long as `self`.
        unsafe {
            // The frame before is over with the images: its writes, and the copies that read them.
            self.barrier(cmd, vk::ImageLayout::UNDEFINED);
            if self.options.dynamic {
                let attachment = |view, layout, clear| {
                    vk::RenderingAttachmentInfo::default()
                        .image_view(view)
                        .image_layout(layout)
                        .load_op(vk::AttachmentLoadOp::CLEAR)
                        .store_op(vk::AttachmentStoreOp::STORE)
                        .clear_value(clear)
                };
                let layout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
                let mut drawn = attachment(self.color.view, layout, color);
                if let Some(several) = &self.multisampled {
                    drawn = attachment(several.view, layout, color)
                        .resolve_mode(vk::ResolveModeFlags::AVERAGE)
                        .resolve_image_view(self.color.view)
                        .resolve_image_layout(layout);
                }
                let colors = [drawn];
                let depths = attachment(
                    self.depth.view,
                    vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                    depth,
                );
                let info = vk::RenderingInfo::default()
                    .render_area(area)
                    .layer_count(1)
                    .color_attachments(&colors)
                    .depth_attachment(&depths);
                device.cmd_begin_rendering(cmd, &info);
            } else {
                let clears = [color, depth, color];
                let info = vk::RenderPassBeginInfo::default()
                    .render_pass(self.pass)
                    .framebuffer(self.framebuffer)
                    .render_area(area)
                    .clear_values(&clears);
                device.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE);
            }
            let viewport = vk::Viewport {
                x: 0.0,
                y: 0.0,
                width: extent.width as f32,
                height: extent.height as f32,
                min_depth: 0.0,
                max_depth: 1.0,
            };
            device.cmd_set_viewport(cmd, 0, &[viewport]);
            device.cmd_set_scissor(cmd, 0, &[area]);
        }
    }

    /// All images from what they were to attachments.
    unsafe fn barrier(&self, cmd: vk::CommandBuffer, from: vk::ImageLayout) {
        use vk::AccessFlags as A;
        use vk::PipelineStageFlags as S;
        let of = |image: &HostImage, aspect, layout, access| {
            let range = vk::ImageSubresourceRange::default()
                .aspect_mask(aspect)
                .level_count(1)
                .layer_count(1);
            vk::ImageMemoryBarrier::default()
                .image(image.raw)
                .subresource_range(range)
                .old_layout(from)
                .new_layout(layout)
                .src_access_mask(A::COLOR_ATTACHMENT_WRITE | A::DEPTH_STENCIL_ATTACHMENT_WRITE)
                .dst_access_mask(access)
        };
        let color = |image| {
            of(
                image,
                vk::ImageAspectFlags::COLOR,
                vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
                A::COLOR_ATTACHMENT_WRITE | A::COLOR_ATTACHMENT_READ,
            )
        };
        let mut barriers = vec![
            color(&self.color),
            of(
                &self.depth,
                vk::ImageAspectFlags::DEPTH,
                vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                A::DEPTH_STENCIL_ATTACHMENT_READ | A::DEPTH_STENCIL_ATTACHMENT_WRITE,
            ),
        ];
        barriers.extend(self.multisampled.as_ref().map(color));
        let tests = S::EARLY_FRAGMENT_TESTS | S::LATE_FRAGMENT_TESTS;
        let drawing = S::COLOR_ATTACHMENT_OUTPUT | tests;
        // SAFETY: `cmd` is recording, outside of a pass.
        unsafe {
            let none = vk::DependencyFlags::empty();
            self.host.device.cmd_pipeline_barrier(
                cmd,
                drawing | S::TRANSFER,
                drawing,
                none,
                &[],
                &[],
                &barriers,
            );
        }
    }

    /// Waits for all frames and reads the last: sRGB bytes; of one sample, depths, too.
    pub fn read(&self) -> Fallible<(Vec<u8>, Vec<f32>)> {
        let device = &self.host.device;
        let InFlight {
            commands: cmd,
            fence,
        } = self.frames[self.next];
        // SAFETY: all frames are waited for; the copies are waited for, too.
        unsafe {
            device.device_wait_idle()?;
            device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
            let copied = [
                (
                    &self.color,
                    vk::ImageAspectFlags::COLOR,
                    vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
                ),
                (
                    &self.depth,
                    vk::ImageAspectFlags::DEPTH,
                    vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                ),
            ];
            let count = if self.options.samples == 1 { 2 } else { 1 };
            for ((image, aspect, layout), to) in copied.into_iter().zip(&self.read).take(count) {
                let range = vk::ImageSubresourceRange::default()
                    .aspect_mask(aspect)
                    .level_count(1)
                    .layer_count(1);
                let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
                let barrier = vk::ImageMemoryBarrier::default()
                    .image(image.raw)
                    .subresource_range(range)
                    .old_layout(layout)
                    .new_layout(source)
                    .src_access_mask(vk::AccessFlags::MEMORY_WRITE)
                    .dst_access_mask(vk::AccessFlags::TRANSFER_READ);
                let (all, transfer) = (
                    vk::PipelineStageFlags::ALL_COMMANDS,
                    vk::PipelineStageFlags::TRANSFER,
                );
                let none = vk::DependencyFlags::empty();
                device.cmd_pipeline_barrier(cmd, all, transfer, none, &[], &[], &[barrier]);
                let region = vk::BufferImageCopy::default()
                    .image_subresource(
                        vk::ImageSubresourceLayers::default()
                            .aspect_mask(aspect)
                            .layer_count(1),
                    )
                    .image_extent(vk::Extent3D {
                        width: self.options.width,
                        height: self.options.height,
                        depth: 1,
                    });
                device.cmd_copy_image_to_buffer(cmd, image.raw, source, to.raw, &[region]);
            }
            let barrier = vk::MemoryBarrier::default()
                .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
                .dst_access_mask(vk::AccessFlags::HOST_READ);
            let (transfer, host) = (
                vk::PipelineStageFlags::TRANSFER,
                vk::PipelineStageFlags::HOST,
            );
            let none = vk::DependencyFlags::empty();
            device.cmd_pipeline_barrier(cmd, transfer, host, none, &[barrier], &[], &[]);
            device.end_command_buffer(cmd)?;
            device.reset_fences(&[fence])?;
            let buffers = [cmd];
            let submits = [vk::SubmitInfo::default().command_buffers(&buffers)];
            device.queue_submit(self.host.queue, &submits, fence)?;
            device.wait_for_fences(&[fence], true, u64::MAX)?;
        }
        let depths = if self.options.samples == 1 {
            bytemuck::pod_collect_to_vec(&self.read[1].bytes())
        } else {
            Vec::new()
        };
        Ok((self.read[0].bytes(), depths))
    }

    /// Waits until the device is done with all frames.
    pub fn wait(&self) -> Fallible<()> {
        // SAFETY: plain call.
        Ok(unsafe { self.host.device.device_wait_idle() }?)
    }
}

impl Drop for Stage<'_> {
    fn drop(&mut self) {
        let device = &self.host.device;
        // SAFETY: the device is waited for; null handles may be destroyed.
        unsafe {
            let _ = device.device_wait_idle();
            for frame in &self.frames {
                device.destroy_fence(frame.fence, None);
            }
            device.destroy_command_pool(self.pool, None);
            device.destroy_pipeline(self.pipeline, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_framebuffer(self.framebuffer, None);
            device.destroy_render_pass(self.pass, None);
        }
    }
}

/// A host's matrices: looking along -z from `eye` to `target`, z up in the world, clip space with Vulkan's y downwards. Reversed
/// depth reaches to infinity.
pub fn view_and_projection(eye: DVec3, target: DVec3, options: &Options) -> [DMat4; 2] {
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let up = right.cross(forward);
    let row = |axis: DVec3| axis.extend(-axis.dot(eye));
    let view = DMat4::from_cols(row(right), row(up), row(-forward), DVec4::W).transpose();
    let (near, far) = (0.1, 50.0);
    let focal = 1.0 / 20f64.to_radians().tan();
    let aspect = f64::from(options.width) / f64::from(options.height);
    let (z, w) = if options.reversed {
        (0.0, near)
    } else {
        (far / (near - far), near * far / (near - far))
    };
    let projection = DMat4::from_cols(
        DVec4::new(focal / aspect, 0.0, 0.0, 0.0),
        DVec4::new(0.0, -focal, 0.0, 0.0),
        DVec4::new(0.0, 0.0, z, -1.0),
        DVec4::new(0.0, 0.0, w, 0.0),
    );
    [view, projection]
}

/// Writes sRGB bytes as a PNG.
pub fn write_png(path: &str, options: &Options, pixels: &[u8]) -> Fallible<()> {
    let file = std::io::BufWriter::new(std::fs::File::create(path)?);
    let mut encoder = png::Encoder::new(file, options.width, options.height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(())
}
