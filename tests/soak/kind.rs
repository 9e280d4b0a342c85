//! The kinds of output that renderers of a random host have.

use crate::common::host::{COLOR, Canvas, DEPTH, Host, Options, dynamic, order};
use crate::random::Random;
use ash::vk;
use revmap::gpu::{HostPass, Output, PassFormats, PassKind};
use revmap::settings::{Plane, PlaneList, Planes, SearchSettings, Solver, Tolerance};

/// An output, and how its renderer searches.
#[derive(Clone, Debug)]
pub struct Kind {
    pub options: Options,
    pub planes: Planes,
    /// Formats of the colour attachments.
    pub formats: Vec<vk::Format>,
    pub compute: bool,
    /// True if the renderer gets the host's render pass itself, with pipelines of its own.
    pub own_pass: bool,
    pub search: SearchSettings,
}

impl Kind {
    pub fn random(dice: &mut Random) -> Self {
        let (width, height) = dice.pick(&[(24, 20), (33, 17), (20, 36), (24, 20), (64, 48)]);
        let mut kind = Self {
            options: Options {
                reversed: dice.chance(0.3),
                ..Options::new(width, height)
            },
            planes: Planes::Color,
            formats: vec![COLOR],
            compute: false,
            own_pass: false,
            search: search(dice),
        };
        match dice.weighed([0.4, 0.2, 0.15, 0.25].into_iter()) {
            0 => {
                kind.options.dynamic = dice.chance(0.5);
                kind.options.samples = dice.pick(&[1, 1, 4]);
                kind.own_pass = !kind.options.dynamic && dice.chance(0.2);
            }
            1 => {
                let planes = planes(dice);
                kind.formats = planes.iter().map(|plane| format(*plane)).collect();
                kind.planes = Planes::List(PlaneList::new(&planes).unwrap());
            }
            2 => {
                let parallel = dice.chance(0.5);
                kind.planes = Planes::Depth { parallel };
                kind.formats.clear();
            }
            _ => {
                kind.compute = true;
                kind.options.reversed = false;
                kind.formats.clear();
            }
        }
        kind
    }

    /// What a slot's frame is drawn into.
    pub fn canvas<'a>(&self, host: &'a Host) -> Canvas<'a> {
        match self.compute {
            true => Canvas::words(host, self.options),
            false => Canvas::pass(host, self.options, &self.formats),
        }
    }

    /// True if depths are along parallel rays.
    pub fn parallel(&self) -> bool {
        self.planes == Planes::Depth { parallel: true }
    }

    pub fn has_motion(&self) -> bool {
        matches!(self.planes, Planes::List(list) if list.has(Plane::Motion))
    }

    /// The number of the attachment of identities.
    pub fn identity(&self) -> Option<usize> {
        let Planes::List(list) = self.planes else {
            return None;
        };
        list.planes().iter().position(|p| *p == Plane::Identity)
    }

    pub fn width(&self) -> usize {
        self.options.width as usize
    }

    pub fn pixels(&self) -> usize {
        (self.options.width * self.options.height) as usize
    }

    /// The output, in the host's render pass if there is one. Null: in any pass of the formats.
    pub fn output(&self, pass: vk::RenderPass) -> Output {
        if self.compute {
            return Output::Compute(self.planes);
        }
        let begun = if self.options.dynamic {
            dynamic(&self.formats)
        } else if pass == vk::RenderPass::null() {
            let (color, depth) = (self.formats.clone(), DEPTH);
            PassKind::SingleSubpass { color, depth }
        } else {
            // SAFETY: the pass outlives the renderers of the episode and what they compile.
            let pass = unsafe { HostPass::new(pass) };
            PassKind::RenderPass { pass, subpass: 0 }
        };
        Output::Pass(PassFormats {
            samples: self.options.samples,
            depth: order(&self.options),
            ..PassFormats::new(begun, self.planes)
        })
    }
}

fn search(dice: &mut Random) -> SearchSettings {
    SearchSettings {
        solver: match dice.below(6) {
            0 => Solver::Quadric,
            1 => Solver::Live,
            _ => Solver::Exact,
        },
        // Small maps are baked fast.
        map_rows: Some(32),
        proxy_min_pixels: dice.pick(&[0, 150, 150, u32::MAX]),
        tolerance: Tolerance::new(dice.pick(&[0.0, 0.25, 8.0])).unwrap(),
        ..SearchSettings::exact()
    }
}

/// Some planes in any order.
fn planes(dice: &mut Random) -> Vec<Plane> {
    let mut left = vec![
        Plane::Color,
        Plane::BaseColor,
        Plane::Normal,
        Plane::OctahedralNormal,
        Plane::Material,
        Plane::Motion,
        Plane::Identity,
    ];
    let count = 1 + dice.below(5);
    (0..count)
        .map(|_| left.remove(dice.below(left.len())))
        .collect()
}

fn format(plane: Plane) -> vk::Format {
    match plane {
        Plane::Color | Plane::BaseColor => COLOR,
        Plane::Normal => vk::Format::R16G16B16A16_SFLOAT,
        Plane::OctahedralNormal => vk::Format::R16G16_SFLOAT,
        Plane::Material => vk::Format::R8G8_UNORM,
        Plane::Motion => vk::Format::R32G32_SFLOAT,
        Plane::Identity => vk::Format::R32G32_UINT,
    }
}
