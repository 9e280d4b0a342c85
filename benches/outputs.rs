//! What the planes of a pass cost: milliseconds of a frame with each list of planes, and the ratio
//! to colour alone, in rounds one after the other. `cargo bench --bench outputs`.
#![allow(unsafe_code, clippy::unwrap_used)]

mod rounds;

use ash::vk;
use revmap::gpu::{Output, PassFormats, SlopeBias};
use revmap::settings::{Plane, PlaneList, Planes, SearchSettings};
use rounds::host::{Canvas, borrow, dynamic, once, open_unchecked, renderer_of};
use rounds::{Case, OPTIONS, bishop, compare};

/// Formats as an engine would take them.
const fn format(plane: Plane) -> vk::Format {
    match plane {
        Plane::Color | Plane::Normal => vk::Format::R16G16B16A16_SFLOAT,
        Plane::BaseColor => vk::Format::R8G8B8A8_SRGB,
        Plane::OctahedralNormal | Plane::Motion => vk::Format::R16G16_SFLOAT,
        Plane::Material => vk::Format::R8G8_UNORM,
        Plane::Identity => vk::Format::R32G32_UINT,
    }
}

/// The planes of a pass, its colours, and its name.
fn listed(planes: Planes, slope_bias: SlopeBias) -> (Vec<vk::Format>, String) {
    let list = match planes {
        Planes::List(list) => list.planes().to_vec(),
        Planes::Depth { .. } => Vec::new(),
        _ => vec![Plane::Color],
    };
    let names: Vec<_> = list.iter().map(|plane| format!("{plane:?}")).collect();
    let name = match planes {
        Planes::List(_) => format!("list: {}", names.join(", ")),
        Planes::Depth { .. } if !slope_bias.is_none() => "depth, bias for slopes".into(),
        Planes::Depth { .. } => "depth".into(),
        _ => names.join(", "),
    };
    (list.iter().map(|plane| format(*plane)).collect(), name)
}

fn main() {
    let host = open_unchecked();
    let device = borrow(&host);
    let (scene, view) = bishop();
    use Plane as P;
    const BUFFER: [P; 5] = [
        P::BaseColor,
        P::OctahedralNormal,
        P::Material,
        P::Motion,
        P::Identity,
    ];
    let alone = [
        P::Color,
        P::BaseColor,
        P::OctahedralNormal,
        P::Motion,
        P::Identity,
    ];
    let lists = alone.chunks(1).chain([&BUFFER[..]]);
    let lists = lists.map(|list| PlaneList::new(list).unwrap());
    let depth = Planes::Depth { parallel: false };
    let none = SlopeBias::default();
    let mut passes = vec![(Planes::Color, none)];
    passes.extend(lists.map(|list| (Planes::List(list), none)));
    passes.push((depth, none));
    passes.push((depth, SlopeBias::new(1.5, 1e-3).unwrap()));
    let made = passes.into_iter().map(|(planes, slope_bias)| {
        let (colors, name) = listed(planes, slope_bias);
        let output = Output::Pass(PassFormats {
            slope_bias,
            ..PassFormats::new(dynamic(&colors), planes)
        });
        let canvas = Canvas::new(&host, OPTIONS, &output);
        let renderer = renderer_of(&device, output, &SearchSettings::exact(), 1, &scene);
        ((name, renderer), canvas)
    });
    let (mut cases, canvases): (Vec<Case>, Vec<_>) = made.unzip();
    println!("{}, 800x600", device.report().name);
    compare("", &mut cases, |n, (_, renderer)| {
        once(&host, |cmd| {
            // SAFETY: `cmd` is recording; the frame before is done; the pass has the output's
            // formats.
            unsafe {
                let frame = renderer.prepare(cmd, 0, &view.with_last(&view)).unwrap();
                let record = || renderer.record(cmd, &frame).unwrap();
                canvases[n].record(cmd, record);
            }
        });
    });
}
