//! What a host's frame is drawn into and read from, and renderers with it.

use super::*;

/// Attachments of a pass, or words of compute.
pub enum Canvas<'a> {
    Pass(Box<Attachments<'a>>),
    /// Two words a pixel: depths, then colours.
    Words(HostBuffer<'a>),
}

/// Bytes of the first colour, if there is one, and depths; of compute, all colours and depths.
pub type Picture = (Vec<u8>, Vec<f32>);

impl<'a> Canvas<'a> {
    /// For an output in compute, or by dynamic rendering into pictures of this size.
    pub fn new(host: &'a Host, options: Options, output: &Output) -> Self {
        let formats = match output {
            Output::Compute(_) => return Self::words(host, options),
            Output::Pass(formats) => formats,
        };
        let PassKind::Dynamic { color, .. } = &formats.begun else {
            unreachable!("{formats:?}");
        };
        let options = Options {
            reversed: formats.depth == DepthOrder::Reversed,
            samples: formats.samples,
            ..options
        };
        Self::pass(host, options, color)
    }

    pub fn pass(host: &'a Host, options: Options, colors: &[vk::Format]) -> Self {
        Self::Pass(Box::new(Attachments::new(host, options, colors).unwrap()))
    }

    pub fn words(host: &'a Host, options: Options) -> Self {
        let bytes = 8 * (options.width * options.height) as usize;
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        Self::Words(HostBuffer::new(host, bytes, usage).unwrap())
    }

    /// Makes the words the target of a renderer in compute, whose depths count or not.
    pub fn lend(&self, renderer: &mut Renderer, depths: bool) {
        if let Self::Words(words) = self {
            let target = ComputeTarget {
                words: words.raw,
                images: Vec::new(),
                depths,
            };
            // SAFETY: the buffer has two words per pixel, and outlives the renderer's frames.
            unsafe { renderer.set_compute_target(target) }.unwrap();
        }
    }

    /// Clears everything, and records draws or dispatches: identities to the largest number, depths
    /// to the far end, the rest to 0.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass, and has run before the canvas is dropped.
    pub unsafe fn record<T>(&self, cmd: vk::CommandBuffer, draws: impl FnOnce() -> T) -> T {
        // SAFETY: as the caller promised.
        unsafe {
            match self {
                Self::Pass(into) => into.draw(cmd, &into.clears(), false, draws),
                Self::Words(words) => {
                    let host = words.host;
                    let half = words.size as u64 / 2;
                    barrier(host, cmd, &[]);
                    let device = &host.device;
                    device.cmd_fill_buffer(cmd, words.raw, 0, half, 1f32.to_bits());
                    device.cmd_fill_buffer(cmd, words.raw, half, half, 0);
                    barrier(host, cmd, &[]);
                    let drawn = draws();
                    barrier(host, cmd, &[]);
                    drawn
                }
            }
        }
    }

    /// Draws a frame, waits for it and reads it: `prepare` records outside of the pass, `record`
    /// within.
    pub fn draw<T>(
        &self,
        host: &Host,
        prepare: impl FnOnce(vk::CommandBuffer) -> T,
        record: impl FnOnce(vk::CommandBuffer, T),
    ) -> Picture {
        once(host, |cmd| {
            let prepared = prepare(cmd);
            // SAFETY: `cmd` is recording.
            unsafe {
                self.record(cmd, || record(cmd, prepared));
                self.copy(cmd);
            }
        });
        self.read()
    }

    /// Records copies to the host.
    ///
    /// # Safety
    /// Same as for [`Canvas::record`].
    pub unsafe fn copy(&self, cmd: vk::CommandBuffer) {
        if let Self::Pass(into) = self {
            // SAFETY: as the caller promised.
            unsafe { into.copy(cmd) };
        }
    }

    /// What was copied.
    pub fn read(&self) -> Picture {
        match self {
            Self::Pass(into) => {
                let color = into.colors().next();
                (color.unwrap_or_default(), into.depths())
            }
            Self::Words(words) => {
                let bytes = words.bytes();
                let (depths, colors) = bytes.split_at(bytes.len() / 2);
                (colors.to_vec(), bytemuck::pod_collect_to_vec(depths))
            }
        }
    }

    /// The bytes of each colour, and of the depths.
    pub fn planes(&self) -> Vec<Vec<u8>> {
        match self {
            Self::Pass(into) => {
                let depths = into.depths();
                let depths = (!depths.is_empty()).then(|| bytemuck::pod_collect_to_vec(&depths));
                into.colors().chain(depths).collect()
            }
            Self::Words(words) => vec![words.bytes()],
        }
    }
}

/// A renderer of a scene, with what it draws into.
pub struct Drawn<'a> {
    pub renderer: Renderer,
    pub ids: Vec<ObjectId>,
    pub view: View,
    pub canvas: Canvas<'a>,
    pub host: &'a Host,
}

impl<'a> Drawn<'a> {
    /// A renderer of two slots, seen by the scene's camera.
    pub fn new(
        host: &'a Host,
        device: &Device,
        options: Options,
        (output, search): (Output, &SearchSettings),
        scene: &Scene,
    ) -> Self {
        let renderer = Renderer::new(device, output.clone(), search, 2).unwrap();
        Self::by(host, renderer, options, &output, scene)
    }

    /// The same by a renderer without objects.
    pub fn by(
        host: &'a Host,
        mut renderer: Renderer,
        options: Options,
        output: &Output,
        scene: &Scene,
    ) -> Self {
        let canvas = Canvas::new(host, options, output);
        canvas.lend(&mut renderer, true);
        Self {
            ids: add(&mut renderer, scene),
            view: view_of(scene, &options),
            renderer,
            canvas,
            host,
        }
    }

    /// The same from another view.
    pub fn seen(mut self, view: &View) -> Self {
        self.view = *view;
        self
    }

    /// Prepares a frame in a slot, and records it as often as `times` says, with the set of the
    /// host's shading.
    pub fn record(
        &mut self,
        cmd: vk::CommandBuffer,
        (slot, times): (usize, usize),
        set: Option<&UniformSet>,
    ) -> revmap::Result<PreparedFrame> {
        // SAFETY: `cmd` is recording outside of a pass, and no frame is in flight.
        let frame = unsafe { self.renderer.prepare(cmd, slot, &self.view) }?;
        let renderer = &self.renderer;
        for _ in 0..times {
            // SAFETY: as above; the canvas has the output's formats, and the layout has the set.
            unsafe {
                let draws = || {
                    let compute = matches!(self.canvas, Canvas::Words(..));
                    let point = match compute {
                        true => vk::PipelineBindPoint::COMPUTE,
                        false => vk::PipelineBindPoint::GRAPHICS,
                    };
                    if let Some(set) = set {
                        set.bind(cmd, point, renderer.pipeline_layout()?, 3);
                    }
                    match compute {
                        true => renderer.record_compute(cmd, &frame),
                        false => renderer.record(cmd, &frame),
                    }
                };
                self.canvas.record(cmd, draws)?;
                self.canvas.copy(cmd);
            }
        }
        Ok(frame)
    }

    /// The next frame, in the first slot.
    pub fn picture(&mut self) -> Picture {
        self.picture_by(None)
    }

    /// The same with the set of the host's shading.
    pub fn picture_by(&mut self, set: Option<&UniformSet>) -> Picture {
        let host = self.host;
        once(host, |cmd| self.record(cmd, (0, 1), set).map(drop)).unwrap();
        self.canvas.read()
    }
}
