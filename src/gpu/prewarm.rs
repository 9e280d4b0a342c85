//! Pipelines compiled before they are needed.

use super::device::Shared;
use super::entry::Entry;
use super::hulls;
use super::output::Output;
use super::refresh::FALLBACK;
use super::renderer::Renderer;
use crate::error::Result;
use crate::settings::Solver;
use crate::shader::{Kind, Variant};
use ash::vk;
use std::sync::Arc;

/// Pipelines that a renderer may come to need. It may be sent to another thread, and compiled there
/// while the renderer draws.
pub struct Prewarm {
    wanted: Vec<(Variant, Kind)>,
    output: Output,
    owner: u64,
    device: Arc<Shared>,
}

impl Prewarm {
    /// How many pipelines they are, compiled or not.
    #[must_use]
    pub fn len(&self) -> usize {
        self.wanted.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.wanted.is_empty()
    }

    /// Compiles those that are not compiled yet. The renderer must live until this returns.
    ///
    /// # Errors
    /// [`Stage::Draw`](crate::error::Stage::Draw) of Vulkan.
    pub fn compile(&self) -> Result<()> {
        let pipelines = self.device.pipelines()?;
        for &(variant, kind) in &self.wanted {
            pipelines.get(variant, kind, &self.output, self.owner)?;
        }
        Ok(())
    }
}

impl Renderer {
    /// Every pipeline that the objects can reach while parameters, lights, placements and the view
    /// change. What makes others necessary is another technique: textures where there were none,
    /// replicas, shadows, a box that cuts; in compute also more objects or copies than one.
    ///
    /// # Errors
    /// As [`Renderer::prepare`], of what was added and set.
    pub fn prewarm(&mut self) -> Result<Prewarm> {
        let view = self.view;
        self.refresh(view.as_ref())?;
        let mut wanted = Vec::new();
        for entry in self.ordered() {
            self.reachable(entry, &mut wanted);
        }
        Ok(Prewarm {
            wanted,
            output: self.output.clone(),
            owner: self.owner,
            device: self.device.clone(),
        })
    }

    /// Records draws of no pixel, or dispatches of no group, with every pipeline of
    /// [`Renderer::prewarm`]. Some drivers, all software drivers among them, compile shaders at the
    /// first draw; they do it when these commands run.
    ///
    /// # Errors
    /// As [`Prewarm::compile`], for pipelines that it has not compiled.
    ///
    /// # Safety
    /// This call does what [`Renderer::record`] does in a pass, and [`Renderer::record_compute`]
    /// outside; in a pass it sets the scissor, too, to nothing.
    ///
    /// The caller must see to what the same function asks for.
    pub unsafe fn record_prewarm(&self, cmd: vk::CommandBuffer, slot: usize) -> Result<()> {
        let Some(slot) = self.frames.get(slot) else {
            return Ok(());
        };
        let pipelines = self.device.pipelines()?;
        let raw = &self.device.raw;
        if self.draws_hulls() {
            // SAFETY: `cmd` is recording, and the scissor is dynamic.
            unsafe { raw.cmd_set_scissor(cmd, 0, &[vk::Rect2D::default()]) };
        }
        let mut wanted = Vec::new();
        for (&number, entry) in self.order.iter().zip(self.ordered()) {
            wanted.clear();
            self.reachable(entry, &mut wanted);
            for &(variant, kind) in &wanted {
                let pipeline = pipelines.get(variant, kind, &self.output, self.owner)?;
                self.bind(cmd, slot, entry, pipeline, number);
                if self.draws_hulls() {
                    // SAFETY: `cmd` is recording within a pass; all that is bound lives as long as
                    // the caller promised.
                    unsafe { raw.cmd_draw(cmd, 3, 1, 0, entry.instances.start) };
                } else {
                    self.dispatch(cmd, [0; 4], [0, 0]);
                    self.wait_for_writes(cmd);
                }
            }
        }
        Ok(())
    }

    fn reachable(&self, entry: &Entry, all: &mut Vec<(Variant, Kind)>) {
        let object = entry.drawn();
        let surface = entry.prepared.as_ref().and_then(|p| p.surface.as_deref());
        let (settings, solver) = (&self.settings, self.settings.solver);
        let planes = self.output.planes();
        let of = |solver| Variant::new(settings, planes, solver, &self.lighting, object, self.met);
        let fallback = matches!(solver, Solver::Quadric | Solver::Hull).then(|| of(FALLBACK));
        let wraps = settings.proxy_min_pixels != u32::MAX && object.repeat == [1; 3];
        let several = self.order.len() > 1;
        let copies = object.placements().len() > 1;
        let compute = (!self.draws_hulls()).then_some(several);
        // An offset may move the size of tables across the limit.
        let own = surface.map_or(0, |s| s.tables().own);
        let limit = self.device.constants.own_vectors as usize;
        let fits = [own <= limit + limit / 2, own > limit - limit / 4];
        let clips = self.device.clips || !self.draws_hulls();
        let may_be_cut = clips && hulls::may_be_cut(object);
        let reachable = of(solver).reachable(solver, wraps, copies, compute, fallback);
        let drawn = |(v, kind): &(Variant, Kind)| may_be_cut || !v.is_cut(*kind);
        for (variant, kind) in reachable.into_iter().filter(drawn) {
            for (fit, _) in [true, false].into_iter().zip(fits).filter(|(_, may)| *may) {
                let keeps = self.keeps_depths && matches!(kind, Kind::Compute | Kind::Listed);
                let variant = variant.keeping(keeps).with_tables_of(kind, fit);
                let new = variant.filter(|v| !all.contains(&(*v, kind)));
                all.extend(new.map(|v| (v, kind)));
            }
        }
    }
}
