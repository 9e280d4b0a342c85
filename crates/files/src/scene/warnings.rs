//! Warnings about a scene that is allowed but looks unintended.

use super::Extent;
use glam::DVec3;
use revmap::frame::Frame;
use revmap::scene::{Camera, CameraFrame, Object, Offset, Placement, Scene};
use revmap::surface::ContourSource;

/// A field of view below this many degrees looks like one in radians.
const NARROW: f64 = 2.0;
/// A light brighter than this looks like a colour from 0 to 255.
const BRIGHT: f32 = 16.0;
/// Parts of a solid's height by which it hovers by mistake.
const HOVERS: std::ops::RangeInclusive<f64> = 0.002..=0.05;
/// Copies of a scene, as many of each object, that are looked at for that: each is compared with all
/// others.
const LOOKED_AT: usize = 256;
/// A background is stored with an error below this.
const ROUNDING: f32 = 1.0 / 256.0;

/// Warnings for a picture of `width x height` pixels, one sentence each, with the key. The
/// causes are a field of view that looks like radians, colours above 1,
/// [warnings](revmap::profile::Profile::warnings) of the profiles, shadows of a crowd, objects that
/// hover, insets that leave nothing, and an empty view.
#[must_use]
pub fn warnings(scene: &Scene, width: u32, height: u32) -> Vec<String> {
    let mut found = Vec::new();
    let fov = scene.camera.fov_y;
    if fov < NARROW {
        let size = if fov < 1e-3 {
            format!("{fov:e}")
        } else {
            format!("{fov}")
        };
        let remedy = match fov.to_degrees() {
            ..NARROW => format!("give more than {NARROW}, such as {}", Camera::FOV_Y),
            meant => format!("if radians are meant, give {meant:.1}"),
        };
        found.push(format!("camera.fov_y: is {size} degrees; {remedy}"));
    }
    let mut color = |key: &str, channels: &[f32], most: f32| {
        if let Some(c) = channels.iter().find(|c| **c > most) {
            found.push(format!(
                "{key}: has {c}; colours are linear from 0 to 1, divide by 255 if bytes are meant"
            ));
        }
    };
    color("background", &scene.background, 1.0);
    color("ambient", &scene.ambient, BRIGHT);
    if let Some(sky) = &scene.environment {
        color("environment.up", &sky.up, BRIGHT);
        color("environment.down", &sky.down, BRIGHT);
    }
    for (i, light) in scene.lights.iter().enumerate() {
        color(&format!("light.{i}.color"), &light.color, BRIGHT);
    }
    for (i, object) in scene.objects.iter().enumerate() {
        color(&format!("object.{i}.color"), &object.color, 1.0);
    }
    for (i, object) in scene.objects.iter().enumerate() {
        let of_profile = object.profile.warnings.iter();
        let key = if object.file.is_some() {
            "profile"
        } else {
            "polygon"
        };
        found.extend(of_profile.map(|w| format!("object.{i}.{key}: {w}")));
    }
    found.extend(hovering(scene));
    found.extend(unseen(scene, width, height));
    found
}

/// Objects of which a copy hovers a little above the flat top of another object, as a drawing with
/// a margin below it does.
fn hovering(scene: &Scene) -> Vec<String> {
    let each = (LOOKED_AT / scene.objects.len().max(1)).max(1);
    let objects = scene.objects.iter().enumerate();
    let copies = objects.flat_map(|(i, object)| {
        let some = object.placements().iter().take(each);
        some.map(move |place| (i, place))
    });
    let copies: Vec<_> = copies.take(LOOKED_AT).collect();
    let end = copies.last().map_or(0, |(i, _)| i + 1);
    let extents: Vec<_> = scene.objects[..end].iter().map(Extent::of).collect();
    let top = |&(i, place): &(usize, &Placement)| Some((i, extents[i].top(place)?, place.position));
    let tops: Vec<_> = copies.iter().filter_map(top).collect();
    let gap = |&(i, place): &(usize, &Placement)| {
        let low = -extents[i].reach(place, -DVec3::Z);
        let height = extents[i].reach(place, DVec3::Z) - low;
        let below = tops.iter().filter(|(other, [top, radius], middle)| {
            let aside = (place.position - *middle).truncate().length();
            *other != i && aside <= *radius && *top < low + 0.5 * height
        });
        let top = below.map(|(_, [top, _], _)| *top);
        let gap = (low - top.fold(f64::NEG_INFINITY, f64::max)) / height;
        HOVERS.contains(&gap).then_some((i, gap))
    };
    let mut all: Vec<_> = copies.iter().filter_map(gap).collect();
    all.dedup_by_key(|(i, _)| *i);
    let told = all.into_iter().map(|(i, gap)| {
        format!(
            "object.{i}: hovers {:.1} % of its height above the face below it; with object.{i}.stand = true its lowest point is at its position, whatever margin its drawing has",
            100.0 * gap
        )
    });
    told.collect()
}

/// Insets that leave nothing, and an empty view.
fn unseen(scene: &Scene, width: u32, height: u32) -> Vec<String> {
    let mut found = Vec::new();
    let left = |object: &&Object| object.offset.extend >= 0.0 || !is_empty(object);
    for (i, object) in scene.objects.iter().enumerate().filter(|(_, o)| !left(o)) {
        let inset = -object.offset.extend;
        found.push(format!(
            "object.{i}.extend: the inset of {inset} leaves nothing of the solid; give a smaller one"
        ));
    }
    let mut left = scene.objects.iter().filter(left).peekable();
    if left.peek().is_some() && !is_in_view(&scene.camera, left, width, height) {
        found.push(
            "nothing is in view; turn camera.target to the objects, or move camera.eye".to_owned(),
        );
    }
    found
}

/// A warning about a picture of the scene that shows nothing but the background, with the best reason
/// that is known. `None` where [`warnings`] gives one.
#[must_use]
pub fn blank(scene: &Scene, frame: &Frame) -> Option<String> {
    let same = |(a, b): (&f32, &f32)| (a - b).abs() < ROUNDING;
    let empty = |c: &[f32; 4]| c.iter().zip(&scene.background).all(same);
    let hit = frame.distance.iter().any(|d| d.is_finite());
    if hit || !frame.color.iter().all(empty) {
        return None;
    }
    let (width, height) = (frame.width, frame.height);
    let known = unseen(scene, width, height);
    known.is_empty().then(|| {
        let why = reason(scene, width, height);
        format!("the picture shows nothing but the background: {why}")
    })
}

/// Why no pixel of a view with objects in it shows one.
fn reason(scene: &Scene, width: u32, height: u32) -> String {
    let objects = || scene.objects.iter().enumerate();
    let sizes = objects().map(|(i, object)| (i, pixels(&scene.camera, object, width, height)));
    let largest = sizes.max_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((i, size)) = largest.filter(|(_, size)| *size < 1.0) {
        return format!(
            "object.{i} is {size:.2} pixels large; move camera.eye nearer, or give a larger scale"
        );
    }
    let offset = objects().find_map(|(i, object)| {
        let Offset { extend, bevel, .. } = object.offset;
        let keys = [
            ("extend", extend < 0.0),
            ("bevel", bevel > 0.0),
            ("extend", extend > 0.0),
        ];
        let key = keys.iter().find(|(_, given)| *given)?.0;
        Some(format!(
            "object.{i}.{key} leaves no surface in view; give a smaller one"
        ))
    });
    offset.unwrap_or("change camera.eye, camera.target, or the objects' position and scale".into())
}

/// Pixels across or down of an object's largest copy; infinite beside or behind the eye.
fn pixels(camera: &Camera, object: &Object, width: u32, height: u32) -> f64 {
    let bounds = object.profile.outline.bounds();
    let (Ok(camera), Some(bounds)) = (CameraFrame::new(camera, width, height), bounds) else {
        return f64::INFINITY;
    };
    let grown = (object.offset.extend + object.offset.bevel).max(0.0);
    let (wide, high) = (bounds.r_max + grown, bounds.z_max - bounds.z_min + grown);
    let of_copy = |p: &Placement| {
        let depth = (p.position - camera.eye).dot(camera.forward);
        let size = (p.scale * DVec3::new(2.0 * wide, 2.0 * wide, high))
            .abs()
            .max_element();
        match depth > size {
            true => size / (depth * camera.right.length()),
            false => f64::INFINITY,
        }
    };
    object.placements().iter().map(of_copy).fold(0.0, f64::max)
}

/// Returns true if the offset leaves no surface within the box.
fn is_empty(object: &Object) -> bool {
    let source = ContourSource::new(&object.profile.outline);
    let contour = source.and_then(|source| source.contour(&object.offset));
    contour.is_ok_and(|contour| contour.chains.is_empty())
}

/// Returns true if a ball about any copy's box is at least partly in the picture.
fn is_in_view<'a>(
    camera: &Camera,
    mut objects: impl Iterator<Item = &'a Object>,
    width: u32,
    height: u32,
) -> bool {
    let Ok(camera) = CameraFrame::new(camera, width, height) else {
        return true;
    };
    // The four sides of the view, normals inwards.
    let (w, h) = (f64::from(width), f64::from(height));
    let corner = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(|(x, y)| camera.direction(x, y));
    let sides = [0, 1, 2, 3].map(|k| corner[k].cross(corner[(k + 1) % 4]).normalize_or_zero());
    objects.any(|object| {
        let grown = object.offset.extend.max(0.0) + object.offset.bevel;
        let radius = object.profile.radius + grown;
        let half = DVec3::new(radius, radius, 0.5 + grown);
        object.placements().iter().any(|p| {
            let middle = p.position + p.rotation * (p.scale * DVec3::new(0.0, 0.0, 0.5));
            let from = middle - camera.eye;
            let reach = (p.scale * half).length();
            from.dot(camera.forward) > -reach && sides.iter().all(|s| s.dot(from) > -reach)
        })
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use revmap::profile::Profile;
    use std::sync::Arc;

    fn scene() -> Scene {
        let points = [[0.0, 0.1], [0.3, 0.1], [0.0, 0.9]];
        let profile = Arc::new(Profile::polygon(&points, 0.5).unwrap());
        let mut scene = Scene::new(Camera::new(
            DVec3::new(2.0, 0.0, 0.5),
            DVec3::new(0.0, 0.0, 0.5),
        ));
        scene.objects.push(Object::new("cone", profile));
        scene
    }

    #[track_caller]
    fn warns(words: &str, change: impl Fn(&mut Scene)) {
        let mut scene = scene();
        assert!(warnings(&scene, 80, 60).is_empty());
        change(&mut scene);
        scene.check().unwrap();
        let found = warnings(&scene, 80, 60);
        assert!(found.len() == 1 && found[0].contains(words), "{found:?}");
    }

    #[test]
    fn what_looks_unintended_is_named() {
        warns(
            "camera.fov_y: is 0.7 degrees; if radians are meant, give 40.1",
            |s| s.camera.fov_y = 0.7,
        );
        warns("background", |s| s.background = [255.0, 0.0, 0.0, 1.0]);
        warns("object.0.color: has 200", |s| s.objects[0].color[1] = 200.0);
        warns("light.0.color", |s| s.lights[0].color = [255.0; 3]);
        warns("object.0.extend: the inset of 0.9 leaves nothing", |s| {
            s.objects[0].offset.extend = -0.9
        });
        // The other object is there, and the first is not asked for twice.
        let two = |s: &mut Scene, extend: f64| {
            s.objects.push(s.objects[0].clone());
            s.objects[1].offset.extend = extend;
        };
        warns("object.1.extend: the inset of 0.3", |s| two(s, -0.3));
        let mut small = scene();
        two(&mut small, -0.02);
        assert_eq!(warnings(&small, 80, 60), [""; 0]);
    }

    /// The cone's foot is 0.1 above its position, an eighth of its height.
    #[test]
    fn what_hovers_over_a_flat_face_is_named() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let table = Object::new("table", Arc::new(Profile::polygon(&square, 1.0).unwrap()));
        let gap = |gap: f64, aside: f64| {
            let mut scene = scene();
            scene.objects.insert(0, table.clone());
            scene.objects[0].placement.scale.z = 0.05;
            let place = &mut scene.objects[1].placement.position;
            (place.z, place.x) = (0.05 + 0.8 * gap - 0.1, aside);
            warnings(&scene, 80, 60)
        };
        for (part, words) in [
            (0.003, "object.1: hovers 0.3 %"),
            (0.04, "object.1: hovers 4.0 %"),
        ] {
            let found = gap(part, 0.5);
            assert!(found.len() == 1 && found[0].contains(words), "{found:?}");
        }
        // It stands, is in the table, is meant to float, or is beside the table.
        for (part, aside) in [
            (0.0, 0.0),
            (0.001, 0.0),
            (-0.03, 0.0),
            (0.08, 0.0),
            (0.03, 1.2),
        ] {
            assert_eq!(gap(part, aside), [""; 0], "{part} {aside}");
        }
    }

    #[test]
    fn a_blank_picture_has_a_reason() {
        let mut frame = Frame::new(80, 60, [0.0; 4]).unwrap();
        let mut tiny = scene();
        tiny.objects[0].placement.scale = DVec3::splat(1e-6);
        let mut inset = scene();
        inset.objects[0].offset.extend = -0.05;
        for (scene, words) in [
            (&tiny, "object.0 is 0.00 pixels large"),
            (&inset, "object.0.extend leaves no surface in view"),
            (&scene(), "change camera.eye"),
        ] {
            let found = blank(scene, &frame).unwrap();
            assert!(found.contains(words), "{found}");
        }
        // The scene's own warnings name the reason.
        inset.objects[0].offset.extend = -0.9;
        assert_eq!(blank(&inset, &frame), None);
        frame.color[7] = [0.0, 0.0, 0.0, 0.2];
        assert_eq!(blank(&tiny, &frame), None);
    }

    #[test]
    fn a_camera_that_looks_elsewhere_sees_nothing() {
        for target in [
            [4.0, 0.0, 0.5],
            [2.0, 1.0, 0.5],
            [2.1, 0.0, 5.0],
            [2.0, -1.0, -3.0],
        ] {
            warns("nothing is in view", |s| s.camera.target = target.into());
        }
        // The eye is within the solid's box, so every view direction counts. A solid at the
        // picture's edge counts.
        for (eye, target) in [
            ([0.1, 0.0, 0.5], [1.0, 0.2, 0.5]),
            ([2.0, 0.0, 0.5], [0.0, 1.0, 0.5]),
        ] {
            let mut seen = scene();
            (seen.camera.eye, seen.camera.target) = (eye.into(), target.into());
            assert_eq!(warnings(&seen, 80, 60), [""; 0]);
        }
    }
}
