//! Lists of planes through the C interface, as for a G-buffer: what the Rust renderer draws, bit for
//! bit. Motion, masks, rays through samples.

use crate::host::{
    self, COLOR, Canvas, DEPTH, Drawn, Host, borrow, dynamic, open, open_with, view_and_projection,
};
use crate::names::*;
use crate::recording::{EYE, OPTIONS, add, lend, scene};

type F = vk::Format;
type A = RevmapAttachment;

/// Every plane with a format.
const PLANES: [(A, Plane, vk::Format); 7] = [
    (A::Identity, Plane::Identity, F::R32G32_UINT),
    (A::Motion, Plane::Motion, F::R32G32_SFLOAT),
    (A::Color, Plane::Color, F::R16G16B16A16_SFLOAT),
    (A::BaseColor, Plane::BaseColor, F::R8G8B8A8_UNORM),
    (A::Normal, Plane::Normal, F::R32G32B32A32_SFLOAT),
    (
        A::OctahedralNormal,
        Plane::OctahedralNormal,
        F::R16G16_SNORM,
    ),
    (A::Material, Plane::Material, F::R32G32_SFLOAT),
];
const NONE: [u32; 2] = [u32::MAX; 2];
/// Where the first object is in the second frame.
const MOVED: [f64; 3] = [0.05, -0.15, 0.02];
const BIAS: f64 = 1.0 / 1024.0;

/// A pass of all planes, by dynamic rendering.
fn output() -> Output {
    let list = Planes::List(PlaneList::new(&PLANES.map(|(_, plane, _)| plane)).unwrap());
    let begun = dynamic(&PLANES.map(|(.., format)| format));
    Output::Pass(PassFormats::new(begun, list))
}

/// The pairs of words of a plane.
fn pairs(bytes: &[u8]) -> Vec<[u32; 2]> {
    let words: Vec<u32> = bytemuck::pod_collect_to_vec(bytes);
    words.as_chunks().0.to_vec()
}

/// The eye and the jitter of a view, world units and pixels.
type Seen = (DVec3, [f64; 2]);
const FIRST: Seen = (DVec3::from_array(EYE), [0.25, -0.375]);
const SECOND: Seen = (DVec3::new(2.0, 0.6, 1.45), [-0.25, 0.125]);

/// The matrices of a view.
fn matrices((eye, jitter): Seen) -> [DMat4; 2] {
    let [view, projection] = view_and_projection(eye, DVec3::new(0.0, 0.0, 0.5), &OPTIONS);
    let size = [f64::from(OPTIONS.width), f64::from(OPTIONS.height)];
    let shift = DVec3::new(2.0 * jitter[0] / size[0], 2.0 * jitter[1] / size[1], 0.0);
    [view, DMat4::from_translation(shift) * projection]
}

fn view_in_rust(seen: Seen) -> View {
    let [view, projection] = matrices(seen);
    let view = host::view([view, projection], &OPTIONS).unwrap();
    view.with_jitter(seen.1)
}

fn view_in_c(seen: Seen) -> RevmapView {
    let [view, projection] = matrices(seen).map(|matrix| matrix.to_cols_array());
    let (width, height) = (f64::from(OPTIONS.width), f64::from(OPTIONS.height));
    RevmapView {
        view,
        projection,
        viewport: [0.0, 0.0, width, height],
        jitter: seen.1,
        ..sized!(RevmapView)
    }
}

/// Two frames of the Rust renderer; the first object moves between them.
fn drawn(host: &Host) -> [Vec<Vec<u8>>; 2] {
    let (device, search) = (borrow(host), SearchSettings::default());
    let mut drawn = Drawn::new(host, &device, OPTIONS, (output(), &search), &scene());
    let first = view_in_rust(FIRST);
    let second = view_in_rust(SECOND).with_last(&first).with_depth_bias(BIAS);
    [first, second].map(|view| {
        drawn.view = view;
        drawn.picture();
        drawn.renderer.end_frame();
        let moved = Placement {
            position: MOVED.into(),
            ..Placement::default()
        };
        drawn.renderer.set_placement(drawn.ids[0], moved).unwrap();
        drawn.canvas.planes()
    })
}

/// A renderer of all planes in C.
struct Lists<'a> {
    host: &'a Host,
    device: *mut RevmapDevice,
    renderer: *mut RevmapRenderer,
    objects: [RevmapObject; 2],
    canvas: Canvas<'a>,
}

/// A renderer of all planes.
fn renderer(device: *mut RevmapDevice) -> *mut RevmapRenderer {
    let numbers = PLANES.map(|(attachment, ..)| attachment as u32);
    let formats = PLANES.map(|(.., format)| format);
    let pass = RevmapPass {
        kind: RevmapPassKind::Dynamic as u32,
        samples: 1,
        planes: RevmapPlanes::List as u32,
        color_formats: formats.as_ptr(),
        color_format_count: PLANES.len() as u32,
        depth_format: DEPTH,
        attachments: numbers.as_ptr(),
        attachment_count: PLANES.len() as u32,
        ..sized!(RevmapPass)
    };
    let mut renderer = null_mut();
    ok! { revmap_renderer_create(device, &pass, null(), 1, &mut renderer); }
    renderer
}

impl<'a> Lists<'a> {
    fn new(host: &'a Host) -> Self {
        let device = lend(host);
        ok! { revmap_device_enable_debug_labels(device); }
        let renderer = renderer(device);
        Self {
            host,
            device,
            renderer,
            objects: add(renderer),
            canvas: Canvas::new(host, OPTIONS, &output()),
        }
    }

    fn draw(&self, view: &RevmapView) {
        let record = |cmd, ()| {
            ok! { revmap_renderer_record(self.renderer, cmd, 0); }
        };
        let prepare = |cmd| {
            ok! { revmap_renderer_prepare(self.renderer, cmd, 0, view); }
        };
        self.canvas.draw(self.host, prepare, record);
    }

    /// The number of an object in the plane of identities.
    fn number(&self, object: usize) -> u32 {
        let mut number = 0;
        ok! { revmap_renderer_object_number(self.renderer, self.objects[object], &mut number); }
        number
    }

    /// The number of pixels that show each object, and of those that show none.
    fn shown(&self) -> [usize; 3] {
        let pixels = pairs(&self.canvas.planes()[0]);
        let of = |pair| pixels.iter().filter(|p| **p == pair).count();
        let [first, second] = [0, 1].map(|n| of([self.number(n), 0]));
        assert_eq!(first + second + of(NONE), pixels.len());
        [first, second, of(NONE)]
    }
}

impl Drop for Lists<'_> {
    fn drop(&mut self) {
        // The frames are done.
        revmap_renderer_destroy(self.renderer);
        revmap_device_destroy(self.device);
    }
}

#[test]
fn a_list_of_planes_is_what_rust_draws() {
    let host = open();
    let wanted = drawn(&host);
    let lists = Lists::new(&host);
    lists.draw(&view_in_c(FIRST));
    assert!(
        lists.canvas.planes() == wanted[0],
        "the first frame differs"
    );
    // A view shows the objects of its mask.
    let masks = |first, second| {
        ok! {
            revmap_renderer_set_mask(lists.renderer, lists.objects[0], first);
            revmap_renderer_set_mask(lists.renderer, lists.objects[1], second);
        }
    };
    masks(1, 2);
    for (mask, wanted) in [(0, [true; 2]), (1, [true, false]), (4, [false; 2])] {
        lists.draw(&RevmapView {
            mask,
            ..view_in_c(FIRST)
        });
        let [first, second, _] = lists.shown();
        assert_eq!([first > 0, second > 0], wanted, "mask {mask}");
    }
    masks(u32::MAX, u32::MAX);
    let mut moved = defaults!(revmap_object_defaults, RevmapObjectInfo).placement;
    moved.position = MOVED;
    ok! {
        revmap_renderer_end_frame(lists.renderer);
        revmap_renderer_set_placement(lists.renderer, lists.objects[0], &moved);
    }
    // Without a last view the object that has moved has motion, and the other one has none.
    lists.draw(&view_in_c(SECOND));
    let [first, second, none] = lists.shown();
    assert!(first > 1500 && second > 1500 && none > 10_000);
    let planes = lists.canvas.planes();
    let pixels = [&planes[1], &planes[0]].map(|bytes| pairs(bytes));
    for (motion, identity) in pixels[0].iter().zip(&pixels[1]) {
        let [x, y] = motion.map(f32::from_bits);
        let moves = x.hypot(y);
        match identity[0] == lists.number(0) {
            true => assert!(moves > 1.0, "{moves}"),
            false => assert!(moves < 1e-3, "{moves}"),
        }
    }
    let last = view_in_c(FIRST);
    lists.draw(&RevmapView {
        last: &last,
        depth_bias: BIAS,
        ..view_in_c(SECOND)
    });
    let pairs = lists.canvas.planes().into_iter().zip(&wanted[1]);
    for (n, (found, wanted)) in pairs.enumerate() {
        assert!(found == *wanted, "plane {n} of the second frame differs");
    }
}

#[test]
fn rays_through_samples_need_their_feature() {
    let host = open_with(|features| vk::PhysicalDeviceFeatures {
        sample_rate_shading: vk::FALSE,
        ..features
    });
    let (device, mut made) = (lend(&host), null_mut());
    let mut pass = sized!(RevmapPass);
    (pass.samples, pass.sample_rays) = (4, 1);
    (pass.color_formats, pass.color_format_count) = (&COLOR, 1);
    pass.depth_format = DEPTH;
    fail! {
        Unsupported, "sampleRateShading": revmap_renderer_create(device, &pass, null(), 2, &mut made);
    }
    pass.sample_rays = 0;
    ok! {
        revmap_renderer_create(device, &pass, null(), 2, &mut made);
        revmap_renderer_destroy(made);
        revmap_device_destroy(device);
    }
}
