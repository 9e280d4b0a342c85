//! A small deferred renderer: a G-buffer of its own formats into which it draws meshes and revolved
//! solids, light and temporal anti-aliasing in compute. The anti-aliasing follows the solids' motion
//! vectors.
//!
//! `cargo run --release --example deferred -- out` writes the last frame of a movement with and
//! without motion vectors, and the mean of 64 jittered frames of that moment, as PNG files into
//! `out/`; `deferred.png` has a part of each side by side, enlarged.
#![allow(unsafe_code)] // raw handles enter here: each use says what it promises

#[path = "../host/mod.rs"]
#[allow(clippy::duplicate_mod)] // in tests of several hosts
mod host;
mod passes;

use glam::{DMat4, DQuat, DVec2, DVec3, Vec3, Vec4};
use host::{Fallible, Host, Mesh, Options, lend, solids};
use passes::{Blend, Passes};
use revmap::frame::Frame;
use revmap::gpu::{Device, ObjectId, Renderer, View};
use revmap::scene::{Material, Placement};
use revmap::settings::{PlaneList, Planes, SearchSettings};

const OPTIONS: Options = Options::new(640, 400);
/// Frames of the movement.
const FRAMES: u32 = 24;
/// Frames of the truth.
const RAYS: u32 = 64;
/// FLIP's default.
const PIXELS_PER_DEGREE: f64 = 67.0;
/// The weight of a new frame.
const WEIGHT: f32 = 0.12;

#[allow(dead_code)] // a test calls `run`
fn main() -> Fallible<()> {
    let (folder, validate) = lend::arguments();
    let [with, without] = run(&folder, validate)?;
    println!("FLIP against {RAYS} frames: {with:.4} with motion vectors, {without:.4} without");
    Ok(())
}

/// Draws all pictures into a folder. Returns how far those with and without motion vectors are from
/// the mean of many frames.
pub fn run(folder: &str, validate: bool) -> Fallible<[f32; 2]> {
    let host = lend::open(folder, validate)?;
    // SAFETY: the host outlives the device.
    let device = unsafe { lend::lend(&host) }?;
    let mut pictures = Vec::new();
    for name in ["with-motion", "without-motion", "64-frames"] {
        let mut engine = Engine::new(&host, &device)?;
        for frame in 0..FRAMES {
            let blend = match frame {
                0 => Blend::FIRST,
                _ => Blend {
                    weight: WEIGHT,
                    follows: name != "without-motion",
                    clips: true,
                },
            };
            engine.frame(f64::from(frame), jitter(frame), &blend)?;
        }
        if name == "64-frames" {
            for n in 0..RAYS {
                let blend = Blend {
                    weight: 1.0 / (n as f32 + 1.0),
                    follows: false,
                    clips: false,
                };
                engine.frame(f64::from(FRAMES - 1), jitter(n), &blend)?;
            }
        }
        let picture = engine.passes.read()?;
        let (name, pixels) = (format!("deferred-{name}"), srgb(&picture));
        host::write_png(folder, &name, &OPTIONS, &pixels)?;
        pictures.push(picture);
    }
    let [with, without, truth] = pictures.try_into().map_err(|_| "three pictures")?;
    let parts = [&without, &with, &truth].map(|picture| enlarged(picture));
    let row = |y: usize| parts.iter().flat_map(move |part| part[y].clone());
    let rows: Vec<Vec4> = (0..parts[0].len()).flat_map(row).collect();
    let all = Options {
        width: rows.len() as u32 / parts[0].len() as u32,
        height: parts[0].len() as u32,
        ..OPTIONS
    };
    host::write_png(folder, "deferred", &all, &srgb(&rows))?;
    lend::check(&host)?;
    Ok([flip(&truth, &with)?, flip(&truth, &without)?])
}

/// Positions of samples in a pixel, from its centre (Halton's sequence of bases 2 and 3).
fn jitter(frame: u32) -> DVec2 {
    let radical = |base: u32| {
        let (mut n, mut part, mut sum) = (frame + 1, 1.0, 0.0);
        while n > 0 {
            part /= f64::from(base);
            sum += part * f64::from(n % base);
            n /= base;
        }
        sum
    };
    DVec2::new(radical(2), radical(3)) - 0.5
}

struct Engine<'a> {
    passes: Passes<'a>,
    renderer: Renderer,
    solids: Vec<ObjectId>,
    meshes: [Mesh<'a>; 2],
    last: Option<(View, DMat4)>,
}

impl<'a> Engine<'a> {
    fn new(host: &'a Host, device: &Device) -> Fallible<Self> {
        let planes = PlaneList::new(&passes::PLANES.map(|(plane, _)| plane))?;
        let formats = passes::PLANES.map(|(_, format)| format);
        let output = lend::pass(&OPTIONS, &formats, Planes::List(planes));
        let mut renderer = Renderer::new(device, output, &SearchSettings::default(), 1)?;
        let mut solids = Vec::new();
        for (name, color, metalness) in [
            ("king", [0.9, 0.7, 0.35], 1.0),
            ("rook", [0.55, 0.15, 0.1], 0.0),
            ("pawn", [0.8, 0.8, 0.75], 0.0),
        ] {
            let mut object = solids::chessman(name, color)?;
            object.material = Some(Material {
                roughness: 0.35,
                metalness,
            });
            solids.push(renderer.add(object)?);
        }
        let middle = Vec3::new(-0.9, 0.35, 0.25);
        Ok(Self {
            passes: Passes::new(host, OPTIONS)?,
            renderer,
            solids,
            meshes: [
                Mesh::floor(host, 2.5, 0.0, Vec3::new(0.35, 0.33, 0.3))?,
                Mesh::sphere(host, 48, middle, 0.25, Vec3::new(0.2, 0.35, 0.6))?,
            ],
            last: None,
        })
    }

    /// One solid falls over as it slides, one swells, one moves across; the eye moves, too.
    fn frame(&mut self, time: f64, jitter: DVec2, blend: &Blend) -> Fallible<()> {
        let part = time / f64::from(FRAMES);
        let turned = DQuat::from_rotation_y(1.2 * part);
        let placements = [
            (DVec3::new(-0.3 + 0.5 * part, -0.6, 0.0), turned),
            (DVec3::new(0.1, 0.1, 0.0), DQuat::IDENTITY),
            (DVec3::new(0.7 - 1.6 * part, 0.8, 0.0), DQuat::IDENTITY),
        ];
        for (id, (position, rotation)) in self.solids.iter().zip(placements) {
            let placement = Placement {
                position,
                rotation,
                ..Placement::default()
            };
            self.renderer.set_placement(*id, placement)?;
        }
        let mut offset = self.renderer.object(self.solids[1])?.offset;
        offset.extend = 0.1 * part;
        self.renderer.set_offset(self.solids[1], offset)?;

        let eye = DVec3::new(3.0, 0.5 - 0.6 * part, 1.3);
        let [view, projection] =
            host::view_and_projection(eye, DVec3::new(0.0, 0.0, 0.4), &OPTIONS);
        let size = DVec2::new(f64::from(OPTIONS.width), f64::from(OPTIONS.height));
        let shift = 2.0 * jitter / size;
        let jittered = DMat4::from_translation(shift.extend(0.0)) * projection;
        let seen = lend::view([view, jittered], &OPTIONS)?;
        let seen = seen.with_jitter(jitter.to_array());
        let (last, last_clip) = self.last.unwrap_or((seen, projection * view));
        let now = jittered * view;
        self.passes.frame(
            now,
            &self.meshes,
            (&mut self.renderer, &seen.with_last(&last)),
            &passes::Lights {
                world_from_clip: now.inverse().as_mat4(),
                eye: eye.as_vec3(),
                towards_sun: Vec3::new(0.5, -0.4, 0.7).normalize(),
            },
            &passes::Resolve {
                last_from_clip: (last_clip * now.inverse()).as_mat4(),
                jitter: jitter.as_vec2(),
                blend: *blend,
            },
        )?;
        self.renderer.end_frame();
        self.last = Some((seen, projection * view));
        Ok(())
    }
}

/// Rows of a part of a picture, each pixel twice as wide and high, and a white border.
fn enlarged(picture: &[Vec4]) -> Vec<Vec<Vec4>> {
    let row = |y: usize| {
        let pixels = (376..480).flat_map(move |x| [picture[y * OPTIONS.width as usize + x]; 2]);
        pixels.chain([Vec4::ONE; 8]).collect()
    };
    (80..230).flat_map(|y| [row(y), row(y)]).collect()
}

/// The mean perceived difference of two pictures.
fn flip(truth: &[Vec4], picture: &[Vec4]) -> Fallible<f32> {
    let frame = |colors: &[Vec4]| {
        let mut frame = Frame::new(OPTIONS.width, OPTIONS.height, [0.0; 4])?;
        frame.color = colors.iter().map(Vec4::to_array).collect();
        revmap::Result::Ok(frame)
    };
    let map = revmap_compare::flip_map(&frame(truth)?, &frame(picture)?, PIXELS_PER_DEGREE);
    Ok(map.iter().sum::<f32>() / map.len() as f32)
}

fn srgb(picture: &[Vec4]) -> Vec<u8> {
    let byte =
        |v: f32| (revmap::frame::srgb_from_linear(f64::from(v)).clamp(0.0, 1.0) * 255.0) as u8;
    let bytes = |c: &Vec4| [byte(c.x), byte(c.y), byte(c.z), 255];
    picture.iter().flat_map(bytes).collect()
}
