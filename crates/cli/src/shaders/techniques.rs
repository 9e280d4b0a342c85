//! Techniques that scenes may use, one at a time.

use revmap::error::Result;
use revmap::gpu::compiler::Look;
use revmap::maps::{ColorMap, DisplacementMap, MapFormat, SlopeFilter};
use revmap::profile::Profile;
use revmap::scene::{Clip, Light, Lighting, Object, Shadow};
use revmap::settings::{Plane, PlaneList, Planes};
use std::sync::Arc;

/// Each technique by its name, with an example scene. The first has nothing besides its shape; the
/// same pipelines draw an extended solid.
pub fn techniques() -> Result<Vec<(&'static str, Look)>> {
    let triangle = [[0.0, 0.0], [0.5, 0.0], [0.0, 1.0]];
    let profile = Arc::new(Profile::polygon(&triangle, 0.5)?);
    let white = Arc::new(ColorMap::from_texels(1, 1, vec![[255; 4]])?);
    let level = DisplacementMap::from_heights(1, 1, &[0.5], SlopeFilter::Central)?;
    let level = Arc::new(level);
    let changed = |name, change: &dyn Fn(&mut Look)| {
        let mut look = Look {
            object: Object::new(name, profile.clone()),
            lighting: Lighting {
                lights: vec![Light::default()],
                ..Lighting::default()
            },
            format: MapFormat::R32,
            planes: Planes::Color,
        };
        change(&mut look);
        (name, look)
    };
    let buffer = PlaneList::new(&[
        Plane::BaseColor,
        Plane::OctahedralNormal,
        Plane::Material,
        Plane::Motion,
        Plane::Identity,
    ])?;
    Ok(vec![
        changed("revolution", &|_| ()),
        // The same code draws solids that contain the eye.
        changed("cut by the box", &|look| look.object.clip = Clip::Box),
        changed("beveled", &|look| look.object.offset.bevel = 0.25),
        changed("8-bit map", &|look| look.format = MapFormat::Rgba8),
        changed("many lights", &|look| {
            let light = look.lighting.lights.first().copied();
            look.lighting.lights.extend(light.iter().cycle().take(3));
        }),
        changed("textured", &|look| {
            look.object.texturing.color_map = Some(white.clone());
        }),
        changed("textured, bumped", &|look| {
            look.object.texturing.color_map = Some(white.clone());
            look.object.texturing.displacement_map = Some(level.clone());
        }),
        changed("replicas", &|look| look.object.repeat = [2; 3]),
        changed("hard shadows", &|look| look.lighting.shadow = Shadow::Hard),
        changed("soft shadows", &|look| look.lighting.shadow = Shadow::Soft),
        changed("every plane", &|look| look.planes = Planes::All),
        changed("G-buffer", &|look| look.planes = Planes::List(buffer)),
        changed("depth alone", &|look| {
            look.planes = Planes::Depth { parallel: false };
        }),
    ])
}
