//! Calls of the random host apart from renderers: handles, profiles, textures, rays, the device,
//! pictures without a host.

use super::{Driver, noted};
use crate::names::*;
use std::mem::offset_of;
use std::ptr::without_provenance_mut;

impl Driver<'_> {
    /// A number that is no live handle, or hardly ever.
    pub fn none(&mut self) -> usize {
        match self.dice.below(3) {
            0 => 0,
            1 if !self.dead.is_empty() => self.dice.pick(&self.dead),
            _ => self.dice.below(1 << 20),
        }
    }

    /// A live handle, or one that is none.
    pub fn some<T: 'static>(&mut self) -> *mut T {
        let live = self.live(&null_mut::<T>()).clone();
        without_provenance_mut(match live.is_empty() || self.dice.chance(0.06) {
            true => self.none(),
            false => self.dice.pick(&live),
        })
    }

    /// Destroys a handle if there are more than `least`, and tries to destroy one that is gone.
    pub fn destroy<T: 'static>(
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
    pub fn clear(&mut self, all: bool) {
        let least = |number: usize| if all { 0 } else { number };
        while self.destroy(least(3), revmap_profile_destroy) && all {}
        while self.destroy(least(1), revmap_color_map_destroy) && all {}
        while self.destroy(least(1), revmap_height_map_destroy) && all {}
        while self.destroy(least(1), revmap_ray_caster_destroy) && all {}
        while self.destroy(least(0), revmap_offscreen_destroy) && all {}
        while self.destroy(least(4), revmap_prewarm_destroy) && all {}
        while self.destroy(least(2), revmap_host_image_destroy) && all {}
    }

    pub fn object(&mut self, copies: &[RevmapPlacement]) -> [RevmapObjectInfo; 2] {
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

    /// Calls apart from renderers: profiles, textures, rays, the device, pictures without a host.
    pub fn supply(&mut self) {
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

    pub fn picture(&mut self, device: *mut RevmapDevice) {
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
}
