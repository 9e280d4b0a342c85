//! Frames prepared ahead: each slot keeps the plan of its view, whatever is prepared or changed
//! before it is recorded.

use crate::common::host::{
    self, HostBuffer, Options, Stage, barrier, borrow, once, open, target, view_of,
};
use crate::common::{eye, placement, scene_of, shapes};
use crate::embedding::options;
use ash::vk;
use glam::{DMat4, DVec3, Vec3};
use revmap::error::ErrorKind;
use revmap::gpu::{Device, ObjectId, Output, PreparedFrame, Renderer, View};
use revmap::scene::{Camera, Object, Placement, Scene};
use revmap::settings::{Planes, SearchSettings};
use std::sync::Arc;

/// Slots of these renderers: two views for each of the host's frames in flight.
const SLOTS: usize = 2 * host::FRAMES;

fn small() -> Options {
    Options {
        width: 160,
        height: 120,
        ..options()
    }
}

/// A vase, a field of copies and a glass that the camera cuts.
fn scene() -> Scene {
    let mut scene = scene_of(shapes::vase(), eye(25.0, 3.0));
    let mut field = Object::new("field", Arc::new(shapes::jewel()));
    field.instances = rows(9).into();
    let mut glass = Object::new("glass", Arc::new(shapes::glass()));
    glass.placement.position.y = -0.9;
    scene.objects.extend([field, glass]);
    scene
}

/// A square field with `side` copies along each side.
fn rows(side: u32) -> Vec<Placement> {
    let at = |k: u32| 3.0 * f64::from(k) / f64::from(side) - 1.5;
    let place = |n: u32| placement([at(n % side), at(n / side), -0.6], [0.0; 3], [0.3; 3]);
    (0..side * side).map(place).collect()
}

fn views() -> [View; 2] {
    let of = |from: [f64; 3], to: [f64; 3]| {
        let camera = Camera::new(DVec3::from_array(from), DVec3::from_array(to));
        view_of(&Scene::new(camera), &small())
    };
    [
        of([2.0, 1.5, 1.8], [0.0, 0.0, 0.2]),
        of([-1.6, 0.4, 0.3], [0.0, -0.5, 0.3]),
    ]
}

fn add(renderer: &mut Renderer, scene: &Scene) -> Vec<ObjectId> {
    let add = |object: &Object| renderer.add(object.clone()).unwrap();
    scene.objects.iter().map(add).collect()
}

/// Prepares a frame in a slot.
type Prepare<'a> = &'a mut dyn FnMut(&mut Renderer, vk::CommandBuffer, usize) -> PreparedFrame;

/// A renderer that draws in one of the two stages. It is dropped before the words.
struct Drawn<'a> {
    renderer: Renderer,
    /// The pass of fragments; `None` in compute.
    stage: Option<Stage<'a>>,
    words: HostBuffer<'a>,
    host: &'a host::Host,
    next: usize,
}

impl<'a> Drawn<'a> {
    fn new(
        host: &'a host::Host,
        device: &Device,
        settings: &SearchSettings,
        compute: bool,
    ) -> Self {
        let stage = (!compute).then(|| Stage::new(host, small()).unwrap());
        let output = Output::Compute(Planes::Color);
        Self {
            renderer: match &stage {
                Some(stage) => host::renderer(device, stage, settings, SLOTS),
                None => Renderer::new(device, output, settings, SLOTS).unwrap(),
            },
            stage,
            words: Self::cleared(host),
            host,
            next: 0,
        }
    }

    fn cleared(host: &host::Host) -> HostBuffer<'_> {
        let pixels = (small().width * small().height) as usize;
        let mut words = vec![1f32.to_bits(); pixels];
        words.extend(vec![0u32; pixels]);
        HostBuffer::of(host, &words, vk::BufferUsageFlags::STORAGE_BUFFER).unwrap()
    }

    /// Calls `prepare`, records the frame that it returns, and returns the picture.
    fn draw(&mut self, prepare: Prepare) -> Vec<u8> {
        let Some(stage) = &mut self.stage else {
            return self.compute_frame(prepare);
        };
        let renderer = std::cell::RefCell::new(&mut self.renderer);
        let drawn = stage.frame(
            DMat4::IDENTITY,
            Vec3::Z,
            &[],
            |cmd, slot| Ok(prepare(&mut renderer.borrow_mut(), cmd, slot)),
            // SAFETY: the frame was prepared, the pass has the output's formats.
            |cmd, frame| Ok(unsafe { renderer.borrow().record(cmd, frame) }?),
        );
        drawn.unwrap();
        stage.read().unwrap().0
    }

    fn compute_frame(&mut self, prepare: Prepare) -> Vec<u8> {
        let slot = self.next;
        self.next = (slot + 1) % host::FRAMES;
        let (words, renderer) = (Self::cleared(self.host), &mut self.renderer);
        // SAFETY: the buffer has two words per pixel, is of the host's device, and outlives the
        // frame; every frame before is complete, as `once` waits.
        unsafe { renderer.set_compute_target(target(&words)) }.unwrap();
        once(self.host, |cmd| {
            let frame = prepare(renderer, cmd, slot);
            // SAFETY: `cmd` is recording outside of a pass, and the frame was prepared for it.
            unsafe {
                renderer.record_compute(cmd, &frame).unwrap();
                barrier(self.host, cmd, &[]);
            }
        });
        let bytes = words.bytes();
        self.words = words;
        bytes
    }
}

/// Runs a test in both stages, each renderer with the objects of [`scene`].
fn in_both_stages(test: impl Fn(&mut Drawn, &[ObjectId], &str)) {
    let host = open();
    let device = borrow(&host);
    for stage in ["fragment", "compute"] {
        let settings = SearchSettings::exact();
        let mut drawn = Drawn::new(&host, &device, &settings, stage == "compute");
        let ids = add(&mut drawn.renderer, &scene());
        test(&mut drawn, &ids, stage);
    }
}

/// The picture of one view, prepared just before it is recorded.
fn plainly(drawn: &mut Drawn, view: &View) -> Vec<u8> {
    drawn.draw(&mut |renderer, cmd, slot| {
        // SAFETY: `cmd` is recording, and the slot's previous frame is complete.
        unsafe { renderer.prepare(cmd, slot, view) }.unwrap()
    })
}

/// Pixels that differ.
fn differ(a: &[u8], b: &[u8]) -> usize {
    assert_eq!(a.len(), b.len());
    let pairs = a.chunks_exact(4).zip(b.chunks_exact(4));
    pairs.filter(|(a, b)| a != b).count()
}

#[test]
fn a_slot_keeps_the_plan_of_its_view() {
    in_both_stages(|drawn, _, stage| {
        let views = views();
        let wanted = views.each_ref().map(|view| plainly(drawn, view));
        assert!(differ(&wanted[0], &wanted[1]) > 2000, "{stage}");
        for k in [0, 1, 0] {
            let found = drawn.draw(&mut |renderer, cmd, slot| {
                // SAFETY: as in `plainly`; the slots after the host's belong to this frame, too.
                let frames = [0, 1].map(|n| unsafe {
                    let slot = slot + n * host::FRAMES;
                    renderer.prepare(cmd, slot, &views[n]).unwrap()
                });
                let [first, second] = frames;
                if k == 0 { first } else { second }
            });
            assert_eq!(differ(&found, &wanted[k]), 0, "{stage}, view {k}");
        }
    });
}

#[test]
fn what_is_set_after_prepare_takes_effect_next_time() {
    in_both_stages(|drawn, ids, stage| {
        let view = views()[0];
        let wanted = plainly(drawn, &view);
        let found = drawn.draw(&mut |renderer, cmd, slot| {
            // SAFETY: as in `plainly`.
            let frame = unsafe { renderer.prepare(cmd, slot, &view) }.unwrap();
            // More copies, fewer copies, and another object removed.
            renderer.set_instances(ids[1], rows(40)).unwrap();
            renderer.set_instances(ids[1], rows(3)).unwrap();
            renderer.remove(ids[2]).unwrap();
            frame
        });
        assert_eq!(differ(&found, &wanted), 0, "{stage}");
        let after = plainly(drawn, &view);
        assert!(differ(&after, &wanted) > 200, "{stage}: as before");
        // The result equals a renderer that always had this state.
        let all = &mut drawn.renderer;
        all.remove(ids[0]).unwrap();
        all.remove(ids[1]).unwrap();
        let mut few = scene();
        few.objects.pop();
        few.objects[1].instances = rows(3).into();
        add(all, &few);
        let fresh = plainly(drawn, &view);
        assert_eq!(differ(&after, &fresh), 0, "{stage}");
    });
}

#[test]
fn a_token_is_of_its_renderer_and_of_its_slots_last_frame() {
    in_both_stages(|drawn, _, stage| {
        let view = views()[0];
        // Uploads belong to the commands of the `prepare` call that recorded them.
        plainly(drawn, &view);
        let mut stale = None;
        drawn.draw(&mut |renderer, cmd, slot| {
            // SAFETY: as in `plainly`; the first frame is never recorded.
            unsafe {
                stale = Some(renderer.prepare(cmd, slot, &view).unwrap());
                renderer.prepare(cmd, slot, &view).unwrap()
            }
        });
        let stale = stale.unwrap();
        let renderer = &drawn.renderer;
        // SAFETY: a refused call records nothing.
        let refused = unsafe {
            let none = vk::CommandBuffer::null();
            match stage {
                "compute" => renderer.record_compute(none, &stale),
                _ => renderer.record(none, &stale),
            }
        };
        assert_eq!(refused.unwrap_err().kind, ErrorKind::Usage, "{stage}");
    });
}

/// Twenty thousand objects use ten times the device memory of two thousand, and can be removed.
#[test]
fn objects_by_the_ten_thousand() {
    let host = open();
    let device = borrow(&host);
    let profiles = [shapes::vase(), shapes::sphere(), shapes::glass()].map(Arc::new);
    let object = |n: u32| {
        let mut object = Object::new("one", profiles[n as usize % profiles.len()].clone());
        let (x, y) = (f64::from(n % 150), f64::from(n / 150));
        object.placement = placement([0.1 * x - 7.5, 0.1 * y - 6.5, 0.0], [0.0; 3], [0.1; 3]);
        object
    };
    let bytes = |count: u32| {
        let mut compute = Drawn::new(&host, &device, &SearchSettings::exact(), true);
        let ids: Vec<_> = (0..count)
            .map(|n| compute.renderer.add(object(n)).unwrap())
            .collect();
        let view = views()[0];
        plainly(&mut compute, &view);
        let bytes = device.memory_use().total();
        for id in ids.iter().step_by(20) {
            compute.renderer.remove(*id).unwrap();
        }
        assert_eq!(compute.renderer.object_count(), ids.len() - ids.len() / 20);
        plainly(&mut compute, &view);
        bytes
    };
    let (few, many) = (bytes(2_000), bytes(20_000));
    println!("{few} and {many} bytes");
    assert!(many < 14 * few);
}
