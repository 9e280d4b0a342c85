//! The error of a map by itself: the surface of its bilinear distances, found on the CPU, against
//! the truth. Along a ray the map's `F = D - w` is read closely, and the first change of sign is
//! halved to the last digit. What a drawn picture errs beyond this is the search's share.

use super::plan::Plan;
use crate::compare::{CompareOptions, Comparison, compare};
use crate::method::MethodSettings;
use glam::DVec3;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::maps::{BakeOptions, MapSource, ShapeMap};
use revmap::scene::{CameraFrame, Object, Placement, Scene};
use revmap_reference as reference;

/// The error of a view's maps.
#[derive(Clone, Debug, PartialEq)]
pub struct MapError {
    /// Index of the view.
    pub view: usize,
    /// Source of the distances.
    pub source: MapSource,
    /// Rows of the map.
    pub rows: u32,
    /// Against the truth.
    pub errors: Comparison,
}

/// Samples along a ray are at most this many texels apart where the surface is near.
const STRIDE: f64 = 0.25;

/// Distances of the reference, which is slow: no picture is drawn with it twice.
#[derive(Clone, Debug, Default)]
pub struct Truths {
    known: Vec<(usize, (u32, u32), Vec<f32>)>,
}

impl Truths {
    /// Keeps what should be seen of a picture.
    pub fn keep(&mut self, view: usize, truth: &Frame) {
        let size = (truth.width, truth.height);
        if self.find(view, size).is_none() {
            self.known.push((view, size, truth.distance.clone()));
        }
    }

    fn find(&self, view: usize, size: (u32, u32)) -> Option<&Vec<f32>> {
        let same = |known: &&(usize, (u32, u32), Vec<f32>)| (known.0, known.1) == (view, size);
        self.known.iter().find(same).map(|known| &known.2)
    }

    /// The frame of a view, of which distances alone are true.
    fn frame(&self, view: usize, seen: &Scene, settings: &MethodSettings) -> Result<Frame> {
        let (width, height) = (settings.width, settings.height);
        match self.find(view, (width, height)) {
            Some(distance) => {
                let mut frame = Frame::new(width, height, seen.background)?;
                frame.distance.clone_from(distance);
                Ok(frame)
            }
            None => reference::draw(seen, &settings.into(), &|_, _| {}),
        }
    }
}

/// Measures the maps that a plan sweeps over, for views of solids without repetition; the reference
/// is drawn where `truths` has none. Of the errors depth and wrong pixels count: colours and
/// normals are not compared. `progress` is told what is done and how much there is.
pub fn measure(
    plan: &Plan,
    size: (u32, u32),
    truths: &Truths,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Vec<MapError>> {
    let mut wanted: Vec<(usize, MapSource, u32)> = Vec::new();
    for case in &plan.cases {
        if let (Some(source), Some(rows)) = (case.settings.map_source, case.settings.map_rows) {
            let mut objects = plan.views[case.view].scene.objects.iter();
            let simple = objects.all(|o| o.repeat == [1; 3] && o.axis == [0.5; 2]);
            let one = (case.view, source, rows);
            if simple && !wanted.contains(&one) {
                wanted.push(one);
            }
        }
    }
    let mut all = Vec::new();
    let mut truth: Option<(usize, Frame)> = None;
    let settings = MethodSettings::default().sized(size.0, size.1);
    for (number, &(view, source, rows)) in wanted.iter().enumerate() {
        progress(number, wanted.len());
        let seen = &plan.views[view];
        if truth.as_ref().is_none_or(|(known, _)| *known != view) {
            truth = Some((view, truths.frame(view, &seen.scene, &settings)?));
        }
        let Some((_, truth)) = &truth else { continue };
        let frame = draw(&seen.scene, size, source, rows)?;
        let options = CompareOptions::of(seen.texel());
        all.push(MapError {
            view,
            source,
            rows,
            errors: compare(truth, &frame, &options)?,
        });
    }
    Ok(all)
}

/// Draws the distances (no colours, no normals) of the surface that the maps hold.
pub fn draw(scene: &Scene, size: (u32, u32), source: MapSource, rows: u32) -> Result<Frame> {
    let mut maps = Vec::new();
    for object in &scene.objects {
        let widest =
            object.offset.extend.max(0.0) + object.offset.bevel.max(0.0) * object.offset.chamfer;
        let reach = object.profile.radius * std::f64::consts::SQRT_2 + widest;
        let options = BakeOptions {
            reach,
            ..BakeOptions::new(source, rows)
        };
        maps.push(ShapeMap::bake(&object.profile, &options)?);
    }
    let camera = CameraFrame::new(&scene.camera, size.0, size.1)?;
    let mut frame = Frame::new(size.0, size.1, scene.background)?;
    let rows = frame.distance.par_chunks_mut(size.0 as usize).enumerate();
    rows.for_each(|(j, row)| {
        for (i, distance) in row.iter_mut().enumerate() {
            let direction = camera.pixel(i as u32, j as u32);
            let hits = scene.objects.iter().zip(&maps).flat_map(|(object, map)| {
                let placements = object.placements().iter();
                placements.filter_map(|p| hit(object, map, p, (camera.eye, direction)))
            });
            let first = hits.fold(f64::INFINITY, f64::min);
            *distance = (first * direction.length()) as f32;
        }
    });
    Ok(frame)
}

/// The first point of the map's surface along a ray, from outside.
fn hit(
    object: &Object,
    map: &ShapeMap,
    placement: &Placement,
    (eye, direction): (DVec3, DVec3),
) -> Option<f64> {
    let back = placement.rotation.conjugate();
    let o = back * (eye - placement.position) / placement.scale;
    let v = back * direction / placement.scale;
    let radius = object.profile.radius;
    let low = DVec3::new(-radius, -radius, 0.0);
    let high = DVec3::new(radius, radius, 1.0);
    let (a, b) = ((low - o) / v, (high - o) / v);
    let start = a.min(b).max_element().max(0.0);
    let end = a.max(b).min_element();
    // Parallel to a face outside of it: 0 / 0 would let it pass.
    if start.is_nan() || end.is_nan() || start >= end {
        return None;
    }
    let offset = object.offset;
    let field = |t: f64| {
        let p = o + v * t;
        let w = offset.extend + offset.bevel * (1.0 - p.z).clamp(0.0, offset.chamfer.max(0.0));
        map.distance_at(p.x.hypot(p.y), p.z) - w
    };
    // Distances change by at most the way and a texel's interpolation; a bevel adds its slope.
    let slope = (std::f64::consts::SQRT_2 + offset.bevel.abs()) * v.length();
    let stride = STRIDE * map.texel() / v.length();
    let mut t = start;
    let mut value = field(t);
    if value <= 0.0 {
        return Some(start);
    }
    while t < end {
        let next = (t + (value / slope).max(stride)).min(end);
        let there = field(next);
        if there <= 0.0 {
            let (mut outside, mut inside) = (t, next);
            for _ in 0..50 {
                let middle = 0.5 * (outside + inside);
                if field(middle) > 0.0 {
                    outside = middle
                } else {
                    inside = middle
                }
            }
            return Some(inside);
        }
        t = next;
        value = there;
        if next >= end {
            break;
        }
    }
    None
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::view::View;
    use super::super::view::tests::spindle;
    use super::*;

    /// The errors of a map against the reference.
    fn error(view: &View, size: (u32, u32), source: MapSource, rows: u32) -> Comparison {
        let settings = MethodSettings::default().sized(size.0, size.1);
        let truth = reference::draw(&view.scene, &(&settings).into(), &|_, _| {});
        let frame = draw(&view.scene, size, source, rows).unwrap();
        let options = CompareOptions::of(view.texel());
        compare(&truth.unwrap(), &frame, &options).unwrap()
    }

    /// On straight flanks an exact map errs by next to nothing, a binary one by a third of a texel.
    #[test]
    fn errors_are_those_that_the_sources_are_known_for() {
        let view = spindle().framed(20.0);
        let error = |source, rows| error(&view, (120, 90), source, rows);
        let exact = error(MapSource::EXACT, 512);
        let p99 = exact.depth.unwrap().p99;
        assert!(exact.wrong() < 0.01 && p99 < 0.5, "{exact}");
        let [fine, coarse] = [512, 128].map(|rows| error(revmap_files::BINARY, rows));
        let rms = |errors: &Comparison| errors.depth.unwrap().rms;
        assert!(rms(&fine) > 2.0 * rms(&exact), "{fine}");
        assert!(rms(&coarse) > 2.0 * rms(&fine), "{coarse}");
    }

    #[test]
    fn offsets_and_placements_are_taken_over() {
        let mut view = spindle();
        let object = &mut view.scene.objects[0];
        object.offset.extend = 0.04;
        object.placement.scale = DVec3::new(1.3, 0.8, 1.1);
        object.placement.rotation = glam::DQuat::from_rotation_x(0.4);
        let errors = error(&view.framed(15.0), (100, 75), MapSource::EXACT, 512);
        let p99 = errors.depth.unwrap().p99;
        assert!(errors.wrong() < 0.02 && p99 < 1.0, "{errors}");
    }

    /// A planted truth is taken for the reference; without one the reference itself is drawn.
    #[test]
    fn truths_that_are_known_are_not_drawn_again() {
        let view = spindle().framed(20.0);
        let settings = MethodSettings {
            width: 40,
            height: 30,
            map_source: Some(MapSource::EXACT),
            map_rows: Some(64),
            ..MethodSettings::default()
        };
        let mut plan = Plan::new(vec![view]);
        plan.add(0, settings, "");
        let wrong = |truths: &Truths| {
            let measured = measure(&plan, (40, 30), truths, &mut |_, _| {});
            measured.unwrap()[0].errors.wrong()
        };
        assert!(wrong(&Truths::default()) < 0.1);
        let mut planted = Truths::default();
        planted.keep(0, &Frame::new(40, 30, [0.0; 4]).unwrap());
        assert!(wrong(&planted) > 10.0, "nothing is hit there");
        // The first that is kept stays; another size is another picture.
        let mut other = Truths::default();
        other.keep(0, &Frame::new(80, 60, [0.0; 4]).unwrap());
        assert!(wrong(&other) < 0.1);
    }
}
