"""A solid of revolution as triangles, as a mesh renderer has it.

Every corner of the outline is a ring of vertices on the surface. A segment between two rings is two
triangles for each sector, one where an end is on the axis. Between vertices the mesh is inside
convex parts of the solid by at most r (1 - cos(pi / sectors)).

Normals are smooth around the axis and split at the corners of the outline: each segment has vertex
normals of its own, and they are interpolated over the triangle. A vertex on the axis has the normal
of the middle of its sector. The first ring vertex is at an azimuth of `START`, so that no view of a
set looks along a row of vertices.
"""

import math

import numpy as np

START = 1.0


class Mesh:
    """`positions`: float32, four to a vertex (the last is padding). `triangles`: three vertices each."""

    def __init__(self, polygons, sectors):
        self.sectors = sectors
        self._normals, self._on_axis, first, positions, triangles = [], [], [0], [], []
        for polygon in polygons:
            rings = []
            for r, z in polygon:
                rings.append(sum(map(len, positions)) + np.arange(sectors if r else 1))
                positions.append(self._ring(r, z))
            for k, a in enumerate(polygon):
                b, next_one = polygon[(k + 1) % len(polygon)], rings[(k + 1) % len(polygon)]
                if a[0] == b[0] == 0.0:
                    continue
                block = self._band(rings[k], next_one)
                triangles.append(block)
                first.append(first[-1] + len(block))
                self._normals.append(_outwards(polygon, a, b))
                self._on_axis.append((a[0] == 0.0, b[0] == 0.0))
        self._first = np.array(first)
        self.positions = np.concatenate(positions).astype("<f4")
        self.triangles = np.concatenate(triangles).astype("<i4")

    def bytes(self):
        """Of positions, vertex normals (12 bytes each) and indices."""
        ends = 2 * len(self._on_axis)
        return self.positions.nbytes + self.triangles.nbytes + 12 * self.sectors * ends

    def normals(self, triangles, u, v):
        """The interpolated normals, of length 1, at barycentric places of triangles."""
        block = np.searchsorted(self._first, triangles, side="right") - 1
        within = triangles - self._first[block]
        sector, second = within % self.sectors, within >= self.sectors
        tip_a, tip_b = np.array(self._on_axis)[block].T
        turns = np.zeros((3, len(triangles)))
        turns[0] = np.where(tip_a, 0.5, 0.0)
        turns[1] = np.where(tip_b, 0.5, np.where(second, 1.0, 0.0))
        turns[2] = 1.0
        azimuth = START + (sector + turns) * 2 * math.pi / self.sectors
        weight = np.array([1.0 - u - v, u, v])
        flat, up = np.array(self._normals)[block].T
        x, y = flat * (weight * np.cos(azimuth)).sum(0), flat * (weight * np.sin(azimuth)).sum(0)
        found = np.stack([x, y, up], axis=-1)
        return found / np.linalg.norm(found, axis=-1, keepdims=True)

    def _ring(self, r, z):
        azimuth = START + np.arange(self.sectors if r else 1) * 2 * math.pi / self.sectors
        columns = [r * np.cos(azimuth), r * np.sin(azimuth), np.full(len(azimuth), z), 0 * azimuth]
        return np.stack(columns, axis=-1)

    def _band(self, a, b):
        """The triangles between two rings; a ring of one vertex is a tip."""
        here, there = np.arange(self.sectors), np.roll(np.arange(self.sectors), -1)
        if len(a) == 1:
            return np.stack([np.repeat(a, self.sectors), b[here], b[there]], axis=-1)
        if len(b) == 1:
            return np.stack([a[here], np.repeat(b, self.sectors), a[there]], axis=-1)
        one = np.stack([a[here], b[here], b[there]], axis=-1)
        two = np.stack([a[here], b[there], a[there]], axis=-1)
        return np.concatenate([one, two])


def _outwards(polygon, a, b):
    """The outer normal (r, z) of the segment from `a` to `b`."""
    pairs = zip(polygon, polygon[1:] + polygon[:1])
    sign = 1.0 if sum(p[0] * q[1] - q[0] * p[1] for p, q in pairs) > 0 else -1.0
    length = math.dist(a, b)
    return (sign * (b[1] - a[1]) / length, -sign * (b[0] - a[0]) / length)
