//! Views of any matrices, and plans of viewports of any numbers: refused by name, or planned within
//! the picture.

use super::path::Conditions;
use super::walk::Walks;
use super::{Call, DepthOrder, FramePlan, PlanObject, View, Viewport, plan, shape_of};
use crate::error::{ErrorKind, Result};
use crate::profile::Profile;
use crate::scene::{Object, Placement};
use crate::shader::generated::{GROUP_PIXELS, QUAD_BITS};
use crate::shader::{SearchCode, Technique};
use crate::solid::cache::Solid;
use crate::solid::offset_surface::{OffsetSurface, Recipe};
use crate::surface::FitOptions;
use glam::{DMat4, DQuat, DVec3, DVec4};
use proptest::prelude::*;
use std::sync::{Arc, LazyLock};

/// A spindle, its surface, and as objects: one copy, and a hundred.
static SOLIDS: LazyLock<(Arc<OffsetSurface>, [Object; 2])> = LazyLock::new(|| {
    let points = [[0.0, 0.0], [0.45, 0.5], [0.0, 1.0]];
    let profile = Arc::new(Profile::polygon(&points, 0.5).unwrap());
    let FitOptions { tolerance } = FitOptions::default();
    let exact = Recipe::Patches {
        level: 0,
        tolerance,
    };
    let one = Object::new("one", profile.clone());
    let mut several = one.clone();
    let place = |n: u32| Placement {
        position: DVec3::new(0.7 * f64::from(n / 10), 0.7 * f64::from(n % 10) - 3.5, 0.0),
        rotation: DQuat::from_rotation_x(0.1 * f64::from(n)),
        ..Placement::default()
    };
    several.instances = (0..100).map(place).collect();
    let solid = Arc::new(Solid::new(&profile));
    let surface = solid.surface(&one.offset, exact).unwrap();
    (surface, [one, several])
});

const WHOLE: [f64; 4] = [0.0, 0.0, 64.0, 48.0];

fn port([x, y, width, height]: [f64; 4]) -> Viewport {
    Viewport {
        x,
        y,
        width,
        height,
    }
}

/// A projection along x with this row of depths, and with the row of perspective or of parallel rays.
/// `up`: 1 if `y` points downwards.
fn lens(up: f64, [z, w]: [f64; 2], parallel: bool) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(0.0, -1.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, -up, 0.0),
        DVec4::new(z, 0.0, 0.0, w),
        if parallel { DVec4::W } else { DVec4::X },
    )
    .transpose()
}

/// The view from 6 units away, of 90 degrees in perspective.
fn view_of(viewport: Viewport, parallel: bool, order: DepthOrder) -> Result<View> {
    let look = DMat4::from_translation(DVec3::new(6.0, 0.0, -0.5));
    let deep = 1000.0 / 999.9;
    let depths = match (parallel, order) {
        (false, DepthOrder::Normal) => [deep, -0.1 * deep],
        (false, DepthOrder::Reversed) => [0.0, 0.1],
        (true, DepthOrder::Normal) => [1e-3, 0.0],
        (true, DepthOrder::Reversed) => [-1e-3, 1.0],
    };
    let lens = lens(viewport.height.signum(), depths, parallel);
    View::from_matrices(look, lens, viewport, order)
}

fn planned(view: &View) -> FramePlan {
    let (surface, objects) = &*SOLIDS;
    let surfaces = [surface.clone()];
    let objects: Vec<_> = (0..)
        .zip(objects)
        .map(|(number, object)| PlanObject {
            object,
            number,
            first_instance: number,
            technique: Technique {
                search: SearchCode::Quadric,
                ..Technique::LISTS
            },
            textures: number as usize,
            look_copies: object.placements().len(),
            surfaces: &surfaces,
            levels: None,
            shape: shape_of(object, [0.5, 0.46, 0.0, 1.0]),
        })
        .collect();
    let with = Conditions {
        compute: true,
        passes_cells: true,
        takes_patches: true,
        subgroup_size: 32,
        most_storage: 1 << 30,
        parallel: view.parallel,
        ..Conditions::default()
    };
    let walks = Walks::new(&objects, &with, false);
    let [planned, again] = [0; 2].map(|_| plan(view, &objects, &with, None, &walks));
    assert!(planned == again, "the same input gives two plans");
    planned
}

/// Ends of the pixels that a viewport may draw: left, top, right, bottom.
fn shown(view: &View) -> [f64; 4] {
    let [low, high] = view.corners();
    let most = f64::from(1u32 << QUAD_BITS);
    [low.x, low.y, high.x, high.y].map(|end| end.clamp(0.0, most))
}

/// Checks the plan of a view. Returns the number of its tiles.
fn check(view: &View) -> u32 {
    let [left, top, right, bottom] = shown(view);
    // A picture of 32,768 pixels a side has 17 million tiles, so few of its rows are planned.
    let view = match bottom > 4096.0 {
        true => view.with_rows(64..128),
        false => *view,
    };
    let mut tiles = 0;
    for step in planned(&view).steps {
        let (Call::Groups(_, pushed) | Call::Indirect(_, pushed)) = step.call else {
            continue;
        };
        let size = [pushed.size & 0xffff, pushed.size >> 16];
        let corner = [0, QUAD_BITS].map(|bits| pushed.corner >> bits & ((1 << QUAD_BITS) - 1));
        let last = [0, 1].map(|axis| f64::from(corner[axis] + GROUP_PIXELS * (size[axis] - 1)));
        let [x, y] = corner.map(|end| f64::from(end + GROUP_PIXELS));
        assert!(x > left && y > top, "{view:?}");
        assert!(last[0] < right && last[1] < bottom, "{view:?}");
        tiles += size[0] * size[1];
    }
    let shows = left < right && top < bottom;
    assert!(shows || tiles == 0, "{view:?}");
    tiles
}

fn number() -> impl Strategy<Value = f64> {
    let sizes = [0.0, 1e-9, 1e-300, 1e9, 1e300, f64::INFINITY, f64::NAN];
    let odd: Vec<f64> = sizes.into_iter().flat_map(|size| [size, -size]).collect();
    prop_oneof![
        6 => -900.0..900.0f64,
        2 => (-60i32..60).prop_map(|n| 8.0 * f64::from(n)),
        3 => proptest::sample::select(odd),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    /// A viewport of any four numbers is refused by name or planned, in both stages, and nothing is
    /// drawn outside of it.
    #[test]
    fn any_viewport_is_planned_or_refused(
        [x, y, width, height] in [number(), number(), number(), number()],
        parallel: bool,
        reversed: bool,
    ) {
        let order = if reversed { DepthOrder::Reversed } else { DepthOrder::Normal };
        let numbers = [x, y, width, height];
        match view_of(port(numbers), parallel, order) {
            Ok(view) => {
                let finite = numbers.iter().all(|number| number.is_finite());
                prop_assert!(finite && width > 0.0 && height != 0.0);
                check(&view);
            }
            Err(error) => {
                prop_assert_eq!(error.kind, ErrorKind::Content);
                let usual = |number: &f64| number.abs() < 1e10 && (number.abs() > 1e-10);
                let fits = numbers[2..].iter().all(usual) && width > 0.0;
                let placed = numbers[..2].iter().all(|number| number.abs() < 1e10);
                prop_assert!(!(fits && placed), "{}", error);
            }
        }
    }
}

/// The first number that is not finite is named.
#[test]
fn numbers_that_are_not_finite_are_named() {
    let keys = ["x", "y", "width", "height"];
    for (n, key) in keys.into_iter().enumerate() {
        for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut all = WHOLE;
            all[n] = odd;
            let error = view_of(port(all), false, DepthOrder::Normal).unwrap_err();
            assert_eq!(error.kind, ErrorKind::Content);
            let named = error.to_string().contains(&format!("viewport.{key} is"));
            assert!(named, "{error}");
        }
    }
}

/// A split screen that slides out to each side draws its visible pixels until none is left.
#[test]
fn a_viewport_slides_out_to_each_side() {
    // These alone have solids in their visible part, or the box around all copies.
    const SHOWS: [[f64; 2]; 2] = [[-20.0, -10.0], [-20.0, -30.0]];
    for parallel in [false, true] {
        for [x, y] in [
            [-64.0, 0.0],
            [-65.0, 0.0],
            [-1e4, 0.0],
            [0.0, -48.0],
            [0.0, -1e4],
            SHOWS[0],
            SHOWS[1],
            [1e9, 1e9],
        ] {
            for height in [48.0, -48.0] {
                let below = if height < 0.0 { y - height } else { y };
                let viewport = port([x, below, 64.0, height]);
                let tiles = check(&view_of(viewport, parallel, DepthOrder::Normal).unwrap());
                let shows = !parallel && SHOWS.contains(&[x, y]);
                assert_eq!(tiles > 0, shows, "{x} {y} {height}");
            }
        }
    }
}

/// Depths follow the range of the viewport and the bias in any order, and invert.
#[test]
fn depths_are_in_the_range_of_the_viewport() {
    for (parallel, order) in [
        (false, DepthOrder::Normal),
        (false, DepthOrder::Reversed),
        (true, DepthOrder::Normal),
        (true, DepthOrder::Reversed),
    ] {
        let plain = view_of(port(WHOLE), parallel, order).unwrap();
        let one = plain
            .with_depth_range([0.2, 0.7])
            .unwrap()
            .with_depth_bias(1e-3);
        let other = plain
            .with_depth_bias(1e-3)
            .with_depth_range([0.2, 0.7])
            .unwrap();
        assert_eq!(one, other);
        for t in [0.3, 5.0, 70.0] {
            let wanted = 0.2 + 0.5 * plain.depth_at(t) + 1e-3;
            assert!((one.depth_at(t) - wanted).abs() < 1e-12);
            assert!(
                (one.t_at(wanted) / t - 1.0).abs() < 1e-6,
                "{parallel} {order:?} {t}"
            );
        }
        for range in [
            [0.7, 0.2],
            [0.5, 0.5],
            [-0.1, 1.0],
            [0.0, 1.1],
            [f64::NAN, 1.0],
        ] {
            let error = plain.with_depth_range(range).unwrap_err();
            assert!(error.to_string().contains("depth range"), "{error}");
        }
    }
}

/// A view along x through a projection whose near and far plane, which is `far` away, have these depths
/// in clip space.
fn view_of_range(
    [first, last]: [f64; 2],
    far: f64,
    parallel: bool,
    order: DepthOrder,
) -> Result<View> {
    let near = 0.1;
    let deep = far - near;
    // Depth is (z x + w) / x in perspective, z x + w for parallel rays.
    let slope = (last - first) / deep;
    let depths = match (parallel, far.is_finite()) {
        (true, _) => [slope, first - near * slope],
        (_, true) => {
            let z = (far * last - near * first) / deep;
            [z, near * (first - z)]
        }
        (_, false) => [last, near * (first - last)],
    };
    let lens = lens(1.0, depths, parallel);
    View::from_matrices(DMat4::IDENTITY, lens, port(WHOLE), order)
}

/// A projection whose depth runs against the order of the pass is refused, whatever its rays, its far
/// plane and its range are: otherwise far solids are drawn over near ones.
#[test]
fn projections_of_the_other_depth_order_are_refused() {
    const VULKAN: [f64; 2] = [0.0, 1.0];
    const OPENGL: [f64; 2] = [-1.0, 1.0];
    for parallel in [false, true] {
        for far in [100.0, 0.2, f64::INFINITY] {
            // Parallel rays without a far plane have no depths.
            if parallel && far.is_infinite() {
                continue;
            }
            for [a, b] in [VULKAN, OPENGL] {
                for (ends, order, other) in [
                    ([a, b], DepthOrder::Normal, DepthOrder::Reversed),
                    ([b, a], DepthOrder::Reversed, DepthOrder::Normal),
                ] {
                    let of = (ends, far);
                    let view = view_of_range(ends, far, parallel, order);
                    assert!(view.is_ok(), "{parallel} {of:?} {order:?}: {view:?}");
                    let error = view_of_range(ends, far, parallel, other).unwrap_err();
                    assert_eq!(error.kind, ErrorKind::Content);
                    assert_eq!(error.key.as_deref(), Some("view"));
                    let remedy = "give a projection for this depth order";
                    assert!(
                        error.message.contains(remedy),
                        "{parallel} {of:?} {other:?}: {error}"
                    );
                }
            }
        }
    }
}
