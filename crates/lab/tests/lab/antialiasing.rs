//! The benchmark of anti-aliasing on a device, under the validation layers.

use revmap::gpu::Device;
use revmap::settings::DrawStage;
use revmap_lab::renderer::MethodDevice;
use revmap_lab::report::antialiasing::{Way, measure};
use revmap_lab::report::suite::Extent;

#[test]
fn four_samples_bring_meshes_closer_to_64_rays() {
    let device = Device::open_validated(None).unwrap();
    let stages = [DrawStage::Fragment, DrawStage::Compute];
    let methods = MethodDevice::new(device.clone()).unwrap();
    let (lines, _) = measure(&methods, &stages, Extent::One, 1, &|_, _| {}).unwrap();
    drop(methods);
    device.check().unwrap();
    for stage in stages {
        let drawn = lines.iter().filter(|line| line.stage == stage);
        let ways: Vec<Way> = drawn.map(|line| line.way).collect();
        assert_eq!(ways, Way::of(stage));
    }
    assert!(lines.iter().all(|line| line.ms > 0.0 && line.ratio > 0.0));
    let found = |way| lines.iter().find(|line| line.way == way).unwrap();
    let [one, four] = [Way::Mesh, Way::MeshMsaa].map(|way| found(way).own);
    println!("mesh: {one}, four samples: {four}");
    assert!(four < 0.8 * one, "{four} of {one}");
    assert!(found(Way::MeshMsaa).flip < found(Way::Mesh).flip);
    // Rays go through the middle of pixels all the same.
    let [one, four] = [Way::Rays(1), Way::Msaa].map(|way| found(way).flip);
    println!("one ray: {one}, four samples: {four}");
    assert!(four > 0.9 * one && four < 1.3 * one, "{four} of {one}");
}
