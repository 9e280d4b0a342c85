//! A view of the scene: the ray of each pixel and the depth of its hit, from a camera or from a
//! host's matrices.

use crate::error::{Error, ErrorKind, Result};
use crate::scene::{Camera, CameraFrame, Scene};
use crate::shader::generated::GROUP_PIXELS;
use glam::{DMat4, DVec2, DVec3, DVec4};
use std::ops::Range;

/// The end of the depth range that is near.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DepthOrder {
    /// 0 is near; fragments of smaller depth pass.
    #[default]
    Normal,
    /// 1 is near; fragments of greater depth pass.
    Reversed,
}

impl DepthOrder {
    /// The depth of the near plane in clip space, and 1 if depth grows away from the eye, else -1.
    pub(crate) fn near_and_sense(self) -> [f64; 2] {
        match self {
            Self::Normal => [0.0, 1.0],
            Self::Reversed => [1.0, -1.0],
        }
    }
}

/// The rectangle of the framebuffer onto which the view is projected, in pixels. It may be partly or
/// wholly outside of the framebuffer: what is outside is not drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Viewport {
    /// Left edge.
    pub x: f64,
    /// Upper edge, or lower edge where `height` is negative.
    pub y: f64,
    /// Width, positive.
    pub width: f64,
    /// Height; negative where clip space has `y` upwards (Vulkan 1.1).
    pub height: f64,
}

impl Viewport {
    /// Clip position, from -1 to 1, of a framebuffer position.
    fn clip(&self, x: f64, y: f64) -> DVec2 {
        DVec2::new(
            2.0 * (x - self.x) / self.width - 1.0,
            2.0 * (y - self.y) / self.height - 1.0,
        )
    }

    /// Returns an error for a number that is not finite, and for an empty viewport.
    fn check(&self) -> Result<()> {
        let sides = [("width", self.width), ("height", self.height)];
        for (key, value) in [("x", self.x), ("y", self.y)].into_iter().chain(sides) {
            if !value.is_finite() {
                return Err(wrong(format!(
                    "viewport.{key} is {value}; give a finite number"
                )));
            }
        }
        if self.width <= 0.0 || self.height == 0.0 {
            let (width, height) = (self.width, self.height);
            let message = format!(
                "the viewport is empty: {width} x {height} pixels; give a width above 0 and a height other than 0"
            );
            return Err(wrong(message));
        }
        Ok(())
    }
}

/// An eye, the ray of every pixel, and the depth of every point.
///
/// The ray through the centre of framebuffer pixel `(i, j)` is `eye + t (dir_00 + i dir_x + j
/// dir_y)`. The direction is not normalised: `t` is the depth along `forward`, and the depth in clip
/// space is `depth[0] + depth[1] / t`. A parallel view has rays `eye + i dir_x + j dir_y + t dir_00`
/// instead, and depths `depth[0] + depth[1] t`. [`View::depth_at`] is the value in the depth buffer.
///
/// Members are what all pixels and copies read, computed once for a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    pub(crate) eye: DVec3,
    pub(crate) dir_00: DVec3,
    pub(crate) dir_x: DVec3,
    pub(crate) dir_y: DVec3,
    pub(crate) forward: DVec3,
    pub(crate) clip_from_world: DMat4,
    /// Constant and factor of depths in clip space, from 0 to 1: `depth[0] + depth[1] / t`.
    pub(crate) depth: [f64; 2],
    /// The depth buffer's values of these depths 0 and 1.
    pub(crate) depth_range: [f64; 2],
    /// Shift of depths, units of the depth buffer.
    pub(crate) depth_bias: f64,
    /// `t` of the near plane.
    pub(crate) near: f64,
    /// `t` at which rays begin: that of the near plane, or 0 in a scene's view.
    pub(crate) start: f64,
    pub(crate) order: DepthOrder,
    pub(crate) viewport: Viewport,
    pub(crate) parallel: bool,
    pub(crate) mask: u32,
    /// Shift of the picture by the projection's jitter, pixels.
    pub(crate) jitter: DVec2,
    /// Width of the part of a pixel that a ray stands for, pixels.
    pub(crate) ray_width: f64,
    /// [`View::pixel_rows`] of the last frame's view, for motion.
    pub(crate) last: Option<[DVec4; 3]>,
    /// First row and end of the rows that are drawn; all if none.
    pub(crate) rows: Option<[u32; 2]>,
}

impl View {
    /// Rows of a tile.
    pub const ROW_STEP: u32 = GROUP_PIXELS;

    /// The view of `camera` for pictures of `size` pixels. Depth is 0 at `near` and 1 at `far`,
    /// both measured along the view. Rays begin at `near`: that plane cuts solids.
    ///
    /// # Errors
    /// The errors of [`CameraFrame::new`]; [`ErrorKind::Content`] unless `0 < near < far`.
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

    /// The same view of the objects whose mask shares a bit with `mask`. A new view shows all.
    #[must_use]
    pub fn with_mask(self, mask: u32) -> Self {
        Self { mask, ..self }
    }

    /// The same view with a jitter that its projection contains: the shift of the picture, pixels, x
    /// to the right and y downwards. Motion leaves it out.
    #[must_use]
    pub fn with_jitter(self, shift: [f64; 2]) -> Self {
        let jitter = DVec2::from(shift);
        Self { jitter, ..self }
    }

    /// The same view for rays that stand for a part of a pixel, of this width in pixels. Textures are
    /// sharper by as much: `n` rays of a pixel whose colours are averaged, in one frame or over
    /// frames with jitter, have a width of `1 / sqrt(n)`. Values of 0 and below count as the least
    /// positive one, above 1 textures are softer.
    #[must_use]
    pub fn with_ray_width(self, pixels: f64) -> Self {
        let ray_width = pixels.max(f64::MIN_POSITIVE);
        Self { ray_width, ..self }
    }

    /// The same view after a frame of the view `last`, whose viewport may differ. Motion is that
    /// from `last`; without it, only objects move.
    #[must_use]
    pub fn with_last(self, last: &Self) -> Self {
        Self {
            last: Some(last.pixel_rows()),
            ..self
        }
    }

    /// The same view with depths shifted by `bias`, in units of the depth buffer: positive is
    /// farther in [`DepthOrder::Normal`] and nearer in [`DepthOrder::Reversed`]. For shadow maps.
    /// [`SlopeBias`](crate::gpu::SlopeBias) adds a bias for slopes. Parts of solids whose
    /// shifted depth leaves 0 to 1 may be missing, and those at the near plane may have holes.
    #[must_use]
    pub fn with_depth_bias(self, bias: f64) -> Self {
        Self {
            depth_bias: self.depth_bias + bias,
            ..self
        }
    }

    /// The same view with the depth range of the host's `VkViewport`: `minDepth` and `maxDepth`.
    /// The depth buffer holds `minDepth` for a depth of 0 in clip space, and `maxDepth` for 1. A new
    /// view has the range 0 to 1. Give it in each frame of a viewport with another range: the
    /// viewport does not reach depths that a shader writes.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] unless `0 <= minDepth < maxDepth <= 1`.
    pub fn with_depth_range(self, [min, max]: [f64; 2]) -> Result<Self> {
        if !(0.0 <= min && min < max && max <= 1.0) {
            return Err(wrong(format!(
                "the depth range {min} to {max} is none; give 0 <= minDepth < maxDepth <= 1, and DepthOrder::Reversed for reversed depths"
            )));
        }
        Ok(Self {
            depth_range: [min, max],
            ..self
        })
    }

    /// Constant and factor of depths in clip space, with the bias.
    pub(crate) fn clip_depth(&self) -> [f64; 2] {
        let [constant, factor] = self.depth;
        let [min, max] = self.depth_range;
        [constant + self.depth_bias / (max - min), factor]
    }

    /// The same view of some rows of the picture, for a picture that is drawn in several submissions:
    /// tiles and copies beside them are left out. Give fragments a scissor of these rows. Each end is
    /// the picture's or a multiple of [`View::ROW_STEP`]: compute draws whole tiles.
    #[must_use]
    pub fn with_rows(self, rows: Range<u32>) -> Self {
        let rows = Some([rows.start, rows.end.max(rows.start)]);
        Self { rows, ..self }
    }

    /// The number of tiles in all rows of the picture, from that in the rows that are drawn: an
    /// estimate, so that bands of a frame choose as the whole frame does.
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss
    )]
    pub(crate) fn tiles_of_all_rows(&self, tiles: u64) -> u64 {
        let share = |[first, end]: [u32; 2]| self.viewport.height.abs() / f64::from(end - first);
        self.rows
            .map_or(tiles, |rows| (tiles as f64 * share(rows)) as u64)
    }

    /// The rows of the map from the world to `(x w, y w, w)`, where x and y are a position in the
    /// picture without jitter, pixels.
    pub(crate) fn pixel_rows(&self) -> [DVec4; 3] {
        let rows = self.clip_from_world.transpose();
        let v = &self.viewport;
        let of = |clip: DVec4, from: f64, size: f64, jitter: f64| {
            clip * (0.5 * size) + rows.w_axis * (from + 0.5 * size - jitter)
        };
        [
            of(rows.x_axis, v.x, v.width, self.jitter.x),
            of(rows.y_axis, v.y, v.height, self.jitter.y),
            rows.w_axis,
        ]
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
        let w_row = clip_from_world.transpose().w_axis;
        if w_row.truncate().length() < 1e-12 * w_row.w.abs() {
            return Self::parallel(clip_from_world, viewport, order);
        }
        let eye = view.inverse().w_axis;
        let eye = eye.truncate() / eye.w;
        let rows = clip_from_world.transpose();
        let (z_row, forward) = (rows.z_axis, rows.w_axis.truncate());
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

    /// The matrix from world space to clip space.
    #[must_use]
    pub fn clip_from_world(&self) -> DMat4 {
        self.clip_from_world
    }

    /// The eye in world units.
    #[must_use]
    pub fn eye(&self) -> DVec3 {
        self.eye
    }

    /// The depth-buffer value of a point at `t`.
    #[must_use]
    pub fn depth_at(&self, t: f64) -> f64 {
        let ([constant, factor], [min, max]) = (self.depth, self.depth_range);
        let along = if self.parallel { t } else { 1.0 / t };
        min + (max - min) * (constant + factor * along) + self.depth_bias
    }

    /// The `t` of a depth-buffer value: the inverse of [`View::depth_at`].
    #[must_use]
    pub fn t_at(&self, depth: f64) -> f64 {
        let [min, max] = self.depth_range;
        let by = (depth - self.depth_bias - min) / (max - min) - self.depth[0];
        if self.parallel {
            by / self.depth[1]
        } else {
            self.depth[1] / by
        }
    }

    /// Framebuffer position of a world point, in pixels from the upper left corner, and its depth
    /// along the view.
    pub(crate) fn project(&self, world: DVec3) -> (DVec2, f64) {
        let from_eye = world - self.eye;
        let depth = from_eye.dot(self.forward);
        let beside = if self.parallel {
            from_eye
        } else {
            from_eye / depth - self.dir_00
        };
        let along = |d: DVec3| beside.dot(d) / d.length_squared() + 0.5;
        (DVec2::new(along(self.dir_x), along(self.dir_y)), depth)
    }

    /// Change of clip x and y for a step in the world; for parallel rays at a clip w of 1.
    pub(crate) fn clip_rows(&self) -> [DVec3; 2] {
        let rows = self.clip_from_world.transpose();
        let w = if self.parallel { rows.w_axis.w } else { 1.0 };
        [rows.x_axis, rows.y_axis].map(|row| row.truncate() / w)
    }

    /// Clip x and y of a point relative to the eye.
    pub(crate) fn clip_of(&self, from_eye: DVec3) -> DVec2 {
        let [x, y] = self.clip_rows();
        let at_eye = self.clip_from_world * self.eye.extend(1.0);
        // The eye's own part is zero in perspective.
        let constant = if self.parallel {
            at_eye.truncate().truncate() / at_eye.w
        } else {
            DVec2::ZERO
        };
        constant + DVec2::new(x.dot(from_eye), y.dot(from_eye))
    }

    /// The corners of the viewport: upper left, lower right, pixels.
    pub(crate) fn corners(&self) -> [DVec2; 2] {
        let v = &self.viewport;
        let (top, bottom) = (v.y.min(v.y + v.height), v.y.max(v.y + v.height));
        [DVec2::new(v.x, top), DVec2::new(v.x + v.width, bottom)]
    }

    /// A pixel's size at unit depth.
    pub(crate) fn pixel_size(&self) -> f64 {
        self.dir_x.length()
    }

    /// The directions through the corners of the viewport, in perspective.
    pub(crate) fn corner_rays(&self) -> [DVec3; 4] {
        let [low, high] = self.corners();
        [
            [low.x, low.y],
            [high.x, low.y],
            [low.x, high.y],
            [high.x, high.y],
        ]
        .map(|[x, y]| self.dir_00 + (x - 0.5) * self.dir_x + (y - 0.5) * self.dir_y)
    }

    /// The largest distance from the eye at which a ray begins, in perspective.
    pub(crate) fn farthest_start(&self) -> f64 {
        let lengths = self.corner_rays().map(DVec3::length);
        self.start * lengths.into_iter().fold(0.0, f64::max)
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

fn wrong(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Content, message).at_key("view")
}
