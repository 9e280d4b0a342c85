//! A view of the scene: the ray of each pixel and the depth of its hit, from a camera or from a
//! host's matrices.

mod construct;

use crate::error::{Error, ErrorKind, Result};
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

fn wrong(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Content, message).at_key("view")
}
