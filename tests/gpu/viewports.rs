//! Viewports of a host: partly or wholly beside the framebuffer, with `y` upwards, and with a depth
//! range of their own.
#![allow(unsafe_code)]

use crate::common::host::{
    self, Canvas, Drawn, Host, Mesh, MeshPipeline, MeshShaders, Picture, once, opened,
};
use crate::common::prelude::*;
use crate::embedding::{hundred, matrices, options, three};
use crate::embedding_outputs::{WIDE, by_proxies_of, depth_only, parallel};

/// The host's `VkViewport` and scissor.
#[derive(Clone, Copy)]
struct Port {
    place: Viewport,
    depths: [f64; 2],
    rows: [u32; 2],
    order: DepthOrder,
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
            order: DepthOrder::Normal,
        }
    }

    /// A lens with `y` downwards in clip space, as the viewport has it.
    fn lens(&self, lens: DMat4) -> DMat4 {
        let sense = self.place.height.signum();
        DMat4::from_scale(DVec3::new(1.0, sense, 1.0)) * lens
    }

    fn view(&self, [look, lens]: [DMat4; 2]) -> View {
        let view = View::from_matrices(look, self.lens(lens), self.place, self.order).unwrap();
        let view = view.with_depth_range(self.depths).unwrap();
        view.with_rows(self.rows[0]..self.rows[1])
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
        let scissor = vk::Rect2D::default()
            .offset(vk::Offset2D::default().y(first as i32))
            .extent(vk::Extent2D {
                width: options().width,
                height: end - first,
            });
        // SAFETY: `cmd` is recording.
        unsafe {
            host.device.cmd_set_viewport(cmd, 0, &[viewport]);
            host.device.cmd_set_scissor(cmd, 0, &[scissor]);
        }
    }

    /// Draws solids, in a pass after a mesh, if any.
    fn picture(
        &self,
        drawn: &mut Drawn,
        matrices: [DMat4; 2],
        mesh: Option<&(MeshPipeline, Mesh)>,
    ) -> Picture {
        drawn.view = self.view(matrices);
        if let Canvas::Words(..) = drawn.canvas {
            return drawn.picture();
        }
        let (host, canvas, renderer) = (drawn.host, &drawn.canvas, &mut drawn.renderer);
        let clip = self.lens(matrices[1]) * matrices[0];
        once(host, |cmd| {
            // SAFETY: `cmd` is recording; no frame is in flight; the pass has the output's formats.
            unsafe {
                let frame = renderer.prepare(cmd, 0, &drawn.view).unwrap();
                canvas.record(cmd, || {
                    self.set(host, cmd);
                    if let Some((pipeline, mesh)) = mesh {
                        pipeline.draw(cmd, clip, Vec3::Z, std::slice::from_ref(mesh));
                    }
                    renderer.record(cmd, &frame).unwrap();
                });
                canvas.copy(cmd);
            }
        });
        canvas.read()
    }
}

fn drawn<'a>(host: &'a Host, device: &Device, output: Output, scene: &Scene) -> Drawn<'a> {
    let by = (output, &SearchSettings::default());
    Drawn::new(host, device, options(), by, scene)
}

fn outputs() -> [Output; 2] {
    [
        Output::Pass(host::color_pass()),
        Output::Compute(Planes::Color),
    ]
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

/// The visible part of a viewport is that of the same picture drawn in place, in both stages, and in a
/// shadow map of parallel rays.
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
        let from = DVec3::new(2.0, 1.0, 2.5);
        let aside = host::look(from, DVec3::new(0.0, 0.0, 0.5), DVec3::Z);
        let usual = SearchSettings::default();
        let [color, compute] = outputs().map(|output| (output, usual, matrices(&scene)));
        let map = Output::Pass(depth_only(true));
        let map = (map, by_proxies_of(0), [aside, parallel()]);
        for (output, search, matrices) in [color, compute, map] {
            let what = format!("{name}, {output:?}");
            let by = (output, &search);
            let mut solids = Drawn::new(&host, &device, options(), by, &scene);
            let mut drawn = |port: &Port| port.picture(&mut solids, matrices, None);
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
                if let Some(row) = wanted.0.get_mut(4 * at..4 * (at + width)) {
                    row.fill(0);
                }
                wanted.1[at..at + width].fill(1.0);
            }
            assert!(band == wanted, "{what}: a band differs");
        }
    }
}

/// A viewport that the device does not have is refused by name, and so is its plan.
#[test]
fn viewports_beyond_the_device_are_refused() {
    let (host, device) = opened();
    let scene = three();
    let matrices = matrices(&scene);
    for output in outputs() {
        let mut renderer = drawn(&host, &device, output, &scene).renderer;
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
            let error = renderer.plan(&port.view(matrices)).unwrap_err();
            assert_eq!(error.kind, ErrorKind::Content);
            assert_eq!(error.key.as_deref(), Some("view.viewport"), "{error}");
        }
    }
}

/// A lens whose far plane cuts the scene.
fn lens(parallel: bool, reversed: bool) -> DMat4 {
    let (scales, range) = match parallel {
        true => (WIDE, [0.5, 6.0]),
        false => (host::scales(&options()), [0.1, 3.1]),
    };
    host::lens(scales, parallel, reversed, range)
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
    for (name, scene, least) in [
        ("cells", three(), 0),
        ("boxes", three(), u32::MAX),
        ("copies", hundred(), 0),
    ] {
        let look = matrices(&scene)[0];
        let port = |depths, order| {
            Port::new([0, 0], false).with(|p| (p.depths, p.order) = (depths, order))
        };
        let ranges = [[0.0, 1.0], RANGE.map(f64::from)];
        for (is_parallel, reversed) in [(false, false), (false, true), (true, false), (true, true)]
        {
            let options = options().with(|o| o.reversed = reversed);
            let order = host::order(&options);
            let (pass, colors) = match is_parallel {
                true => (depth_only(true), &[][..]),
                false => (host::color_pass(), &[host::COLOR][..]),
            };
            let output = Output::Pass(pass.with(|p| p.depth = order));
            let by = (output, &by_proxies_of(least));
            let mut solids = Drawn::new(&host, &device, options, by, &scene);
            let (shaders, none) = (MeshShaders::default(), vk::RenderPass::null());
            let pipeline = MeshPipeline::new(&host, &shaders, &options, none, colors).unwrap();
            let middle = Vec3::new(0.3, -0.1, 0.45);
            let mesh = (
                pipeline,
                Mesh::sphere(&host, 64, middle, 0.3, Vec3::Z).unwrap(),
            );
            let matrices = [look, lens(is_parallel, reversed)];
            for mesh in [None, Some(&mesh)] {
                let [plain, ranged] =
                    ranges.map(|r| port(r, order).picture(&mut solids, matrices, mesh));
                let [hits, differ] = compare_ranges(&ranged, &plain, RANGE, reversed);
                println!("{name}, parallel {is_parallel}, reversed {reversed}: {differ} of {hits}");
                // Ties of mesh and solid may be decided in another way.
                assert!(hits > 1500 && differ <= 10, "{name}: {differ} of {hits}");
            }
        }
        let matrices = [look, lens(false, false)];
        let mut solids = drawn(&host, &device, Output::Compute(Planes::Color), &scene);
        let [plain, ranged] =
            ranges.map(|r| port(r, DepthOrder::Normal).picture(&mut solids, matrices, None));
        let [hits, differ] = compare_ranges(&ranged, &plain, RANGE, false);
        assert!(
            hits > 1500 && differ == 0,
            "{name} in compute: {differ} of {hits}"
        );
    }
}
