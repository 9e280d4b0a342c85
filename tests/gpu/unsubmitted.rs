//! Retries after a failed `prepare`: no texture and no object is lost. The random host (`tests/soak`)
//! drops frames, prepares slots twice in one command buffer and records frames twice.
#![allow(unsafe_code)]

use crate::calls::Layer;
use crate::common::host::{
    Attachments, COLOR, Host, HostBuffer, add, barrier, borrow_through, color_pass, never, once,
    open, opened, target, view_of,
};
use crate::common::prelude::*;
use crate::embedding::{far_words, options, three};

const SIZE: u32 = 16;
const CLEAR: vk::ClearColorValue = vk::ClearColorValue { float32: [0.0; 4] };

/// The three solids, with a colour map and a displacement map on the first.
fn textured() -> Scene {
    let mut scene = three();
    let object = &mut scene.objects[0];
    let pixels = 0..SIZE * SIZE;
    let texel = |n: u32| [(37 * n) as u8, 255 - (91 * n) as u8, 40, 255];
    let colors = ColorMap::from_texels(SIZE, SIZE, pixels.clone().map(texel).collect());
    let heights: Vec<f32> = pixels.map(|n| (n * 29 % 64) as f32 / 64.0).collect();
    let slopes = DisplacementMap::from_heights(SIZE, SIZE, &heights, SlopeFilter::Scharr);
    object.texturing.color_map = Some(Arc::new(colors.unwrap()));
    object.texturing.displacement_map = Some(Arc::new(slopes.unwrap()));
    object.texturing.bump = 0.02;
    scene
}

/// A renderer with its target: an attachment, or words of compute.
pub struct Drawn<'a> {
    pub renderer: Renderer,
    pub ids: Vec<ObjectId>,
    pub view: View,
    into: Into<'a>,
    host: &'a Host,
}

pub enum Into<'a> {
    Pass(Box<Attachments<'a>>),
    Words(HostBuffer<'a>),
}

impl<'a> Drawn<'a> {
    /// A renderer of two slots; `live` shows every object by its map, which is a texture too.
    fn new(host: &'a Host, device: &Device, stage: DrawStage, scene: &Scene) -> Self {
        let search = SearchSettings {
            solver: Solver::Live,
            map_rows: Some(64),
            ..SearchSettings::exact()
        };
        Self::by(host, device, stage, scene, &search)
    }

    /// A renderer of two slots.
    pub fn by(
        host: &'a Host,
        device: &Device,
        stage: DrawStage,
        scene: &Scene,
        search: &SearchSettings,
    ) -> Self {
        let options = options();
        let compute = stage == DrawStage::Compute;
        let output = match compute {
            true => Output::Compute(Planes::Color),
            false => Output::Pass(color_pass()),
        };
        let mut renderer = Renderer::new(device, output, search, 2).unwrap();
        let ids = add(&mut renderer, scene);
        let mut drawn = Self {
            renderer,
            ids,
            view: view_of(scene, &options),
            into: match compute {
                true => Into::Words(cleared(host)),
                false => Into::Pass(Box::new(
                    Attachments::new(host, options, &[(COLOR, 4)]).unwrap(),
                )),
            },
            host,
        };
        drawn.clear();
        drawn
    }

    /// Prepares a frame in `slot` and records it as often as `times` says.
    pub fn record(
        &mut self,
        cmd: vk::CommandBuffer,
        slot: usize,
        times: usize,
    ) -> revmap::Result<()> {
        // SAFETY: `cmd` is recording, and no frame is in flight.
        let frame = unsafe { self.renderer.prepare(cmd, slot, &self.view) }?;
        for _ in 0..times {
            // SAFETY: the frame was just prepared, and the target has the output's formats.
            unsafe {
                match &self.into {
                    Into::Pass(into) => {
                        let record = || self.renderer.record(cmd, &frame).unwrap();
                        into.draw(cmd, &[CLEAR], false, record);
                        into.copy(cmd);
                    }
                    Into::Words(_) => {
                        self.renderer.record_compute(cmd, &frame)?;
                        barrier(self.host, cmd, &[]);
                    }
                }
            }
        }
        Ok(())
    }

    /// The picture of a frame that is submitted.
    pub fn picture(&mut self, slot: usize) -> Vec<u8> {
        self.clear();
        let host = self.host;
        once(host, |cmd| self.record(cmd, slot, 1).unwrap());
        self.read()
    }

    fn clear(&mut self) {
        if let Into::Words(words) = &mut self.into {
            *words = cleared(self.host);
            // SAFETY: the buffer has two words per pixel and lives until the next one is set.
            unsafe { self.renderer.set_compute_target(target(words)) }.unwrap();
        }
    }

    fn read(&self) -> Vec<u8> {
        match &self.into {
            Into::Pass(into) => into.color(0),
            Into::Words(words) => words.bytes(),
        }
    }
}

/// Words of depths, all far, then words of colours, all 0.
fn cleared(host: &Host) -> HostBuffer<'_> {
    let words = far_words(&options());
    HostBuffer::of(host, &words, vk::BufferUsageFlags::STORAGE_BUFFER).unwrap()
}

/// The number of pixels that differ, of four bytes each.
pub fn differ(a: &[u8], b: &[u8]) -> usize {
    let pairs = a.chunks_exact(4).zip(b.chunks_exact(4));
    pairs.filter(|(a, b)| a != b).count()
}

/// Each Vulkan call that fails in the first `prepare` is an error; the retry draws everything. The
/// commands of the failed call are dropped or submitted.
#[test]
fn a_retry_after_a_failed_call_draws_everything() {
    let (layer, host) = (Layer::take(), open());
    let raw = layer.device(&host.instance, &host.device);
    let device = borrow_through(&host, &host.instance, &raw).unwrap();
    let scene = textured();
    for stage in STAGES {
        let wanted = Drawn::new(&host, &device, stage, &scene).picture(0);
        let mut failures = 0;
        for n in 0.. {
            let mut drawn = Drawn::new(&host, &device, stage, &scene);
            let mut failed = false;
            let fail = |cmd| {
                layer.fail_at(n);
                failed = drawn.record(cmd, 0, 0).is_err();
                layer.fail_at(usize::MAX);
            };
            match n % 2 {
                0 => never(&host, fail),
                _ => once(&host, fail),
            }
            // A `set` with equal values changes nothing.
            let object = drawn.renderer.object(drawn.ids[0]).unwrap().clone();
            drawn.renderer.set(drawn.ids[0], object).unwrap();
            for slot in [0, 1] {
                let pixels = differ(&drawn.picture(slot), &wanted);
                assert_eq!(pixels, 0, "{stage:?}, call {n}, slot {slot}");
            }
            if !failed {
                break;
            }
            failures += 1;
        }
        assert!(failures > 8, "{stage:?}: {failures}");
    }
}

/// The budget of memory refuses a frame. Once there is memory, everything is drawn.
#[test]
fn a_retry_after_a_refusal_of_memory_draws_everything() {
    let (host, device) = opened();
    let scene = textured();
    for stage in STAGES {
        let wanted = Drawn::new(&host, &device, stage, &scene).picture(0);
        let mut drawn = Drawn::new(&host, &device, stage, &scene);
        let mut refused = 0;
        for more in 0..20 {
            let used = device.memory_use().total();
            device.set_memory_budget(Some(used + 2000 * more));
            never(&host, |cmd| {
                refused += u32::from(drawn.record(cmd, 0, 0).is_err())
            });
        }
        device.set_memory_budget(None);
        assert!(refused > 2, "{stage:?}: {refused}");
        assert_eq!(differ(&drawn.picture(0), &wanted), 0, "{stage:?}");
    }
}

/// An object that cannot be drawn is named in each frame until it is mended or removed; the others
/// are drawn then, without being set again.
#[test]
fn one_wrong_object_hides_no_other() {
    let (host, device) = opened();
    let search = SearchSettings {
        solver: Solver::Live,
        map_format: MapFormat::Rgba8,
        ..SearchSettings::exact()
    };
    let output = Output::Compute(Planes::Color);
    let mut renderer = Renderer::new(&device, output, &search, 1).unwrap();
    let words = cleared(&host);
    // SAFETY: the buffer has two words per pixel and outlives the renderer's frames.
    unsafe { renderer.set_compute_target(target(&words)) }.unwrap();
    let mut scene = three();
    scene.objects[2].offset.extend = 0.01;
    let view = view_of(&scene, &options());
    let mut wrong = scene.objects[1].clone();
    wrong.offset.extend = -0.02;
    let ids = add(
        &mut renderer,
        &Scene {
            objects: vec![scene.objects[0].clone(), wrong, scene.objects[2].clone()],
            ..scene.clone()
        },
    );
    let shown = |renderer: &mut Renderer| {
        let mut result = Ok(0);
        once(&host, |cmd| {
            // SAFETY: `cmd` is recording, and no frame is in flight.
            result = unsafe { renderer.prepare(cmd, 0, &view) }.map(|f| f.statistics().objects);
        });
        result
    };
    for _ in 0..2 {
        let error = shown(&mut renderer).unwrap_err();
        assert!(error.to_string().contains("object.1.extend"), "{error}");
    }
    renderer.set(ids[1], scene.objects[1].clone()).unwrap();
    assert_eq!(shown(&mut renderer).unwrap(), 3);
    let mut wrong = scene.objects[1].clone();
    wrong.offset.extend = -0.02;
    let last = renderer.add(wrong).unwrap();
    let good = renderer.add(scene.objects[0].clone()).unwrap();
    assert!(shown(&mut renderer).is_err());
    renderer.remove(last).unwrap();
    assert_eq!(shown(&mut renderer).unwrap(), 4);
    assert!(renderer.object(good).is_ok());
}
