//! A flight through a crowd: every frame is timed, and pictures stay within their tolerance.

use revmap::gpu::Device;
use revmap::settings::{DrawStage, Tolerance};
use revmap_lab::method::MethodSettings;
use revmap_lab::renderer::MethodDevice;
use revmap_lab::report::flight::{self, FlightTimes};

fn flight(device: &MethodDevice, stage: DrawStage, tolerance: f64) -> FlightTimes {
    let settings = MethodSettings {
        width: 160,
        height: 90,
        tolerance: Tolerance::new(tolerance).unwrap(),
        ..flight::settings(stage)
    };
    flight::fly(device, &settings, 1600, 6, 3).unwrap()
}

#[test]
fn flights_time_each_frame_and_hold_their_tolerance() {
    let device = Device::open_validated(None).unwrap();
    let methods = MethodDevice::new(device.clone()).unwrap();
    for stage in [DrawStage::Fragment, DrawStage::Compute] {
        let fine = flight(&methods, stage, 0.25);
        assert_eq!((fine.times.len(), fine.errors.len()), (6, 2));
        assert!(fine.errors.iter().all(|(_, e)| e.pixels > 1000));
        assert!(
            fine.worst().into_iter().all(|e| e <= 0.25),
            "{:?}",
            fine.worst()
        );
        let [median, slowest] = fine.frame_ms();
        assert!(0.0 < median && median <= slowest);
        assert_eq!(fine.table().records.len(), 6);
        // A tolerance of many pixels must show, or nothing would be compared.
        let coarse = flight(&methods, stage, 60.0);
        assert!(coarse.worst()[0] > fine.worst()[0], "{:?}", coarse.worst());
    }
    device.check().unwrap();
}
