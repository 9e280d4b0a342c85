//! The picture of `render --levels`: every object in the colour of its level.

use revmap::gpu::ObjectCost;
use revmap::scene::{Object, Scene, Shadow};
use std::collections::BTreeSet;

/// The coarsest level that has a colour of its own.
const COARSEST: f32 = 12.0;

/// The scene reduced to colours: those of the levels by which its objects, or their copies, were
/// drawn. Objects without levels are grey. `copies`: the levels of each object's copies, if they
/// differ.
pub fn painted(scene: &Scene, costs: &[ObjectCost], copies: &[Vec<u8>]) -> Scene {
    let mut painted = scene.clone();
    painted.lights.clear();
    painted.ambient = [1.0; 3];
    painted.environment = None;
    painted.shadow = Shadow::Off;
    painted.objects.clear();
    for ((object, cost), copies) in scene.objects.iter().zip(costs).zip(copies) {
        let mut object = object.clone();
        object.texturing.color_map = None;
        object.texturing.displacement_map = None;
        object.specular.strength = 0.0;
        object.color = cost.level.map_or([0.2; 3], color);
        for level in BTreeSet::from_iter(copies) {
            let all = object.instances.iter().zip(copies);
            let of_level = all.filter(|(_, of)| *of == level).map(|(copy, _)| *copy);
            painted.objects.push(Object {
                instances: of_level.collect(),
                color: color(u32::from(*level)),
                ..object.clone()
            });
        }
        if copies.is_empty() {
            painted.objects.push(object);
        }
    }
    painted
}

/// Colours from blue over green to red, linear RGB.
fn color(level: u32) -> [f32; 3] {
    let at = (level as f32 / COARSEST).min(1.0);
    let near = |middle: f32| (1.0 - 2.0 * (at - middle).abs()).clamp(0.02, 1.0);
    [near(1.0), near(0.5), near(0.0)]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use glam::DVec3;
    use revmap::gpu::DrawPath;
    use revmap::profile::Profile;
    use revmap::scene::{Camera, Placement};
    use std::sync::Arc;

    /// Copies are painted by their own levels, and none is lost.
    #[test]
    fn copies_are_painted_one_by_one() {
        let profile = Profile::polygon(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.5).unwrap();
        let mut object = Object::new("many", Arc::new(profile));
        object.instances = vec![Placement::default(); 5].into();
        let mut scene = Scene::new(Camera::new(DVec3::X, DVec3::ZERO));
        scene.objects = vec![object.clone(), object];
        let cost = ObjectCost {
            path: DrawPath::Walk,
            level: Some(3),
            error_pixels: None,
            patches: 1,
            table_bytes: 0,
            map_bytes: 0,
            instance_bytes: 0,
        };
        let found = painted(&scene, &[cost; 2], &[vec![6, 0, 6, 12, 0], vec![]]).objects;
        let counts: Vec<_> = found.iter().map(|o| (o.instances.len(), o.color)).collect();
        let wanted = [(2, color(0)), (2, color(6)), (1, color(12)), (5, color(3))];
        assert_eq!(counts, wanted);
    }

    #[test]
    fn levels_have_colours_of_their_own() {
        let all: Vec<_> = (0..=12).map(color).collect();
        for (k, one) in all.iter().enumerate() {
            assert!(one.iter().all(|c| (0.0..=1.0).contains(c)));
            assert!(!all[..k].contains(one), "level {k}");
        }
    }
}
