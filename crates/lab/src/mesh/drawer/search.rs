//! The default search in another's pass, as a host draws it.

use super::{MeshPipelines, SAMPLES};
use crate::method::MethodSettings;
use ash::vk;
use revmap::error::{Error, Result};
use revmap::gpu::{DepthOrder, Guest, Offscreen, Output, PassFormats, PassKind, Renderer, View};
use revmap::scene::Scene;
use revmap::settings::{SearchSettings, Settings};
use std::cell::RefCell;

/// A renderer in a multisampled pass.
pub(in super::super) struct SearchGuest {
    renderer: RefCell<Renderer>,
    view: View,
    /// Why the last frame was not prepared.
    failed: RefCell<Option<Error>>,
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
            failed: RefCell::default(),
        })
    }

    /// What hindered the last frame.
    pub fn take_error(&self) -> Result<()> {
        self.failed.take().map_or(Ok(()), Err)
    }
}

impl Guest for SearchGuest {
    unsafe fn prepare(&self, cmd: vk::CommandBuffer) {
        // SAFETY: `cmd` is recording outside of a pass, and the last frame was waited for.
        let prepared = unsafe { self.renderer.borrow_mut().prepare(cmd, 0, &self.view) };
        *self.failed.borrow_mut() = prepared.err();
    }

    unsafe fn record(&self, cmd: vk::CommandBuffer) {
        if self.failed.borrow().is_none() {
            // SAFETY: the frame was prepared; the caller has begun the pass.
            unsafe { self.renderer.borrow().record(cmd, 0) };
        }
    }
}
