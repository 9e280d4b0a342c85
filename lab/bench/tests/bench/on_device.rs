//! Benchmarks of anti-aliasing and of a flight on a device, under the validation layers.

use revmap::gpu::Device;
use revmap::settings::{DrawStage, Tolerance};
use revmap_bench::measure::device::DeviceBench;
use revmap_bench::measure::row::Row;
use revmap_bench::measure::{Observer, measure};
use revmap_bench::plan::Overrides;
use revmap_bench::plan::method::Edges;
use revmap_bench::plan::method::renderer::MethodDevice;
use revmap_bench::report::flight::{self, FlightTimes};
use revmap_bench::report::pictures::Sheets;
use revmap_bench::report::plan_file::{Flight, embedded};
use std::sync::atomic::AtomicBool;

#[test]
fn four_samples_bring_edges_closer_to_64_rays() {
    let device = Device::open_validated(None).unwrap();
    let given = Overrides {
        quick: true,
        passes: Some(1),
        rounds: Some(1),
        ..Overrides::default()
    };
    let mut file = embedded::plan("antialiasing").unwrap();
    file.apply(&given);
    let plan = file.plan(&given).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut sheets = Sheets::new(folder.path());
    let mut bench = DeviceBench::new(device.clone(), false).unwrap();
    let mut observer = Observer {
        stop: &AtomicBool::new(false),
        progress: &|_, _, _| {},
        picture: &mut |seen| sheets.add(seen),
        passed: &mut |_| Ok(()),
    };
    let rows = measure(&plan, &mut bench, &file.time, &mut observer)
        .unwrap()
        .rows;
    sheets.finish().unwrap();
    drop(bench);
    device.check().unwrap();
    let edges = |stage| -> Vec<String> {
        let own = rows.iter().filter(|r| r.settings.stage == stage);
        own.map(|r| r.settings.edges.name()).collect()
    };
    let search = ["1 ray", "silhouettes", "4 rays", "16 rays"];
    assert_eq!(edges(DrawStage::Compute), search);
    assert_eq!(
        edges(DrawStage::Fragment),
        [&search[..], &["MSAA 4", "1 ray", "MSAA 4"]].concat()
    );
    assert!(rows.iter().all(|r| r.time().is_some_and(|t| t.value > 0.0)));
    for stage in ["fragment", "compute"] {
        let file = format!("antialiasing-vase-{stage}.png");
        assert!(folder.path().join(&file).exists(), "{file}");
    }
    let found = |mesh, edges| -> &Row {
        let own = |r: &&Row| r.settings.method.is_mesh() == mesh && r.settings.edges == edges;
        rows.iter().find(own).unwrap()
    };
    let [one, four] = [Edges::OneRay, Edges::Msaa].map(|edges| found(true, edges));
    let own = |row: &Row| row.flip_own.unwrap();
    println!("mesh: {}, four samples: {}", own(one), own(four));
    assert!(own(four) < 0.8 * own(one));
    assert!(four.errors.flip < one.errors.flip);
    // Solids have a ray for each sample.
    let flip = |edges| found(false, edges).errors.flip.unwrap();
    let [one, four] = [Edges::OneRay, Edges::Msaa].map(flip);
    println!("one ray: {one}, four samples: {four}");
    assert!(four < 0.6 * one, "{four} of {one}");
}

fn flight(
    device: &MethodDevice,
    stage: DrawStage,
    tolerance: f64,
    copies_move: bool,
) -> FlightTimes {
    let mut settings = flight::settings(stage).sized(160, 90);
    settings.tolerance = Tolerance::new(tolerance).unwrap();
    let plan = Flight {
        copies: 1600,
        frames: 6,
        compared: 3,
        copies_move,
    };
    flight::fly(device, &settings, &plan).unwrap()
}

#[test]
fn flights_time_each_frame_and_hold_their_tolerance() {
    let device = Device::open_validated(None).unwrap();
    let methods = MethodDevice::new(device.clone()).unwrap();
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let fine = flight(&methods, stage, 0.25, false);
        assert_eq!((fine.times.len(), fine.errors.len()), (6, 2));
        assert!(fine.errors.iter().all(|(_, e)| e.pixels > 1000));
        let worst = fine.worst();
        assert!(worst.into_iter().all(|e| e <= 0.25), "{worst:?}");
        let [median, slowest] = fine.frame_ms();
        assert!(0.0 < median && median <= slowest);
        assert_eq!(fine.table().records.len(), 6);
        // A tolerance of many pixels must show, or nothing would be compared.
        let coarse = flight(&methods, stage, 60.0, false);
        assert!(coarse.worst()[0] > fine.worst()[0], "{:?}", coarse.worst());
        let moving = flight(&methods, stage, 0.25, true);
        assert!(moving.worst().into_iter().all(|e| e <= 0.25));
        assert_ne!(moving.errors[0].1.pixels, moving.errors[1].1.pixels);
    }
    device.check().unwrap();
}
