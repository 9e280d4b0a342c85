//! Random views.

use crate::common::host::order;
use crate::kind::Kind;
use crate::random::Random;
use ash::vk;
use glam::{DMat4, DVec3, DVec4};
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
    let port = match kind.compute {
        true => whole(kind),
        false => viewport(dice, kind),
    };
    let plain = port == whole(kind);
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
        let projection = match kind.parallel() {
            true => parallel(dice, kind.options.reversed, port.height < 0.0),
            false => perspective(dice, &port, kind.options.reversed),
        };
        View::from_matrices(look(eye, target), projection, port, order(&kind.options))
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
        scissor: vk::Rect2D {
            offset: vk::Offset2D {
                x: 0,
                y: rows[0] as i32,
            },
            extent: vk::Extent2D {
                width,
                height: rows[1] - rows[0],
            },
        },
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

fn whole(kind: &Kind) -> Viewport {
    Viewport {
        x: 0.0,
        y: 0.0,
        width: f64::from(kind.options.width),
        height: f64::from(kind.options.height),
    }
}

fn viewport(dice: &mut Random, kind: &Kind) -> Viewport {
    let whole = whole(kind);
    let (width, height) = (whole.width, whole.height);
    let mut port = match dice.below(10) {
        0 => Viewport {
            x: 10.0,
            y: 5.0,
            width: width - 15.0,
            height: height - 7.5,
        },
        1 => Viewport {
            x: 8.0,
            y: 3.0,
            ..whole
        },
        2 => Viewport {
            x: -9.5,
            y: -7.0,
            width: width + 3.0,
            height: height + 20.0,
        },
        3 => Viewport {
            x: -100.0,
            y: 0.0,
            width: 60.0,
            height,
        },
        _ => whole,
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

fn look(eye: DVec3, target: DVec3) -> DMat4 {
    let forward = (target - eye).normalize();
    let right = forward.cross(up(forward)).normalize();
    let up = right.cross(forward);
    let row = |axis: DVec3| axis.extend(-axis.dot(eye));
    DMat4::from_cols(row(right), row(up), row(-forward), DVec4::W).transpose()
}

/// A frustum in the middle or beside it; reversed depth may reach to infinity.
fn perspective(dice: &mut Random, port: &Viewport, reversed: bool) -> DMat4 {
    let (near, far) = (0.05, 60.0);
    let focal = 1.0 / dice.pick(&[10f64, 20.0, 45.0]).to_radians().tan();
    let aspect = port.width / port.height;
    let [x, y] = dice.pick(&[[0.0; 2], [0.0; 2], [0.3, -0.2]]);
    let (z, w) = match (reversed, dice.chance(0.5)) {
        (true, true) => (0.0, near),
        (true, false) => (near / (far - near), near * far / (far - near)),
        (false, _) => (far / (near - far), near * far / (near - far)),
    };
    // Clip space has y upwards in a viewport of negative height.
    DMat4::from_cols(
        DVec4::new(focal / aspect.abs(), 0.0, 0.0, 0.0),
        DVec4::new(0.0, -focal * port.height.signum(), 0.0, 0.0),
        DVec4::new(x, y, z, -1.0),
        DVec4::new(0.0, 0.0, w, 0.0),
    )
}

fn parallel(dice: &mut Random, reversed: bool, flipped: bool) -> DMat4 {
    let (near, far) = (0.05, 60.0);
    let half = dice.pick(&[0.5, 1.5, 4.0]);
    let (z, w) = match reversed {
        true => (1.0 / (far - near), far / (far - near)),
        false => (-1.0 / (far - near), -near / (far - near)),
    };
    let y = if flipped { 1.0 } else { -1.0 };
    DMat4::from_cols(
        DVec4::new(0.75 / half, 0.0, 0.0, 0.0),
        DVec4::new(0.0, y / half, 0.0, 0.0),
        DVec4::new(0.0, 0.0, z, 0.0),
        DVec4::new(0.0, 0.0, w, 1.0),
    )
}
