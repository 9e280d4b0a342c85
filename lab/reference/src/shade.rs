//! Colour of a hit: texture and bump, Blinn-Phong under the scene's lights, linear (Blinn 1977,
//! 1978), hard and soft shadows.

use super::texture::{self, Lengths};
use super::{Hit, Ray, Reference};
use glam::{DVec2, DVec3};
use revmap::error::Result;
use revmap::scene::{Material, Scene, Shadow};

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

/// The colours of a scene.
#[derive(Debug)]
pub struct Colors<'a> {
    scene: &'a Scene,
    lengths: Lengths,
}

impl<'a> Colors<'a> {
    /// Prepares a scene.
    pub fn new(scene: &'a Scene) -> Result<Self> {
        let lengths = Lengths::new(scene)?;
        Ok(Self { scene, lengths })
    }

    /// The linear colour of the first hit along a ray; `None` without a hit. Rays towards the
    /// lights begin at least `lift` off the surface, world units.
    pub fn along(&self, reference: &Reference, ray: Ray, lift: f64) -> Option<[f32; 4]> {
        let hit = reference.trace(ray).hit?;
        Some(self.shade(reference, &hit, ray, lift)?.color)
    }

    /// Shades a hit that is seen along `ray`; `None` if its object is not in the scene. A ray towards a
    /// light begins at least `least_lift` off the surface, world units.
    ///
    /// The colour is `albedo * ambient + environment + sum over lights of light * (albedo * max(0, n.l) + strength *
    /// (n.l > 0 ? max(0, n.h)^shininess : 0))`. `l` points towards the light, `h` half way between `l`
    /// and the viewer. `n`, tilted by the bumps, is turned to the viewer's side if the surface faces
    /// away. [`Environment`](revmap::scene::Environment) has the formula of its part. A soft light counts
    /// by the mean over those directions to its disc that reach it.
    pub(super) fn shade(
        &self,
        reference: &Reference,
        hit: &Hit,
        ray: Ray,
        least_lift: f64,
    ) -> Option<Shaded> {
        let Self { scene, lengths } = self;
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
        if let Some(environment) = &scene.environment {
            let Material {
                roughness,
                metalness,
            } = object.material();
            let (facing, metal) = (normal.dot(view), f64::from(metalness));
            let reflected = 2.0 * facing * normal - view;
            let fill = environment.sky(normal);
            let seen = environment.sky(reflected.lerp(normal, f64::from(roughness)));
            let glass = 0.04 + 0.96 * (1.0 - facing.clamp(0.0, 1.0)).powi(5);
            for (c, sum) in color.iter_mut().enumerate() {
                let part = glass + metal * (albedo[c] - glass);
                *sum += albedo[c] * fill[c] + f64::from(object.specular.strength) * part * seen[c];
            }
        }
        for light in &scene.lights {
            let towards = -light.direction.normalize_or_zero();
            let from = point + lift * smooth;
            // Lambert's term and the highlight of light from one direction.
            let reflected = |towards: DVec3| {
                let lambert = normal.dot(towards);
                if lambert <= 0.0 {
                    return DVec2::ZERO;
                }
                let half = (towards + view).normalize_or_zero();
                let shine = normal.dot(half).max(0.0);
                let shine = shine.powf(f64::from(object.specular.shininess));
                DVec2::new(lambert, f64::from(object.specular.strength) * shine)
            };
            let reaches = |towards| reaches(reference, from, smooth, towards);
            let [lambert, shine] = match scene.shadow {
                Shadow::Off => reflected(towards),
                Shadow::Hard if !reaches(towards) => DVec2::ZERO,
                Shadow::Hard => reflected(towards),
                Shadow::Soft => over_disc(towards, light.cap(), reflected, reaches),
            }
            .to_array();
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
}

/// Rays towards a light's disc, where they disagree.
const DISC_RAYS: u32 = 256;
/// Rays that must agree for the others to be left out.
const FIRST_RAYS: u32 = 64;

/// True if nothing is between a point and a light. The surface itself hides what is below its
/// horizon; `normal` points to the lit side.
fn reaches(reference: &Reference, from: DVec3, normal: DVec3, towards: DVec3) -> bool {
    let ray = Ray::new(from, towards);
    normal.dot(towards) > 0.0 && reference.trace(ray).hit.is_none()
}

/// The mean of `reflected` over the directions of a light's disc that `reaches` the light: those within
/// the cone around `towards`, all of the same weight. `cap` is 1 - cos of the cone's half angle.
fn over_disc(
    towards: DVec3,
    cap: f64,
    reflected: impl Fn(DVec3) -> DVec2,
    reaches: impl Fn(DVec3) -> bool,
) -> DVec2 {
    let (u, v) = towards.any_orthonormal_pair();
    let ray = |k: u32| {
        // Bit-reversed numbers beside multiples of the golden ratio: every prefix is even.
        let height = cap * (f64::from(k.reverse_bits()) + 0.5) / f64::from(u32::MAX);
        let turn = f64::from(k) * std::f64::consts::TAU * 0.618_033_988_749_894_9;
        let aside = (height * (2.0 - height)).sqrt();
        (1.0 - height) * towards + aside * (turn.cos() * u + turn.sin() * v)
    };
    let first: Vec<bool> = (0..FIRST_RAYS).map(|k| reaches(ray(k))).collect();
    let agree = first.iter().all(|lit| *lit == first[0]);
    let lit = |k: u32| match first.get(k as usize) {
        Some(lit) => *lit,
        None if agree => first[0],
        None => reaches(ray(k)),
    };
    let seen = (0..DISC_RAYS)
        .filter(|&k| lit(k))
        .map(|k| reflected(ray(k)));
    seen.sum::<DVec2>() / f64::from(DISC_RAYS)
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
    use revmap::profile::Profile;
    use revmap::scene::{Light, Object};
    use std::f64::consts::FRAC_1_SQRT_2;

    fn look(normal: [f64; 3], light: [f64; 3], direction: [f64; 3]) -> Shaded {
        let mut scene = tests::scene(vec![tests::object(samples::torus(), 0.5)]);
        scene.lights.truncate(1);
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
        let ray = Ray::new(DVec3::ZERO, direction);
        let colors = Colors::new(&scene).unwrap();
        colors.shade(&reference, &hit, ray, 0.0).unwrap()
    }

    #[track_caller]
    fn assert_color(shaded: &Shaded, expected: [f64; 3]) {
        let found = shaded.color;
        for (c, e) in found.iter().zip(expected) {
            assert!(
                (f64::from(*c) - e).abs() < 1e-6,
                "{found:?} is not {expected:?}"
            );
        }
        assert_eq!(found[3], 1.0);
    }

    /// A wide plate whose edge crosses the light's disc hides a segment of a circle.
    #[test]
    fn half_hidden_lights_are_segments_of_circles() {
        let plate = Profile::polygon(&[[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]], 0.5);
        let radius: f64 = 3.0;
        let light = Light {
            radius,
            ..Light::default()
        };
        let visible = |reference: &Reference, normal: DVec3| {
            let reaches = |towards| reaches(reference, DVec3::ZERO, normal, towards);
            over_disc(DVec3::Z, light.cap(), |_| DVec2::X, reaches).x
        };
        let disc = 10.0 * radius.to_radians().tan();
        for part in [-1.1, -0.7, -0.2, 0.0, 0.3, 0.6, 1.1] {
            let mut scene = tests::scene(vec![Object::new("plate", plate.clone().unwrap().into())]);
            scene.objects[0].placement.scale = DVec3::new(2e4, 2e4, 1e-4);
            scene.objects[0].placement.position = DVec3::new(1e4 + part * disc, 0.0, 10.0);
            let reference = Reference::new(&scene).unwrap();
            let found = visible(&reference, DVec3::Z);
            let d: f64 = f64::clamp(-part, -1.0, 1.0);
            let segment = (d.acos() - d * (1.0 - d * d).sqrt()) / std::f64::consts::PI;
            assert!((found - segment).abs() < 0.02, "{part}: {found}, {segment}");
        }
        // Half of the disc is below the horizon.
        let clear = Reference::new(&tests::scene(Vec::new())).unwrap();
        let low = visible(&clear, DVec3::X);
        assert!((low - 0.5).abs() < 0.01, "{low}");
    }

    #[test]
    fn colours_are_the_formulas() {
        // Albedo 0.8 0.6 0.4, ambient 0.1, strength 0.3, shininess 40. Light, normal and viewer in
        // one line give the full value.
        let full = [0.8 * 1.1 + 0.3, 0.6 * 1.1 + 0.3, 0.4 * 1.1 + 0.3];
        let straight = look([0.0, 0.0, 1.0], [0.0, 0.0, -5.0], [0.0, 0.0, -2.0]);
        assert_color(&straight, full);
        // Seen from behind the surface, the normal is turned, and the light on that side counts.
        let back = look([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);
        assert_color(&back, full);
        assert_eq!(back.shading_normal, DVec3::NEG_Z);
        // A surface lit from behind has only ambient light.
        let dark = look([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]);
        assert_color(&dark, [0.08, 0.06, 0.04]);
        // Light from 45 degrees and the viewer above give half the angle for the highlight.
        let shine = 0.3 * (std::f64::consts::FRAC_PI_8.cos()).powi(40);
        let slant = look([0.0, 0.0, 1.0], [-1.0, 0.0, -1.0], [0.0, 0.0, -1.0]);
        let lit = [0.8, 0.6, 0.4].map(|a| a * (0.1 + FRAC_1_SQRT_2) + shine);
        assert_color(&slant, lit);
    }

    #[test]
    fn texture_coordinates_run_about_the_axis() {
        let [u, v] = look([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]).uv;
        // Azimuth -90 degrees is a quarter of the way round.
        assert!((u - 0.25).abs() < 1e-15 && v == 0.3);
    }
}
