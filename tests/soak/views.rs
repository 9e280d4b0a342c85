//! Random views.

use crate::common::host;
use crate::kind::Kind;
use crate::random::Random;
use ash::vk;
use glam::{DMat4, DVec3};
use revmap::gpu::{View, Viewport};
use revmap::scene::{Camera, Placement};
use revmap::settings::Planes;

/// A view, with the dynamic state that a pass sets for it.
#[derive(Clone, Copy)]
pub struct Seen {
    pub view: View,
    pub viewport: vk::Viewport,
    pub scissor: vk::Rect2D,
    pub name: &'static str,
}

/// A view of a scene near the origin, in which a solid may be at `inside`.
pub fn random(
    dice: &mut Random,
    kind: &Kind,
    inside: Option<Placement>,
    last: Option<&View>,
) -> Seen {
    let (width, height) = (kind.options.width, kind.options.height);
    let (eye, target, name) = eye(dice, inside);
    let whole = host::viewport(&kind.options);
    let port = match kind.compute {
        true => whole,
        false => viewport(dice, &whole),
    };
    let plain = port == whole;
    let camera = plain && !kind.options.reversed && !kind.parallel() && dice.chance(0.4);
    let made = if camera {
        let camera = Camera {
            up: up(target - eye),
            fov_y: dice.pick(&[20.0, 40.0, 90.0]),
            shift: dice.pick(&[[0.0; 2], [0.0; 2], [0.3, -0.2]]),
            ..Camera::new(eye, target)
        };
        View::from_camera(&camera, (width, height), [0.05, 60.0])
    } else {
        let look = host::look(eye, target, up(target - eye));
        let order = host::order(&kind.options);
        View::from_matrices(look, lens(dice, kind, &port), port, order)
    };
    let mut view = made.unwrap_or_else(|e| panic!("a view {name} was refused: {e}"));
    let mut rows = [0, height];
    let steps = height / View::ROW_STEP;
    if plain && steps > 1 && dice.chance(0.1) {
        let first = dice.below(steps as usize) as u32 * View::ROW_STEP;
        rows = [first, dice.pick(&[first + View::ROW_STEP, height])];
        view = view.with_rows(rows[0]..rows[1]);
    }
    if dice.chance(0.2) {
        view = view.with_mask(dice.pick(&[1, 2, 3, 5, 0]));
    }
    if dice.chance(0.2) {
        view = view.with_jitter([0.25, -0.4]);
    }
    if matches!(kind.planes, Planes::Depth { .. }) && dice.chance(0.2) {
        view = view.with_depth_bias(1e-3);
    }
    if let Some(last) = last
        && dice.chance(0.7)
    {
        view = view.with_last(last);
    }
    Seen {
        view,
        viewport: vk::Viewport {
            x: port.x as f32,
            y: port.y as f32,
            width: port.width as f32,
            height: port.height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        },
        scissor: vk::Rect2D::default()
            .offset(vk::Offset2D::default().y(rows[0] as i32))
            .extent(vk::Extent2D {
                width,
                height: rows[1] - rows[0],
            }),
        name,
    }
}

/// Eye, target, and what they are called.
fn eye(dice: &mut Random, inside: Option<Placement>) -> (DVec3, DVec3, &'static str) {
    let mut at = |size: f64| {
        let mut one = || dice.between(-size, size);
        DVec3::new(one(), one(), one())
    };
    let (target, side) = (at(0.3), at(1.0));
    let side = match side.length() > 0.1 {
        true => side.normalize(),
        false => DVec3::X,
    };
    match (dice.below(16), inside) {
        (0, _) => (side * 40.0, target, "far"),
        (1, _) => (side * 0.9, target, "near"),
        (2, _) => (DVec3::Z * 4.0, DVec3::ZERO, "along the axis"),
        (3 | 4, Some(place)) => {
            let within = place.scale * DVec3::new(0.02, 0.0, 0.5);
            let eye = place.position + place.rotation * within;
            (eye, eye + side, "in a solid")
        }
        (5, Some(place)) => {
            let above = place.rotation * (place.scale * DVec3::Z * 3.0);
            let eye = place.position + above;
            (eye, place.position, "on a solid's axis")
        }
        (6, _) => (side * 4.0, side * 9.0, "away"),
        _ => (side * dice.between(2.0, 7.0), target, "near by"),
    }
}

fn viewport(dice: &mut Random, whole: &Viewport) -> Viewport {
    let (width, height) = (whole.width, whole.height);
    let [x, y, width, height] = match dice.below(10) {
        0 => [10.0, 5.0, width - 15.0, height - 7.5],
        1 => [8.0, 3.0, width, height],
        2 => [-9.5, -7.0, width + 3.0, height + 20.0],
        3 => [-100.0, 0.0, 60.0, height],
        _ => [0.0, 0.0, width, height],
    };
    let mut port = Viewport {
        x,
        y,
        width,
        height,
    };
    if dice.chance(0.15) {
        (port.y, port.height) = (port.y + port.height, -port.height);
    }
    port
}

fn up(forward: DVec3) -> DVec3 {
    match forward.normalize().cross(DVec3::Z).length() > 0.05 {
        true => DVec3::Z,
        false => DVec3::X,
    }
}

/// A frustum in the middle or beside it, where reversed depth may reach to infinity, or parallel
/// rays. Clip space has y upwards in a viewport of negative height.
fn lens(dice: &mut Random, kind: &Kind, port: &Viewport) -> DMat4 {
    let reversed = kind.options.reversed;
    let mut range = [0.05, 60.0];
    let [x, y] = match kind.parallel() {
        true => {
            let half = dice.pick(&[0.5, 1.5, 4.0]);
            [0.75 / half, 1.0 / half]
        }
        false => {
            if reversed && dice.chance(0.5) {
                range[1] = f64::INFINITY;
            }
            let focal = 1.0 / dice.pick(&[10f64, 20.0, 45.0]).to_radians().tan();
            [focal / (port.width / port.height).abs(), focal]
        }
    };
    let scales = [x, y * port.height.signum()];
    let mut lens = host::lens(scales, kind.parallel(), reversed, range);
    if !kind.parallel() {
        [lens.z_axis.x, lens.z_axis.y] = dice.pick(&[[0.0; 2], [0.0; 2], [0.3, -0.2]]);
    }
    lens
}
