//! A random host: calls of the C interface in any order, with valid and invalid handles, sizes and
//! values. No call meets a fault of the library, and the validation layers report nothing.
//!
//! A quarter of `REVMAP_SOAK_SECONDS` is the time, `REVMAP_SOAK_SEED` repeats a run.

use crate::host::{COLOR, Canvas, DEPTH, Host, Options, Texture, assert_silent, commands, open};
use crate::names::*;
use crate::recording::lend_with_queue;
use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

mod values;
use values::Random;

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

macro_rules! call {
    ($function:ident($($argument:expr),* $(,)?)) => {{
        // SAFETY: pointers are live or null, handles are numbers. Vulkan's handles are the host's.
        #[allow(unused_unsafe)]
        let result = unsafe { $function($($argument),*) };
        noted(stringify!($function), result)
    }};
}

/// Calls that may fail.
macro_rules! calls {
    ($($function:ident($($argument:expr),*);)*) => {{$( call!($function($($argument),*)); )*}};
}

/// Keeps the handle that a call makes.
macro_rules! made {
    ($list:expr, $function:ident($($argument:expr),*);) => {{
        let mut handle = null_mut();
        if call! { $function($($argument,)* &mut handle) } {
            $list.push(handle);
        }
    }};
}

/// One of the handles of a list, or one that is none.
macro_rules! some {
    ($driver:ident.$list:ident) => {
        $driver.dice.handle(&$driver.dead, &$driver.$list)
    };
}

mod renderers;
mod supplies;
use renderers::{LIST, Made};

struct Driver<'a> {
    host: &'a Host,
    dice: Random,
    device: [*mut RevmapDevice; 1],
    /// One for each kind of renderer.
    canvases: [Canvas<'a>; 4],
    images: Vec<*mut RevmapHostImage>,
    renderers: Vec<Made>,
    profiles: Vec<*mut RevmapProfile>,
    colors: Vec<*mut RevmapColorMap>,
    heights: Vec<*mut RevmapHeightMap>,
    casters: Vec<*mut RevmapRayCaster>,
    pictures: Vec<*mut RevmapOffscreen>,
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
    fn object(&mut self, copies: &[RevmapPlacement]) -> RevmapObjectInfo {
        let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
        info.profile = some!(self.profiles);
        let dice = &mut self.dice;
        info.map_rows = dice.pick(&[16, 32, 32, 64, 0, 1, 99_999]);
        if dice.chance(0.3) {
            info.color_map = dice.handle(&self.dead, &self.colors);
        }
        if dice.chance(0.3) {
            info.height_map = dice.handle(&self.dead, &self.heights);
        }
        if dice.chance(0.5) {
            info.offset = dice.offset();
        }
        if dice.chance(0.2) {
            info.repeat = [(); 3].map(|()| dice.one_of(3).wrapping_add(1));
            info.mirror = [(); 3].map(|()| dice.one_of(2));
        }
        if dice.chance(0.2) {
            info.axis = dice.numbers().map(f64::abs);
        }
        (info.projection, info.bump_form) = (dice.one_of(4), dice.one_of(2));
        (info.clip, info.bump) = (dice.one_of(2), 0.1 * dice.number());
        info.texture_offset = dice.numbers();
        info.placement = dice.placement();
        info.has_material = dice.one_of(2);
        (info.roughness, info.metalness) = (dice.number() as f32, 0.5);
        info.specular_strength = dice.number().abs() as f32;
        if !copies.is_empty() {
            (info.instances, info.instance_count) = (copies.as_ptr(), copies.len());
        }
        info.size = dice.size::<RevmapObjectInfo>();
        info
    }

    /// A change of an object, or of all.
    fn change(&mut self, number: usize) {
        let dice = &mut self.dice;
        let renderer = dice.handle(&self.dead, &[self.renderers[number].handle]);
        let objects = match dice.chance(0.05) {
            true => self
                .renderers
                .iter()
                .flat_map(|r| r.objects.clone())
                .collect(),
            false => self.renderers[number].objects.clone(),
        };
        let object = match objects.is_empty() || dice.chance(0.05) {
            true => dice.below(1 << 16) as u64,
            false => dice.pick(&objects),
        };
        let copies = dice.copies();
        let own = &mut self.renderers[number].objects;
        match dice.below(16) {
            0..5 if objects.len() < 12 => {
                let (info, mut added) = (self.object(&copies), 0);
                if call! { revmap_renderer_add(renderer, &info, &mut added) } {
                    self.renderers[number].objects.push(added);
                }
            }
            0..6 => {
                if call! { revmap_renderer_remove(renderer, object) } {
                    own.retain(|other| *other != object);
                }
            }
            6 => {
                let info = self.object(&copies);
                calls! { revmap_renderer_set(renderer, object, &info); }
            }
            7 => calls! { revmap_renderer_set_offset(renderer, object, &dice.offset()); },
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
                let image = dice.handle(&self.dead, &self.images);
                let set = dice.pick(&[
                    revmap_renderer_set_color_image,
                    revmap_renderer_set_slope_image,
                    revmap_renderer_set_height_image,
                ]);
                calls! { set(renderer, object, image); }
            }
            13 => {
                let mut lighting = defaults!(revmap_lighting_defaults, RevmapLighting);
                lighting.shadow = dice.one_of(3);
                lighting.ambient = [dice.number().abs() as f32; 3];
                lighting.environment_up = lighting.ambient;
                let light = dice.light();
                if dice.chance(0.5) {
                    (lighting.lights, lighting.light_count) = (&light, 1);
                }
                calls! { revmap_renderer_set_lighting(renderer, &lighting); }
            }
            14 => {
                made! { self.casters, revmap_renderer_ray_caster(renderer, object); }
                calls! { revmap_renderer_object_number(renderer, object, &mut 0); }
            }
            _ => {
                calls! {
                    revmap_renderer_hide_until_compiled(renderer, dice.one_of(2));
                    revmap_renderer_end_frame(renderer);
                }
            }
        }
    }

    fn ask(&mut self, number: usize) {
        let renderer = self
            .dice
            .handle(&self.dead, &[self.renderers[number].handle]);
        let device = some!(self.device);
        let dice = &mut self.dice;
        match dice.below(6) {
            0 => {
                let mut room = [sized!(RevmapStatistics); 2];
                room[0].size = dice.size::<RevmapStatistics>();
                calls! {
                    revmap_renderer_statistics(renderer, &mut room[0]);
                    revmap_renderer_note(renderer, dice.one_of(3), &mut null());
                }
            }
            1 => {
                let mut prewarm = null_mut();
                if call! { revmap_renderer_prewarm(renderer, &mut prewarm) } {
                    calls! { revmap_prewarm_count(prewarm, &mut 0); }
                    if dice.chance(0.2) {
                        calls! { revmap_prewarm_compile(prewarm); }
                    }
                    self.renderers[number].prewarms.push(prewarm);
                }
            }
            2 => {
                let mut room = [sized!(RevmapDeviceInfo); 2];
                room[0].size = dice.size::<RevmapDeviceInfo>();
                calls! { revmap_device_info(device, &mut room[0]); }
                let mut room = [sized!(RevmapMemoryUse); 2];
                room[0].size = dice.size::<RevmapMemoryUse>();
                calls! {
                    revmap_device_memory_use(device, &mut room[0]);
                    revmap_device_check(device);
                }
            }
            3 => {
                let bytes: Vec<u8> = (0..dice.below(200)).map(|n| n as u8).collect();
                let (at, count) = (bytes.as_ptr().cast(), bytes.len());
                calls! {
                    revmap_device_add_pipeline_cache(device, at, count);
                    revmap_shading_from_bytes(at, count, &mut null_mut());
                    revmap_profile_from_bytes(at, count, 0, &mut null_mut());
                }
                let mut layout = vk::PipelineLayout::null();
                calls! { revmap_renderer_pipeline_layout(renderer, &mut layout); }
            }
            4 => {
                let caster = dice.handle(&self.dead, &self.casters);
                let count = dice.below(20);
                let ray = |_| RevmapRay {
                    origin: dice.numbers().map(|n| 3.0 * n),
                    direction: dice.numbers(),
                };
                let rays: Vec<_> = (0..count).map(ray).collect();
                let mut hits = vec![crate::zeros::<RevmapRayHit>(); count];
                calls! {
                    revmap_ray_caster_cast(caster, rays.as_ptr(), count, hits.as_mut_ptr());
                    revmap_ray_caster_bounds(caster, &mut crate::zeros());
                }
            }
            _ => {
                let (image, mut held) = (dice.handle(&self.dead, &self.images), 0);
                calls! { revmap_host_image_is_held(image, &mut held); }
                revmap_color_word(dice.number() as f32, 0.0, 1.0, dice.number() as f32);
                let (profile, mut radius) = (dice.handle(&self.dead, &self.profiles), 0.0);
                calls! { revmap_profile_radius(profile, &mut radius); }
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
                    assert!(call! { $function(handle) });
                }
            )*};
        }
        destroy! {
            profiles: revmap_profile_destroy, colors: revmap_color_map_destroy,
            heights: revmap_height_map_destroy, casters: revmap_ray_caster_destroy,
            pictures: revmap_offscreen_destroy, images: revmap_host_image_destroy,
        }
        assert!(call! { revmap_device_destroy(self.device[0]) });
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
        device: [lend_with_queue(&host)],
        canvases: [
            pass(&[COLOR]),
            pass(&list),
            pass(&[]),
            Canvas::words(&host, SIZE),
        ],
        images: Vec::new(),
        renderers: Vec::new(),
        profiles: vec![crate::arguments::spindle()],
        colors: Vec::new(),
        heights: Vec::new(),
        casters: Vec::new(),
        pictures: Vec::new(),
        dead: Vec::new(),
        seed,
    };
    for texture in &textures {
        let (view, sampler) = (texture.memory.view, texture.sampler);
        made! { driver.images, revmap_host_image_create(view, sampler); }
    }
    assert_eq!(driver.images.len(), textures.len());
    let begin = Instant::now();
    let mut steps = 0;
    while begin.elapsed() < Duration::from_secs(seconds) {
        driver.step();
        assert_silent(&host);
        steps += 1;
    }
    driver.end();
    let done = CALLS.lock().unwrap().1;
    println!("seed {seed}: {steps} steps, {done} calls succeeded");
    assert!(done > 50, "{done} calls of {steps} steps");
}
