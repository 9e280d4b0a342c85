//! CPU time of frames, summed over all of a software driver's threads: `cargo run --release --example cpu_time -- [--close] [--stage fragment|compute] [--view NAME ...] [--crowd COPIES] [--distant] [METHOD ...]`
//!
//! The clock tells how long a frame takes; this tells how much work it is, and it is steadier on a machine that does other things beside.
//! Every solid that the program carries, at 25 degrees, 800x600 (`--close`: so near that it fills the picture); searches are drawn in turn, and ratios are to
//! the RBM baseline. `--crowd` and `--distant` draw copies at the default tolerance; `revmap bench --crowds` has the CPU's part of a new view.
//! `--count N` draws N frames by the last method and prints nothing, for `perf stat`. Linux alone: it reads `/proc/self/task`.

use revmap::gpu::Device;
use revmap::settings::{DrawStage, Planes, Solver};
use revmap_lab::method::{Method, MethodSettings};
use revmap_lab::renderer::MethodDevice;
use revmap_lab::report::flight;
use revmap_lab::report::plan::suite::{Extent, views};
use revmap_lab::report::plan::{army, distant, plain, rbm_baseline};
use std::time::Instant;

const ROUNDS: usize = 8;
/// As many frames are timed at once.
const LEAST_MS: f64 = 60.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut stage, mut close, mut counted) = (DrawStage::Fragment, false, None);
    let (mut only, mut methods, mut crowds) = (Vec::new(), Vec::new(), Vec::new());
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--close" => close = true,
            "--count" => counted = Some(args.next().unwrap_or_default().parse::<u32>()?),
            "--view" => only.extend(args.next()),
            "--crowd" => crowds.push(army(args.next().unwrap_or_default().parse()?)?),
            "--distant" => crowds.push(distant()?),
            "--stage" if args.next().as_deref() == Some("compute") => stage = DrawStage::Compute,
            "--stage" => {}
            name => methods.push(name.parse::<Method>()?),
        }
    }
    if methods.is_empty() {
        methods = [Solver::Exact, Solver::Quadric, Solver::Live]
            .map(Method::from)
            .to_vec();
    }
    let device = Device::open(None)?;
    println!("{}, {stage:?} stage", device.report().name);
    let device = MethodDevice::new(device)?;
    let mut sums = vec![0.0; methods.len()];
    let mut views = if crowds.is_empty() {
        views(&Extent::ALL, &[25.0])?
    } else {
        crowds
    };
    views.retain(|view| only.is_empty() || only.contains(&view.name));
    let count = views.len() as f64;
    for mut view in views {
        view.scene.background = [0.0; 4];
        if close {
            view.scene.camera.fov_y *= 0.45;
        }
        let settings = if view.solids() > 1 {
            flight::settings(stage)
        } else {
            let settings = MethodSettings::default().in_stage(stage);
            settings.storing(Planes::Color)
        };
        let mut ways = vec![rbm_baseline(&view, &settings)];
        ways.extend(methods.iter().map(|&method| MethodSettings {
            tolerance: settings.tolerance,
            ..plain(&settings, method)
        }));
        let mut drawn = Vec::new();
        for way in &ways {
            let mut renderer = device.renderer(&view.scene, way)?;
            for _ in 0..3 {
                renderer.draw()?;
            }
            let start = Instant::now();
            renderer.draw()?;
            let frames = (LEAST_MS / (start.elapsed().as_secs_f64() * 1e3)).ceil() as usize;
            drawn.push((renderer, frames.clamp(4, 400), Vec::new(), Vec::new()));
        }
        if let Some(count) = counted {
            let renderer = &mut drawn.last_mut().ok_or("no method")?.0;
            for _ in 0..count {
                renderer.draw()?;
            }
            continue;
        }
        for _ in 0..ROUNDS {
            for (renderer, frames, cpu, wall) in &mut drawn {
                let (start, clock) = (cpu_ms()?, Instant::now());
                for _ in 0..*frames {
                    renderer.draw()?;
                }
                cpu.push((cpu_ms()? - start) / *frames as f64);
                wall.push(clock.elapsed().as_secs_f64() * 1e3 / *frames as f64);
            }
        }
        let frame = drawn[1].0.read()?;
        let hit = frame.color.iter().filter(|p| p[3] > 0.0).count();
        let papers = median(&mut drawn[0].2);
        print!(
            "{:<10} {hit:>7} pixels, RBM baseline {papers:6.2} ms",
            view.name
        );
        for (k, (_, _, cpu, wall)) in drawn[1..].iter_mut().enumerate() {
            let (ms, clock) = (median(cpu), median(wall));
            print!(
                "   {} {ms:6.2} ms ({clock:5.2} by the clock) {:.2}",
                methods[k],
                ms / papers
            );
            sums[k] += (ms / papers).ln() / count;
        }
        println!();
    }
    for (method, sum) in methods.iter().zip(&sums) {
        println!(
            "{method}: {:.3} of the RBM baseline (geometric mean)",
            sum.exp()
        );
    }
    Ok(())
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Time that all threads were running so far.
fn cpu_ms() -> Result<f64, Box<dyn std::error::Error>> {
    let mut nanoseconds = 0.0;
    for task in std::fs::read_dir("/proc/self/task")? {
        let text = std::fs::read_to_string(task?.path().join("schedstat"))?;
        nanoseconds += text.split(' ').next().ok_or("no fields")?.parse::<f64>()?;
    }
    Ok(nanoseconds / 1e6)
}
