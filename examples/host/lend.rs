//! The part of a host that knows revmap: opens a device that it can use, lends the device, describes
//! passes and views to it, records its frames.

use super::{DEPTH, Fallible, Host, Mesh, Options, Stage};
use ash::vk;
use glam::{DMat4, Vec3};
use revmap::gpu::{
    DepthOrder, Device, HostDevice, HostShading, Output, PassFormats, PassKind, Renderer,
    Requirements, VALIDATION_VARIABLE, View, Viewport,
};
use revmap::settings::{Planes, SearchSettings};
use revmap::shading::Shading;
use std::sync::Arc;

/// The arguments of an example: the folder of its pictures, `out` by default, and whether the
/// environment switches validation on.
pub fn arguments() -> (String, bool) {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "out".to_owned());
    let validate = std::env::var_os(VALIDATION_VARIABLE).is_some();
    (folder, validate)
}

/// Makes the folder, and opens a device that has what revmap requires.
pub fn open(folder: &str, validate: bool) -> Fallible<Host> {
    std::fs::create_dir_all(folder)?;
    Host::open(validate, |instance, physical| {
        // SAFETY: both are live.
        let needs = unsafe { Requirements::of(instance, physical) }?;
        Ok((needs.queue_family, needs.features))
    })
}

/// A host's own handles, opened with its features. Renderers need no queue.
pub fn lent(host: &Host) -> HostDevice<'_> {
    HostDevice {
        instance: &host.instance,
        physical: host.physical,
        device: &host.device,
        queue_family: host.family,
        queue: None,
        features: host.features,
        allocator: None,
        pipeline_cache: None,
    }
}

/// Lends the device of a host, and prints its name.
///
/// # Safety
/// The host outlives the device.
pub unsafe fn lend(host: &Host) -> Fallible<Device> {
    // SAFETY: as the caller promised.
    let device = unsafe { Device::borrow(&lent(host)) }?;
    println!("{}", device.report().name);
    Ok(device)
}

/// A pass by dynamic rendering, of these colours and a depth.
pub fn dynamic(color: &[vk::Format]) -> PassKind {
    PassKind::Dynamic {
        color: color.to_vec(),
        depth: DEPTH,
        stencil: vk::Format::UNDEFINED,
    }
}

/// A pass by dynamic rendering into such pictures.
pub fn pass(options: &Options, color: &[vk::Format], planes: Planes) -> Output {
    Output::Pass(PassFormats {
        depth: order(options),
        ..PassFormats::new(dynamic(color), planes)
    })
}

pub fn order(options: &Options) -> DepthOrder {
    match options.reversed {
        true => DepthOrder::Reversed,
        false => DepthOrder::Normal,
    }
}

pub fn viewport(options: &Options) -> Viewport {
    Viewport {
        x: 0.0,
        y: 0.0,
        width: f64::from(options.width),
        height: f64::from(options.height),
    }
}

/// The view of a whole picture by a host's matrices.
pub fn view([view, projection]: [DMat4; 2], options: &Options) -> revmap::Result<View> {
    View::from_matrices(view, projection, viewport(options), order(options))
}

/// A renderer that shades by a host's function, with a layout of the host's set.
///
/// # Safety
/// The layout has the bindings that the function reads, and outlives the renderer.
pub unsafe fn shaded(
    device: &Device,
    output: Output,
    search: &SearchSettings,
    slots: usize,
    shading: &Arc<Shading>,
    set_layout: vk::DescriptorSetLayout,
) -> revmap::Result<Renderer> {
    let host = HostShading {
        shading: shading.clone(),
        set_layout,
    };
    // SAFETY: as the caller promised.
    unsafe { Renderer::with_shading(device, output, search, slots, &host) }
}

/// Draws meshes, then solids.
pub fn frame(
    stage: &mut Stage,
    renderer: &mut Renderer,
    view: &View,
    lit: (DMat4, Vec3),
    meshes: &[Mesh],
) -> Fallible<()> {
    let (cmd, slot) = stage.begin()?;
    // SAFETY: the stage has waited for the slot's last frame; `cmd` is recording outside of its pass.
    let frame = unsafe { renderer.prepare(cmd, slot, view) }?;
    // SAFETY: the frame was prepared, and the pass is of the output's formats.
    let solids = || Ok(unsafe { renderer.record(cmd, &frame) }?);
    stage.draw(slot, lit, meshes, solids)
}

/// Fails with the first message of the validation layers.
pub fn check(host: &Host) -> Fallible<()> {
    match host.take_messages().first() {
        Some(message) => Err(message.clone().into()),
        None => Ok(()),
    }
}
