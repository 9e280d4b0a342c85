//! Colour of a hit: texture and bump, Blinn-Phong under the scene's lights, linear (Blinn 1977,
//! 1978), hard shadows.

use super::texture::{self, Lengths};
use super::{Hit, Ray, Reference};
use glam::DVec3;
use revmap::scene::{Scene, Shadow};

/// The colour and the shading normal of a hit.
pub(super) struct Shaded {
    pub color: [f32; 4],
    pub shading_normal: DVec3,
    pub albedo: [f32; 3],
    pub uv: [f64; 2],
}

/// Distance off the surface at which a ray towards a light begins, as a fraction of the hit's
/// distance from the eye. Nearer to it, the surface would shade itself.
const LIFT: f64 = 1e-6;

/// Shades a hit that is seen along `ray`; `None` if its object is not in the scene. A ray towards a
/// light begins at least `least_lift` off the surface, world units.
///
/// The colour is `albedo * ambient + sum over lights of light * (albedo * max(0, n.l) + strength *
/// (n.l > 0 ? max(0, n.h)^shininess : 0))`. `l` points towards the light, `h` half way between `l`
/// and the viewer. `n`, tilted by the bumps, is turned to the viewer's side if the surface faces
/// away. A hidden light adds nothing. Soft shadows are drawn as hard ones, since they are an
/// estimate without a ground truth.
pub(super) fn shade(
    scene: &Scene,
    reference: &Reference,
    lengths: &Lengths,
    hit: &Hit,
    ray: Ray,
    least_lift: f64,
) -> Option<Shaded> {
    let object = scene.objects.get(hit.object)?;
    let arc = lengths.of(hit.object);
    let uv = texture::coordinates(object, arc, hit.place);
    let own = object.color.map(f64::from);
    let albedo = texture::color(object, uv).unwrap_or(own);

    let view = -ray.direction.normalize_or_zero();
    let facing = if hit.normal.dot(view) < 0.0 {
        -1.0
    } else {
        1.0
    };
    let smooth = facing * hit.normal;
    let normal = bumped(scene, lengths, hit).map_or(smooth, |tilted| facing * tilted);
    let point = ray.origin + ray.direction * hit.t;
    let lift = (LIFT * hit.t * ray.direction.length()).max(least_lift);

    let mut color: [f64; 3] = std::array::from_fn(|c| albedo[c] * f64::from(scene.ambient[c]));
    for light in &scene.lights {
        let towards = -light.direction.normalize_or_zero();
        let lambert = normal.dot(towards);
        if lambert <= 0.0 {
            continue;
        }
        let shadow = Ray {
            origin: point + lift * smooth,
            direction: towards,
        };
        let shaded = scene.shadow != Shadow::Off
            && (smooth.dot(towards) <= 0.0 || reference.trace(shadow).hit.is_some());
        if shaded {
            continue;
        }
        let half = (towards + view).normalize_or_zero();
        let shine = f64::from(object.specular.strength)
            * normal
                .dot(half)
                .max(0.0)
                .powf(f64::from(object.specular.shininess));
        for (c, sum) in color.iter_mut().enumerate() {
            *sum += f64::from(light.color[c]) * (albedo[c] * lambert + shine);
        }
    }
    Some(Shaded {
        color: [color[0] as f32, color[1] as f32, color[2] as f32, 1.0],
        shading_normal: normal,
        albedo: albedo.map(|v| v as f32),
        uv,
    })
}

/// The outward normal tilted by the height's slope, in the world; `None` if the object has no
/// bumps.
fn bumped(scene: &Scene, lengths: &Lengths, hit: &Hit) -> Option<DVec3> {
    let object = scene.objects.get(hit.object)?;
    let depth = object.texturing.bump;
    if depth == 0.0 {
        return None;
    }
    let placement = object.placements().get(hit.instance)?;
    // Normals transform by the inverse transpose; here in the inverse direction, from the world to
    // the cell.
    let n = placement.rotation.conjugate() * hit.normal * placement.scale / hit.cell;
    let n = n.normalize_or_zero();
    let slope = texture::slope(object, lengths.of(hit.object), hit.place, n)?;
    let tilted = (n - depth * slope) * hit.cell / placement.scale;
    Some((placement.rotation * tilted).normalize_or_zero())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::{Surface, samples, tests};
    use super::*;
    use std::f64::consts::FRAC_1_SQRT_2;

    fn look(normal: [f64; 3], light: [f64; 3], direction: [f64; 3]) -> Shaded {
        let mut scene = tests::scene(vec![tests::object(samples::torus(), 0.5)]);
        scene.lights[0].direction = light.into();
        let hit = Hit {
            t: 1.0,
            object: 0,
            instance: 0,
            normal: normal.into(),
            surface: Surface::Turned,
            place: DVec3::new(0.0, -0.2, 0.3),
            cell: DVec3::ONE,
        };
        let reference = Reference::new(&scene).unwrap();
        let ray = Ray {
            origin: DVec3::ZERO,
            direction: direction.into(),
        };
        let lengths = Lengths::new(&scene).unwrap();
        shade(&scene, &reference, &lengths, &hit, ray, 0.0).unwrap()
    }

    #[track_caller]
    fn assert_color(shaded: &Shaded, expected: [f64; 3]) {
        for (c, e) in shaded.color.iter().zip(expected) {
            assert!(
                (f64::from(*c) - e).abs() < 1e-6,
                "{:?} is not {expected:?}",
                shaded.color
            );
        }
        assert_eq!(shaded.color[3], 1.0);
    }

    #[test]
    fn colours_are_the_formulas() {
        // Albedo 0.8 0.6 0.4, ambient 0.1, strength 0.3, shininess 40. Light, normal and viewer in
        // one line give the full value.
        let full = [0.8 * 1.1 + 0.3, 0.6 * 1.1 + 0.3, 0.4 * 1.1 + 0.3];
        assert_color(
            &look([0.0, 0.0, 1.0], [0.0, 0.0, -5.0], [0.0, 0.0, -2.0]),
            full,
        );
        // Seen from behind the surface, the normal is turned, and the light on that side counts.
        let back = look([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
        assert_color(&back, full);
        assert_eq!(back.shading_normal, DVec3::NEG_Z);
        // A surface lit from behind has only ambient light.
        assert_color(
            &look([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]),
            [0.08, 0.06, 0.04],
        );
        // Light from 45 degrees and the viewer above give half the angle for the highlight.
        let shine = 0.3 * (std::f64::consts::FRAC_PI_8.cos()).powi(40);
        let slant = look([0.0, 0.0, 1.0], [-1.0, 0.0, -1.0], [0.0, 0.0, -1.0]);
        assert_color(
            &slant,
            [0.8, 0.6, 0.4].map(|a| a * (0.1 + FRAC_1_SQRT_2) + shine),
        );
    }

    #[test]
    fn texture_coordinates_run_about_the_axis() {
        let [u, v] = look([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]).uv;
        // Azimuth -90 degrees is a quarter of the way round.
        assert!((u - 0.25).abs() < 1e-15 && v == 0.3);
    }
}
