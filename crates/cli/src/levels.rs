//! The picture of `render --levels`: every object in the colour of its level.

use revmap::gpu::ObjectCost;
use revmap::scene::{Scene, Shadow};

/// The coarsest level that has a colour of its own.
const COARSEST: f32 = 12.0;

/// The scene reduced to colours: those of the levels by which its objects were drawn. Objects
/// without levels are grey.
pub fn painted(scene: &Scene, costs: &[ObjectCost]) -> Scene {
    let mut painted = scene.clone();
    painted.lights.clear();
    painted.ambient = [1.0; 3];
    painted.shadow = Shadow::Off;
    for (object, cost) in painted.objects.iter_mut().zip(costs) {
        object.texturing.color_map = None;
        object.texturing.displacement_map = None;
        object.specular.strength = 0.0;
        object.color = cost.level.map_or([0.2; 3], color);
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
    use super::*;

    #[test]
    fn levels_have_colours_of_their_own() {
        let all: Vec<_> = (0..=12).map(color).collect();
        for (k, one) in all.iter().enumerate() {
            assert!(one.iter().all(|c| (0.0..=1.0).contains(c)));
            assert!(!all[..k].contains(one), "level {k}");
        }
    }
}
