//! Profiles, textures and pictures without a host.

use super::*;

impl Driver<'_> {
    /// Makes a profile, a texture or a picture without a host, or destroys one.
    pub fn supply(&mut self) {
        let dice = &mut self.dice;
        match dice.below(7) {
            0 | 1 => {
                let count = 3 + dice.below(6);
                let points: Vec<[f64; 2]> =
                    (0..count).map(|_| dice.numbers().map(f64::abs)).collect();
                made! { self.profiles, revmap_profile_from_points(points.as_ptr(), count, 0.5); }
            }
            2 => {
                let (side, texels) = (dice.one_of(9).min(8), [[200, 40, 9, 255]; 64]);
                made! { self.colors, revmap_color_map_from_texels(side, 8, texels.as_ptr()); }
            }
            3 => {
                let heights = dice.numbers::<64>().map(|n| n as f32);
                let (at, filter) = (heights.as_ptr(), dice.one_of(2));
                made! { self.heights, revmap_height_map_from_heights(8, 8, at, filter); }
            }
            4 => self.picture(),
            _ => {
                macro_rules! destroy {
                    ($($list:ident: $function:ident, $keep:literal;)*) => {$(
                        if self.$list.len() > $keep {
                            let number = dice.below(self.$list.len());
                            let handle = self.$list.swap_remove(number);
                            calls! { $function(handle); }
                            self.dead.push(handle.addr());
                        }
                        let none = dice.handle(&self.dead, &[]);
                        if !self.$list.contains(&none) {
                            calls! { $function(none); }
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
        let dice = &mut self.dice;
        let mut scene = defaults!(revmap_scene_defaults, RevmapScene);
        (scene.objects, scene.object_count) = (objects.as_ptr(), dice.below(3));
        scene.lighting.shadow = dice.one_of(3);
        scene.camera.eye[1] = dice.number();
        scene.size = dice.size::<RevmapScene>();
        let mut picture = defaults!(revmap_picture_defaults, RevmapPicture);
        (picture.width, picture.height) = (dice.one_of(40), dice.one_of(30).wrapping_add(1));
        (picture.stage, picture.planes) = (dice.one_of(2), dice.one_of(2));
        if self.pictures.len() < 2 {
            let device = some!(self.device);
            made! { self.pictures, revmap_offscreen_create(device, &picture, &scene); }
        }
        let offscreen = some!(self.pictures);
        calls! { revmap_offscreen_update(offscreen, &scene); }
        let mut times = [sized!(RevmapTimes); 2];
        calls! { revmap_offscreen_draw(offscreen, &mut times[0]); }
        let (plane, mut bytes) = (self.dice.one_of(8), vec![0u8; 16 * self.dice.below(1200)]);
        let (at, count) = (bytes.as_mut_ptr().cast(), bytes.len());
        calls! {
            revmap_offscreen_read(offscreen, plane, at, count);
            revmap_offscreen_write_png(offscreen, c"/missing/a.png".as_ptr());
        }
    }
}
