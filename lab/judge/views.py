"""The views of a solid, by class of ray."""

import dataclasses
import math

from rays import Camera

CLASSES = ("ordinary", "edge", "vertex", "grazing", "axis", "start", "scene")


@dataclasses.dataclass
class View:
    """A camera, and the class of its rays.

    - *ordinary*: the whole solid from around, above and below, and close.
    - *edge*: all rays pass an edge within a fortieth or a two-hundredth of the solid's size.
    - *vertex*: the same of a tip on the axis.
    - *grazing*: the eye is in the plane or cone of a face, or a ten-thousandth above it.
    - *axis*: the eye is on the axis and looks along it.
    - *start*: the eye is a thousandth of the solid's size off the surface, or twice the tolerance.
    - *scene*: the view of a scene file.
    """

    kind: str
    name: str
    camera: Camera


def views(solid):
    """All views of a solid, in object space made, in the world given."""
    radius, low, high = solid.bounds()
    size = math.hypot(2 * radius, high - low)
    middle = (0.0, 0.0, 0.5 * (low + high))
    found = []

    def add(kind, name, eye, target, across):
        """A view that is `across` object units high at the target."""
        if not _is_free(solid, eye, size):
            return
        far = math.dist(eye, target)
        fov = math.degrees(2 * math.atan(0.5 * across / far))
        ends = [tuple(float(v) for v in solid.placement.point_out(p)) for p in (eye, target)]
        along = [b - a for a, b in zip(*ends)]
        upright = math.hypot(along[0], along[1]) < 1e-6 * abs(along[2])
        up = (0.0, 1.0, 0.0) if upright else (0.0, 0.0, 1.0)
        found.append(View(kind, name, Camera(*ends, fov, up)))

    for name, turn, rise, far in [("around", 20, 15, 1.6), ("above", 130, 50, 1.6), ("below", 250, -40, 1.6), ("close", 70, 30, 0.9)]:
        across = 1.1 * size if far > 1 else 0.4 * size
        add("ordinary", name, _around(middle, turn, rise, far * size), middle, across)
    _edges(solid, size, add)
    _faces(solid, size, add)
    for name, end in [("down", high + size), ("up", low - size)]:
        for part, across in [("whole", 2.2 * radius), ("near", 0.02 * radius)]:
            add("axis", f"{name}-{part}", (0.0, 0.0, end), middle, across)
    return found


def _edges(solid, size, add):
    """Views of edges, and of tips on the axis."""
    for part, polygon in enumerate(solid.polygons):
        for k, (r, z) in enumerate(polygon):
            out = _free_side(polygon, k)
            turn = math.radians(37.0 + 61.0 * k)
            point = (r * math.cos(turn), r * math.sin(turn), z)
            for far in (1.2, 0.3, 0.05):
                aside = 0.4 * far * size
                eye = _place(r + far * size * out[0], z + far * size * out[1], turn, aside)
                if _is_free(solid, eye, size) and _sees(solid, eye, point):
                    for across in (0.05, 0.01):
                        kind = "vertex" if r == 0.0 else "edge"
                        add(kind, f"{kind}-{part}.{k}-{across}", eye, point, across * size)
                    break


def _faces(solid, size, add):
    """Views along faces, and from just off them."""
    for part, polygon in enumerate(solid.polygons):
        sign = 1.0 if _area(polygon) > 0 else -1.0
        for k, a in enumerate(polygon):
            b = polygon[(k + 1) % len(polygon)]
            length = math.dist(a, b)
            if length < 0.02 * size or a[0] == b[0] == 0.0:
                continue
            u = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
            n = (sign * u[1], -sign * u[0])
            mid = (0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]))
            for lift in (0.0, 1e-4):
                for end, way in ((b, 1.0), (a, -1.0)):
                    at = [end[i] + way * size * u[i] + lift * size * n[i] for i in (0, 1)]
                    if at[0] > 0.0:
                        name = f"face-{part}.{k}-{way:+.0f}-{lift}"
                        add("grazing", name, (at[0], 0.0, at[1]), (mid[0], 0.0, mid[1]), 0.5 * length)
            for off in (1e-3, 4e-4):
                lift = off * max(size, 1.0)
                eye = (mid[0] + lift * n[0], 0.0, mid[1] + lift * n[1])
                to = (eye[0] + u[0] - 0.3 * n[0], 0.7, eye[2] + u[1] - 0.3 * n[1])
                add("start", f"start-{part}.{k}-{off}", eye, to, 1.6)


def _around(middle, turn, rise, far):
    turn, rise = math.radians(turn), math.radians(rise)
    flat = far * math.cos(rise)
    return (flat * math.cos(turn), flat * math.sin(turn), middle[2] + far * math.sin(rise))


def _place(r, z, turn, aside):
    """The point (r, z) of the half-plane at an azimuth, moved sideways."""
    x, y = r * math.cos(turn), r * math.sin(turn)
    return (x - aside * math.sin(turn), y + aside * math.cos(turn), z)


def _free_side(polygon, k):
    """The direction between the outer normals of the two segments of corner `k`."""
    sign = 1.0 if _area(polygon) > 0 else -1.0
    total = [0.0, 0.0]
    for a, b in ((polygon[k - 1], polygon[k]), (polygon[k], polygon[(k + 1) % len(polygon)])):
        length = math.dist(a, b)
        if a[0] == b[0] == 0.0 or length == 0.0:
            continue
        total[0] += sign * (b[1] - a[1]) / length
        total[1] -= sign * (b[0] - a[0]) / length
    size = math.hypot(*total)
    return (total[0] / size, total[1] / size) if size > 1e-9 else (1.0, 0.0)


def _area(polygon):
    pairs = zip(polygon, polygon[1:] + polygon[:1])
    return 0.5 * sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs)


def _is_within(polygon, r, z):
    within = False
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        if (a[1] > z) != (b[1] > z):
            within ^= r < a[0] + (b[0] - a[0]) * (z - a[1]) / (b[1] - a[1])
    return within


def _clearance(polygon, r, z):
    """The distance of a point to the polygon's segments; those on the axis are no surface."""
    least = math.inf
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        if a[0] == b[0] == 0.0:
            continue
        u = (b[0] - a[0], b[1] - a[1])
        square = u[0] ** 2 + u[1] ** 2
        part = ((r - a[0]) * u[0] + (z - a[1]) * u[1]) / square if square else 0.0
        part = min(max(part, 0.0), 1.0)
        least = min(least, math.hypot(r - a[0] - part * u[0], z - a[1] - part * u[1]))
    return least


def _is_free(solid, eye, size):
    """Whether an eye is outside, and farther off than the tolerance of any judge."""
    r, z = math.hypot(eye[0], eye[1]), eye[2]
    return all(
        not _is_within(polygon, r, z) and _clearance(polygon, r, z) > 3e-4 * max(size, 1.0)
        for polygon in solid.polygons
    )


def _sees(solid, eye, point):
    """Whether the way to a point of the surface is free, up to its last hundredth."""
    for k in range(100):
        x, y, z = (a + (b - a) * k / 100 for a, b in zip(eye, point))
        if any(_is_within(polygon, math.hypot(x, y), z) for polygon in solid.polygons):
            return False
    return True
