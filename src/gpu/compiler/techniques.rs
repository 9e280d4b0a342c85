//! What scenes may use, and the pipelines that draw it.

use crate::error::Result;
use crate::maps::{ColorMap, DisplacementMap, MapFormat, SlopeFilter};
use crate::profile::Profile;
use crate::scene::{Clip, Lighting, Object, Shadow};
use crate::settings::{DrawStage, Planes, SearchSettings, Solver};
use crate::shader::{Dispatch, Kind, Met, Variant};
use std::sync::Arc;

/// What a scene uses besides a bare solid.
pub(super) struct Technique {
    pub name: &'static str,
    object: Object,
    lighting: Lighting,
    format: MapFormat,
    pub planes: Planes,
}

impl Technique {
    /// The pipelines that draw it.
    pub fn pipelines(&self, stage: DrawStage, solver: Solver) -> Vec<(Variant, Kind)> {
        let depth_alone = matches!(self.planes, Planes::Depth { .. });
        let exact = matches!(solver, Solver::Hull | Solver::Quadric | Solver::Live);
        if (depth_alone && (stage == DrawStage::Compute || !exact))
            || (self.format == MapFormat::Rgba8 && !solver.reads_map())
        {
            return Vec::new();
        }
        let settings = SearchSettings {
            solver,
            map_format: self.format,
            ..SearchSettings::default()
        };
        let met = Met::default();
        let own = Variant::new(
            &settings,
            self.planes,
            solver,
            &self.lighting,
            &self.object,
            met,
        );
        let in_compute = stage == DrawStage::Compute;
        let all = [false, true]
            .into_iter()
            .flat_map(|several| {
                own.reachable(solver, true, several, in_compute.then_some(several), None)
            })
            // What other values of the parameters lead to is another technique's.
            .filter(|(v, kind)| {
                matches!(kind, Kind::Beam | Kind::List | Kind::ListCopies)
                    || (v.search, v.more_lights) == (own.search, own.more_lights)
            })
            .filter(|(v, kind)| {
                let cut = self.object.clip == Clip::Box;
                let tiled = v.dispatch == Dispatch::Beams && !v.search.is_live();
                match kind {
                    _ if v.is_cut(*kind) => cut,
                    Kind::Hull | Kind::List | Kind::Listed => !cut,
                    Kind::Compute if tiled => !cut,
                    Kind::Box | Kind::Spots | Kind::Bins | Kind::Compute => *v == v.seen_from(!cut),
                    Kind::ConvexHull | Kind::Beam | Kind::ListCopies | Kind::Sides => true,
                }
            });
        let large = |(v, kind): &(Variant, Kind)| {
            let variant = v.with_tables_of(*kind, false);
            let variant = variant.filter(|large| self.name == BARE && large != v);
            variant.map(|large| (large, *kind))
        };
        all.flat_map(|one| std::iter::once(one).chain(large(&one)))
            .collect()
    }
}

/// The technique whose solid has nothing besides its shape. An extended one is drawn by the same
/// pipelines.
const BARE: &str = "revolution";

pub(super) fn techniques() -> Result<Vec<Technique>> {
    let triangle = [[0.0, 0.0], [0.5, 0.0], [0.0, 1.0]];
    let profile = Arc::new(Profile::polygon(&triangle, 0.5)?);
    let white = Arc::new(ColorMap::from_texels(1, 1, vec![[255; 4]])?);
    let level = DisplacementMap::from_heights(1, 1, &[0.5], SlopeFilter::Central)?;
    let level = Arc::new(level);
    let bare = |name| Technique {
        name,
        object: Object::new(name, profile.clone()),
        lighting: Lighting::default(),
        format: MapFormat::R32,
        planes: Planes::Color,
    };
    let changed = |name, change: &dyn Fn(&mut Technique)| {
        let mut technique = bare(name);
        change(&mut technique);
        technique
    };
    Ok(vec![
        bare(BARE),
        // The same code draws what the eye is within.
        changed("cut by the box", &|t| t.object.clip = Clip::Box),
        changed("beveled", &|t| t.object.offset.bevel = 0.25),
        changed("8-bit map", &|t| t.format = MapFormat::Rgba8),
        changed("many lights", &|t| {
            let light = t.lighting.lights.first().copied();
            t.lighting.lights.extend(light.iter().cycle().take(3));
        }),
        changed("textured", &|t| {
            t.object.texturing.color_map = Some(white.clone());
        }),
        changed("textured, bumped", &|t| {
            t.object.texturing.color_map = Some(white.clone());
            t.object.texturing.displacement_map = Some(level.clone());
        }),
        changed("replicas", &|t| t.object.repeat = [2; 3]),
        changed("hard shadows", &|t| t.lighting.shadow = Shadow::Hard),
        changed("soft shadows", &|t| t.lighting.shadow = Shadow::Soft),
        changed("every plane", &|t| t.planes = Planes::All),
        changed("depth alone", &|t| {
            t.planes = Planes::Depth { parallel: false };
        }),
    ])
}
