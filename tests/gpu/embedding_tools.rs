//! Tools for hosts: labels of a frame's commands, two renderers recorded on two threads.
#![allow(unsafe_code)]

use crate::calls::{above, planted_instance};
use crate::common::host::{
    self, Attachments, Commands, Drawn, Host, borrow_through, once, open, opened, view_of,
};
use crate::common::prelude::*;
use crate::embedding::{drawn, options, three};
use std::ffi::{CStr, c_char};
use std::sync::Mutex;

/// Labels that began, and names.
static TEXTS: Mutex<[Vec<String>; 2]> = Mutex::new([Vec::new(), Vec::new()]);
static DEPTH: Mutex<i32> = Mutex::new(0);

fn keep(kind: usize, text: &CStr) {
    TEXTS.lock().unwrap()[kind].push(text.to_string_lossy().into_owned());
}

above! { labels;
    "vkCmdBeginDebugUtilsLabelEXT" begin: PFN_vkCmdBeginDebugUtilsLabelEXT(
        _cmd: vk::CommandBuffer, info: *const vk::DebugUtilsLabelEXT<'_>
    ), |_real| {
        keep(0, CStr::from_ptr((*info).p_label_name));
        *DEPTH.lock().unwrap() += 1;
    }
    "vkCmdEndDebugUtilsLabelEXT" end: PFN_vkCmdEndDebugUtilsLabelEXT(
        _cmd: vk::CommandBuffer
    ), |_real| {
        *DEPTH.lock().unwrap() -= 1;
    }
    "vkSetDebugUtilsObjectNameEXT" name: PFN_vkSetDebugUtilsObjectNameEXT(
        _device: vk::Device, info: *const vk::DebugUtilsObjectNameInfoEXT<'_>
    ) -> vk::Result, |_real| {
        keep(1, CStr::from_ptr((*info).p_object_name));
        vk::Result::SUCCESS
    }
}

above! { queries;
    "vkGetDeviceProcAddr" function: PFN_vkGetDeviceProcAddr(
        device: vk::Device, wanted: *const c_char
    ) -> vk::PFN_vkVoidFunction, |real| {
        let own = real(device, wanted);
        let planted = labels(CStr::from_ptr(wanted), own.map_or(0, |f| f as usize));
        planted.map_or(own, |f| std::mem::transmute(f))
    }
}

/// Every step has a label that ends, and buffers have names, once a host enables it; none before.
#[test]
fn commands_have_labels_where_a_host_enables_them() {
    let host = open();
    let instance = planted_instance(&host.entry, &host.instance, queries);
    let device = borrow_through(&host, &instance, &host.device).unwrap();
    let (options, scene) = (options(), three());
    let by = (Output::Pass(host::color_pass()), &SearchSettings::exact());
    for enabled in [false, true] {
        if enabled {
            // SAFETY: the functions above are those of the extension.
            unsafe { device.enable_debug_labels() };
        }
        Drawn::new(&host, &device, options, by.clone(), &scene).picture();
        let [labels, names] = std::mem::take(&mut *TEXTS.lock().unwrap());
        println!("{labels:?} {names:?}");
        assert_eq!(labels.is_empty(), !enabled);
        assert_eq!(names.is_empty(), !enabled);
        assert!(labels.iter().all(|label| label.starts_with("revmap ")));
        assert!(!enabled || names.iter().any(|name| name == "instances"));
        assert_eq!(*DEPTH.lock().unwrap(), 0);
    }
}

/// Records a frame into secondary commands, whose pool only this thread uses.
fn record(host: &Host, cmd: vk::CommandBuffer, renderer: &Renderer, frame: &PreparedFrame) {
    let colors = [host::COLOR];
    let mut pass = vk::CommandBufferInheritanceRenderingInfo::default()
        .color_attachment_formats(&colors)
        .depth_attachment_format(host::DEPTH)
        .rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let inherited = vk::CommandBufferInheritanceInfo::default().push_next(&mut pass);
    let info = vk::CommandBufferBeginInfo::default()
        .flags(vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE)
        .inheritance_info(&inherited);
    // SAFETY: the commands are this thread's; the frame was prepared.
    unsafe {
        host.device.begin_command_buffer(cmd, &info).unwrap();
        host::attachments::set_viewport(host, cmd, &options());
        renderer.record(cmd, frame).unwrap();
        host.device.end_command_buffer(cmd).unwrap();
    }
}

/// Two renderers of one device, each recorded on a thread of its own into secondary commands, draw
/// what one renderer of all objects draws.
#[test]
fn two_threads_record_two_renderers() {
    let (host, device) = opened();
    let (options, scene) = (options(), three());
    let view = view_of(&scene, &options);
    let wanted = drawn(&host, &device, options, &scene, &view);
    let found = Attachments::new(&host, options, &[host::COLOR]).unwrap();
    let mut parts = [scene.clone(), scene];
    parts[0].objects.truncate(1);
    parts[1].objects.remove(0);
    let mut both = parts.each_ref().map(|scene| {
        let output = Output::Pass(host::color_pass());
        host::renderer_of(&device, output, &SearchSettings::exact(), 1, scene)
    });
    let level = vk::CommandBufferLevel::SECONDARY;
    let secondary = [(); 2].map(|()| Commands::new(&host, level, 1).unwrap());
    once(&host, |cmd| {
        // SAFETY: `cmd` is recording outside of a pass; each renderer records into commands of its own.
        unsafe {
            let frames = both.each_mut().map(|r| r.prepare(cmd, 0, &view).unwrap());
            std::thread::scope(|scope| {
                for ((renderer, frame), own) in both.iter().zip(&frames).zip(&secondary) {
                    let (host, cmd): (&Host, _) = (&host, own.raw[0]);
                    scope.spawn(move || record(host, cmd, renderer, frame));
                }
            });
            let commands = secondary.each_ref().map(|own| own.raw[0]);
            let execute = || host.device.cmd_execute_commands(cmd, &commands);
            found.draw(cmd, &found.clears(), true, execute);
            found.copy(cmd);
        }
    });
    assert!(wanted.0.iter().any(|byte| *byte != 0));
    assert!(found.colors().next() == Some(wanted.0) && found.depths() == wanted.1);
}
