//! The default search in another's pass, as a host draws it.

use super::{MeshPipelines, SAMPLES};
use crate::method::MethodSettings;
use ash::vk;
use revmap::error::Result;
use revmap::gpu::{
    DepthOrder, Guest, Offscreen, Output, PassFormats, PassKind, PreparedFrame, Renderer, View,
};
use revmap::scene::Scene;
use revmap::settings::{SearchSettings, Settings};
use std::cell::RefCell;

/// A renderer in a multisampled pass.
pub(in super::super) struct SearchGuest {
    renderer: RefCell<Renderer>,
    view: View,
    /// The last frame, or why it was not prepared.
    prepared: RefCell<Option<Result<PreparedFrame>>>,
}

impl SearchGuest {
    pub fn new(
        pipelines: &MeshPipelines,
        pass: vk::RenderPass,
        scene: &Scene,
        settings: &MethodSettings,
    ) -> Result<Self> {
        let settings = Settings::from(settings);
        let output = Output::Pass(PassFormats {
            begun: PassKind::RenderPass { pass, subpass: 0 },
            samples: SAMPLES.as_raw(),
            depth: DepthOrder::Normal,
            planes: settings.planes,
        });
        let device = pipelines.device();
        let mut renderer = Renderer::new(device, output, &SearchSettings::from(&settings), 1)?;
        renderer.set_lighting(&scene.lighting())?;
        for object in &scene.objects {
            renderer.add(object.clone())?;
        }
        Ok(Self {
            renderer: RefCell::new(renderer),
            view: *Offscreen::for_guests(device, scene, &settings)?.view(),
            prepared: RefCell::default(),
        })
    }

    /// Fails where the last frame could not be drawn.
    pub fn take_error(&self) -> Result<()> {
        self.prepared.take().map_or(Ok(()), |last| last.map(|_| ()))
    }
}

impl Guest for SearchGuest {
    unsafe fn prepare(&self, cmd: vk::CommandBuffer) {
        // SAFETY: `cmd` is recording outside of a pass, and the last frame was waited for.
        let prepared = unsafe { self.renderer.borrow_mut().prepare(cmd, 0, &self.view) };
        *self.prepared.borrow_mut() = Some(prepared);
    }

    unsafe fn record(&self, cmd: vk::CommandBuffer) {
        let mut prepared = self.prepared.borrow_mut();
        if let Some(Ok(frame)) = prepared.as_ref() {
            // SAFETY: the frame was prepared; the caller has begun the pass.
            if let Err(error) = unsafe { self.renderer.borrow().record(cmd, frame) } {
                *prepared = Some(Err(error));
            }
        }
    }
}
