//! Device memory of a host whose surfaces change in every frame.

use crate::common::host::{Stage, frame, opened};
use crate::common::prelude::*;
use crate::embedding::{options, renderer};

fn crowd_member(n: u32, profiles: &[Arc<Profile>]) -> Object {
    let mut object = Object::new("one", profiles[n as usize % profiles.len()].clone());
    let (x, y) = (f64::from(n % 12), f64::from(n / 12 % 10));
    object.placement = placement([0.5 * x - 3.0, 0.5 * y - 2.5, 0.0], [0.0; 3], [0.4; 3]);
    object.color = [0.2 + 0.05 * (n % 10) as f32, 0.5, 0.3];
    object
}

/// Device memory after two thousand frames equals that after a hundred, although every frame builds
/// surfaces.
#[test]
fn memory_stays_flat() {
    let (host, device) = opened();
    let options = options().with(|o| (o.width, o.height) = (32, 24));
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
    for n in 0..2000u32 {
        let extend = 0.01 + 1e-6 * f64::from(n);
        let id = ids[n as usize % 2];
        few.set_offset(id, offset(extend, 0.0, 1.0)).unwrap();
        frame(&mut stage, &mut few, &view, DMat4::IDENTITY, &[]);
        if n == 100 {
            early = Some(taken());
        }
    }
    assert_eq!(early, Some(taken()));
    assert_eq!(few.rebuild_count(), 2001);
    stage.wait().unwrap();
}
