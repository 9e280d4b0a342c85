//! Pictures without a host: drawn, waited for, read back.

use crate::device::RevmapDevice;
use crate::enums::{self, RevmapPlane};
use crate::fault::{Fault, Outcome, RevmapResult, enter};
use crate::handle::{Handle, create, enter_with, handle, with};
use crate::object::RevmapObjectInfo;
use crate::pointers::text;
use crate::structures::{described, fill, read, read_all, sized};
use crate::values::{RevmapCamera, RevmapLighting, RevmapSearch};
use revmap::frame::Frame;
use revmap::scene::Scene;
use revmap::settings::{Planes, Settings};
use revmap_files::Picture;
use revmap_offscreen::Offscreen;
use std::ffi::{c_char, c_void};
use std::sync::{Arc, Mutex};

/// A scene on a device and a picture that it is drawn into.
pub struct RevmapOffscreen;
handle!(RevmapOffscreen, "off-screen picture", Arc<Mutex<Drawing>>);

pub(crate) struct Drawing {
    offscreen: Offscreen,
    planes: Planes,
    /// The planes of the last picture that were read back.
    frame: Option<Frame>,
    drawn: bool,
}

/// Settings of a picture. Defaults: revmap_picture_defaults().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RevmapPicture {
    /// sizeof(RevmapPicture).
    pub size: u32,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// A RevmapStage.
    pub stage: u32,
    /// REVMAP_PLANES_COLOR or REVMAP_PLANES_ALL.
    pub planes: u32,
    /// Not read.
    pub padding: u32,
    /// Settings of the search.
    pub search: RevmapSearch,
}

/// What is drawn. Defaults: revmap_scene_defaults().
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RevmapScene {
    /// sizeof(RevmapScene).
    pub size: u32,
    /// Linear RGBA behind everything.
    pub background: [f32; 4],
    /// Not read.
    pub padding: u32,
    /// The eye.
    pub camera: RevmapCamera,
    /// Lights and shadows.
    pub lighting: RevmapLighting,
    /// The objects, all of one size; read during the call.
    pub objects: *const RevmapObjectInfo,
    /// Number of objects.
    pub object_count: usize,
}

/// What a picture cost.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RevmapTimes {
    /// sizeof(RevmapTimes).
    pub size: u32,
    /// 0.
    pub padding: u32,
    /// CPU time to apply changes and to record, milliseconds.
    pub prepare_ms: f64,
    /// Milliseconds between timestamps of the device around the work; negative if it has no
    /// timestamps.
    pub gpu_ms: f64,
    /// Milliseconds from submission to completion by the clock.
    pub frame_ms: f64,
}

described! {
    RevmapPicture { 0 => [size, width, height, stage, planes, padding, search: RevmapSearch] }
    RevmapScene {
        0 => [
            size, background, padding, camera: RevmapCamera, lighting: RevmapLighting, objects,
            object_count,
        ]
    }
    RevmapTimes { 0 => [size, padding, prepare_ms, gpu_ms, frame_ms] }
}

impl RevmapPicture {
    fn settings(&self) -> Outcome<Settings> {
        let search = self.search.settings()?;
        Ok(Settings {
            width: self.width,
            height: self.height,
            stage: enums::stage(self.stage)?,
            planes: enums::planes(self.planes)?,
            ..Settings::from(&search)
        })
    }
}

impl RevmapScene {
    unsafe fn scene(&self) -> Outcome<Scene> {
        let mut scene = Scene::new(self.camera.camera());
        let lighting = self.lighting.lighting()?;
        scene.background = self.background;
        scene.ambient = lighting.ambient;
        scene.environment = lighting.environment;
        scene.lights = lighting.lights;
        scene.shadow = lighting.shadow;
        for info in read_all(self.objects, self.object_count)? {
            scene.objects.push(info.object()?);
        }
        Ok(scene)
    }
}

impl Drawing {
    /// The planes of the last picture.
    fn frame(&mut self) -> Outcome<&Frame> {
        if !self.drawn {
            let message = "nothing is drawn yet; call revmap_offscreen_draw";
            return Err(Fault::usage(message));
        }
        match &mut self.frame {
            Some(frame) => Ok(frame),
            none => Ok(none.insert(self.offscreen.read()?)),
        }
    }
}

/// Fills in 800x600 pixels, REVMAP_STAGE_FRAGMENT, REVMAP_PLANES_COLOR and the default search. The
/// size must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_picture_defaults(picture: *mut RevmapPicture) -> RevmapResult {
    let settings = Settings::default();
    let value = RevmapPicture {
        width: settings.width,
        height: settings.height,
        stage: enums::RevmapStage::Fragment as u32,
        planes: enums::RevmapPlanes::Color as u32,
        search: RevmapSearch::defaults(),
        ..sized()
    };
    enter(|| fill(picture, value))
}

/// Fills in a scene without objects before transparent black, with the default camera and lights.
/// The size must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_scene_defaults(scene: *mut RevmapScene) -> RevmapResult {
    enter(|| {
        let value = RevmapScene {
            camera: RevmapCamera::defaults(),
            lighting: RevmapLighting::defaults(),
            ..sized()
        };
        fill(scene, value)
    })
}

/// Takes a scene onto a device, with a picture to draw it into. A borrowed device must have a
/// queue, which nobody else uses while a picture is drawn or read.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_offscreen_create(
    device: *const RevmapDevice,
    picture: *const RevmapPicture,
    scene: *const RevmapScene,
    offscreen: *mut *mut RevmapOffscreen,
) -> RevmapResult {
    create(offscreen, || {
        let settings = read(picture)?.settings()?;
        let scene = read(scene)?.scene()?;
        let device = RevmapDevice::get(device)?;
        Ok(Mutex::new(Drawing {
            offscreen: Offscreen::new(&device, &scene, &settings)?,
            planes: settings.planes,
            frame: None,
            drawn: false,
        }))
    })
}

/// Updates the picture to another scene. The cost depends on the differences from the former scene.
/// If it fails, the former scene can still be drawn.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_offscreen_update(
    offscreen: *mut RevmapOffscreen,
    scene: *const RevmapScene,
) -> RevmapResult {
    enter(|| {
        let scene = read(scene)?.scene()?;
        with(offscreen, |d| Ok(d.offscreen.update(&scene)?))
    })
}

/// Compiles every pipeline that updates can come to need, as long as no object's technique changes.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_offscreen_prewarm(offscreen: *mut RevmapOffscreen) -> RevmapResult {
    enter_with(offscreen, |d| {
        d.drawn = false;
        d.frame = None;
        Ok(d.offscreen.prewarm()?)
    })
}

/// Draws the picture and waits for it. times may be null; else its size must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_offscreen_draw(
    offscreen: *mut RevmapOffscreen,
    times: *mut RevmapTimes,
) -> RevmapResult {
    enter(|| {
        let drawn = with(offscreen, |d| {
            d.drawn = false;
            d.frame = None;
            let drawn = d.offscreen.draw()?;
            d.drawn = true;
            Ok(drawn)
        })?;
        if times.is_null() {
            return Ok(());
        }
        let value = RevmapTimes {
            prepare_ms: drawn.prepare_ms,
            gpu_ms: drawn.gpu_ms.unwrap_or(-1.0),
            frame_ms: drawn.frame_ms,
            ..sized()
        };
        fill(times, value)
    })
}

/// Reads a plane of the picture that was drawn last: width * height pixels, row by row from the
/// top. plane is a RevmapPlane; REVMAP_PLANES_COLOR has REVMAP_PLANE_SRGB8 and REVMAP_PLANE_COLOR.
/// count is the number of bytes, which must be exact.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_offscreen_read(
    offscreen: *mut RevmapOffscreen,
    plane: u32,
    bytes: *mut c_void,
    count: usize,
) -> RevmapResult {
    enter(|| {
        let plane = enums::plane(plane)?;
        with(offscreen, |d| {
            let of_color = matches!(plane, RevmapPlane::Srgb8 | RevmapPlane::Color);
            if !of_color && d.planes != Planes::All {
                let message = "the picture holds colours alone; give it REVMAP_PLANES_ALL";
                return Err(Fault::usage(message));
            }
            let frame = d.frame()?;
            match plane {
                RevmapPlane::Srgb8 => copy(&Picture::of(frame)?.rgba, bytes, count),
                RevmapPlane::Color => copy(&frame.color, bytes, count),
                RevmapPlane::Distance => copy(&frame.distance, bytes, count),
                RevmapPlane::Normal => copy(&frame.normal, bytes, count),
                RevmapPlane::ShadingNormal => copy(&frame.shading_normal, bytes, count),
                RevmapPlane::Albedo => copy(&frame.albedo, bytes, count),
                RevmapPlane::Uv => copy(&frame.uv, bytes, count),
                RevmapPlane::Steps => copy(&frame.steps, bytes, count),
            }
        })
    })
}

/// Copies a whole plane.
unsafe fn copy<T: Copy>(from: &[T], to: *mut c_void, count: usize) -> Outcome<()> {
    let whole = size_of_val(from);
    if to.is_null() || count != whole {
        return Err(Fault::usage(format!(
            "the plane has {whole} bytes; give room for as many, not {count}"
        )));
    }
    // SAFETY: the caller's room is as large; bytes need no alignment.
    unsafe {
        to.cast::<u8>()
            .copy_from_nonoverlapping(from.as_ptr().cast(), whole);
    }
    Ok(())
}

/// Writes the picture that was drawn last as a PNG file of 8-bit sRGB with alpha. The path is
/// UTF-8.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_offscreen_write_png(
    offscreen: *mut RevmapOffscreen,
    path: *const c_char,
) -> RevmapResult {
    enter(|| {
        let path = text(path, "path")?;
        with(offscreen, |d| {
            Ok(revmap_files::write_png(d.frame()?, path)?)
        })
    })
}

/// Destroys a picture; null is none.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_offscreen_destroy(offscreen: *mut RevmapOffscreen) -> RevmapResult {
    enter(|| RevmapOffscreen::destroy(offscreen))
}
