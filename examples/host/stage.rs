//! A picture that is drawn with two frames in flight.

use super::mesh::{Mesh, MeshPipeline, MeshShaders};
use super::{Attachments, COLOR, Commands, FRAMES, Fallible, Host, Options};
use ash::vk;
use glam::{DMat4, Vec3};

/// The commands of a frame in flight, and what tells that they have run.
type InFlight = (vk::CommandBuffer, vk::Fence);

/// The colour behind everything, linear.
const BACKGROUND: vk::ClearColorValue = vk::ClearColorValue {
    float32: [0.2, 0.25, 0.3, 1.0],
};

/// The images of a frame, the meshes' pipeline, and commands for the frames in flight.
pub struct Stage<'a> {
    pub options: Options,
    pub into: Attachments<'a>,
    pub meshes: MeshPipeline<'a>,
    commands: Commands<'a>,
    frames: Vec<InFlight>,
    next: usize,
    host: &'a Host,
}

impl<'a> Stage<'a> {
    pub fn new(host: &'a Host, options: Options) -> Fallible<Self> {
        Self::with_shaders(host, options, &MeshShaders::default())
    }

    pub fn with_shaders(
        host: &'a Host,
        options: Options,
        shaders: &MeshShaders<'_>,
    ) -> Fallible<Self> {
        let device = &host.device;
        let into = Attachments::new(host, options, &[COLOR])?;
        // SAFETY: plain creations, destroyed in Drop.
        unsafe {
            let commands = Commands::new(host, vk::CommandBufferLevel::PRIMARY, FRAMES)?;
            let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
            let mut frames = Vec::new();
            for cmd in &commands.raw {
                frames.push((*cmd, device.create_fence(&signaled, None)?));
            }
            Ok(Self {
                meshes: MeshPipeline::new(host, shaders, &options, into.pass, &[COLOR])?,
                options,
                into,
                commands,
                frames,
                next: 0,
                host,
            })
        }
    }

    /// Draws one frame: `before` records outside of the pass, `within` after the host's meshes, with
    /// what `before` returned. Waits only for the frame before the last.
    pub fn frame<T>(
        &mut self,
        clip_from_world: DMat4,
        towards_light: Vec3,
        meshes: &[Mesh<'_>],
        before: impl FnOnce(vk::CommandBuffer, usize) -> Fallible<T>,
        within: impl FnOnce(vk::CommandBuffer, &T) -> Fallible<()>,
    ) -> Fallible<()> {
        let device = &self.host.device;
        let slot = self.next;
        self.next = (slot + 1) % FRAMES;
        let (cmd, fence) = self.frames[slot];
        // SAFETY: the fence tells that the commands have run; the rest is plain recording.
        unsafe {
            device.wait_for_fences(&[fence], true, u64::MAX)?;
            device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
            let prepared = before(cmd, slot)?;
            self.into.draw(cmd, &[BACKGROUND], false, || {
                self.meshes
                    .draw(cmd, clip_from_world, towards_light, meshes);
                within(cmd, &prepared)
            })?;
            self.submit((cmd, fence))
        }
    }

    /// Ends commands and submits them.
    unsafe fn submit(&self, (cmd, fence): InFlight) -> Fallible<()> {
        let device = &self.host.device;
        let buffers = [cmd];
        let submits = [vk::SubmitInfo::default().command_buffers(&buffers)];
        // SAFETY: the commands are recording, outside of a pass.
        unsafe {
            device.end_command_buffer(cmd)?;
            device.reset_fences(&[fence])?;
            device.queue_submit(self.host.queue, &submits, fence)?;
        }
        Ok(())
    }

    /// Waits for all frames and reads the last: sRGB bytes, and depths of one sample.
    pub fn read(&self) -> Fallible<(Vec<u8>, Vec<f32>)> {
        let (cmd, fence) = self.frames[self.next];
        self.wait()?;
        let device = &self.host.device;
        // SAFETY: all frames are waited for; the copies are waited for, too.
        unsafe {
            device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
            self.into.copy(cmd);
            self.submit((cmd, fence))?;
        }
        self.wait()?;
        Ok((
            self.into.colors().next().unwrap_or_default(),
            self.into.depths(),
        ))
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
        // SAFETY: the device is waited for.
        unsafe {
            let _ = device.device_wait_idle();
            for (_, fence) in &self.frames {
                device.destroy_fence(*fence, None);
            }
        }
    }
}
