//! A picture that is drawn with two frames in flight.

use super::mesh::{Mesh, MeshPipeline, MeshShaders};
use super::{Attachments, COLOR, Commands, FRAMES, Fallible, Host, Options, commands};
use ash::vk;
use glam::{DMat4, Vec3};

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
    /// The fence of each frame in flight tells that its commands have run.
    fences: Vec<vk::Fence>,
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
            let fences = (0..FRAMES).map(|_| device.create_fence(&signaled, None));
            let fences = fences.collect::<Result<_, _>>()?;
            Ok(Self {
                meshes: MeshPipeline::new(host, shaders, &options, into.pass, &[COLOR])?,
                options,
                into,
                commands,
                fences,
                next: 0,
                host,
            })
        }
    }

    /// Begins a frame: its commands, which are recording outside of the pass, and its slot. Waits
    /// only for the frame before the last.
    pub fn begin(&mut self) -> Fallible<(vk::CommandBuffer, usize)> {
        let device = &self.host.device;
        let slot = self.next;
        self.next = (slot + 1) % FRAMES;
        let (cmd, fence) = (self.commands.raw[slot], self.fences[slot]);
        // SAFETY: the fence tells that the commands have run.
        unsafe {
            device.wait_for_fences(&[fence], true, u64::MAX)?;
            device.begin_command_buffer(cmd, &vk::CommandBufferBeginInfo::default())?;
        }
        Ok((cmd, slot))
    }

    /// Draws the frame of a slot that was begun, and submits it: meshes, then what `within` records
    /// in the pass.
    pub fn draw(
        &self,
        slot: usize,
        (clip_from_world, towards_light): (DMat4, Vec3),
        meshes: &[Mesh<'_>],
        within: impl FnOnce() -> Fallible<()>,
    ) -> Fallible<()> {
        let device = &self.host.device;
        let (cmd, fence) = (self.commands.raw[slot], self.fences[slot]);
        let buffers = [cmd];
        let submits = [vk::SubmitInfo::default().command_buffers(&buffers)];
        // SAFETY: the commands are recording; the attachments live until they have run.
        unsafe {
            self.into.draw(cmd, &[BACKGROUND], false, || {
                self.meshes
                    .draw(cmd, clip_from_world, towards_light, meshes);
                within()
            })?;
            device.end_command_buffer(cmd)?;
            device.reset_fences(&[fence])?;
            device.queue_submit(self.host.queue, &submits, fence)?;
        }
        Ok(())
    }

    /// Waits for all frames and reads the last: sRGB bytes, and depths of one sample.
    pub fn read(&self) -> Fallible<(Vec<u8>, Vec<f32>)> {
        self.wait()?;
        // SAFETY: all frames are waited for, and so are the copies.
        commands(self.host, true, |cmd| unsafe { self.into.copy(cmd) })?;
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
            for fence in &self.fences {
                device.destroy_fence(*fence, None);
            }
        }
    }
}
