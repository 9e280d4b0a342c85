//! A random host: calls of the C interface in any order, with valid and invalid handles, sizes and
//! values. No call meets a fault of the library, and the validation layers report nothing.
//!
//! A quarter of `REVMAP_SOAK_SECONDS` is the time, `REVMAP_SOAK_SEED` repeats a run.

use crate::host::{
    COLOR, Canvas, DEPTH, Host, Options, Texture, assert_silent, commands, open,
    view_and_projection,
};
use crate::names::*;
use crate::recording::lend_with_queue;
use std::any::TypeId;
use std::collections::{HashMap, VecDeque};
use std::mem::offset_of;
use std::ptr::without_provenance_mut;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

#[path = "../../../../tests/common/random.rs"]
mod numbers;
use numbers::Random;

/// The size of every target.
const SIZE: Options = Options::new(64, 48);
const WHOLE: [f64; 4] = [0.0, 0.0, 64.0, 48.0];
const VIEWPORTS: [[f64; 4]; 7] = [
    [0.0, 48.0, 64.0, -48.0],
    [-50.0, -20.0, 128.0, 96.0],
    [60.0, 40.0, 64.0, 48.0],
    [500.0, 500.0, 64.0, 48.0],
    [0.0; 4],
    [1e9, 0.0, 1e9, 1e9],
    [0.0, 0.0, f64::NAN, 48.0],
];
const ODD: [f64; 10] = [
    0.0,
    -0.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    1e300,
    -1e300,
    5e-324,
    1e20,
    -1.0,
];

/// The last calls with their results, and the number of those that succeeded.
static CALLS: Mutex<(VecDeque<String>, u32)> = Mutex::new((VecDeque::new(), 0));

/// Notes a call. True if it has succeeded.
fn noted(name: &str, result: RevmapResult) -> bool {
    let succeeds = result == RevmapResult::Ok;
    let text = if succeeds {
        String::new()
    } else {
        crate::text()
    };
    {
        let (last, done) = &mut *CALLS.lock().unwrap();
        *done += u32::from(succeeds);
        last.push_back(format!("{name}: {result:?} {text}"));
        if last.len() > 30 {
            last.pop_front();
        }
    }
    let never = [
        RevmapResult::Internal,
        RevmapResult::DeviceLost,
        RevmapResult::Busy,
    ];
    assert!(!never.contains(&result), "{name}: {text}");
    succeeds
}

/// A call that may fail. True if it has succeeded.
macro_rules! call {
    ($function:ident($($argument:expr),* $(,)?)) => {{
        // SAFETY: pointers are live or null, handles are numbers. Vulkan's handles are the host's.
        #[allow(unused_unsafe)]
        let result = unsafe { $function($($argument),*) };
        noted(stringify!($function), result)
    }};
}

macro_rules! calls {
    ($($function:ident($($argument:expr),*);)*) => {{$( call!($function($($argument),*)); )*}};
}

/// Keeps the handle that a call makes.
macro_rules! made {
    ($driver:ident, $function:ident($($argument:expr),*)) => {{
        let mut handle = null_mut();
        if call! { $function($($argument,)* &mut handle) } {
            $driver.live(&handle).push(handle.addr());
        }
    }};
}

/// The bytes of members from some to others.
macro_rules! kept {
    ($name:ident: $($from:ident..$to:ident),*) => {
        [$([offset_of!($name, $from), offset_of!($name, $to)]),*]
    };
}

impl Random {
    /// A number of an enumeration of so many, or a little beyond.
    fn one_of(&mut self, count: usize) -> u32 {
        match self.chance(0.04) {
            true => self.pick(&[count as u32, u32::MAX]),
            false => self.below(count) as u32,
        }
    }

    /// A number, mostly of a usual size.
    fn number(&mut self) -> f64 {
        match self.chance(0.03) {
            true => self.pick(&ODD),
            false => self.between(-1.0, 1.0),
        }
    }

    fn numbers<const N: usize>(&mut self) -> [f64; N] {
        [(); N].map(|()| self.number())
    }

    /// Gives some words of plain numbers other values: a double, a float or an integer. The bytes
    /// of `kept` stay.
    fn spoil<T: Copy>(&mut self, value: &mut T, kept: &[[usize; 2]]) {
        for _ in 0..self.pick(&[0, 0, 0, 1, 2, 4]) {
            let at = 4 * self.below(size_of::<T>() / 4);
            let bytes = match self.below(4) {
                0 | 1 => self.number().to_ne_bytes().to_vec(),
                2 => (self.number() as f32).to_ne_bytes().to_vec(),
                _ => self.pick(&[0u32, 1, 2, 3, 9]).to_ne_bytes().to_vec(),
            };
            // Doubles start at multiples of eight bytes.
            let at = at / bytes.len() * bytes.len();
            let end = at + bytes.len();
            let is_kept = kept.iter().any(|k| at < k[1] && k[0] < end);
            if end <= size_of::<T>() && !is_kept {
                let to = (&raw mut *value).cast::<u8>();
                // SAFETY: within the value, of which any bits are numbers.
                unsafe {
                    to.add(at)
                        .copy_from_nonoverlapping(bytes.as_ptr(), bytes.len())
                };
            }
        }
    }

    /// A spoilt structure that begins with its size, mostly the right one. The second gives room to
    /// larger sizes.
    fn spoilt<T: Copy>(&mut self, mut value: T, kept: &[[usize; 2]]) -> [T; 2] {
        let own = size_of::<T>();
        let size = match self.chance(0.02) {
            true => self.pick(&[0, 4, own - 8, own + 8, own + 4, usize::MAX]),
            false => own,
        };
        self.spoil(&mut value, kept);
        // SAFETY: the structure begins with its size.
        unsafe { (&raw mut value).cast::<u32>().write(size as u32) };
        [value; 2]
    }

    fn placement(&mut self) -> RevmapPlacement {
        let mut placement = RevmapPlacement {
            position: self.numbers(),
            rotation: [0.0, 0.0, 0.0, 1.0],
            scale: [1.0; 3],
        };
        if self.chance(0.3) {
            let angle = self.between(-3.0, 3.0);
            placement.rotation = [0.0, angle.sin(), 0.0, angle.cos()];
        }
        if self.chance(0.05) {
            self.spoil(&mut placement, &[]);
        }
        placement
    }

    fn view(&mut self) -> [RevmapView; 2] {
        let eye = DVec3::new(2.0, 2.0 * self.number(), 1.0 + self.number());
        let matrices = view_and_projection(eye, DVec3::new(0.0, 0.0, 0.5), &SIZE);
        let [view, projection] = matrices.map(|matrix| matrix.to_cols_array());
        let made = RevmapView {
            view,
            projection,
            viewport: match self.chance(0.4) {
                true => self.pick(&VIEWPORTS),
                false => WHOLE,
            },
            mask: self.pick(&[0, 0, 1, 2, u32::MAX]),
            ..sized!(RevmapView)
        };
        self.spoilt(made, &kept!(RevmapView: last..jitter))
    }
}

/// What a renderer draws into.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Color,
    List,
    Depth,
    Compute,
}

/// Formats of the attachments of a list, with numbers of `RevmapAttachment`.
const LIST: [(vk::Format, u32); 4] = [
    (vk::Format::R16G16B16A16_SFLOAT, 0),
    (vk::Format::R32G32B32A32_SFLOAT, 2),
    (vk::Format::R32G32_SFLOAT, 5),
    (vk::Format::R32G32_UINT, 6),
];

struct Made {
    handle: *mut RevmapRenderer,
    kind: Kind,
    slots: u32,
    objects: Vec<RevmapObject>,
}

struct Driver<'a> {
    host: &'a Host,
    dice: Random,
    /// One for each kind of renderer.
    canvases: [Canvas<'a>; 4],
    renderers: Vec<Made>,
    /// Numbers of all other handles, by their type.
    handles: HashMap<TypeId, Vec<usize>>,
    /// Numbers of handles that were destroyed.
    dead: Vec<usize>,
    seed: u64,
}

impl Drop for Driver<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            println!("REVMAP_SOAK_SEED={}; the last calls:", self.seed);
            let calls = CALLS.lock().unwrap_or_else(PoisonError::into_inner);
            calls.0.iter().for_each(|call| println!("  {call}"));
        }
    }
}

impl Driver<'_> {
    /// The live handles of a type.
    fn live<T: 'static>(&mut self, _: &*mut T) -> &mut Vec<usize> {
        self.handles.entry(TypeId::of::<T>()).or_default()
    }

    /// A number that is no live handle, or hardly ever.
    fn none(&mut self) -> usize {
        match self.dice.below(3) {
            0 => 0,
            1 if !self.dead.is_empty() => self.dice.pick(&self.dead),
            _ => self.dice.below(1 << 20),
        }
    }

    /// A live handle, or one that is none.
    fn some<T: 'static>(&mut self) -> *mut T {
        let live = self.live(&null_mut::<T>()).clone();
        without_provenance_mut(match live.is_empty() || self.dice.chance(0.06) {
            true => self.none(),
            false => self.dice.pick(&live),
        })
    }

    /// Destroys a handle if there are more than `least`, and tries to destroy one that is gone.
    fn destroy<T: 'static>(
        &mut self,
        least: usize,
        destroy: extern "C" fn(*mut T) -> RevmapResult,
    ) -> bool {
        if let 1.. = self.dead.len() {
            let dead = self.dice.pick(&self.dead);
            assert!(!noted("destroy", destroy(without_provenance_mut(dead))));
        }
        let count = self.live(&null_mut::<T>()).len();
        if count > least {
            let number = self.dice.below(count);
            let handle = self.live(&null_mut::<T>()).swap_remove(number);
            assert!(noted("destroy", destroy(without_provenance_mut(handle))));
            self.dead.push(handle);
        }
        count > least
    }

    /// Destroys one of each kind, or if all go, every one.
    fn clear(&mut self, all: bool) {
        let least = |number: usize| if all { 0 } else { number };
        while self.destroy(least(3), revmap_profile_destroy) && all {}
        while self.destroy(least(1), revmap_color_map_destroy) && all {}
        while self.destroy(least(1), revmap_height_map_destroy) && all {}
        while self.destroy(least(1), revmap_ray_caster_destroy) && all {}
        while self.destroy(least(0), revmap_offscreen_destroy) && all {}
        while self.destroy(least(4), revmap_prewarm_destroy) && all {}
        while self.destroy(least(2), revmap_host_image_destroy) && all {}
    }

    fn object(&mut self, copies: &[RevmapPlacement]) -> [RevmapObjectInfo; 2] {
        let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
        info.profile = self.some();
        if self.dice.chance(0.3) {
            (info.color_map, info.height_map) = (self.some(), self.some());
        }
        let dice = &mut self.dice;
        info.map_rows = dice.pick(&[16, 32, 32, 64, 0, 1, 99_999]);
        info.placement = dice.placement();
        if dice.chance(0.2) {
            info.repeat = [(); 3].map(|()| dice.one_of(3).wrapping_add(1));
            info.mirror = [(); 3].map(|()| dice.one_of(2));
        }
        (info.projection, info.bump_form) = (dice.one_of(4), dice.one_of(2));
        (info.instances, info.instance_count) = (copies.as_ptr(), copies.len());
        let kept = kept!(RevmapObjectInfo: profile..color, instances..has_material);
        dice.spoilt(info, &kept)
    }

    fn make_renderer(&mut self) {
        let device = self.some::<RevmapDevice>();
        let dice = &mut self.dice;
        let search = defaults!(revmap_search_defaults, RevmapSearch);
        let search = dice.spoilt(search, &kept!(RevmapSearch: max_steps..map_rows));
        let search = if dice.chance(0.5) {
            null()
        } else {
            search.as_ptr()
        };
        let slots = dice.one_of(3).wrapping_add(1);
        let kind = dice.pick(&[Kind::Color, Kind::List, Kind::Depth, Kind::Compute]);
        let (mut handle, mut planes) = (null_mut(), 0);
        let made = if kind == Kind::Compute {
            planes = if dice.chance(0.1) { dice.one_of(5) } else { 0 };
            call! { revmap_renderer_create_compute(device, planes, search, slots, &mut handle) }
        } else {
            let formats: Vec<_> = match kind {
                Kind::List => LIST.iter().map(|(format, _)| *format).collect(),
                Kind::Color => vec![COLOR],
                _ => Vec::new(),
            };
            let numbers = LIST.map(|(_, number)| number);
            let pass = RevmapPass {
                samples: 1,
                planes: [0, 4, 2][kind as usize],
                color_formats: formats.as_ptr(),
                color_format_count: formats.len() as u32,
                depth_format: DEPTH,
                attachments: numbers.as_ptr(),
                attachment_count: if kind == Kind::List { 4 } else { 0 },
                ..sized!(RevmapPass)
            };
            let pass = dice.spoilt(pass, &[[0, size_of::<RevmapPass>()]]);
            call! { revmap_renderer_create(device, pass.as_ptr(), search, slots, &mut handle) }
        };
        // Other planes need another target.
        if !made || planes != 0 {
            calls! { revmap_renderer_destroy(handle); }
            return;
        }
        let mut target = sized!(RevmapComputeTarget);
        if let Canvas::Words(words) = &self.canvases[Kind::Compute as usize] {
            target.words = words.raw;
        }
        let set = call! { revmap_renderer_set_compute_target(handle, &target) };
        assert_eq!(set, kind == Kind::Compute);
        self.renderers.push(Made {
            handle,
            kind,
            slots,
            objects: Vec::new(),
        });
    }

    fn drop_renderer(&mut self, number: usize) {
        let handle = self.renderers.swap_remove(number).handle;
        assert!(call! { revmap_renderer_destroy(handle) });
        self.dead.push(handle.addr());
    }

    /// Prepares a slot; then records it, submits it, or does not.
    fn frame(&mut self, number: usize) {
        let dice = &mut self.dice;
        let (last, [mut view, more]) = (dice.view(), dice.view());
        view.last = if dice.chance(0.2) { &last[0] } else { null() };
        let Made {
            handle: renderer,
            kind,
            slots,
            ..
        } = self.renderers[number];
        let slot = dice.one_of(slots as usize);
        let [submits, records, warms, by_camera] =
            [0.7, 0.9, 0.1, 0.2].map(|part| dice.chance(part));
        let [near, far] = dice.numbers();
        let camera = dice.spoilt(defaults!(revmap_camera_defaults, RevmapCamera), &[]);
        if by_camera {
            view.viewport = WHOLE;
        }
        let (host, view) = (self.host, [view, more]);
        // What is recorded: the frame, or draws of nothing with its pipelines.
        let record = |cmd, ready| {
            let recorded = match (warms, kind) {
                (true, _) => call! { revmap_renderer_record_prewarm(renderer, cmd, slot) },
                (_, Kind::Compute) => call! { revmap_renderer_record_compute(renderer, cmd, slot) },
                _ => call! { revmap_renderer_record(renderer, cmd, slot) },
            };
            assert_eq!(recorded, ready);
        };
        let done = commands(host, submits, |cmd| {
            let ready = if by_camera {
                let (camera, near, far) = (camera.as_ptr(), near.abs(), 10.0 * far.abs());
                call! { revmap_renderer_prepare_camera(renderer, cmd, slot, camera, 64, 48, near, far) }
            } else {
                call! { revmap_renderer_prepare(renderer, cmd, slot, view.as_ptr()) }
            };
            let mut statistics = sized!(RevmapFrameStatistics);
            let known = call! { revmap_renderer_frame_statistics(renderer, slot, &mut statistics) };
            assert!(known || !ready);
            let [x, y, width, height] = view[0].viewport.map(|side| side as f32);
            // Vulkan refuses viewports far outside.
            let sides = [x, y, width, height, y + height];
            let usual = sides.iter().all(|side| side.abs() <= 16_384.0) && width > 0.0;
            let fits = kind != Kind::Compute || view[0].viewport == WHOLE;
            // Wrong arguments leave the frame before, which has another view.
            if !records || known != ready || ready && !(usual && fits) {
                return;
            }
            let viewport = vk::Viewport {
                x,
                y,
                width,
                height,
                min_depth: 0.0,
                max_depth: 1.0,
            };
            // SAFETY: `cmd` is recording outside of a pass, the canvas lives and does not change.
            unsafe {
                self.canvases[kind as usize].record(cmd, || {
                    if ready && kind != Kind::Compute {
                        host.device.cmd_set_viewport(cmd, 0, &[viewport]);
                    }
                    record(cmd, ready);
                });
            }
        });
        done.unwrap();
    }

    /// A change of an object, or of all.
    fn change(&mut self, number: usize) {
        let renderer = match self.dice.chance(0.06) {
            true => without_provenance_mut(self.none()),
            false => self.renderers[number].handle,
        };
        let dice = &mut self.dice;
        // Objects of other renderers are refused.
        let of = if dice.chance(0.05) { 0 } else { number };
        let objects = self.renderers[of].objects.clone();
        let object = match objects.is_empty() || dice.chance(0.05) {
            true => dice.below(1 << 16) as u64,
            false => dice.pick(&objects),
        };
        let count = dice.pick(&[0, 0, 0, 1, 5, 70, 200]);
        let copies: Vec<_> = (0..count).map(|_| dice.placement()).collect();
        let own = self.renderers[number].objects.len();
        match dice.below(16) {
            0..5 if own < 12 => {
                let (info, mut added) = (self.object(&copies), 0);
                if call! { revmap_renderer_add(renderer, info.as_ptr(), &mut added) } {
                    self.renderers[number].objects.push(added);
                }
            }
            0..6 => {
                if call! { revmap_renderer_remove(renderer, object) } {
                    let own = &mut self.renderers[number].objects;
                    own.retain(|other| *other != object);
                }
            }
            6 => {
                let info = self.object(&copies);
                calls! { revmap_renderer_set(renderer, object, info.as_ptr()); }
            }
            7 => {
                let mut offset = RevmapOffset {
                    extend: 0.2 * dice.number(),
                    bevel: 0.3 * dice.number().abs(),
                    chamfer: dice.number().abs(),
                };
                dice.spoil(&mut offset, &[]);
                calls! { revmap_renderer_set_offset(renderer, object, &offset); }
            }
            8 => calls! { revmap_renderer_set_placement(renderer, object, &dice.placement()); },
            9 => {
                let (at, count) = (copies.as_ptr(), copies.len());
                calls! { revmap_renderer_set_instances(renderer, object, at, count); }
            }
            10 => {
                let mask = dice.pick(&[0, 1, 2, u32::MAX]);
                calls! { revmap_renderer_set_mask(renderer, object, mask); }
            }
            11..13 => {
                let set = dice.pick(&[
                    revmap_renderer_set_color_image,
                    revmap_renderer_set_slope_image,
                    revmap_renderer_set_height_image,
                ]);
                let image = self.some();
                calls! { set(renderer, object, image); }
            }
            13 => {
                let mut light = RevmapLight {
                    direction: dice.numbers(),
                    color: [1.0; 3],
                    radius: 30.0 * dice.number() as f32,
                };
                dice.spoil(&mut light, &[]);
                let mut lighting = defaults!(revmap_lighting_defaults, RevmapLighting);
                lighting.shadow = dice.one_of(3);
                if dice.chance(0.5) {
                    (lighting.lights, lighting.light_count) = (&light, 1);
                }
                let kept = kept!(RevmapLighting: light_count..environment_up);
                let lighting = dice.spoilt(lighting, &kept);
                calls! { revmap_renderer_set_lighting(renderer, lighting.as_ptr()); }
            }
            14 => {
                calls! { revmap_renderer_object_number(renderer, object, &mut 0); }
                made! { self, revmap_renderer_ray_caster(renderer, object) }
            }
            _ => {
                let mut room = dice.spoilt(sized!(RevmapStatistics), &[]);
                let mut layout = vk::PipelineLayout::null();
                calls! {
                    revmap_renderer_hide_until_compiled(renderer, dice.one_of(2));
                    revmap_renderer_end_frame(renderer);
                    revmap_renderer_statistics(renderer, &mut room[0]);
                    revmap_renderer_note(renderer, dice.one_of(3), &mut null());
                    revmap_renderer_pipeline_layout(renderer, &mut layout);
                }
                made! { self, revmap_renderer_prewarm(renderer) }
            }
        }
    }

    /// Calls apart from renderers: profiles, textures, rays, the device, pictures without a host.
    fn supply(&mut self) {
        let (device, profile) = (self.some::<RevmapDevice>(), self.some::<RevmapProfile>());
        let dice = &mut self.dice;
        match dice.below(10) {
            0 | 1 => {
                let count = 3 + dice.below(6);
                let points = (0..count).map(|_| dice.numbers().map(f64::abs));
                let points: Vec<[f64; 2]> = points.collect();
                made! { self, revmap_profile_from_points(points.as_ptr(), count, 0.5) }
                calls! { revmap_profile_radius(profile, &mut 0.0); }
            }
            2 => {
                let (side, texels) = (dice.one_of(9).min(8), [[200, 40, 9, 255]; 64]);
                made! { self, revmap_color_map_from_texels(side, 8, texels.as_ptr()) }
            }
            3 => {
                let heights = dice.numbers::<64>().map(|n| n as f32);
                let (at, filter) = (heights.as_ptr(), dice.one_of(2));
                made! { self, revmap_height_map_from_heights(8, 8, at, filter) }
            }
            4 => self.picture(device),
            5 => {
                let mut info = dice.spoilt(sized!(RevmapDeviceInfo), &[]);
                let mut used = dice.spoilt(sized!(RevmapMemoryUse), &[]);
                calls! {
                    revmap_device_info(device, &mut info[0]);
                    revmap_device_memory_use(device, &mut used[0]);
                    revmap_device_check(device);
                }
            }
            6 => {
                let bytes: Vec<u8> = (0..dice.below(200)).map(|n| n as u8).collect();
                let (at, count) = (bytes.as_ptr().cast(), bytes.len());
                calls! {
                    revmap_device_add_pipeline_cache(device, at, count);
                    revmap_shading_from_bytes(at, count, &mut null_mut());
                    revmap_profile_from_bytes(at, count, 0, &mut null_mut());
                }
            }
            7 => {
                let count = dice.below(20);
                let ray = |_| RevmapRay {
                    origin: dice.numbers().map(|n| 3.0 * n),
                    direction: dice.numbers(),
                };
                let rays: Vec<_> = (0..count).map(ray).collect();
                let mut hits = vec![crate::zeros::<RevmapRayHit>(); count];
                let caster = self.some();
                calls! {
                    revmap_ray_caster_cast(caster, rays.as_ptr(), count, hits.as_mut_ptr());
                    revmap_ray_caster_bounds(caster, &mut crate::zeros());
                }
            }
            8 => {
                revmap_color_word(dice.number() as f32, 0.0, 1.0, dice.number() as f32);
                let (image, prewarm, compiles) = (self.some(), self.some(), self.dice.chance(0.2));
                calls! {
                    revmap_host_image_is_held(image, &mut 0);
                    revmap_prewarm_count(prewarm, &mut 0);
                }
                let _ = compiles && call! { revmap_prewarm_compile(prewarm) };
            }
            _ => self.clear(false),
        }
    }

    fn picture(&mut self, device: *mut RevmapDevice) {
        let objects = [self.object(&[])[0], self.object(&[])[0]];
        let dice = &mut self.dice;
        let mut scene = defaults!(revmap_scene_defaults, RevmapScene);
        (scene.objects, scene.object_count) = (objects.as_ptr(), dice.below(3));
        scene.lighting.shadow = dice.one_of(3);
        let pointers = [offset_of!(RevmapScene, lighting), size_of::<RevmapScene>()];
        let scene = dice.spoilt(scene, &[pointers]);
        let mut picture = defaults!(revmap_picture_defaults, RevmapPicture);
        (picture.width, picture.height) = (dice.one_of(40), dice.one_of(30).wrapping_add(1));
        (picture.stage, picture.planes) = (dice.one_of(2), dice.one_of(2));
        let steps = offset_of!(RevmapPicture, search) + offset_of!(RevmapSearch, max_steps);
        let picture = dice.spoilt(picture, &[[steps, steps + 4]]);
        if self.live(&null_mut::<RevmapOffscreen>()).len() < 2 {
            made! { self, revmap_offscreen_create(device, picture.as_ptr(), scene.as_ptr()) }
        }
        let offscreen = self.some();
        let mut times = [sized!(RevmapTimes); 2];
        let (plane, mut bytes) = (self.dice.one_of(8), vec![0u8; 16 * self.dice.below(1200)]);
        let (at, count) = (bytes.as_mut_ptr().cast(), bytes.len());
        calls! {
            revmap_offscreen_update(offscreen, scene.as_ptr());
            revmap_offscreen_draw(offscreen, &mut times[0]);
            revmap_offscreen_read(offscreen, plane, at, count);
            revmap_offscreen_write_png(offscreen, c"/missing/a.png".as_ptr());
        }
    }

    fn step(&mut self) {
        if self.renderers.is_empty() || (self.renderers.len() < 3 && self.dice.chance(0.03)) {
            return self.make_renderer();
        }
        let number = self.dice.below(self.renderers.len());
        match self.dice.below(100) {
            0..2 => self.drop_renderer(number),
            2..40 => self.frame(number),
            40..80 => self.change(number),
            _ => self.supply(),
        }
    }
}

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

#[test]
fn random_calls_meet_no_fault() {
    let host = open();
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
    let seed = variable("REVMAP_SOAK_SEED").unwrap_or(now.as_nanos() as u64);
    let seconds = variable("REVMAP_SOAK_SECONDS").map_or(5, |seconds| seconds.div_ceil(4));
    let textures = [
        (vk::Format::R8G8B8A8_UNORM, [200, 90, 30, 255]),
        (vk::Format::R8G8B8A8_SNORM, [10, 250, 0, 0]),
    ];
    let textures = textures.map(|(format, texel)| Texture::new(&host, format, &[texel; 64]));
    let list = LIST.map(|(format, _)| format);
    let pass = |formats: &[_]| Canvas::pass(&host, SIZE, formats);
    let mut driver = Driver {
        host: &host,
        dice: Random(seed),
        canvases: [
            pass(&[COLOR]),
            pass(&list),
            pass(&[]),
            Canvas::words(&host, SIZE),
        ],
        renderers: Vec::new(),
        handles: HashMap::new(),
        dead: Vec::new(),
        seed,
    };
    let (device, profile) = (lend_with_queue(&host), crate::arguments::spindle());
    driver.live(&device).push(device.addr());
    driver.live(&profile).push(profile.addr());
    for texture in &textures {
        let (view, sampler) = (texture.memory.view, texture.sampler);
        made! { driver, revmap_host_image_create(view, sampler) }
    }
    let begin = Instant::now();
    let mut steps = 0;
    // A slow machine takes some steps, too.
    while begin.elapsed() < Duration::from_secs(seconds) || steps < 100 {
        driver.step();
        assert_silent(&host);
        steps += 1;
    }
    while !driver.renderers.is_empty() {
        driver.drop_renderer(0);
    }
    driver.clear(true);
    assert!(driver.destroy(0, revmap_device_destroy));
    let done = CALLS.lock().unwrap().1;
    println!("seed {seed}: {steps} steps, {done} calls succeeded");
    assert!(done > 50, "{done} calls of {steps} steps");
}
