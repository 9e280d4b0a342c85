//! Views from a camera, or from a host's matrices.

use super::{DepthOrder, View, Viewport, wrong};
use crate::error::Result;
use crate::scene::{Camera, CameraFrame, Scene};
use glam::{DMat4, DVec2, DVec3, DVec4};

impl View {
    /// The view of `camera` for pictures of `size` pixels. Depth is 0 at `near` and 1 at `far`,
    /// both measured along the view. Rays begin at `near`: that plane cuts solids.
    ///
    /// # Errors
    /// The errors of [`CameraFrame::new`]; [`ErrorKind::Content`] unless `0 < near < far`.
    ///
    /// [`ErrorKind::Content`]: crate::error::ErrorKind::Content
    pub fn from_camera(camera: &Camera, size: (u32, u32), [near, far]: [f64; 2]) -> Result<Self> {
        if !(near > 0.0 && far > near && far.is_finite()) {
            return Err(wrong(format!(
                "the depth range {near} to {far} is none; give 0 < near < far"
            )));
        }
        let ray_width = camera.ray_width;
        let camera = CameraFrame::new(camera, size.0, size.1)?;
        // depth = constant + factor / t
        let constant = far / (far - near);
        let factor = -far * near / (far - near);
        // Step of one pixel as a fraction of half the picture. The middle is 0 in clip space unless
        // the camera is shifted.
        let step = |v: DVec3, pixels: u32| v * (2.0 / (v.length_squared() * f64::from(pixels)));
        let middle = |at: f64, pixels: u32| camera.forward * (2.0 * at / f64::from(pixels) - 1.0);
        let right = step(camera.right, size.0) + middle(camera.middle[0], size.0);
        let down = step(-camera.up, size.1) + middle(camera.middle[1], size.1);
        let row = |v: DVec3| DVec4::new(v.x, v.y, v.z, -v.dot(camera.eye));
        let depth_row = row(camera.forward);
        let clip_from_world = DMat4::from_cols(
            row(right),
            row(down),
            depth_row * constant + DVec4::W * factor,
            depth_row,
        )
        .transpose();
        let viewport = Viewport {
            x: 0.0,
            y: 0.0,
            width: f64::from(size.0),
            height: f64::from(size.1),
        };
        let dir_00 = camera.pixel(0, 0);
        let rays = [dir_00, camera.right, -camera.up, camera.forward];
        Ok(Self {
            depth: [constant, factor],
            near,
            start: near,
            ray_width,
            ..Self::of_rays(camera.eye, rays, clip_from_world, viewport)
        })
    }

    /// A view of all objects in all rows, without depths. `rays`: `dir_00`, `dir_x`, `dir_y` and
    /// `forward`.
    fn of_rays(
        eye: DVec3,
        [dir_00, dir_x, dir_y, forward]: [DVec3; 4],
        clip_from_world: DMat4,
        viewport: Viewport,
    ) -> Self {
        Self {
            eye,
            dir_00,
            dir_x,
            dir_y,
            forward,
            clip_from_world,
            depth: [0.0; 2],
            depth_range: [0.0, 1.0],
            depth_bias: 0.0,
            near: 0.0,
            start: 0.0,
            order: DepthOrder::Normal,
            viewport,
            parallel: false,
            mask: u32::MAX,
            jitter: DVec2::ZERO,
            ray_width: 1.0,
            last: None,
            rows: None,
        }
    }

    /// The view of a host's matrices, which act on column vectors. `projection * view` takes a
    /// world point to Vulkan's clip space (`0 <= z <= w`). The projection may include jitter, an
    /// off-centre frustum, infinite depth or reversed depth. Rays begin at the near plane, which
    /// cuts solids as it cuts meshes.
    ///
    /// A projection of OpenGL (`-w <= z <= w`) is not refused, for it is a projection of Vulkan with a
    /// near plane where `z` is 0: in perspective about twice as far away as meant.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for a projection whose depth runs against `order`, whose near plane is
    /// not at right angles to the view, or that mirrors the picture; for an empty viewport; for
    /// numbers that are not finite.
    ///
    /// [`ErrorKind::Content`]: crate::error::ErrorKind::Content
    pub fn from_matrices(
        view: DMat4,
        projection: DMat4,
        viewport: Viewport,
        order: DepthOrder,
    ) -> Result<Self> {
        viewport.check()?;
        let clip_from_world = projection * view;
        if !clip_from_world.is_finite() {
            return Err(wrong("the matrices are not finite; give finite numbers"));
        }
        let inverse = clip_from_world.inverse();
        let rows = clip_from_world.transpose();
        let (z_row, forward) = (rows.z_axis, rows.w_axis.truncate());
        if forward.length() < 1e-12 * rows.w_axis.w.abs() {
            return Self::parallel(clip_from_world, viewport, order);
        }
        let eye = view.inverse().w_axis;
        let eye = eye.truncate() / eye.w;
        if forward.length() < 1e-12 || !inverse.is_finite() || !eye.is_finite() {
            return Err(wrong(
                "the projection is not of perspective; give one whose last row looks along the view",
            ));
        }
        // clip z = constant * clip w + factor
        let constant = z_row.truncate().dot(forward) / forward.length_squared();
        let factor = (clip_from_world * eye.extend(1.0)).z;
        let bent = z_row.truncate() - forward * constant;
        if bent.length() > 1e-6 * z_row.truncate().length().max(forward.length()) {
            return Err(wrong(
                "the near plane is not at right angles to the view; give a projection without an oblique plane",
            ));
        }
        let direction = |x: f64, y: f64| {
            let ndc = viewport.clip(x, y);
            // The pixel's clip point at w = 1 minus the eye's, which is (0, 0, factor, 0).
            let point = inverse * DVec4::new(ndc.x, ndc.y, constant, 1.0);
            point.truncate()
        };
        let dir_00 = direction(0.5, 0.5);
        let (dir_x, dir_y) = (direction(1.5, 0.5) - dir_00, direction(0.5, 1.5) - dir_00);
        check_steps(dir_00, [dir_x, dir_y])?;
        if turn(dir_x, dir_y).dot(forward) <= 0.0 {
            return Err(wrong(
                "the view mirrors the picture; turn one axis of the projection or of the viewport round",
            ));
        }
        let [near_value, sense] = order.near_and_sense();
        // The sign decides about both planes: the far one is behind the near one, or at infinity.
        if sense * factor >= 0.0 {
            return Err(wrong(format!(
                "the projection's {}; give a projection for this depth order",
                against(order)
            )));
        }
        let near = factor / (near_value - constant);
        if !(near > 0.0 && near.is_finite()) {
            return Err(wrong(
                "the near plane is not in front of the eye; give a projection whose near plane is",
            ));
        }
        let rays = [dir_00, dir_x, dir_y, forward];
        Ok(Self {
            depth: [constant, factor],
            near,
            start: near,
            order,
            ..Self::of_rays(eye, rays, clip_from_world, viewport)
        })
    }

    /// The view of a scene's camera for pictures of `size` pixels, with a depth range that contains
    /// every solid before the eye. The near end is at least a ten-thousandth of the far one, and cuts
    /// nothing: rays begin at the eye.
    ///
    /// # Errors
    /// The errors of [`CameraFrame::new`].
    pub fn of_scene(scene: &Scene, size: (u32, u32)) -> Result<Self> {
        let camera = CameraFrame::new(&scene.camera, size.0, size.1)?;
        let view = Self::from_camera(&scene.camera, size, camera.depth_range(scene))?;
        Ok(Self { start: 0.0, ..view })
    }

    /// The view of parallel rays that begin in the near plane, where `t` is 0.
    fn parallel(clip_from_world: DMat4, viewport: Viewport, order: DepthOrder) -> Result<Self> {
        let inverse = clip_from_world.inverse();
        let [near_value, sense] = order.near_and_sense();
        let point = |x: f64, y: f64| {
            let p = inverse * viewport.clip(x, y).extend(near_value).extend(1.0);
            p.truncate() / p.w
        };
        let eye = point(0.5, 0.5);
        let (dir_x, dir_y) = (point(1.5, 0.5) - eye, point(0.5, 1.5) - eye);
        check_steps(eye, [dir_x, dir_y])?;
        let rows = clip_from_world.transpose();
        let (z_row, w) = (rows.z_axis.truncate() / rows.w_axis.w, rows.w_axis.w);
        let slope = z_row.length();
        let forward = z_row * (sense / slope);
        let turned = turn(dir_x, dir_y).dot(forward);
        let level = dir_x.dot(forward).abs() + dir_y.dot(forward).abs();
        let finite = forward.is_finite() && w != 0.0;
        let is_level = level <= 1e-6 * (dir_x.length() + dir_y.length());
        if !(finite && is_level) {
            return Err(wrong(
                "the parallel projection is oblique, or is none; give one at right angles to the view",
            ));
        }
        if turned <= 0.0 {
            return Err(wrong(format!(
                "the parallel projection mirrors the picture, or its {}; turn one axis round, or give a projection for this depth order",
                against(order)
            )));
        }
        let rays = [forward, dir_x, dir_y, forward];
        Ok(Self {
            depth: [near_value, sense * slope],
            order,
            parallel: true,
            ..Self::of_rays(eye, rays, clip_from_world, viewport)
        })
    }
}

/// The direction around which the picture's axes turn.
fn turn(dir_x: DVec3, dir_y: DVec3) -> DVec3 {
    dir_x.normalize().cross(dir_y.normalize())
}

/// Returns an error for pixels that 64 bits cannot hold: of a viewport, or a projection, of extreme
/// size.
fn check_steps(first: DVec3, steps: [DVec3; 2]) -> Result<()> {
    let holds = |step: DVec3| step.length_squared().is_normal();
    if first.is_finite() && steps.into_iter().all(holds) {
        return Ok(());
    }
    Err(wrong(
        "a pixel of this viewport and projection is no number; give sizes and positions in pixels",
    ))
}

/// The fault of a projection whose depth runs against an order.
fn against(order: DepthOrder) -> &'static str {
    match order {
        DepthOrder::Normal => "depth does not grow from 0 at the near plane",
        DepthOrder::Reversed => "depth does not fall from 1 at the near plane",
    }
}
