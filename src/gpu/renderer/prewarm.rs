//! Pipelines compiled before they are needed.

use super::Renderer;
use super::prepare::PreparedFrame;
use crate::error::Result;
use crate::gpu::content::Content;
use crate::gpu::content::entry::Entry;
use crate::gpu::content::refresh::FALLBACK;
use crate::gpu::content::view_plan::PlannedObject;
use crate::gpu::device::Shared;
use crate::gpu::vk::pipelines::Owner;
use crate::plan::levels::CopyLevels;
use crate::plan::{PlanObject, variants};
use crate::shader::{Kind, Pushed, Variant};
use ash::vk;
use std::collections::HashSet;
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
        let reachable = self.content.reachable();
        Ok(Prewarm {
            wanted: reachable,
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
        // No set of an object: nothing keeps those alive until the commands have run.
        let blank = &self.content.textures.blank_set;
        let textures = blank
            .as_ref()
            .map_or_else(Default::default, |blank| blank.set);
        let (compute, point) = match self.content.is_compute() {
            true => (true, vk::PipelineBindPoint::COMPUTE),
            false => (false, vk::PipelineBindPoint::GRAPHICS),
        };
        if !compute {
            // SAFETY: `cmd` is recording, and the scissor is dynamic.
            unsafe { raw.cmd_set_scissor(cmd, 0, &[vk::Rect2D::default()]) };
        }
        for (variant, kind) in self.content.reachable() {
            if !compute && kind.makes_lists() {
                continue;
            }
            let pipeline = pipelines.get(variant, kind, &self.owner)?;
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
    /// The pipelines that objects may need.
    fn reachable(&self) -> Vec<(Variant, Kind)> {
        let (with, solver) = (self.conditions(), self.settings.solver);
        let planned = self.objects.ordered().filter_map(|(number, entry)| {
            let (boundary, derived) = entry.resources()?;
            let planned = PlannedObject {
                number,
                level: 0,
                surfaces: boundary
                    .levels
                    .first()
                    .map(|l| l.1.clone())
                    .into_iter()
                    .collect(),
                levels: (self.levels_copies(entry, derived)).then(CopyLevels::default),
            };
            Some((entry, planned))
        });
        let planned: Vec<_> = planned.collect();
        let drawn_by =
            |entry: &Entry, solver| self.variant(solver, entry.drawn(), &entry.values.images);
        // The list includes objects that fall back, because their contour may close again.
        let own = planned.iter().filter_map(|(entry, planned)| {
            Some(PlanObject {
                variant: drawn_by(entry, solver),
                ..entry.plan_object(planned)?
            })
        });
        let own: Vec<_> = own.collect();
        let mut all = Vec::new();
        let mut known = HashSet::new();
        let objects = own.iter().zip(variants(&own, &with));
        for ((entry, _), (object, variant)) in planned.iter().zip(objects) {
            let mut reachable = with.reachable(object, variant);
            if solver.follows_tolerance() {
                let fallback = Variant {
                    one_object: variant.one_object,
                    one_instance: variant.one_instance,
                    depths: variant.depths,
                    ..drawn_by(entry, FALLBACK)
                };
                let object = PlanObject {
                    variant: fallback,
                    surfaces: &[],
                    takes_patches: false,
                    ..*object
                };
                // The fallback has one form only, the general one.
                let general = with.reachable(&object, fallback).into_iter();
                reachable.extend(general.filter(|(v, _)| v.beveled != 0));
            }
            for key in reachable {
                if known.insert(key) {
                    all.push(key);
                }
            }
        }
        all
    }
}
