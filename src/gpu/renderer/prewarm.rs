//! Pipelines compiled before they are needed.

use super::Renderer;
use super::prepare::PreparedFrame;
use crate::error::Result;
use crate::gpu::content::Content;
use crate::gpu::content::snapshot::FALLBACK;
use crate::gpu::device::Shared;
use crate::gpu::vk::pipelines::Owner;
use crate::shader::{Demands, Kind, Lights, Pushed, Technique, Variant};
use ash::vk;
use std::collections::HashSet;
use std::sync::Arc;

/// The pipeline that places copies.
pub(super) const PLACE: (Variant, Kind) = (Variant::general(Technique::LISTS), Kind::Place);

/// Pipelines that a renderer may need. Another thread may compile them while the renderer draws.
/// Pipelines that are the renderer's own live until both are dropped.
pub struct Prewarm {
    wanted: Vec<(Variant, Kind)>,
    /// Dropped before the device.
    owner: Arc<Owner>,
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

    /// Compiles all pipelines that are not compiled yet.
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
    /// Returns the general form of every pipeline that the objects may need, and the form for up to two
    /// lights. Once these are compiled, [`Renderer::prepare`]
    /// compiles nothing and hides nothing while parameters, lights, masks, placements, the view, and
    /// the numbers of objects and copies change. A change of technique makes others necessary: a
    /// search, textures where there were none, a projection, replicas, shadows.
    ///
    /// # Errors
    /// Same as [`Renderer::prepare`], for values that were added and set.
    pub fn prewarm(&mut self) -> Result<Prewarm> {
        self.content.refresh()?;
        Ok(self.prewarm_of(self.content.prewarmed_forms()))
    }

    /// Returns the pipelines that would draw the frames of all slots faster: special forms for one
    /// object, few lights, a solid that nothing cuts. Compile them on any thread at any time; the next
    /// [`Renderer::prepare`] takes them. It is empty once nothing is faster.
    #[must_use]
    pub fn special_forms(&self) -> Prewarm {
        let bound = self.slots.iter().filter_map(|slot| slot.bound.as_ref());
        let mut all: Vec<_> = bound.flat_map(|bound| &bound.faster).copied().collect();
        let mut known = HashSet::new();
        let pipelines = &self.device.pipelines;
        let is_compiled = |&(variant, kind): &(Variant, Kind)| {
            matches!(pipelines.known(variant, kind, &self.owner), Ok(Some(_)))
        };
        all.retain(|key| known.insert(*key) && !is_compiled(key));
        self.prewarm_of(all)
    }

    fn prewarm_of(&self, wanted: Vec<(Variant, Kind)>) -> Prewarm {
        Prewarm {
            wanted,
            owner: self.owner.clone(),
            device: self.device.clone(),
        }
    }

    /// Records draws of no pixel, or dispatches of no group, with every pipeline of
    /// [`Renderer::prewarm`]; in a pass without the small one that places copies, which is compute.
    /// Some drivers, including all software drivers, compile shaders at the first draw. Such drivers
    /// compile when these commands run.
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
        let textures = blank.as_ref().map(|blank| blank.set).unwrap_or_default();
        let (compute, point) = match self.content.is_compute() {
            true => (true, vk::PipelineBindPoint::COMPUTE),
            false => (false, vk::PipelineBindPoint::GRAPHICS),
        };
        if !compute {
            // SAFETY: `cmd` is recording, and the scissor is dynamic.
            unsafe { raw.cmd_set_scissor(cmd, 0, &[vk::Rect2D::default()]) };
        }
        let forms = self.content.prewarmed_forms().into_iter();
        for (variant, kind) in forms.filter(|form| compute || *form != PLACE) {
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
    /// The general form of every pipeline that an object's technique may need, with the form for few
    /// lights; the general forms of the technique that replaces it if its contour does not close; and
    /// what places copies for walks. View, masks, parameters and numbers of objects and copies do not
    /// count.
    fn prewarmed_forms(&self) -> Vec<(Variant, Kind)> {
        let (with, solver) = (self.conditions(&self.snapshot), self.settings.solver);
        let mut known = HashSet::new();
        let mut all = Vec::new();
        let demands = Demands {
            settings: &self.settings,
            planes: self.output.planes(),
            host_shades: self.host_shades,
            lighting: &self.lighting,
        };
        let casters = self.snapshot.facts.casters;
        for object in &self.snapshot.objects {
            let (drawn, look) = (object.drawn(), object.images.look());
            let drawn_by = |solver| Technique::new(&demands, solver, drawn, casters, look);
            let wanted = drawn_by(solver).by_bevel().into_iter();
            let wanted = wanted.map(|technique| (technique, Lights::Two));
            let replaced = (solver.follows_tolerance()).then(|| (drawn_by(FALLBACK), Lights::Any));
            for (technique, lights) in wanted.chain(replaced) {
                let mut variant = Variant::general(technique);
                variant.speciality.lights = lights;
                for kind in with.kinds(&technique) {
                    let [_, few_lights, general] = variant.forms(kind, u32::MAX);
                    let new = |variant: &Variant| known.insert((*variant, kind));
                    let forms = [general, few_lights].into_iter().filter(new);
                    all.extend(forms.map(|variant| (variant, kind)));
                }
            }
        }
        let walks = |(_, kind): &_| matches!(kind, Kind::Walk | Kind::WalkTiles);
        if all.iter().any(walks) {
            all.push(PLACE);
        }
        all
    }
}
