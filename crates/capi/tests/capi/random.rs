//! A random host: calls of the C interface in any order, with valid and invalid handles, sizes and
//! values. No call meets a fault of the library, and the validation layers report nothing.
//!
//! A quarter of `REVMAP_SOAK_SECONDS` is the time, `REVMAP_SOAK_SEED` repeats a run.

use crate::host::{
    Attachments, COLOR, Checked, DEPTH, Host, HostBuffer, Options, Texture, assert_silent, barrier,
    commands, open, view_and_projection,
};
use crate::recording::lend_with_queue;
use ash::vk;
use glam::DVec3;
use revmap_capi::device::*;
use revmap_capi::fault::*;
use revmap_capi::object::*;
use revmap_capi::offscreen::*;
use revmap_capi::profile::*;
use revmap_capi::rays::*;
use revmap_capi::renderer::frame::*;
use revmap_capi::renderer::objects::*;
use revmap_capi::renderer::statistics::*;
use revmap_capi::renderer::*;
use revmap_capi::shading::*;
use revmap_capi::texture::*;
use revmap_capi::values::*;
use std::collections::VecDeque;
use std::ptr::{null, null_mut, without_provenance_mut};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

#[path = "../../../../tests/common/random.rs"]
mod numbers;
use numbers::Random;

/// The size of every target.
const SIZE: Options = Options {
    width: 64,
    height: 48,
    dynamic: true,
    samples: 1,
    reversed: false,
};
const WHOLE: [f64; 4] = [0.0, 0.0, 64.0, 48.0];

/// What a renderer draws into.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Color,
    List,
    Depth,
    Compute,
}

/// Formats of the attachments of a list, with bytes a pixel and numbers of `RevmapAttachment`.
const LIST: [(vk::Format, usize, u32); 4] = [
    (vk::Format::R16G16B16A16_SFLOAT, 8, 0),
    (vk::Format::R32G32B32A32_SFLOAT, 16, 2),
    (vk::Format::R32G32_SFLOAT, 8, 5),
    (vk::Format::R32G32_UINT, 8, 6),
];

struct Made {
    handle: *mut RevmapRenderer,
    kind: Kind,
    slots: u32,
    objects: Vec<RevmapObject>,
    prewarms: Vec<*mut RevmapPrewarm>,
}

struct Driver<'a> {
    host: &'a Host,
    random: Random,
    device: *mut RevmapDevice,
    into: [Attachments<'a>; 3],
    words: HostBuffer<'a>,
    images: Vec<*mut RevmapHostImage>,
    renderers: Vec<Made>,
    profiles: Vec<*mut RevmapProfile>,
    colors: Vec<*mut RevmapColorMap>,
    heights: Vec<*mut RevmapHeightMap>,
    casters: Vec<*mut RevmapRayCaster>,
    pictures: Vec<*mut RevmapOffscreen>,
    /// Numbers of handles that were destroyed.
    dead: Vec<usize>,
    /// The last calls and their results.
    calls: VecDeque<String>,
    seed: u64,
    done: u32,
}

impl Drop for Driver<'_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            println!("REVMAP_SOAK_SEED={}; the last calls:", self.seed);
            self.calls.iter().for_each(|call| println!("  {call}"));
        }
    }
}

/// Notes a call and its result.
macro_rules! call {
    ($driver:ident, $function:ident($($argument:expr),* $(,)?)) => {{
        // SAFETY: pointers are live or null, handles are numbers. Vulkan's handles are the host's.
        #[allow(unused_unsafe)]
        let result = unsafe { $function($($argument),*) };
        $driver.noted(stringify!($function), result)
    }};
}

impl<'a> Driver<'a> {
    /// True if the call has succeeded.
    fn noted(&mut self, name: &str, result: RevmapResult) -> bool {
        let text = match result {
            RevmapResult::Ok => String::new(),
            _ => crate::text(),
        };
        self.done += u32::from(result == RevmapResult::Ok);
        self.calls.push_back(format!("{name}: {result:?} {text}"));
        if self.calls.len() > 30 {
            self.calls.pop_front();
        }
        assert_ne!(result, RevmapResult::Internal, "{name}: {text}");
        let unlike = [RevmapResult::DeviceLost, RevmapResult::Busy];
        assert!(!unlike.contains(&result), "{name}: {text}");
        result == RevmapResult::Ok
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.random.next() * count as f64) as usize).min(count.saturating_sub(1))
    }

    fn chance(&mut self, part: f64) -> bool {
        self.random.next() < part
    }

    /// A number, mostly of a usual size.
    fn number(&mut self) -> f64 {
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
        match self.chance(0.03) {
            true => ODD[self.below(ODD.len())],
            false => 2.0 * self.random.next() - 1.0,
        }
    }

    /// A number of an enumeration of so many, or a little beyond.
    fn of(&mut self, count: usize) -> u32 {
        match self.chance(0.04) {
            true => [count as u32, u32::MAX][self.below(2)],
            false => self.below(count) as u32,
        }
    }

    /// One of these handles, or one that is none.
    fn handle<T>(&mut self, from: &[*mut T]) -> *mut T {
        if !from.is_empty() && !self.chance(0.06) {
            return from[self.below(from.len())];
        }
        let number = match self.below(3) {
            0 => 0,
            1 if !self.dead.is_empty() => {
                let number = self.below(self.dead.len());
                self.dead[number]
            }
            _ => self.below(1 << 20),
        };
        without_provenance_mut(number)
    }

    fn buried<T>(&mut self, handle: *mut T) {
        self.dead.push(handle.addr());
    }

    /// A structure's size, mostly the right one.
    fn size<T>(&mut self) -> u32 {
        let own = size_of::<T>();
        match self.chance(0.02) {
            true => [0, 4, own - 8, own + 8, own + 4, usize::MAX][self.below(6)] as u32,
            false => own as u32,
        }
    }

    fn placement(&mut self) -> RevmapPlacement {
        let mut placement = RevmapPlacement {
            position: [0; 3].map(|_: i32| self.number()),
            rotation: [0.0, 0.0, 0.0, 1.0],
            scale: [1.0; 3],
        };
        if self.chance(0.3) {
            let angle = 3.0 * self.number();
            placement.rotation = [0.0, angle.sin(), 0.0, angle.cos()];
        }
        if self.chance(0.2) {
            placement.scale = [0; 3].map(|_: i32| self.number() + 1.1);
        }
        placement
    }

    fn offset(&mut self) -> RevmapOffset {
        RevmapOffset {
            extend: 0.2 * self.number(),
            bevel: 0.3 * self.number().abs(),
            chamfer: self.number().abs(),
        }
    }

    fn object(&mut self, copies: &[RevmapPlacement]) -> RevmapObjectInfo {
        let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
        info.profile = self.handle(&self.profiles.clone());
        info.map_rows = [16, 32, 32, 64, 0, 1, 99_999][self.below(7)];
        if self.chance(0.3) {
            info.color_map = self.handle(&self.colors.clone());
        }
        if self.chance(0.3) {
            info.height_map = self.handle(&self.heights.clone());
        }
        if self.chance(0.5) {
            info.offset = self.offset();
        }
        if self.chance(0.2) {
            info.repeat = [0; 3].map(|_: i32| self.of(3).wrapping_add(1));
            info.mirror = [0; 3].map(|_: i32| self.of(2));
        }
        if self.chance(0.2) {
            info.axis = [0; 2].map(|_: i32| self.number().abs());
        }
        (info.projection, info.bump_form) = (self.of(4), self.of(2));
        info.clip = self.of(2);
        info.bump = 0.1 * self.number();
        info.texture_offset = [0; 2].map(|_: i32| self.number());
        info.placement = self.placement();
        info.has_material = self.of(2);
        (info.roughness, info.metalness) = (self.number() as f32, 0.5);
        info.specular_strength = self.number().abs() as f32;
        if !copies.is_empty() {
            (info.instances, info.instance_count) = (copies.as_ptr(), copies.len());
        }
        info.size = self.size::<RevmapObjectInfo>();
        info
    }

    fn copies(&mut self) -> Vec<RevmapPlacement> {
        let count = [0, 0, 0, 1, 5, 70, 200][self.below(7)];
        (0..count).map(|_| self.placement()).collect()
    }

    fn search(&mut self) -> RevmapSearch {
        let mut search = defaults!(revmap_search_defaults, RevmapSearch);
        if self.chance(0.3) {
            (search.solver, search.max_steps) = (self.of(10), self.of(50));
            (search.map_source, search.map_format) = (self.of(4), self.of(3));
            search.map_rows = [0, 16, 32, 1, 1 << 20][self.below(5)];
            search.tolerance = self.number().abs();
        }
        search.size = self.size::<RevmapSearch>();
        search
    }

    fn view(&mut self) -> RevmapView {
        let eye = DVec3::new(2.0, 2.0 * self.number(), 1.0 + self.number());
        let target = DVec3::new(0.0, 0.0, 0.5);
        let [view, projection] = view_and_projection(eye, target, &SIZE);
        let mut made = RevmapView {
            view: view.to_cols_array(),
            projection: projection.to_cols_array(),
            viewport: WHOLE,
            ..sized!(RevmapView)
        };
        if self.chance(0.4) {
            let n = self.number();
            const VIEWPORTS: [[f64; 4]; 7] = [
                [0.0, 48.0, 64.0, -48.0],
                [-50.0, -20.0, 128.0, 96.0],
                [60.0, 40.0, 64.0, 48.0],
                [500.0, 500.0, 64.0, 48.0],
                [0.0; 4],
                [1e9, 0.0, 1e9, 1e9],
                [0.0, 0.0, f64::NAN, 48.0],
            ];
            made.viewport = VIEWPORTS[self.below(7)];
            if self.chance(0.2) {
                made.viewport[self.below(4)] = 100.0 * n;
            }
        }
        if self.chance(0.05) {
            made.projection[self.below(16)] = self.number();
        }
        if self.chance(0.05) {
            made.view[self.below(16)] = self.number();
        }
        made.depth_order = if self.chance(0.1) { self.of(2) } else { 0 };
        if self.chance(0.2) {
            made.jitter = [self.number(), self.number()];
        }
        if self.chance(0.1) {
            (made.depth_bias, made.layer) = (0.01 * self.number(), self.of(2));
        }
        made.mask = [0, 0, 1, 2, u32::MAX][self.below(5)];
        made.size = self.size::<RevmapView>();
        made
    }

    fn make_renderer(&mut self) {
        let (search, slots) = (self.search(), self.of(3).wrapping_add(1));
        let kind = [Kind::Color, Kind::List, Kind::Depth, Kind::Compute][self.below(4)];
        let mut handle = null_mut();
        let search = if self.chance(0.5) {
            null()
        } else {
            &raw const search
        };
        let formats: Vec<_> = match kind {
            Kind::List => LIST.iter().map(|(format, ..)| *format).collect(),
            Kind::Color => vec![COLOR],
            _ => Vec::new(),
        };
        let numbers = LIST.map(|(.., number)| number);
        let pass = RevmapPass {
            size: self.size::<RevmapPass>(),
            samples: 1,
            planes: [0, 4, 2, 0][kind as usize],
            color_formats: formats.as_ptr(),
            color_format_count: formats.len() as u32,
            depth_format: DEPTH,
            attachments: numbers.as_ptr(),
            attachment_count: if kind == Kind::List { 4 } else { 0 },
            ..crate::zeros()
        };
        let made = match kind {
            Kind::Compute => {
                let planes = if self.chance(0.1) { self.of(5) } else { 0 };
                let device = self.device;
                // Other planes need another target.
                call!(
                    self,
                    revmap_renderer_create_compute(device, planes, search, slots, &mut handle)
                ) && planes == 0
            }
            _ => {
                let device = self.handle(&[self.device]);
                call!(
                    self,
                    revmap_renderer_create(device, &pass, search, slots, &mut handle)
                )
            }
        };
        if !made {
            let _ = call!(self, revmap_renderer_destroy(handle));
            return;
        }
        let target = RevmapComputeTarget {
            words: self.words.raw,
            ..sized!(RevmapComputeTarget)
        };
        let set = call!(self, revmap_renderer_set_compute_target(handle, &target));
        assert_eq!(set, kind == Kind::Compute);
        self.renderers.push(Made {
            handle,
            kind,
            slots,
            objects: Vec::new(),
            prewarms: Vec::new(),
        });
    }

    fn drop_renderer(&mut self, number: usize) {
        let made = self.renderers.swap_remove(number);
        for prewarm in made.prewarms {
            call!(self, revmap_prewarm_destroy(prewarm));
            self.buried(prewarm);
        }
        call!(self, revmap_renderer_destroy(made.handle));
        self.buried(made.handle);
    }

    /// Prepares a slot; then records it, submits it, or does not.
    fn frame(&mut self, number: usize) {
        let (last, mut view) = (self.view(), self.view());
        view.last = if self.chance(0.2) { &last } else { null() };
        let Made {
            handle: renderer,
            kind,
            slots,
            ..
        } = self.renderers[number];
        let slot = self.of(slots as usize);
        let submits = self.chance(0.7);
        let records = self.chance(0.9);
        let warms = self.chance(0.1);
        let by_camera = self.chance(0.2);
        let host = self.host;
        commands(host, submits, |cmd| {
            let ready = if by_camera {
                let camera = defaults!(revmap_camera_defaults, RevmapCamera);
                let (near, far) = (self.number().abs(), 10.0 * self.number().abs());
                view.viewport = WHOLE;
                call!(
                    self,
                    revmap_renderer_prepare_camera(renderer, cmd, slot, &camera, 64, 48, near, far)
                )
            } else {
                call!(self, revmap_renderer_prepare(renderer, cmd, slot, &view))
            };
            let mut statistics = sized!(RevmapFrameStatistics);
            let known = call!(
                self,
                revmap_renderer_frame_statistics(renderer, slot, &mut statistics)
            );
            assert!(known || !ready);
            // Wrong arguments leave the frame before, which has another view.
            if !records || known != ready {
                return;
            }
            if kind == Kind::Compute {
                if ready && view.viewport != WHOLE {
                    return; // the target has another size
                }
                // SAFETY: `cmd` is recording outside of a pass; the words live until it has run.
                unsafe {
                    let whole = vk::WHOLE_SIZE;
                    host.device
                        .cmd_fill_buffer(cmd, self.words.raw, 0, whole, 1f32.to_bits());
                    barrier(host, cmd, &[]);
                }
                let recorded = match warms {
                    true => call!(self, revmap_renderer_record_prewarm(renderer, cmd, slot)),
                    false => call!(self, revmap_renderer_record_compute(renderer, cmd, slot)),
                };
                assert_eq!(recorded, ready);
                // SAFETY: as above.
                unsafe { barrier(host, cmd, &[]) };
                return;
            }
            // Vulkan refuses viewports far outside.
            let [x, y, width, height] = view.viewport.map(|side| side as f32);
            let within = |side: f32| side.abs() <= 16_384.0;
            let usual = within(x) && within(y) && within(width) && within(height) && width > 0.0;
            if ready && !(usual && within(y + height)) {
                return;
            }
            let clears = [vk::ClearColorValue::default(); 4];
            let viewport = vk::Viewport {
                x,
                y,
                width,
                height,
                min_depth: 0.0,
                max_depth: 1.0,
            };
            let into = std::ptr::from_ref(&self.into[kind as usize]);
            // SAFETY: `cmd` is recording outside of a pass, the attachments live and do not change.
            unsafe {
                (*into).draw(cmd, &clears, false, || {
                    if ready {
                        host.device.cmd_set_viewport(cmd, 0, &[viewport]);
                    }
                    let recorded = match warms {
                        true => call!(self, revmap_renderer_record_prewarm(renderer, cmd, slot)),
                        false => call!(self, revmap_renderer_record(renderer, cmd, slot)),
                    };
                    assert_eq!(recorded, ready);
                });
            }
        });
    }

    /// A change of an object, or of all.
    fn change(&mut self, number: usize) {
        let renderer = self.handle(&[self.renderers[number].handle]);
        let objects = match self.chance(0.05) {
            true => self
                .renderers
                .iter()
                .flat_map(|r| r.objects.clone())
                .collect(),
            false => self.renderers[number].objects.clone(),
        };
        let object = match objects.is_empty() || self.chance(0.05) {
            true => self.below(1 << 16) as u64,
            false => objects[self.below(objects.len())],
        };
        let copies = self.copies();
        match self.below(16) {
            0..5 if objects.len() < 12 => {
                let (info, mut added) = (self.object(&copies), 0);
                if call!(self, revmap_renderer_add(renderer, &info, &mut added)) {
                    self.renderers[number].objects.push(added);
                }
            }
            0..6 => {
                if call!(self, revmap_renderer_remove(renderer, object)) {
                    self.renderers[number]
                        .objects
                        .retain(|other| *other != object);
                }
            }
            6 => {
                let info = self.object(&copies);
                call!(self, revmap_renderer_set(renderer, object, &info));
            }
            7 => {
                let offset = self.offset();
                call!(self, revmap_renderer_set_offset(renderer, object, &offset));
            }
            8 => {
                let placement = self.placement();
                call!(
                    self,
                    revmap_renderer_set_placement(renderer, object, &placement)
                );
            }
            9 => {
                let (at, count) = (copies.as_ptr(), copies.len());
                call!(
                    self,
                    revmap_renderer_set_instances(renderer, object, at, count)
                );
            }
            10 => {
                let mask = [0, 1, 2, u32::MAX][self.below(4)];
                call!(self, revmap_renderer_set_mask(renderer, object, mask));
            }
            11..13 => {
                let image = self.handle(&self.images.clone());
                let set = [
                    revmap_renderer_set_color_image,
                    revmap_renderer_set_slope_image,
                    revmap_renderer_set_height_image,
                ];
                let set = set[self.below(3)];
                call!(self, set(renderer, object, image));
            }
            13 => {
                let mut lighting = defaults!(revmap_lighting_defaults, RevmapLighting);
                lighting.shadow = self.of(3);
                lighting.ambient = [self.number().abs() as f32; 3];
                let light = RevmapLight {
                    direction: [0; 3].map(|_: i32| self.number()),
                    color: [1.0; 3],
                    radius: 30.0 * self.number() as f32,
                };
                if self.chance(0.5) {
                    (lighting.lights, lighting.light_count) = (&light, 1);
                }
                call!(self, revmap_renderer_set_lighting(renderer, &lighting));
            }
            14 => {
                let mut caster = null_mut();
                if call!(
                    self,
                    revmap_renderer_ray_caster(renderer, object, &mut caster)
                ) {
                    self.casters.push(caster);
                }
                let mut number = 0;
                call!(
                    self,
                    revmap_renderer_object_number(renderer, object, &mut number)
                );
            }
            _ => {
                let hides = self.of(2);
                call!(self, revmap_renderer_hide_until_compiled(renderer, hides));
                call!(self, revmap_renderer_end_frame(renderer));
            }
        }
    }

    fn ask(&mut self, number: usize) {
        let renderer = self.handle(&[self.renderers[number].handle]);
        let device = self.handle(&[self.device]);
        match self.below(6) {
            0 => {
                let mut statistics = sized!(RevmapStatistics);
                statistics.size = self.size::<RevmapStatistics>();
                let mut room = [statistics; 2];
                call!(self, revmap_renderer_statistics(renderer, &mut room[0]));
                let (note, mut text) = (self.of(3), null());
                call!(self, revmap_renderer_note(renderer, note, &mut text));
            }
            1 => {
                let mut prewarm = null_mut();
                if call!(self, revmap_renderer_prewarm(renderer, &mut prewarm)) {
                    let mut count = 0;
                    call!(self, revmap_prewarm_count(prewarm, &mut count));
                    if self.chance(0.2) {
                        call!(self, revmap_prewarm_compile(prewarm));
                    }
                    self.renderers[number].prewarms.push(prewarm);
                }
            }
            2 => {
                let mut room = [sized!(RevmapDeviceInfo); 2];
                room[0].size = self.size::<RevmapDeviceInfo>();
                call!(self, revmap_device_info(device, &mut room[0]));
                let mut room = [sized!(RevmapMemoryUse); 2];
                room[0].size = self.size::<RevmapMemoryUse>();
                call!(self, revmap_device_memory_use(device, &mut room[0]));
                call!(self, revmap_device_check(device));
            }
            3 => {
                let bytes: Vec<u8> = (0..self.below(200)).map(|n| n as u8).collect();
                let (at, count) = (bytes.as_ptr().cast(), bytes.len());
                let (mut profile, mut shading) = (null_mut(), null_mut());
                call!(self, revmap_device_add_pipeline_cache(device, at, count));
                call!(self, revmap_shading_from_bytes(at, count, &mut shading));
                call!(self, revmap_profile_from_bytes(at, count, 0, &mut profile));
                let mut layout = vk::PipelineLayout::null();
                call!(self, revmap_renderer_pipeline_layout(renderer, &mut layout));
            }
            4 => {
                let caster = self.handle(&self.casters.clone());
                let rays: Vec<_> = (0..self.below(20))
                    .map(|_| RevmapRay {
                        origin: [0; 3].map(|_: i32| 3.0 * self.number()),
                        direction: [0; 3].map(|_: i32| self.number()),
                    })
                    .collect();
                let mut hits = vec![crate::zeros::<RevmapRayHit>(); rays.len()];
                let (from, count, to) = (rays.as_ptr(), rays.len(), hits.as_mut_ptr());
                call!(self, revmap_ray_caster_cast(caster, from, count, to));
                let mut bounds = crate::zeros();
                call!(self, revmap_ray_caster_bounds(caster, &mut bounds));
            }
            _ => {
                let (image, mut held) = (self.handle(&self.images.clone()), 0);
                call!(self, revmap_host_image_is_held(image, &mut held));
                revmap_color_word(self.number() as f32, 0.0, 1.0, self.number() as f32);
                let (profile, mut radius) = (self.handle(&self.profiles.clone()), 0.0);
                call!(self, revmap_profile_radius(profile, &mut radius));
            }
        }
    }

    /// Makes a profile, a texture or a picture without a host, or destroys one.
    fn supply(&mut self) {
        match self.below(7) {
            0 | 1 => {
                let points: Vec<[f64; 2]> = (0..3 + self.below(6))
                    .map(|_| [self.number().abs(), self.number().abs()])
                    .collect();
                let (at, count, mut profile) = (points.as_ptr(), points.len(), null_mut());
                if call!(
                    self,
                    revmap_profile_from_points(at, count, 0.5, &mut profile)
                ) {
                    self.profiles.push(profile);
                }
            }
            2 => {
                let texels = [[200, 40, 9, 255]; 64];
                let (side, mut map) = (self.of(9), null_mut());
                let side = side.min(8);
                if call!(
                    self,
                    revmap_color_map_from_texels(side, 8, texels.as_ptr(), &mut map)
                ) {
                    self.colors.push(map);
                }
            }
            3 => {
                let heights = [0; 64].map(|_: i32| self.number() as f32);
                let (filter, mut map) = (self.of(2), null_mut());
                if call!(
                    self,
                    revmap_height_map_from_heights(8, 8, heights.as_ptr(), filter, &mut map)
                ) {
                    self.heights.push(map);
                }
            }
            4 => self.picture(),
            _ => {
                macro_rules! destroy {
                    ($($list:ident: $function:ident, $keep:literal;)*) => {$(
                        if self.$list.len() > $keep {
                            let number = self.below(self.$list.len());
                            let handle = self.$list.swap_remove(number);
                            call!(self, $function(handle));
                            self.buried(handle);
                        }
                        let none = self.handle(&[]);
                        if !self.$list.contains(&none) {
                            call!(self, $function(none));
                        }
                    )*};
                }
                destroy! {
                    profiles: revmap_profile_destroy, 3;
                    colors: revmap_color_map_destroy, 1;
                    heights: revmap_height_map_destroy, 1;
                    casters: revmap_ray_caster_destroy, 1;
                    pictures: revmap_offscreen_destroy, 0;
                }
            }
        }
    }

    fn picture(&mut self) {
        let objects = [self.object(&[]), self.object(&[])];
        let mut scene = defaults!(revmap_scene_defaults, RevmapScene);
        (scene.objects, scene.object_count) = (objects.as_ptr(), self.below(3));
        scene.lighting.shadow = self.of(3);
        scene.camera.eye[1] = self.number();
        scene.size = self.size::<RevmapScene>();
        let mut picture = defaults!(revmap_picture_defaults, RevmapPicture);
        (picture.width, picture.height) = (self.of(40), self.of(30).wrapping_add(1));
        (picture.stage, picture.planes) = (self.of(2), self.of(2));
        if self.pictures.len() < 2 {
            let (device, mut made) = (self.handle(&[self.device]), null_mut());
            if call!(
                self,
                revmap_offscreen_create(device, &picture, &scene, &mut made)
            ) {
                self.pictures.push(made);
            }
        }
        let offscreen = self.handle(&self.pictures.clone());
        call!(self, revmap_offscreen_update(offscreen, &scene));
        let mut times = [sized!(RevmapTimes); 2];
        call!(self, revmap_offscreen_draw(offscreen, &mut times[0]));
        let (plane, mut bytes) = (self.of(8), vec![0u8; 16 * self.below(1200)]);
        let (at, count) = (bytes.as_mut_ptr().cast(), bytes.len());
        call!(self, revmap_offscreen_read(offscreen, plane, at, count));
        call!(
            self,
            revmap_offscreen_write_png(offscreen, c"/missing/a.png".as_ptr())
        );
    }

    fn step(&mut self) {
        if self.renderers.is_empty() || (self.renderers.len() < 3 && self.chance(0.03)) {
            return self.make_renderer();
        }
        let number = self.below(self.renderers.len());
        match self.below(100) {
            0..2 => self.drop_renderer(number),
            2..40 => self.frame(number),
            40..75 => self.change(number),
            75..88 => self.ask(number),
            _ => self.supply(),
        }
    }

    fn end(mut self) {
        while !self.renderers.is_empty() {
            self.drop_renderer(0);
        }
        macro_rules! destroy {
            ($($list:ident: $function:ident,)*) => {$(
                for handle in std::mem::take(&mut self.$list) {
                    assert!(call!(self, $function(handle)));
                }
            )*};
        }
        destroy! {
            profiles: revmap_profile_destroy, colors: revmap_color_map_destroy,
            heights: revmap_height_map_destroy, casters: revmap_ray_caster_destroy,
            pictures: revmap_offscreen_destroy, images: revmap_host_image_destroy,
        }
        let device = self.device;
        assert!(call!(self, revmap_device_destroy(device)));
    }
}

fn variable(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

#[test]
fn random_calls_meet_no_fault() {
    let host: Checked = open();
    let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap();
    let seed = variable("REVMAP_SOAK_SEED").unwrap_or(now.as_nanos() as u64);
    let seconds = variable("REVMAP_SOAK_SECONDS").map_or(5, |seconds| seconds.div_ceil(4));
    let texture = |format, texel| Texture::new(&host, format, &[texel; 64]);
    let textures = [
        texture(vk::Format::R8G8B8A8_UNORM, [200, 90, 30, 255]),
        texture(vk::Format::R8G8B8A8_SNORM, [10, 250, 0, 0]),
    ];
    let formats = [
        vec![(COLOR, 4)],
        LIST.map(|(f, bytes, _)| (f, bytes)).to_vec(),
        vec![],
    ];
    let into = formats.map(|formats| Attachments::new(&host, SIZE, &formats).unwrap());
    type Usage = vk::BufferUsageFlags;
    let usage = Usage::STORAGE_BUFFER | Usage::TRANSFER_DST;
    let mut driver = Driver {
        host: &host,
        random: Random(seed),
        device: lend_with_queue(&host),
        into,
        words: HostBuffer::new(&host, 8 * 64 * 48, usage).unwrap(),
        images: Vec::new(),
        renderers: Vec::new(),
        profiles: vec![crate::arguments::spindle()],
        colors: Vec::new(),
        heights: Vec::new(),
        casters: Vec::new(),
        pictures: Vec::new(),
        dead: Vec::new(),
        calls: VecDeque::new(),
        seed,
        done: 0,
    };
    for texture in &textures {
        let mut image = null_mut();
        let (view, sampler) = (texture.memory.view, texture.sampler);
        assert!(call!(
            driver,
            revmap_host_image_create(view, sampler, &mut image)
        ));
        driver.images.push(image);
    }
    let begin = Instant::now();
    let mut steps = 0;
    while begin.elapsed() < Duration::from_secs(seconds) {
        driver.step();
        assert_silent(&host);
        steps += 1;
    }
    let done = driver.done;
    driver.end();
    println!("seed {seed}: {steps} steps, {done} calls succeeded");
    assert!(done > 50, "{done} calls of {steps} steps");
}
