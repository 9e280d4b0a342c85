//! What is measured to see how time grows: sizes of pictures, numbers of copies, rows of maps.

use crate::method::{Method, MethodSettings};
use crate::report::plan::{Plan, rbm_baseline};
use crate::report::suite;
use crate::report::sweep::has_rows;
use crate::report::view::View;
use glam::DVec3;
use revmap::error::Result;
use revmap::scene::Placement;
use revmap::settings::DrawStage;

/// Sizes of pictures.
const SIZES: [(u32, u32); 5] = [
    (320, 240),
    (640, 480),
    (1280, 720),
    (1920, 1080),
    (3840, 2160),
];
/// Numbers of copies.
const COPIES: [u32; 5] = [1, 10, 100, 1000, 10_000];
/// Rows of maps.
const ROWS: [u32; 7] = [64, 128, 256, 512, 1024, 2048, 4096];
/// Meshes measured where none is named: one for solids that fill the picture, one for solids of
/// some ten pixels.
pub const MESHES: [(u32, u32); 2] = [(16, 32), (64, 128)];
/// Most quads of all copies of a mesh: beyond, a frame takes many seconds.
const MOST_QUADS: u64 = 1 << 23;
/// The size at which solids and rows grow.
const STILL: (u32, u32) = (800, 600);

/// How many sizes, numbers and rows are taken: the first so many of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ranges {
    /// Of the sizes.
    pub sizes: usize,
    /// Of the numbers of copies.
    pub copies: usize,
    /// Of the rows.
    pub rows: usize,
}

impl Ranges {
    /// All.
    pub const ALL: Self = Self {
        sizes: SIZES.len(),
        copies: COPIES.len(),
        rows: ROWS.len(),
    };
    /// A look.
    pub const QUICK: Self = Self {
        sizes: 3,
        copies: 3,
        rows: 4,
    };
}

/// The plan: every stage and search over each of the quantities, the RBM baseline among them.
///
/// # Errors
/// Of the solid that the program carries.
pub fn plan(stages: &[DrawStage], methods: &[Method], ranges: Ranges) -> Result<Plan> {
    let one = suite::one()?;
    let copies = &COPIES[..ranges.copies.min(COPIES.len())];
    let mut views = vec![one.clone()];
    views.extend(copies.iter().map(|&n| field(&one, n)));
    let mut plan = Plan {
        views,
        cases: Vec::new(),
        mixed: false,
    };
    for &stage in stages {
        let base = MethodSettings {
            stage,
            planes: revmap::settings::Planes::Color,
            ..MethodSettings::default()
        };
        let mut ways: Vec<MethodSettings> = methods
            .iter()
            .map(|&method| MethodSettings { method, ..base })
            .collect();
        ways.push(rbm_baseline(&one, &base));
        let sized = |s: &MethodSettings, (width, height): (u32, u32)| MethodSettings {
            width,
            height,
            ..*s
        };
        // A mesh is not drawn by compute, and has no map.
        ways.retain(|w| !w.method.is_mesh() || stage == DrawStage::Fragment);
        for way in &ways {
            for &size in SIZES.iter().take(ranges.sizes) {
                plan.add(0, sized(way, size));
            }
            for &rows in ROWS.iter().take(ranges.rows) {
                if !(way.method.reads_map() || has_rows(way.method)) {
                    continue;
                }
                plan.add(
                    0,
                    MethodSettings {
                        map_rows: Some(rows),
                        ..sized(way, STILL)
                    },
                );
            }
            for (view, &count) in copies.iter().enumerate() {
                if way.method.quads() * u64::from(count) <= MOST_QUADS {
                    plan.add(view + 1, sized(way, STILL));
                }
            }
        }
    }
    Ok(plan)
}

/// `count` copies on a square field one unit wide, seen whole.
pub(crate) fn field(one: &View, count: u32) -> View {
    let mut view = one.clone();
    let side = f64::from(count).sqrt().ceil();
    for object in &mut view.scene.objects {
        let scale = 1.0 / (2.0 * object.profile.radius * side);
        let place = |k: u32| {
            let (x, y) = (f64::from(k) % side, (f64::from(k) / side).floor());
            Placement {
                position: DVec3::new((x + 0.5) / side, (y + 0.5) / side, 0.0),
                scale: DVec3::splat(scale),
                ..Placement::default()
            }
        };
        object.instances = (0..count).map(place).collect();
    }
    view.name = format!("{}-x{count}", one.name);
    view.framed(50.0)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use revmap_searches::CIRCLE;

    #[test]
    fn a_field_holds_its_copies_side_by_side() {
        let plan = plan(
            &[DrawStage::Compute],
            &[Method::Search(CIRCLE)],
            Ranges::ALL,
        )
        .unwrap();
        for (view, count) in plan.views[1..].iter().zip(COPIES) {
            view.scene.check().unwrap();
            assert_eq!(view.solids(), count as usize);
            let all = view.scene.objects[0].placements();
            let width = 2.0 * view.scene.objects[0].profile.radius * all[0].scale.x;
            for (k, a) in all.iter().enumerate().take(40) {
                assert!(
                    all[..k]
                        .iter()
                        .all(|b| (a.position - b.position).abs().max_element() > width * 0.999)
                );
            }
            assert!(
                all.iter()
                    .all(|p| p.position.max_element() <= 1.0 - width / 2.0 + 1e-9)
            );
        }
    }

    #[test]
    fn meshes_grow_with_pixels_and_solids_alone() {
        let methods = MESHES.map(|(segments, rings)| Method::Mesh { segments, rings });
        let stages = [DrawStage::Fragment, DrawStage::Compute];
        let plan = plan(&stages, &methods, Ranges::ALL).unwrap();
        let of = |method| {
            plan.cases
                .iter()
                .filter(move |c| c.settings.method == method)
        };
        for (method, copies) in methods.into_iter().zip([5, 4]) {
            assert!(of(method).all(|c| c.settings.stage == DrawStage::Fragment));
            assert!(of(method).all(|c| c.settings.map_rows.is_none()));
            assert_eq!(of(method).filter(|c| c.view == 0).count(), SIZES.len());
            assert_eq!(of(method).filter(|c| c.view > 0).count(), copies);
        }
    }
}
