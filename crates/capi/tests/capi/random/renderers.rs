//! Renderers of a random host, and their frames.

use super::*;

/// What a renderer draws into.
#[derive(Clone, Copy, PartialEq)]
pub enum Kind {
    Color,
    List,
    Depth,
    Compute,
}

/// Formats of the attachments of a list, with numbers of `RevmapAttachment`.
pub const LIST: [(vk::Format, u32); 4] = [
    (vk::Format::R16G16B16A16_SFLOAT, 0),
    (vk::Format::R32G32B32A32_SFLOAT, 2),
    (vk::Format::R32G32_SFLOAT, 5),
    (vk::Format::R32G32_UINT, 6),
];

pub struct Made {
    pub handle: *mut RevmapRenderer,
    kind: Kind,
    slots: u32,
    pub objects: Vec<RevmapObject>,
    pub prewarms: Vec<*mut RevmapPrewarm>,
}

impl Driver<'_> {
    pub fn make_renderer(&mut self) {
        let dice = &mut self.dice;
        let (search, slots) = (dice.search(), dice.one_of(3).wrapping_add(1));
        let kind = dice.pick(&[Kind::Color, Kind::List, Kind::Depth, Kind::Compute]);
        let mut handle = null_mut();
        let search = if dice.chance(0.5) {
            null()
        } else {
            &raw const search
        };
        let made = if kind == Kind::Compute {
            let planes = if dice.chance(0.1) { dice.one_of(5) } else { 0 };
            let [device] = self.device;
            // Other planes need another target.
            let made = call! { revmap_renderer_create_compute(device, planes, search, slots, &mut handle) };
            made && planes == 0
        } else {
            let formats: Vec<_> = match kind {
                Kind::List => LIST.iter().map(|(format, _)| *format).collect(),
                Kind::Color => vec![COLOR],
                _ => Vec::new(),
            };
            let numbers = LIST.map(|(_, number)| number);
            let pass = RevmapPass {
                size: dice.size::<RevmapPass>(),
                samples: 1,
                planes: [0, 4, 2][kind as usize],
                color_formats: formats.as_ptr(),
                color_format_count: formats.len() as u32,
                depth_format: DEPTH,
                attachments: numbers.as_ptr(),
                attachment_count: if kind == Kind::List { 4 } else { 0 },
                ..crate::zeros()
            };
            let device = some!(self.device);
            call! { revmap_renderer_create(device, &pass, search, slots, &mut handle) }
        };
        if !made {
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
            prewarms: Vec::new(),
        });
    }

    pub fn drop_renderer(&mut self, number: usize) {
        let made = self.renderers.swap_remove(number);
        for prewarm in made.prewarms {
            calls! { revmap_prewarm_destroy(prewarm); }
            self.dead.push(prewarm.addr());
        }
        calls! { revmap_renderer_destroy(made.handle); }
        self.dead.push(made.handle.addr());
    }

    /// Prepares a slot; then records it, submits it, or does not.
    pub fn frame(&mut self, number: usize) {
        let dice = &mut self.dice;
        let (last, mut view) = (dice.view(), dice.view());
        view.last = if dice.chance(0.2) { &last } else { null() };
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
        let host = self.host;
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
                let camera = defaults!(revmap_camera_defaults, RevmapCamera);
                let (camera, near, far) = (&camera, near.abs(), 10.0 * far.abs());
                view.viewport = WHOLE;
                call! { revmap_renderer_prepare_camera(renderer, cmd, slot, camera, 64, 48, near, far) }
            } else {
                call! { revmap_renderer_prepare(renderer, cmd, slot, &view) }
            };
            let mut statistics = sized!(RevmapFrameStatistics);
            let known = call! { revmap_renderer_frame_statistics(renderer, slot, &mut statistics) };
            assert!(known || !ready);
            // Wrong arguments leave the frame before, which has another view.
            if !records || known != ready {
                return;
            }
            if kind == Kind::Compute && ready && view.viewport != WHOLE {
                return; // the target has another size
            }
            // Vulkan refuses viewports far outside.
            let [x, y, width, height] = view.viewport.map(|side| side as f32);
            let usual = [x, y, width, height, y + height]
                .iter()
                .all(|side| side.abs() <= 16_384.0);
            if ready && !(usual && width > 0.0) {
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
}
