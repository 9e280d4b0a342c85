//! A host whose objects come and go while frames are in flight.

use crate::common::host::{Options, Stage, borrow, frame, open};
use crate::common::{offset, placement, shapes};
use crate::embedding::{options, renderer};
use glam::{DMat4, DVec3};
use revmap::gpu::{ObjectId, View};
use revmap::profile::Profile;
use revmap::scene::{Camera, Object, Offset};
use std::sync::Arc;

fn crowd_member(n: u32, profiles: &[Arc<Profile>]) -> Object {
    let mut object = Object::new("one", profiles[n as usize % profiles.len()].clone());
    let (x, y) = (f64::from(n % 12), f64::from(n / 12 % 10));
    object.placement = placement([0.5 * x - 3.0, 0.5 * y - 2.5, 0.0], [0.0; 3], [0.4; 3]);
    object.color = [0.2 + 0.05 * (n % 10) as f32, 0.5, 0.3];
    object
}

/// A thousand objects come and go over 500 frames, two in flight. The remaining objects are drawn
/// like those of a new renderer.
#[test]
fn objects_come_and_go_between_frames() {
    let host = open();
    let device = borrow(&host);
    let profiles = [shapes::vase(), shapes::sphere(), shapes::glass()].map(Arc::new);
    let options = Options {
        width: 160,
        height: 120,
        ..options()
    };
    let view = View::from_camera(
        &Camera::new(DVec3::new(6.0, 0.0, 5.0), DVec3::ZERO),
        (options.width, options.height),
        [0.5, 50.0],
    )
    .unwrap();
    let mut stage = Stage::new(&host, options).unwrap();
    let mut crowd = renderer(&device, &stage);
    let mut there: Vec<(ObjectId, u32)> = Vec::new();
    let mut added = 0;
    for n in 0..500u32 {
        for _ in 0..2 {
            there.push((crowd.add(crowd_member(added, &profiles)).unwrap(), added));
            added += 1;
        }
        while there.len() > 60 {
            let (id, _) = there.remove((n as usize * 7) % there.len());
            crowd.remove(id).unwrap();
            // A removed object stays removed.
            assert!(crowd.remove(id).is_err());
        }
        let (id, _) = there[n as usize % there.len()];
        let extend = 0.01 * f64::from(n % 4);
        crowd.set_offset(id, offset(extend, 0.0, 1.0)).unwrap();
        frame(&mut stage, &mut crowd, &view, DMat4::IDENTITY, &[]);
    }
    assert_eq!(added, 1000);
    for (id, _) in &there {
        crowd.set_offset(*id, Offset::default()).unwrap();
    }
    for _ in 0..2 {
        frame(&mut stage, &mut crowd, &view, DMat4::IDENTITY, &[]);
    }
    let kept = stage.read().unwrap().0;
    let mut fresh = renderer(&device, &stage);
    for (_, n) in &there {
        fresh.add(crowd_member(*n, &profiles)).unwrap();
    }
    frame(&mut stage, &mut fresh, &view, DMat4::IDENTITY, &[]);
    let wanted = stage.read().unwrap().0;
    assert!(kept == wanted, "what is left differs from new objects");
    assert!(wanted.chunks_exact(4).filter(|p| p[1] > 150).count() > 500);
}

/// Device memory after ten thousand frames equals that after a hundred, although every frame builds
/// surfaces.
#[test]
fn memory_stays_flat() {
    let host = open();
    let device = borrow(&host);
    let options = Options {
        width: 32,
        height: 24,
        ..options()
    };
    let mut stage = Stage::new(&host, options).unwrap();
    let mut few = renderer(&device, &stage);
    let profiles = [shapes::sphere()].map(Arc::new);
    let ids: Vec<_> = (0..2)
        .map(|n| few.add(crowd_member(n, &profiles)).unwrap())
        .collect();
    let camera = Camera::new(DVec3::new(1.0, 1.0, 3.0), DVec3::new(-3.0, -2.5, 0.0));
    let size = (options.width, options.height);
    let view = View::from_camera(&camera, size, [0.1, 50.0]).unwrap();
    let taken = || {
        let allocator = device.allocator().unwrap();
        let report = allocator.lock().unwrap().generate_report();
        (report.total_allocated_bytes, report.total_capacity_bytes)
    };
    let mut early = None;
    for n in 0..10_000u32 {
        let extend = 0.01 + 1e-6 * f64::from(n);
        let id = ids[n as usize % 2];
        few.set_offset(id, offset(extend, 0.0, 1.0)).unwrap();
        frame(&mut stage, &mut few, &view, DMat4::IDENTITY, &[]);
        if n == 100 {
            early = Some(taken());
        }
    }
    assert_eq!(early, Some(taken()));
    assert_eq!(few.rebuild_count(), 10_001);
    stage.wait().unwrap();
}
