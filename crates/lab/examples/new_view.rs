use revmap::gpu::Device;
use revmap::settings::DrawStage;
use revmap_lab::renderer::MethodDevice;
use revmap_lab::report::flight;
use revmap_lab::report::plan::{army, flight_camera};
use std::time::Instant;

fn cpu_ms() -> f64 {
    let mut t = libc_time();
    t.drain(..).sum::<f64>()
}
fn libc_time() -> Vec<f64> {
    std::fs::read_dir("/proc/self/task").unwrap().filter_map(|e| {
        let p = e.ok()?.path().join("schedstat");
        let s = std::fs::read_to_string(p).ok()?;
        Some(s.split_whitespace().next()?.parse::<f64>().ok()? / 1e6)
    }).collect()
}

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let count: u32 = args[1].parse().unwrap();
    let stage = if args[2] == "compute" { DrawStage::Compute } else { DrawStage::Fragment };
    let frames: usize = args[3].parse().unwrap();
    let draws = args.get(4).is_some();
    let device = MethodDevice::new(Device::open(None).unwrap()).unwrap();
    let mut scene = army(count).unwrap().scene;
    let mut renderer = device.renderer(&scene, &flight::settings(stage)).unwrap();
    renderer.draw().unwrap();
    let (mut up, mut upc, mut prep, mut gpu) = (vec![], vec![], vec![], vec![]);
    for f in 0..frames {
        scene.camera = flight_camera(f as f64 / frames as f64);
        let (a, c) = (Instant::now(), cpu_ms());
        renderer.update(&scene).unwrap();
        upc.push(cpu_ms() - c);
        up.push(a.elapsed().as_secs_f64() * 1e3);
        if draws {
            let c = cpu_ms();
            let t = renderer.draw().unwrap();
            gpu.push(cpu_ms() - c);
            prep.push(t.prepare_ms);
        }
    }
    let med = |v: &mut Vec<f64>| { v.sort_by(f64::total_cmp); v.get(v.len() / 2).copied().unwrap_or(0.0) };
    println!("{count} {stage:?}: update {:.1} ms wall, {:.1} ms cpu; draw prepare {:.1} ms wall, draw all {:.1} ms cpu", med(&mut up), med(&mut upc), med(&mut prep), med(&mut gpu));
}
