//! Viewports of a host: partly or wholly beside the framebuffer, with `y` upwards, and with a depth
//! range of their own.
#![allow(unsafe_code)]

use crate::common::host::{Attachments, Host, Mesh, MeshPipeline, MeshShaders, once, opened};
use crate::common::prelude::*;
use crate::embedding::{Picture, first_frame, hundred, matrices, options, three};
use crate::embedding_outputs::{by_proxies_of, depth_only, parallel};

/// The host's `VkViewport` and scissor.
#[derive(Clone, Copy)]
struct Port {
    place: Viewport,
    depths: [f64; 2],
    rows: [u32; 2],
}

impl Port {
    /// The size of the framebuffer, moved by some pixels; `up`: with `y` upwards.
    fn new([x, y]: [i32; 2], up: bool) -> Self {
        let [width, height] = [options().width, options().height].map(f64::from);
        let (x, y) = (f64::from(x), f64::from(y));
        Self {
            place: Viewport {
                x,
                y: if up { y + height } else { y },
                width,
                height: if up { -height } else { height },
            },
            depths: [0.0, 1.0],
            rows: [0, options().height],
        }
    }

    /// The view of matrices with `y` downwards in clip space.
    fn view(&self, [look, lens]: [DMat4; 2], order: DepthOrder) -> View {
        let sense = self.place.height.signum();
        let lens = DMat4::from_scale(DVec3::new(1.0, sense, 1.0)) * lens;
        let view = View::from_matrices(look, lens, self.place, order).unwrap();
        view.with_depth_range(self.depths).unwrap()
    }

    /// Sets viewport and scissor.
    unsafe fn set(&self, host: &Host, cmd: vk::CommandBuffer) {
        let (v, [min, max]) = (&self.place, self.depths);
        let viewport = vk::Viewport {
            x: v.x as f32,
            y: v.y as f32,
            width: v.width as f32,
            height: v.height as f32,
            min_depth: min as f32,
            max_depth: max as f32,
        };
        let [first, end] = self.rows;
        let scissor = vk::Rect2D {
            offset: vk::Offset2D {
                x: 0,
                y: first as i32,
            },
            extent: vk::Extent2D {
                width: options().width,
                height: end - first,
            },
        };
        // SAFETY: `cmd` is recording.
        unsafe {
            host.device.cmd_set_viewport(cmd, 0, &[viewport]);
            host.device.cmd_set_scissor(cmd, 0, &[scissor]);
        }
    }
}

/// Draws a mesh, if any, and the solids in a pass of one colour or of none.
fn in_pass(
    host: &Host,
    pass: &PassFormats,
    renderer: &mut Renderer,
    (port, matrices): (&Port, [DMat4; 2]),
    mesh: Option<&Mesh>,
) -> Picture {
    let options = options().with(|o| o.reversed = pass.depth == DepthOrder::Reversed);
    let formats: &[_] = match pass.planes {
        Planes::Color => &[(host::COLOR, 4)],
        _ => &[],
    };
    let into = Attachments::new(host, options, formats).unwrap();
    let colors: Vec<_> = formats.iter().map(|(format, _)| *format).collect();
    let (shaders, none) = (MeshShaders::default(), vk::RenderPass::null());
    let pipeline = MeshPipeline::new(host, &shaders, &options, none, &colors).unwrap();
    let [look, lens] = matrices;
    let view = port
        .view(matrices, pass.depth)
        .with_rows(port.rows[0]..port.rows[1]);
    let sense = DVec3::new(1.0, port.place.height.signum(), 1.0);
    let clip = DMat4::from_scale(sense) * lens * look;
    once(host, |cmd| {
        // SAFETY: `cmd` is recording; no frame is in flight; the pass has the output's formats.
        unsafe {
            let frame = renderer.prepare(cmd, 0, &view).unwrap();
            let clears = vec![vk::ClearColorValue::default(); colors.len()];
            into.draw(cmd, &clears, false, || {
                port.set(host, cmd);
                if let Some(mesh) = mesh {
                    pipeline.draw(cmd, clip, Vec3::Z, std::slice::from_ref(mesh));
                }
                renderer.record(cmd, &frame).unwrap();
            });
            into.copy(cmd);
        }
    });
    let color = formats.first().map(|_| into.color(0));
    (color.unwrap_or_default(), into.depths())
}

/// Draws the solids in compute.
fn in_compute(host: &Host, renderer: &mut Renderer, view: &View) -> Picture {
    first_frame(host, options(), None, (renderer, view), None)
}

fn color_renderer(device: &Device, scene: &Scene, compute: bool) -> Renderer {
    let output = match compute {
        true => Output::Compute(Planes::Color),
        false => Output::Pass(host::color_pass()),
    };
    host::renderer_of(device, output, &SearchSettings::default(), 1, scene)
}

/// The number of pixels in which a picture differs from another one that was moved by some pixels,
/// and of hits that it should show.
fn compare_moved(found: &Picture, whole: &Picture, [dx, dy]: [i32; 2]) -> [usize; 2] {
    let [width, height] = [options().width, options().height].map(|side| side as i32);
    let [mut differ, mut hits] = [0; 2];
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let at = (y * width + x) as usize;
        let from = ((y - dy) * width + x - dx) as usize;
        let inside = (0..width).contains(&(x - dx)) && (0..height).contains(&(y - dy));
        let depth = if inside { whole.1[from] } else { 1.0 };
        hits += usize::from(depth < 1.0);
        let mut same = (found.1[at] - depth).abs() < 1e-5;
        if let Some(color) = found.0.get(4 * at..4 * at + 4) {
            let wanted = match inside {
                true => &whole.0[4 * from..4 * from + 4],
                false => &[0; 4],
            };
            same &= color.iter().zip(wanted).all(|(a, b)| a.abs_diff(*b) <= 2);
        }
        differ += usize::from(!same);
    }
    [differ, hits]
}

const MOVES: [[i32; 2]; 9] = [
    [0, 0],
    [-100, 0],
    [-77, -61],
    [90, 50],
    [-240, 0],
    [-300, 10],
    [0, -180],
    [240, 0],
    [20, 500],
];

fn assert_moved(found: &Picture, whole: &Picture, by: [i32; 2], what: &str) {
    let [differ, hits] = compare_moved(found, whole, by);
    println!("{what}, {by:?}: {differ} pixels differ, {hits} hits");
    // Rounding of rays moves silhouettes.
    assert!(differ <= hits / 200, "{what}, {by:?}: {differ} of {hits}");
}

/// The visible part of a viewport is that of the same picture drawn in place, in both stages.
#[test]
fn viewports_beside_the_framebuffer_draw_what_shows() {
    let (host, device) = opened();
    let mut shadows = hundred();
    shadows.shadow = Shadow::Hard;
    for (name, scene) in [
        ("solids", three()),
        ("copies", hundred()),
        ("shadows", shadows),
    ] {
        let matrices = matrices(&scene);
        for compute in [false, true] {
            let mut renderer = color_renderer(&device, &scene, compute);
            let mut drawn = |port: &Port| match compute {
                true => {
                    let view = port.view(matrices, DepthOrder::Normal);
                    let rows = port.rows[0]..port.rows[1];
                    in_compute(&host, &mut renderer, &view.with_rows(rows))
                }
                false => {
                    let pass = host::color_pass();
                    in_pass(&host, &pass, &mut renderer, (port, matrices), None)
                }
            };
            let what = format!("{name}, compute {compute}");
            let whole = drawn(&Port::new([0, 0], false));
            assert!(whole.1.iter().filter(|depth| **depth < 1.0).count() > 3000);
            for by in MOVES {
                for up in [false, true] {
                    assert_moved(&drawn(&Port::new(by, up)), &whole, by, &what);
                }
            }
            let by = [-77, -61];
            let port = Port::new(by, false);
            let rows = [64, 128];
            let band = drawn(&Port { rows, ..port });
            let mut wanted = drawn(&port);
            let width = options().width as usize;
            for row in (0..options().height).filter(|y| !(rows[0]..rows[1]).contains(y)) {
                let at = row as usize * width;
                wanted.0[4 * at..4 * (at + width)].fill(0);
                wanted.1[at..at + width].fill(1.0);
            }
            assert!(band == wanted, "{what}: a band differs");
        }
    }
}

/// The same for a shadow map of parallel rays.
#[test]
fn parallel_views_beside_the_framebuffer_draw_what_shows() {
    let (host, device) = opened();
    let from = DVec3::new(2.0, 1.0, 2.5);
    let look = host::view_and_projection(from, DVec3::new(0.0, 0.0, 0.5), &options())[0];
    let pass = depth_only(true);
    for scene in [three(), hundred()] {
        let output = Output::Pass(pass.clone());
        let mut renderer = host::renderer_of(&device, output, &by_proxies_of(0), 1, &scene);
        let mut drawn = |port: &Port| {
            let shown = (port, [look, parallel()]);
            in_pass(&host, &pass, &mut renderer, shown, None)
        };
        let whole = drawn(&Port::new([0, 0], false));
        for by in MOVES {
            for up in [false, true] {
                assert_moved(&drawn(&Port::new(by, up)), &whole, by, "parallel");
            }
        }
    }
}

/// A viewport that the device does not have is refused by name, and so is its plan.
#[test]
fn viewports_beyond_the_device_are_refused() {
    let (_host, device) = opened();
    let scene = three();
    let matrices = matrices(&scene);
    for compute in [false, true] {
        let mut renderer = color_renderer(&device, &scene, compute);
        for [x, y, width, height] in [
            [0.0, 0.0, 1e9, 48.0],
            [0.0, 0.0, 64.0, 1e9],
            [0.0, 1e9, 64.0, -1e9],
            [-1e9, 0.0, 64.0, 48.0],
            [0.0, 1e9, 64.0, 48.0],
        ] {
            let mut port = Port::new([0, 0], false);
            port.place = Viewport {
                x,
                y,
                width,
                height,
            };
            let error = renderer
                .plan(&port.view(matrices, DepthOrder::Normal))
                .unwrap_err();
            assert_eq!(error.kind, ErrorKind::Content);
            assert_eq!(error.key.as_deref(), Some("view.viewport"), "{error}");
        }
    }
}

/// A lens whose far plane cuts the scene.
fn lens(is_parallel: bool, reversed: bool) -> DMat4 {
    let mut lens = parallel();
    if !is_parallel {
        let scene = three();
        lens = matrices(&scene)[1];
        let (near, far) = (0.1, 3.1);
        lens.z_axis.z = far / (near - far);
        lens.w_axis.z = near * far / (near - far);
    }
    // `z` becomes `w - z`.
    let turned = DMat4::from_cols(
        DVec4::X,
        DVec4::Y,
        DVec4::new(0.0, 0.0, -1.0, 0.0),
        DVec4::new(0.0, 0.0, 1.0, 1.0),
    );
    if reversed { turned * lens } else { lens }
}

/// The number of hits, and of pixels in which a picture in a depth range differs from that in the
/// whole range.
fn compare_ranges(
    ranged: &Picture,
    plain: &Picture,
    [min, max]: [f32; 2],
    reversed: bool,
) -> [usize; 2] {
    let far = if reversed { 0.0 } else { 1.0 };
    let [mut hits, mut differ] = [0; 2];
    for (n, (found, depth)) in ranged.1.iter().zip(&plain.1).enumerate() {
        let wanted = match *depth == far {
            true => far,
            false => min + (max - min) * depth,
        };
        hits += usize::from(*depth != far);
        let pixel = 4 * n..(4 * n + 4).min(plain.0.len());
        let alike = ranged.0.get(pixel.clone()) == plain.0.get(pixel);
        differ += usize::from((found - wanted).abs() > 2f32.powi(-20) || !alike);
    }
    [hits, differ]
}

/// A viewport's depth range moves solids and meshes alike, by every draw path, in both orders of
/// depth, along parallel rays too. Nothing shows beyond the far plane.
#[test]
fn solids_and_meshes_share_the_depth_range() {
    const RANGE: [f32; 2] = [0.2, 0.7];
    let (host, device) = opened();
    let mesh = Mesh::sphere(&host, 64, Vec3::new(0.3, -0.1, 0.45), 0.3, Vec3::Z).unwrap();
    for (name, scene, least) in [
        ("cells", three(), 0),
        ("boxes", three(), u32::MAX),
        ("copies", hundred(), 0),
    ] {
        let look = matrices(&scene)[0];
        for (is_parallel, reversed) in [(false, false), (false, true), (true, false), (true, true)]
        {
            let pass = PassFormats {
                depth: match reversed {
                    true => DepthOrder::Reversed,
                    false => DepthOrder::Normal,
                },
                ..if is_parallel {
                    depth_only(true)
                } else {
                    host::color_pass()
                }
            };
            let output = Output::Pass(pass.clone());
            let mut renderer = host::renderer_of(&device, output, &by_proxies_of(least), 1, &scene);
            let matrices = [look, lens(is_parallel, reversed)];
            let mut drawn = |depths: [f64; 2], mesh| {
                let port = Port::new([0, 0], false).with(|p| p.depths = depths);
                in_pass(&host, &pass, &mut renderer, (&port, matrices), mesh)
            };
            for mesh in [None, Some(&mesh)] {
                let plain = drawn([0.0, 1.0], mesh);
                let ranged = drawn(RANGE.map(f64::from), mesh);
                let [hits, differ] = compare_ranges(&ranged, &plain, RANGE, reversed);
                println!("{name}, parallel {is_parallel}, reversed {reversed}: {differ} of {hits}");
                // Ties of mesh and solid may be decided in another way.
                assert!(hits > 1500 && differ <= 10, "{name}: {differ} of {hits}");
            }
        }
        let view = |depths| {
            let port = Port::new([0, 0], false).with(|p| p.depths = depths);
            port.view([look, lens(false, false)], DepthOrder::Normal)
        };
        let mut renderer = color_renderer(&device, &scene, true);
        let plain = in_compute(&host, &mut renderer, &view([0.0, 1.0]));
        let ranged = in_compute(&host, &mut renderer, &view(RANGE.map(f64::from)));
        let [hits, differ] = compare_ranges(&ranged, &plain, RANGE, false);
        assert!(
            hits > 1500 && differ == 0,
            "{name} in compute: {differ} of {hits}"
        );
    }
}
