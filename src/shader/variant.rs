//! The variant: everything a pipeline is specialised for, so that it holds one search and nothing else.

use super::generated as g;
use crate::maps::{MapFormat, Projection};
use crate::scene::{BumpForm, Lighting, Object, Shadow};
use crate::settings::{SearchSettings, Solver};

/// The values of the specialisation constants of `variant.glsl`; also the key of a pipeline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Variant {
    /// One of `SOLVER_*`.
    pub solver: u32,
    /// One of `FORMAT_*`.
    pub map_format: u32,
    /// Bound of the search's loop.
    pub max_steps: u32,
    /// One of `OFFSET_*`.
    pub offset: u32,
    /// 1 where the box holds several replicas.
    pub cells: u32,
    /// One of `PROJECTION_*`.
    pub projection: u32,
    /// 1 where colours come from a map.
    pub color_map: u32,
    /// One of `BUMP_*`.
    pub bump: u32,
    /// One of `SHADOW_*`.
    pub shadow: u32,
    /// Number of lights.
    pub lights: u32,
    /// 1 where the batch's pieces fit into a uniform buffer.
    pub own_tables: u32,
    /// 1 where the batch is one instance.
    pub single: u32,
    /// 1 where beams say which tiles to trace and from where, or the fragments of a convex hull.
    pub ahead: u32,
    /// 0 where nothing was drawn before.
    pub depth_test: u32,
    /// 0 where nothing will be drawn after.
    pub depth_keep: u32,
    /// Pieces of a hull's largest cell.
    pub tests: u32,
}

impl Variant {
    /// The variant that draws `object` by `solver`.
    #[must_use]
    pub fn new(
        settings: &SearchSettings,
        solver: Solver,
        lighting: &Lighting,
        object: &Object,
    ) -> Self {
        let beveled = is_beveled(object);
        // A ray towards a light meets every solid of the scene by the code of the one that it left: that code must do for all of
        // them. The general forms are right for plain solids too.
        let general = lighting.shadow != Shadow::Off;
        let texturing = &object.texturing;
        Self {
            solver: match solver {
                Solver::Circle => g::SOLVER_CIRCLE,
                Solver::Cone => g::SOLVER_CONE,
                Solver::Relaxed => g::SOLVER_RELAXED,
                Solver::Live => g::SOLVER_LIVE,
                Solver::Quadric | Solver::Hull => g::SOLVER_QUADRIC,
                Solver::Linear => g::SOLVER_LINEAR,
                Solver::Relief => g::SOLVER_RELIEF,
                Solver::Secant => g::SOLVER_SECANT,
            },
            map_format: match settings.map_format {
                MapFormat::Rgba8 => g::FORMAT_RGBA8,
                MapFormat::R16 | MapFormat::R32 => g::FORMAT_SIGNED,
            },
            max_steps: settings
                .max_steps
                .unwrap_or_else(|| solver.default_steps(beveled))
                .max(1),
            offset: if general {
                g::OFFSET_BEVELED
            } else {
                offset_of(object)
            },
            cells: u32::from(general || object.repeat != [1; 3]),
            projection: match texturing.projection {
                Projection::Planar => g::PROJECTION_PLANAR,
                Projection::Cylindrical => g::PROJECTION_CYLINDRICAL,
                Projection::Spherical => g::PROJECTION_SPHERICAL,
                Projection::Arc => g::PROJECTION_ARC,
            },
            color_map: u32::from(texturing.color_map.is_some()),
            bump: match texturing.bump_form {
                _ if texturing.displacement_map.is_none() || texturing.bump == 0.0 => g::BUMP_OFF,
                BumpForm::SurfaceGradient => g::BUMP_SURFACE_GRADIENT,
                BumpForm::Papers => g::BUMP_PAPERS,
            },
            lights: u32::try_from(lighting.lights.len()).unwrap_or(g::MAX_LIGHTS),
            own_tables: 0,
            single: 0,
            ahead: 0,
            depth_test: 1,
            depth_keep: 1,
            tests: g::HULL_TESTS,
            shadow: match lighting.shadow {
                Shadow::Off => g::SHADOW_OFF,
                Shadow::Hard => g::SHADOW_HARD,
                Shadow::Soft => g::SHADOW_SOFT,
            },
        }
    }

    /// `(constant_id, value)` of every specialisation constant.
    #[must_use]
    pub fn constants(&self) -> [(u32, u32); 16] {
        [
            (g::SOLVER_ID, self.solver),
            (g::MAP_FORMAT_ID, self.map_format),
            (g::MAX_STEPS_ID, self.max_steps),
            (g::OFFSET_ID, self.offset),
            (g::CELLS_ID, self.cells),
            (g::PROJECTION_ID, self.projection),
            (g::COLOR_MAP_ID, self.color_map),
            (g::BUMP_ID, self.bump),
            (g::SHADOW_ID, self.shadow),
            (g::LIGHTS_ID, self.lights),
            (g::OWN_TABLES_ID, self.own_tables),
            (g::SINGLE_ID, self.single),
            (g::AHEAD_ID, self.ahead),
            (g::DEPTH_TEST_ID, self.depth_test),
            (g::DEPTH_KEEP_ID, self.depth_keep),
            (g::TESTS_ID, self.tests),
        ]
    }
}

fn is_beveled(object: &Object) -> bool {
    object.offset.bevel != 0.0 && object.offset.chamfer > 0.0
}

/// The least general form of `w` that `object` has; each is a case of the next.
fn offset_of(object: &Object) -> u32 {
    const { assert!(g::OFFSET_NONE < g::OFFSET_EXTENDED && g::OFFSET_EXTENDED < g::OFFSET_BEVELED) };
    if is_beveled(object) {
        g::OFFSET_BEVELED
    } else if object.offset.extend != 0.0 {
        g::OFFSET_EXTENDED
    } else {
        g::OFFSET_NONE
    }
}
