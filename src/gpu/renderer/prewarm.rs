//! Pipelines compiled before they are needed.

use super::Renderer;
use super::prepare::PreparedFrame;
use crate::error::Result;
use crate::gpu::content::Content;
use crate::gpu::content::refresh::FALLBACK;
use crate::gpu::content::view_plan::PlannedObject;
use crate::gpu::device::Shared;
use crate::gpu::vk::pipelines::Owner;
use crate::plan::levels::LevelledCopies;
use crate::plan::{PlanObject, variants};
use crate::settings::Solver;
use crate::shader::Pushed;
use crate::shader::{Kind, Variant};
use ash::vk;
use std::sync::Arc;

/// Pipelines that a renderer may need. Another thread may compile them while the renderer draws.
pub struct Prewarm {
    wanted: Vec<(Variant, Kind)>,
    owner: Owner,
    device: Arc<Shared>,
}

impl Prewarm {
    /// The number of pipelines, compiled or not.
    #[must_use]
    pub fn len(&self) -> usize {
        self.wanted.len()
    }

    /// Returns true if there are no pipelines.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.wanted.is_empty()
    }

    /// Compiles all pipelines that are not compiled yet. The renderer must live until this returns.
    ///
    /// # Errors
    /// Errors of Vulkan calls.
    pub fn compile(&self) -> Result<()> {
        let pipelines = &self.device.pipelines;
        for &(variant, kind) in &self.wanted {
            pipelines.get(variant, kind, &self.owner)?;
        }
        Ok(())
    }
}

impl Renderer {
    /// Returns every pipeline that the objects can reach while parameters, lights, placements and
    /// the view change. A change of technique makes others necessary: textures where there were
    /// none, replicas, shadows, a box that cuts, copies of a single object.
    ///
    /// # Errors
    /// Same as [`Renderer::prepare`], for values that were added and set.
    pub fn prewarm(&mut self) -> Result<Prewarm> {
        let view = self.content.plan.as_ref().map(|p| p.view);
        self.content.refresh()?;
        self.content.with_surfaces(view.as_ref())?;
        Ok(Prewarm {
            wanted: self
                .content
                .reachable()
                .into_iter()
                .map(|(v, k, _)| (v, k))
                .collect(),
            owner: self.owner.clone(),
            device: self.device.clone(),
        })
    }

    /// Records draws of no pixel, or dispatches of no group, with every pipeline of
    /// [`Renderer::prewarm`]. Some drivers, including all software drivers, compile shaders at the
    /// first draw. Such drivers compile when these commands run.
    ///
    /// # Errors
    /// Same as [`Prewarm::compile`], for pipelines that are not compiled, and as
    /// [`Renderer::record`].
    ///
    /// # Safety
    /// In a pass the effects are those of [`Renderer::record`]; the call also sets the scissor, to
    /// nothing. Outside of a pass the effects are those of [`Renderer::record_compute`].
    ///
    /// The caller must fulfil the duties of the same function.
    pub unsafe fn record_prewarm(
        &self,
        cmd: vk::CommandBuffer,
        frame: &PreparedFrame,
    ) -> Result<()> {
        let (slot, _) = self.frame(frame)?;
        let pipelines = &self.device.pipelines;
        let raw = &self.device.raw;
        let compute = self.content.is_compute();
        if !compute {
            // SAFETY: `cmd` is recording, and the scissor is dynamic.
            unsafe { raw.cmd_set_scissor(cmd, 0, &[vk::Rect2D::default()]) };
        }
        for (variant, kind, textures) in self.content.reachable() {
            if !compute && kind.makes_lists() {
                continue;
            }
            let pipeline = pipelines.get(variant, kind, &self.owner)?;
            let point = if compute {
                vk::PipelineBindPoint::COMPUTE
            } else {
                vk::PipelineBindPoint::GRAPHICS
            };
            self.bind_sets(cmd, point, slot, pipeline, textures, &[0; 2])?;
            if compute {
                self.push(cmd, &Pushed::default());
                // SAFETY: `cmd` is recording, outside a render pass; all bound objects live as long
                // as the caller promised.
                unsafe { raw.cmd_dispatch(cmd, 0, 0, 1) };
                self.wait_for_writes(cmd);
            } else {
                // SAFETY: `cmd` is recording, within a pass; all bound objects live as long as the
                // caller promised.
                unsafe { raw.cmd_draw(cmd, 3, 1, 0, 0) };
            }
        }
        Ok(())
    }
}

impl Content {
    /// Pipelines, each with a set of textures that may be bound with it.
    fn reachable(&self) -> Vec<(Variant, Kind, vk::DescriptorSet)> {
        let with = self.conditions();
        let solver = self.settings.solver;
        let derived: Vec<_> = (self.objects.ordered())
            .filter_map(|(number, entry)| {
                let derived = entry.derived.as_ref()?;
                let planned = PlannedObject {
                    number,
                    level: 0,
                    surface: derived.levels.first().map(|l| l.1.clone()),
                    levelled: (self.levels_copies(entry, derived)).then(LevelledCopies::default),
                };
                Some((entry, derived.textures.set, planned))
            })
            .collect();
        // The list includes objects that fall back, because their contour may close again.
        let own: Vec<PlanObject> = derived
            .iter()
            .filter_map(|(entry, _, planned)| {
                Some(PlanObject {
                    variant: self.variant(solver, entry.drawn(), entry.latest_images()),
                    ..entry.plan_object(planned, &self.settings)?
                })
            })
            .collect();
        let falls_back = matches!(solver, Solver::Quadric | Solver::Exact);
        let mut all: Vec<(Variant, Kind, vk::DescriptorSet)> = Vec::new();
        for ((entry, set, _), (object, variant)) in
            derived.iter().zip(own.iter().zip(variants(&own, &with)))
        {
            let fallback = falls_back.then(|| PlanObject {
                variant: self.variant(FALLBACK, entry.drawn(), entry.latest_images()),
                surface: None,
                takes_patches: false,
                ..*object
            });
            let mut reachable = with.reachable(object, variant);
            for object in fallback.iter() {
                let variant = Variant {
                    one_object: variant.one_object,
                    one_instance: variant.one_instance,
                    ..object.variant
                };
                // The fallback has one form only, the general one.
                let general = |(v, _): &(Variant, Kind)| v.beveled != 0;
                reachable.extend(with.reachable(object, variant).into_iter().filter(general));
            }
            for (variant, kind) in reachable {
                if !all.iter().any(|(v, k, _)| (*v, *k) == (variant, kind)) {
                    all.push((variant, kind, *set));
                }
            }
        }
        all
    }
}
