//! A random host: calls of the C interface in any order, with valid and invalid handles, sizes and
//! values. No call meets a fault of the library, and the validation layers report nothing.
//!
//! A quarter of `REVMAP_SOAK_SECONDS` is the time, `REVMAP_SOAK_SEED` repeats a run.

use crate::host::{COLOR, Canvas, DEPTH, Host, Options, Texture, assert_silent, commands, open};
use crate::names::*;
use crate::recording::lend_with;
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
    let (last, done) = &mut *CALLS.lock().unwrap();
    *done += u32::from(succeeds);
    last.push_back(format!("{name}: {result:?} {text}"));
    if last.len() > 30 {
        last.pop_front();
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

mod supplies;
mod values;

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
    let (device, profile) = (lend_with(&host, host.queue), crate::spindle());
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
