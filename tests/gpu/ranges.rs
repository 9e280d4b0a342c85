//! Ranges of instances and of tables on a device of small storage buffers: everything that fits is
//! drawn, what does not is refused, and memory is used again.
#![allow(unsafe_code)]

use crate::calls::Layer;
use crate::common::host::{Checked, Drawn, Picture, once, open, opened, view_of};
use crate::common::prelude::*;
use crate::embedding::{options, three};

/// Bytes of the device's largest storage buffer.
const STORAGE: u32 = 1 << 20;
const MOST: usize = STORAGE as usize / INSTANCE_BYTES as usize;

/// The layer, the host and the device of small buffers.
fn small() -> (Layer, Checked, Device) {
    let (layer, host) = (Layer::take(), open());
    let small = |p: &mut vk::PhysicalDeviceProperties| p.limits.max_storage_buffer_range = STORAGE;
    let device = layer.poorer(&host, |m| m.properties = Some(small)).unwrap();
    (layer, host, device)
}

fn renderer<'a>(host: &'a Checked, device: &Device, scene: &Scene) -> Drawn<'a> {
    let by = (Output::Compute(Planes::Color), &SearchSettings::exact());
    let seen = view_of(&three(), &options());
    Drawn::new(host, device, options(), by, scene).seen(&seen)
}

/// A frame, and its statistics.
fn draw(drawn: &mut Drawn) -> revmap::Result<(Picture, FrameStatistics)> {
    let frame = once(drawn.host, |cmd| drawn.record(cmd, (0, 1), None))?;
    Ok((drawn.canvas.read(), frame.statistics()))
}

/// Small copies beside the three solids.
fn copies(count: usize) -> Vec<Placement> {
    let place = |n: usize| {
        let (x, y) = ((n / 100) as f64, (n % 100) as f64);
        scaled([-0.02 * x - 1.0, 0.03 * y - 1.5, 0.0], 0.02)
    };
    (0..count).map(place).collect()
}

fn crowd(count: usize) -> Object {
    let mut object = three().objects[1].clone();
    object.instances = copies(count).into();
    object
}

#[test]
fn a_renderer_recovers_from_too_many_copies() {
    let (_layer, host, device) = small();
    let mut drawn = renderer(&host, &device, &three());
    let (wanted, before) = draw(&mut drawn).unwrap();
    // The message names the object.
    let refused = |result: revmap::Result<()>| {
        let error = result.unwrap_err();
        assert_eq!(error.kind, ErrorKind::TooLarge, "{error}");
        assert_eq!(error.key.as_deref(), Some("object.3.instances"), "{error}");
        let named = [&MOST.to_string(), "ball"].map(|name| error.message.contains(name));
        assert_eq!(named, [true; 2], "{error}");
    };
    refused(drawn.renderer.add(crowd(MOST - 2)).map(|_| ()));
    let id = drawn.renderer.add(crowd(9)).unwrap();
    refused(drawn.renderer.set_instances(id, copies(MOST - 2)));
    refused(drawn.renderer.set(id, crowd(4 * MOST)));
    assert_eq!(drawn.renderer.object(id).unwrap().placements().len(), 9);
    // As many as there is room for, then the picture without them, in as little memory.
    drawn.renderer.set_instances(id, copies(MOST - 3)).unwrap();
    let (full, most) = draw(&mut drawn).unwrap();
    assert!(full != wanted && most.slot_bytes > 10 * before.slot_bytes);
    drawn.renderer.set_instances(id, copies(9)).unwrap();
    let mut fresh = renderer(&host, &device, &three());
    fresh.renderer.add(crowd(9)).unwrap();
    assert!(draw(&mut drawn).unwrap().0 == draw(&mut fresh).unwrap().0);
    drawn.renderer.remove(id).unwrap();
    let (found, after) = draw(&mut drawn).unwrap();
    assert!(found == wanted);
    let [after, before] = [after, before].map(|frame| frame.slot_bytes);
    assert!(after < 8 * before, "{after}, {before}");
}

#[test]
fn objects_are_added_beside_a_large_crowd() {
    let (_layer, host, device) = small();
    let mut drawn = renderer(&host, &device, &three());
    drawn.renderer.add(crowd(MOST - 503)).unwrap();
    draw(&mut drawn).unwrap();
    let profile = three().objects[0].profile.clone();
    let small = |n: usize| {
        let mut object = Object::new(format!("small {n}"), profile.clone());
        object.placement = copies(n + 1)[n];
        object
    };
    let ids: Vec<_> = (0..500)
        .map(|n| drawn.renderer.add(small(n)).unwrap())
        .collect();
    assert!(drawn.renderer.add(small(500)).is_err());
    draw(&mut drawn).unwrap();
    // Every other one goes: the rest is no single range, and crowds fit nevertheless.
    for id in ids.iter().step_by(2) {
        drawn.renderer.remove(*id).unwrap();
    }
    for _ in 0..5 {
        drawn.renderer.add(crowd(50)).unwrap();
    }
    assert!(drawn.renderer.add(small(500)).is_err());
    let mut fresh = renderer(&host, &device, &three());
    fresh.renderer.add(crowd(MOST - 503)).unwrap();
    for n in (1..500).step_by(2) {
        fresh.renderer.add(small(n)).unwrap();
    }
    for _ in 0..5 {
        fresh.renderer.add(crowd(50)).unwrap();
    }
    assert!(draw(&mut drawn).unwrap().0 == draw(&mut fresh).unwrap().0);
}

/// Of coincident copies the one of the earlier object shows, wherever its instances are.
#[test]
fn ties_do_not_depend_on_ranges() {
    let (host, device) = opened();
    let object = |color| three().objects[0].clone().with(|o| o.color = color);
    let (first, second) = (object([0.9, 0.1, 0.1]), object([0.1, 0.1, 0.9]));
    let empty = three().with(|s| s.objects = Vec::new());
    let mut fresh = renderer(&host, &device, &empty);
    fresh.renderer.add(first.clone()).unwrap();
    fresh.renderer.add(second.clone()).unwrap();
    let wanted = draw(&mut fresh).unwrap().0;
    let mut drawn = renderer(&host, &device, &empty);
    // The second object takes the instance that a removed one leaves.
    let gone = drawn.renderer.add(first.clone()).unwrap();
    drawn.renderer.add(first).unwrap();
    drawn.renderer.remove(gone).unwrap();
    drawn.renderer.add(second).unwrap();
    assert!(draw(&mut drawn).unwrap().0 == wanted);
}

/// Tables fill nine tenths of the buffer before one is refused, and the place of those that are gone
/// is used again.
#[test]
fn tables_fill_their_buffer() {
    let (_layer, host, device) = small();
    let mut drawn = renderer(&host, &device, &three());
    let other = |n: usize| {
        let side = 0.2 + 0.3 / (n + 1) as f64;
        let radii = [0.0, side, 0.5 * side, side, 0.0].into_iter();
        let points: Vec<_> = radii
            .zip([0.0, 0.2, 0.6, 0.8, 1.0])
            .map(<[f64; 2]>::from)
            .collect();
        let mut object = Object::new("other", Arc::new(Profile::polygon(&points, 0.5).unwrap()));
        object.placement = copies(n + 1)[n];
        object
    };
    let mut ids = Vec::new();
    let mut refused = None;
    for n in 0..2000 {
        ids.push(drawn.renderer.add(other(n)).unwrap());
        if n % 20 == 19
            && let Err(error) = draw(&mut drawn)
        {
            refused = Some(error);
            break;
        }
    }
    let error = refused.expect("tables beyond the limit");
    assert_eq!(error.kind, ErrorKind::TooLarge, "{error}");
    // Those of the last frame that was drawn, each alone.
    let costs = drawn.renderer.object_costs();
    let tables: u64 = costs.iter().map(|cost| cost.table_bytes).sum();
    println!("{} objects, {tables} bytes of tables", ids.len());
    assert!(tables > u64::from(STORAGE) * 17 / 20, "{tables}");
    for id in ids.drain(40..) {
        drawn.renderer.remove(id).unwrap();
    }
    for n in 0..100 {
        ids.push(drawn.renderer.add(other(3000 + n)).unwrap());
    }
    draw(&mut drawn).unwrap();
}
