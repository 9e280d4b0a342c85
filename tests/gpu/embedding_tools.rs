//! Tools for hosts: labels of a frame's commands, two renderers recorded on two threads.
#![allow(unsafe_code)]

use crate::common::host::{
    Attachments, Host, Stage, add, borrow_through, draw_into, once, open, opened, view_of,
};
use crate::common::prelude::*;
use crate::embedding::{options, renderer, three};
use std::ffi::{CStr, c_char};
use std::sync::Mutex;

static LABELS: Mutex<Vec<String>> = Mutex::new(Vec::new());
static NAMES: Mutex<Vec<String>> = Mutex::new(Vec::new());
static DEPTH: Mutex<i32> = Mutex::new(0);

unsafe extern "system" fn begin(_: vk::CommandBuffer, info: *const vk::DebugUtilsLabelEXT<'_>) {
    // SAFETY: the caller's label.
    let label = unsafe { CStr::from_ptr((*info).p_label_name) };
    LABELS
        .lock()
        .unwrap()
        .push(label.to_string_lossy().into_owned());
    *DEPTH.lock().unwrap() += 1;
}

unsafe extern "system" fn end(_: vk::CommandBuffer) {
    *DEPTH.lock().unwrap() -= 1;
}

unsafe extern "system" fn name(
    _: vk::Device,
    info: *const vk::DebugUtilsObjectNameInfoEXT<'_>,
) -> vk::Result {
    // SAFETY: the caller's name.
    let name = unsafe { CStr::from_ptr((*info).p_object_name) };
    NAMES
        .lock()
        .unwrap()
        .push(name.to_string_lossy().into_owned());
    vk::Result::SUCCESS
}

/// The functions of labels.
unsafe extern "system" fn device_function(
    _: vk::Device,
    wanted: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the caller's name, and functions of the signatures that it stands for.
    unsafe {
        let pointer = match CStr::from_ptr(wanted).to_str() {
            Ok("vkCmdBeginDebugUtilsLabelEXT") => begin as *const (),
            Ok("vkCmdEndDebugUtilsLabelEXT") => end as *const (),
            Ok("vkSetDebugUtilsObjectNameEXT") => name as *const (),
            _ => return None,
        };
        std::mem::transmute::<*const (), vk::PFN_vkVoidFunction>(pointer)
    }
}

/// Every step has a label that ends, and buffers have names, once a host enables it; none before.
#[test]
fn commands_have_labels_where_a_host_enables_them() {
    let host = open();
    let entry = &host.entry;
    let handle = host.instance.handle();
    let load = |wanted: &CStr| match wanted.to_bytes() {
        b"vkGetDeviceProcAddr" => device_function as *const _,
        // SAFETY: the instance is live.
        _ => unsafe { entry.get_instance_proc_addr(handle, wanted.as_ptr()) }
            .map_or(std::ptr::null(), |f| f as *const _),
    };
    // SAFETY: each function has the signature of its name.
    let instance = unsafe { ash::Instance::load_with(load, handle) };
    let device = borrow_through(&host, &instance, &host.device).unwrap();
    let (options, scene) = (options(), three());
    let view = view_of(&scene, &options);
    let mut stage = Stage::new(&host, options).unwrap();
    for enabled in [false, true] {
        if enabled {
            // SAFETY: the functions above are those of the extension.
            unsafe { device.enable_debug_labels() };
        }
        let mut made = renderer(&device, &stage);
        add(&mut made, &scene);
        host::frame(&mut stage, &mut made, &view, DMat4::IDENTITY, &[]);
        stage.wait().unwrap();
        let labels = std::mem::take(&mut *LABELS.lock().unwrap());
        let names = std::mem::take(&mut *NAMES.lock().unwrap());
        println!("{labels:?} {names:?}");
        assert_eq!(labels.is_empty(), !enabled);
        assert_eq!(names.is_empty(), !enabled);
        assert!(labels.iter().all(|label| label.starts_with("revmap ")));
        assert!(!enabled || names.iter().any(|name| name == "instances"));
        assert_eq!(*DEPTH.lock().unwrap(), 0);
    }
}

/// A secondary command buffer and the pool that only its thread uses.
struct Secondary<'a> {
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    host: &'a Host,
}

impl<'a> Secondary<'a> {
    fn new(host: &'a Host) -> Self {
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(host.family);
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            let pool = host.device.create_command_pool(&info, None).unwrap();
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .level(vk::CommandBufferLevel::SECONDARY)
                .command_buffer_count(1);
            Self {
                commands: host.device.allocate_command_buffers(&info).unwrap()[0],
                pool,
                host,
            }
        }
    }

    fn record(&self, renderer: &Renderer, frame: &PreparedFrame) {
        let colors = [host::COLOR];
        let mut pass = vk::CommandBufferInheritanceRenderingInfo::default()
            .color_attachment_formats(&colors)
            .depth_attachment_format(host::DEPTH)
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let inherited = vk::CommandBufferInheritanceInfo::default().push_next(&mut pass);
        let info = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE)
            .inheritance_info(&inherited);
        let raw = &self.host.device;
        // SAFETY: the commands are this thread's; the frame was prepared.
        unsafe {
            raw.begin_command_buffer(self.commands, &info).unwrap();
            host::attachments::set_viewport(self.host, self.commands, &options());
            renderer.record(self.commands, frame).unwrap();
            raw.end_command_buffer(self.commands).unwrap();
        }
    }
}

impl Drop for Secondary<'_> {
    fn drop(&mut self) {
        // SAFETY: the commands have run.
        unsafe { self.host.device.destroy_command_pool(self.pool, None) };
    }
}

/// Two renderers of one device, each recorded on a thread of its own into secondary commands, draw
/// what one renderer of all objects draws.
#[test]
fn two_threads_record_two_renderers() {
    let (host, device) = opened();
    let (options, scene) = (options(), three());
    let view = view_of(&scene, &options);
    let mut parts = [scene.clone(), scene.clone()];
    parts[0].objects.truncate(1);
    parts[1].objects.remove(0);
    let made = |scene: &Scene| {
        let output = Output::Pass(host::color_pass());
        host::renderer_of(&device, output, &SearchSettings::exact(), 1, scene)
    };
    let clears = [vk::ClearColorValue { float32: [0.0; 4] }];
    let into = || Attachments::new(&host, options, &[(host::COLOR, 4)]).unwrap();
    let (wanted, mut alone) = (into(), made(&scene));
    draw_into(&host, &wanted, &clears, &mut alone, &view, None);
    let (found, mut both) = (into(), parts.each_ref().map(made));
    let secondary = [Secondary::new(&host), Secondary::new(&host)];
    once(&host, |cmd| {
        // SAFETY: `cmd` is recording outside of a pass; each renderer records into commands of its own.
        unsafe {
            let frames = both.each_mut().map(|r| r.prepare(cmd, 0, &view).unwrap());
            std::thread::scope(|scope| {
                for ((renderer, frame), into) in both.iter().zip(&frames).zip(&secondary) {
                    scope.spawn(|| into.record(renderer, frame));
                }
            });
            let commands = secondary.each_ref().map(|s| s.commands);
            let execute = || host.device.cmd_execute_commands(cmd, &commands);
            found.draw(cmd, &clears, true, execute);
            found.copy(cmd);
        }
    });
    assert!(found.color(0).iter().any(|byte| *byte != 0));
    assert!(found.color(0) == wanted.color(0) && found.depths() == wanted.depths());
}
