//! What the planes of a pass cost: milliseconds of a frame with each list of planes, and the ratio
//! to colour alone, in rounds one after the other. `cargo bench --bench outputs`.
#![allow(unsafe_code, clippy::unwrap_used)]

#[path = "../tests/common/host.rs"]
#[allow(unused_imports)]
mod host;

use ash::vk;
use glam::DVec3;
use host::attachments::Attachments;
use host::{Host, Options, borrow, dynamic, open_unchecked};
use revmap::gpu::{Device, Output, PassFormats, Renderer, SlopeBias, View};
use revmap::scene::Camera;
use revmap::settings::{Plane, PlaneList, Planes, SearchSettings};
use std::time::Instant;

const OPTIONS: Options = Options {
    width: 800,
    height: 600,
    dynamic: true,
    samples: 1,
    reversed: false,
};
const ROUNDS: usize = 41;

/// Formats as an engine would take them.
const fn format(plane: Plane) -> (vk::Format, usize) {
    match plane {
        Plane::Color => (vk::Format::R16G16B16A16_SFLOAT, 8),
        Plane::BaseColor => (vk::Format::R8G8B8A8_SRGB, 4),
        Plane::Normal => (vk::Format::R16G16B16A16_SFLOAT, 8),
        Plane::OctahedralNormal | Plane::Motion => (vk::Format::R16G16_SFLOAT, 4),
        Plane::Material => (vk::Format::R8G8_UNORM, 2),
        Plane::Identity => (vk::Format::R32G32_UINT, 8),
    }
}

/// A renderer, its attachments, and the milliseconds of its frames.
struct Case<'a> {
    name: String,
    renderer: Renderer,
    into: Attachments<'a>,
    colors: usize,
    times: Vec<f64>,
}

impl<'a> Case<'a> {
    fn new(
        host: &'a Host,
        device: &Device,
        scene: &revmap::scene::Scene,
        planes: Planes,
        slope_bias: SlopeBias,
    ) -> Self {
        let list = match planes {
            Planes::List(list) => list.planes().to_vec(),
            Planes::Depth { .. } => Vec::new(),
            _ => vec![Plane::Color],
        };
        let formats: Vec<_> = list.iter().map(|plane| format(*plane)).collect();
        let colors: Vec<_> = formats.iter().map(|f| f.0).collect();
        let output = Output::Pass(PassFormats {
            slope_bias,
            ..PassFormats::new(dynamic(&colors), planes)
        });
        let mut renderer = Renderer::new(device, output, &SearchSettings::exact(), 1).unwrap();
        renderer.set_lighting(&scene.lighting()).unwrap();
        for object in &scene.objects {
            renderer.add(object.clone()).unwrap();
        }
        let names: Vec<_> = list.iter().map(|plane| format!("{plane:?}")).collect();
        let name = match planes {
            Planes::List(_) => format!("list: {}", names.join(", ")),
            Planes::Depth { .. } if !slope_bias.is_none() => "depth, bias for slopes".into(),
            Planes::Depth { .. } => "depth".into(),
            _ => names.join(", "),
        };
        Self {
            name,
            renderer,
            into: Attachments::new(host, OPTIONS, &formats).unwrap(),
            colors: colors.len(),
            times: Vec::new(),
        }
    }

    fn frame(&mut self, host: &Host, view: &View) {
        let clears = vec![vk::ClearColorValue { uint32: [0; 4] }; self.colors];
        let begin = Instant::now();
        host::once(host, |cmd| {
            // SAFETY: `cmd` is recording; the frame before is done; the pass has the output's
            // formats.
            unsafe {
                let frame = self
                    .renderer
                    .prepare(cmd, 0, &view.with_last(view))
                    .unwrap();
                let record = || self.renderer.record(cmd, &frame).unwrap();
                self.into.draw(cmd, &clears, false, record);
            }
        });
        self.times.push(1e3 * begin.elapsed().as_secs_f64());
    }
}

fn main() {
    let host = open_unchecked();
    let device = borrow(&host);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenes/bishop.toml");
    let mut scene = revmap_files::scene(path).unwrap();
    scene.camera = Camera::new(DVec3::new(1.6, 0.5, 1.0), DVec3::new(0.0, 0.0, 0.5));
    let size = (OPTIONS.width, OPTIONS.height);
    let view = View::from_camera(&scene.camera, size, [0.1, 50.0]).unwrap();
    use Plane as P;
    let mut lists: Vec<&[Plane]> = vec![&[P::Color]];
    lists.extend(
        [
            [P::BaseColor],
            [P::OctahedralNormal],
            [P::Motion],
            [P::Identity],
        ]
        .each_ref()
        .map(|l| &l[..]),
    );
    let buffer = [
        P::BaseColor,
        P::OctahedralNormal,
        P::Material,
        P::Motion,
        P::Identity,
    ];
    lists.push(&buffer);
    let listed = lists
        .iter()
        .map(|list| Planes::List(PlaneList::new(list).unwrap()));
    let depth = Planes::Depth { parallel: false };
    let planes = std::iter::once(Planes::Color).chain(listed).chain([depth]);
    let none = SlopeBias::default();
    let mut cases: Vec<_> = planes
        .map(|p| Case::new(&host, &device, &scene, p, none))
        .collect();
    let bias = SlopeBias::new(1.5, 1e-3).unwrap();
    cases.push(Case::new(&host, &device, &scene, depth, bias));
    for _ in 0..ROUNDS {
        cases.iter_mut().for_each(|case| case.frame(&host, &view));
    }
    println!("{}, 800x600, {ROUNDS} rounds", device.report().name);
    let median = |mut all: Vec<f64>| {
        all.sort_unstable_by(f64::total_cmp);
        all[all.len() / 2]
    };
    let color = cases[0].times[1..].to_vec();
    for case in &cases {
        let times = &case.times[1..];
        let ratios = times.iter().zip(&color).map(|(a, b)| a / b).collect();
        println!(
            "{:6.2} ms {:5.2} {}",
            median(times.to_vec()),
            median(ratios),
            case.name
        );
    }
}
