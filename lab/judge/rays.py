"""Rays of pixels, and answers of a ray in the units of one object."""

import dataclasses

import numpy as np


@dataclasses.dataclass
class Camera:
    """The keys of a scene's camera. Lengths in world units, `fov_y` in degrees."""

    eye: tuple
    target: tuple
    fov_y: float = 40.0
    up: tuple = (0.0, 0.0, 1.0)

    def rays(self, width, height):
        """Directions of length 1, height x width x 3.

        Pixel (i, j) is looked through at its centre, row 0 on top. With forward f, right s and up
        u = s x f, the direction is f + p (i + 0.5 - width / 2) s + p (height / 2 - j - 0.5) u, where
        p = 2 tan(fov_y / 2) / height is the side of a pixel at depth 1.
        """
        eye, target, up = (np.array(v, float) for v in (self.eye, self.target, self.up))
        forward = (target - eye) / np.linalg.norm(target - eye)
        right = np.cross(forward, up / np.linalg.norm(up))
        right /= np.linalg.norm(right)
        pixel = self.pixel(height)
        x = pixel * (np.arange(width) + 0.5 - width / 2)
        y = pixel * (height / 2 - np.arange(height) - 0.5)
        over = np.cross(right, forward)
        directions = forward + x[None, :, None] * right + y[:, None, None] * over
        return directions / np.linalg.norm(directions, axis=-1, keepdims=True)

    def pixel(self, height):
        """The side of a pixel at depth 1."""
        return 2 * np.tan(np.radians(self.fov_y) / 2) / height

    def toml(self):
        """The camera as lines of a scene file."""
        keys = dataclasses.asdict(self).items()
        return "".join(f"camera.{key} = {_toml(value)}\n" for key, value in keys)


@dataclasses.dataclass
class Placement:
    """From object space to the world: scale, then rotation (quaternion x y z w), then position."""

    scale: tuple = (1.0, 1.0, 1.0)
    rotation: tuple = (0.0, 0.0, 0.0, 1.0)
    position: tuple = (0.0, 0.0, 0.0)

    def turn(self):
        """The rotation as a 3 x 3 matrix."""
        x, y, z, w = np.array(self.rotation, float) / np.linalg.norm(self.rotation)
        rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)]]
        rows.append([2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)])
        rows.append([2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)])
        return np.array(rows)

    def point_in(self, point):
        """A point of the world in object space."""
        return (np.asarray(point, float) - self.position) @ self.turn() / self.scale

    def vector_in(self, vectors):
        """Directions of the world in object space, not of length 1."""
        return vectors @ self.turn() / self.scale

    def point_out(self, point):
        """A point of object space in the world."""
        return self.turn() @ (np.asarray(point, float) * self.scale) + self.position

    def normal_in(self, normals):
        """Normals of the world in object space, of length 1; those of length 0 stay."""
        turned = normals @ self.turn() * np.array(self.scale)
        size = np.linalg.norm(turned, axis=-1, keepdims=True)
        return turned / np.where(size > 0.0, size, 1.0)

    def toml(self):
        """The placement as lines of an object in a scene file; nothing for the one of no effect."""
        if self == Placement():
            return ""
        keys = dataclasses.asdict(self).items()
        return "".join(f"{key} = {_toml(value)}\n" for key, value in keys)


def _toml(value):
    return repr([float(v) for v in value]) if isinstance(value, tuple) else repr(float(value))
