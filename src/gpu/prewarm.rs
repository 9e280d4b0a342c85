//! Pipelines compiled before they are needed.

use super::device::Shared;
use super::output::Output;
use super::refresh::FALLBACK;
use super::renderer::Renderer;
use super::surface::OffsetSurface;
use crate::error::Result;
use crate::scene::Object;
use crate::settings::Solver;
use crate::shader::generated::PIECE_VECTORS;
use crate::shader::{Kind, Variant};
use std::sync::Arc;

/// Pipelines that a renderer may come to need. It may be sent to another thread, and compiled there while the renderer draws.
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
    /// Every pipeline that the objects can reach while parameters, lights, placements and the view change. What makes others
    /// necessary is another technique: textures where there were none, replicas, shadows; in compute also more objects or copies
    /// than one.
    ///
    /// # Errors
    /// As [`Renderer::prepare`], of what was added and set.
    pub fn prewarm(&mut self) -> Result<Prewarm> {
        self.refresh()?;
        let mut wanted = Vec::new();
        for entry in self.ordered() {
            let surface = entry.prepared.as_ref().and_then(|p| p.surface.as_deref());
            self.reachable(&entry.object, surface, &mut wanted);
        }
        Ok(Prewarm {
            wanted,
            output: self.output.clone(),
            owner: self.owner,
            device: self.device.clone(),
        })
    }

    fn reachable(
        &self,
        object: &Object,
        surface: Option<&OffsetSurface>,
        all: &mut Vec<(Variant, Kind)>,
    ) {
        let (settings, solver) = (&self.settings, self.settings.solver);
        let planes = self.output.planes();
        let of = |solver| Variant::new(settings, planes, solver, &self.lighting, object, self.met);
        let fallback = matches!(solver, Solver::Quadric | Solver::Hull).then(|| of(FALLBACK));
        let wraps = settings.hull_from != u32::MAX && object.repeat == [1; 3];
        let (several, copies) = (self.order.len() > 1, object.placements().len() > 1);
        let compute = (!self.draws_hulls()).then_some([several, copies]);
        // An offset may move the size of tables across the limit.
        let own = surface.map_or(0, |s| s.tables().own);
        let limit = PIECE_VECTORS as usize;
        let fits = [own <= limit + limit / 2, own > limit - limit / 4];
        for (variant, kind) in of(solver).reachable(solver, wraps, compute, fallback) {
            for (fit, _) in [true, false].into_iter().zip(fits).filter(|(_, may)| *may) {
                let variant = match kind {
                    Kind::Hull => variant.in_shell(),
                    _ => variant.with_tables(fit),
                };
                if !all.contains(&(variant, kind)) {
                    all.push((variant, kind));
                }
            }
        }
    }
}
