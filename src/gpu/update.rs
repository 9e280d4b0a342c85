//! What changes from frame to frame: looked at as a whole first, then taken over.

use super::batch::{
    MapFacts, check_format, frame_block, instance_block, largest_width, solid_block,
};
use super::bins::Bins;
use super::blocks::{FrameBlock, InstanceBlock, ShadowBlock};
use super::buffers::write;
use super::cuts::Cut;
use super::hulls::{self, Wrapped};
use super::meshes::Planned;
use super::parts::{Of, Parts};
use super::pipelines::Kind;
use super::renderer::Renderer;
use super::searches::Searches;
use super::work::{Batch, Work};
use crate::error::{Error, Result, Stage};
use crate::maps::MapFormat;
use crate::maps::envelope::SLACK;
use crate::scene::{CameraFrame, Object, Placement, Scene, Shadow};
use crate::settings::{DrawStage, Settings, Solver};
use crate::shader::Variant;
use crate::shader::generated::{MAX_SHADOW_BATCHES, PIECE_VECTORS};
use std::sync::Arc;

/// What an update needs and can find out without changing anything that is drawn.
pub(super) struct Plan {
    pub(super) camera: CameraFrame,
    frame: FrameBlock,
    searches: Searches,
    /// One an object, where meshes are drawn.
    meshes: Vec<Planned>,
}

/// What the batches put into buffers that they share.
pub(super) struct Lists {
    pub(super) bins: Bins,
    /// Words of the lists that beams fill, behind those of the bins.
    pub(super) tiles: usize,
    /// Blocks of copies, behind those of the objects.
    pub(super) blocks: u32,
    pieces: Parts,
    /// Of the hull that has most.
    bands: usize,
    shadows: ShadowBlock,
}

impl Renderer {
    /// Takes over camera, lights, placements and parameters of `scene`, whose objects must be those the renderer was made with.
    /// No map is computed again, but for a solid whose contour no longer closes under its offset ([`Renderer::notes`]), and where shadows
    /// become soft.
    ///
    /// # Errors
    /// Of the scene's values ([`Stage::Scene`]), and of objects or instances other than those the renderer was made with
    /// ([`Stage::Draw`]): what was drawn before can be drawn on. Of baking a map ([`Stage::Map`]) and of Vulkan ([`Stage::Draw`]):
    /// nothing is drawn before an update succeeds.
    pub fn update(&mut self, scene: &Scene) -> Result<()> {
        let plan = self.plan(scene)?;
        self.stale = true;
        self.apply(scene, &plan)?;
        self.stale = false;
        Ok(())
    }

    /// Finds all that can be found wrong with a scene before anything that is drawn is changed for it.
    fn plan(&mut self, scene: &Scene) -> Result<Plan> {
        if scene.objects.len() != self.batches.len() {
            return Err(Error::new(
                Stage::Draw,
                "the scene has other objects than the renderer was made with; make a new one",
            ));
        }
        scene.check()?;
        let size = (self.settings.width, self.settings.height);
        let camera = CameraFrame::new(&scene.camera, size.0, size.1)?;
        let frame = frame_block(scene, &camera, size)?;
        if scene.shadow != Shadow::Off {
            self.check_shadows()?;
        }
        for (batch, object) in self.batches.iter().zip(&scene.objects) {
            self.textures.shape(object, &self.settings)?;
            if object.placements().len() != batch.instances.len() {
                return Err(Error::new(
                    Stage::Draw,
                    format!(
                        "{} has other instances than the renderer was made with; make a new one",
                        object.name
                    ),
                ));
            }
        }
        let searches = Searches::new(&mut self.cuts, &self.contours, scene, &self.settings)?;
        for (number, object) in scene.objects.iter().enumerate() {
            check_format(number, object, &self.settings_of(number, &searches))?;
        }
        let meshes = match &mut self.meshes {
            Some(meshes) => meshes.plan(scene, &self.contours)?,
            None => Vec::new(),
        };
        Ok(Plan {
            camera,
            frame,
            searches,
            meshes,
        })
    }

    fn check_shadows(&self) -> Result<()> {
        let (count, most) = (self.batches.len(), MAX_SHADOW_BATCHES as usize);
        if count > most {
            return Err(Error::new(
                Stage::Scene,
                format!("shadows between {count} objects; at most {most} are drawn: use instances, or set \"off\""),
            )
            .at_key("shadow"));
        }
        self.textures.check_shadows()
    }

    /// The settings with the search that object `number` is drawn by.
    fn settings_of(&self, number: usize, searches: &Searches) -> Settings {
        Settings {
            solver: searches.solver(number),
            ..self.settings
        }
    }

    fn apply(&mut self, scene: &Scene, plan: &Plan) -> Result<()> {
        self.background = scene.background;
        self.cuts.forget_unused();
        for note in plan.searches.notes() {
            if !self.notes.contains(note) {
                self.notes.push(note.clone());
            }
        }
        // All maps before the first set of textures is written: shadows read those of other objects.
        for (number, object) in scene.objects.iter().enumerate() {
            let asked = plan.searches.solver(number) == self.settings.solver;
            if !asked || scene.shadow == Shadow::Soft {
                let (device, commands) = (&self.device, &self.commands);
                self.textures
                    .demand_map(device, commands, object, &self.settings)?;
            }
        }
        let mut lists = Lists {
            bins: Bins::default(),
            tiles: 0,
            blocks: scene.objects.len() as u32,
            pieces: Parts::default(),
            bands: 0,
            shadows: bytemuck::Zeroable::zeroed(),
        };
        let mut batches = Vec::with_capacity(self.batches.len());
        for number in 0..self.batches.len() {
            batches.push(self.batch(number, scene, plan, &mut lists)?);
        }
        // Lists of tiles stand behind all bins, whose number is known only now.
        let bins = lists.bins.words();
        for batch in &mut batches {
            if let Work::Beams { copies, .. } = &mut batch.work {
                for tiles in copies {
                    tiles.at += bins.len() as u32;
                }
            }
        }
        self.buffers.write_bins(&bins, bins.len() + lists.tiles)?;
        self.buffers.write_pieces(lists.pieces)?;
        self.buffers.fit_corners(lists.bands)?;
        write(&mut self.buffers.frame, 0, &plan.frame)?;
        write(&mut self.buffers.shadows, 0, &lists.shadows)?;
        self.descriptors.frame(&self.buffers);
        self.descriptors.target(&self.target, &self.buffers.bins);
        self.batches = batches;
        Ok(())
    }

    /// Makes object `number`'s batch, and writes its block and its instances.
    fn batch(
        &mut self,
        number: usize,
        scene: &Scene,
        plan: &Plan,
        lists: &mut Lists,
    ) -> Result<Batch> {
        let object = &scene.objects[number];
        let instances = self.batches[number].instances.clone();
        let casts = scene.shadow != Shadow::Off;
        let settings = self.settings_of(number, &plan.searches);
        let mut variant = Variant::new(&settings, scene, object);
        variant.single = u32::from(instances.len() == 1);
        let (shape, facts) = self.textures.shape(object, &self.settings)?;
        let bound = self.textures.of(object, shape);
        let mut block = solid_block(object, &facts, &instances, shape, settings.solver);
        let tables = plan.searches.tables(number);
        let wrapped = self.wrapped(object, &settings, &facts, tables);
        let mut near_first = Vec::new();
        let (kind, work) =
            if let (Some(meshes), Some(planned)) = (&mut self.meshes, plan.meshes.get(number)) {
                let both_sides;
                (near_first, both_sides) =
                    meshes.update(number, object, planned, &plan.camera, &self.commands)?;
                (Kind::Mesh { both_sides }, Work::Mesh)
            } else if self.settings.stage == DrawStage::Compute {
                let work = self.compute_work(number, object, wrapped.as_ref(), plan, lists)?;
                let mut several = false;
                if let Work::Beams { copies, .. } = &work {
                    (variant.ahead, variant.single) = (1, 1);
                    several = copies.len() > 1;
                }
                variant.depth_test = u32::from(number > 0 || several);
                variant.depth_keep = u32::from(number + 1 < scene.objects.len() || several);
                (Kind::Compute, work)
            } else if let Some(cut) = &wrapped
                && let Some(Wrapped { hull, bands }) = self.hull(object, cut, plan)
            {
                block.hull[0] = lists.pieces.place(cut, Of::Bands, 1);
                lists.bands = lists.bands.max(hull.bands.len());
                let kind = if cut.is_boundary() {
                    variant.tests = hull.tests();
                    Kind::Hull
                } else {
                    variant.ahead = 1;
                    Kind::ConvexHull
                };
                (kind, Work::Hull { bands })
            } else {
                (Kind::Box, Work::Box)
            };
        let mut tables_offset = 0;
        // A hull's own fragments read none of the tree; shadows' rays do. Of an envelope beams alone read something.
        let read = tables.filter(|_| kind != Kind::Hull || casts).or(wrapped
            .as_ref()
            .filter(|_| matches!(work, Work::Beams { .. })));
        if let Some(cut) = read {
            let align = self.buffers.table_align();
            let begin = lists.pieces.place(cut, Of::Tables, align);
            block.pieces = cut.tables().block(begin);
            block.hull[1] = cut.tables().beams(begin);
            variant.own_tables = u32::from(cut.tables().own <= PIECE_VECTORS as usize);
            tables_offset = 16 * begin;
        }
        let block_offset = number as u32 * self.buffers.stride;
        write(&mut self.buffers.batches, block_offset as usize, &block)?;
        if let Work::Beams { copies, .. } = &work {
            for tiles in copies {
                block.single = instance_block(&object.placements()[tiles.instance]);
                write(
                    &mut self.buffers.batches,
                    tiles.block_offset as usize,
                    &block,
                )?;
            }
        }
        if casts {
            lists.shadows.shadow_batches[0] = scene.objects.len() as u32;
            lists.shadows.shadow_solids[number] = block;
        }
        let placements = match near_first.as_slice() {
            [] => object.placements(),
            sorted => sorted,
        };
        self.write_instances(instances.start, placements)?;
        Ok(Batch {
            block_offset,
            tables_offset,
            pipeline: self.pipelines.get(variant, kind)?,
            textures: self.descriptors.textures(number, &bound),
            instances,
            work,
        })
    }

    /// What rays of `object` can be held to before they are searched: its boundary; of a search on the map, where its solid may be.
    fn wrapped(
        &mut self,
        object: &Object,
        settings: &Settings,
        facts: &MapFacts,
        tables: Option<&Arc<Cut>>,
    ) -> Option<Arc<Cut>> {
        if settings.hull_from == u32::MAX {
            return None;
        }
        match settings.solver {
            Solver::Hull => tables.cloned(),
            // A map of 8 bits bounds nothing.
            Solver::Live if settings.map_format != MapFormat::Rgba8 => {
                let by = largest_width(&object.offset).max(0.0) + SLACK / f64::from(facts.rows);
                // As much as halves of floats are rounded by.
                let by = by * (1.0 + 1.0 / 1024.0);
                Some(self.cuts.grown(facts.envelope.as_ref()?, by))
            }
            _ => None,
        }
    }

    /// The hull of an object, where it is drawn by it.
    fn hull<'a>(&self, object: &Object, cut: &'a Cut, plan: &Plan) -> Option<Wrapped<'a>> {
        let limits = &self.device.limits;
        let wraps = limits.max_fragment_input_components >= hulls::COMPONENTS
            && limits.max_vertex_output_components >= hulls::COMPONENTS + 4;
        if !wraps && cut.is_boundary() {
            return None;
        }
        let view = hulls::View {
            camera: &plan.camera,
            size: (self.settings.width, self.settings.height),
            near: f64::from(plan.frame.eye[3]),
            from: self.settings.hull_from,
        };
        hulls::of(object, cut, &view)
    }

    fn write_instances(&mut self, first: u32, placements: &[Placement]) -> Result<()> {
        const EACH: usize = size_of::<InstanceBlock>();
        let bytes = self.buffers.instances.mapped()?;
        let from = EACH * first as usize;
        for (target, placement) in bytes[from..].chunks_exact_mut(EACH).zip(placements) {
            target.copy_from_slice(bytemuck::bytes_of(&instance_block(placement)));
        }
        Ok(())
    }
}
