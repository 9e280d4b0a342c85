//! Renderers of many objects. The random host (`tests/soak`) prepares several views at a time,
//! changes objects after `prepare` and records old tokens.

use crate::common::host::{opened, renderer_of, view_of};
use crate::common::prelude::*;
use crate::embedding::{first_frame, options};

/// Twenty thousand objects use ten times the device memory of two thousand, and can be removed.
#[test]
fn objects_by_the_ten_thousand() {
    let (host, device) = opened();
    let profiles = [shapes::vase(), shapes::sphere(), shapes::glass()].map(Arc::new);
    let object = |n: u32| {
        let mut object = Object::new("one", profiles[n as usize % profiles.len()].clone());
        let (x, y) = (f64::from(n % 150), f64::from(n / 150));
        object.placement = placement([0.1 * x - 7.5, 0.1 * y - 6.5, 0.0], [0.0; 3], [0.1; 3]);
        object
    };
    let empty = scene_of(shapes::vase(), eye(25.0, 3.0)).with(|s| s.objects = Vec::new());
    let view = view_of(&empty, &options());
    let bytes = |count: u32| {
        let output = Output::Compute(Planes::Color);
        let mut renderer = renderer_of(&device, output, &SearchSettings::exact(), 1, &empty);
        let draw = |renderer: &mut Renderer| {
            first_frame(&host, options(), None, (renderer, &view), None);
        };
        let ids: Vec<_> = (0..count)
            .map(|n| renderer.add(object(n)).unwrap())
            .collect();
        draw(&mut renderer);
        let bytes = device.memory_use().total();
        for id in ids.iter().step_by(20) {
            renderer.remove(*id).unwrap();
        }
        assert_eq!(renderer.object_count(), ids.len() - ids.len() / 20);
        draw(&mut renderer);
        bytes
    };
    let (few, many) = (bytes(2_000), bytes(20_000));
    println!("{few} and {many} bytes");
    assert!(many < 14 * few);
}
