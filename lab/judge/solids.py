"""The solids that are judged: polygons in the half-plane (r, z), typed in anew.

`family` names the kind of test that has such shapes: *detector* is the tests of polycones in
detector geometry (Geant4, ROOT, VecGeom), *revmap* the failures of earlier versions, *offsets* and
*engine* shapes that outlines and CAD kernels find hard.
"""

import dataclasses
import math
import random

from rays import Placement


@dataclasses.dataclass
class Solid:
    """One or more solids of revolution in one place."""

    name: str
    family: str
    polygons: list
    placement: Placement = dataclasses.field(default_factory=Placement)

    def kernel_polygons(self):
        """The polygons for the kernels, which refuse sections without thickness."""
        return [without_spikes(polygon) for polygon in self.polygons]

    def toml(self):
        """The objects of a scene file."""
        objects = [f"polygon = {polygon!r}\n{self.placement.toml()}" for polygon in self.polygons]
        return "".join(f"[[object]]\n{lines}" for lines in objects)

    def bounds(self):
        """The largest r, the least and the largest z."""
        points = [point for polygon in self.polygons for point in polygon]
        heights = [z for _, z in points]
        return max(r for r, _ in points), min(heights), max(heights)


def without_spikes(polygon):
    """A polygon without repeated points, and without the points of which both neighbours are one:
    there it goes out and back along one segment, around nothing."""
    points = list(polygon)
    k = 0
    while k < len(points):
        before, after = points[k - 1], points[(k + 1) % len(points)]
        if points[k] == before or before == after:
            del points[k]
            k = max(k - 2, 0)
        else:
            k += 1
    return points


def sections(rows):
    """The polygon of a polycone: rows of z, inner and outer radius, upwards."""
    outer = [[r, z] for z, _, r in rows]
    inner = [[r, z] for z, r, _ in reversed(rows)]
    points = outer + inner
    return [p for k, p in enumerate(points) if p != points[k - 1]]


def cylinder(radius, low, high):
    """A cylinder's polygon."""
    return [[0.0, low], [radius, low], [radius, high], [0.0, high]]


def ball(count):
    """A ball of `count` segments."""
    turns = [math.pi * (k / count - 0.5) for k in range(count + 1)]
    points = [[0.4 * math.cos(t), 0.5 + 0.4 * math.sin(t)] for t in turns]
    points[0][0] = points[-1][0] = 0.0
    return points


def comb(teeth):
    """A spindle with rectangular grooves."""
    points = [[0.0, 0.1]]
    for k in range(teeth):
        low, step = 0.1 + 0.8 * k / teeth, 0.4 / teeth
        points += [[0.4, low], [0.4, low + step], [0.25, low + step], [0.25, low + 2 * step]]
    return points + [[0.0, 0.9]]


STEPS = [(0.1, 0.1, 0.3), (0.3, 0.1, 0.3), (0.3, 0.2, 0.45), (0.5, 0.2, 0.45), (0.5, 0.05, 0.25)]
STEPS += [(0.7, 0.15, 0.35), (0.9, 0.15, 0.2)]
WALLS = [(0.1, 0.0, 0.4), (0.102, 0.398, 0.4), (0.9, 0.298, 0.3)]
GLASS = [[0.0, 0.04], [0.26, 0.04], [0.26, 0.06], [0.04, 0.1], [0.035, 0.4], [0.18, 0.5]]
GLASS += [[0.3, 0.7], [0.28, 0.95], [0.265, 0.95], [0.285, 0.7], [0.17, 0.52], [0.0, 0.44]]
HOURGLASS = [[0.0, 0.1], [0.35, 0.1], [0.0, 0.5], [0.35, 0.9], [0.0, 0.9]]
FIN = [[0.0, 0.1], [0.2, 0.1], [0.2, 0.5], [0.4, 0.5], [0.2, 0.5], [0.2, 0.9], [0.0, 0.9]]
TOUCHING = [cylinder(0.3, 0.1, 0.5), cylinder(0.45, 0.5, 0.9)]
COINCIDING = [cylinder(0.3, 0.1, 0.7), cylinder(0.3, 0.3, 0.9)]
TURNED = (0.3, -0.2, 0.5, 0.79)


def times(factor, polygon):
    """A polygon of other units."""
    return [[factor * r, factor * z] for r, z in polygon]


def catalogue():
    """Every solid that has a name."""
    lid = [[0.0, 0.1], [0.4, 0.1], [0.4, 0.6], [0.0, 0.62]]
    ring = [[0.03123, 0.81413], [0.03481, 0.75536], [0.20421, 0.8031]]
    steps = sections(STEPS)

    def scaled(factor):
        return Placement(scale=(factor, factor, factor), rotation=TURNED)

    return [
        Solid("lid", "revmap", [lid]),
        Solid("thin-ring", "revmap", [ring]),
        Solid("cone", "detector", [[[0.0, 0.1], [0.4, 0.1], [0.0, 0.9]]]),
        Solid("double-cone", "detector", [[[0.0, 0.1], [0.4, 0.5], [0.0, 0.9]]]),
        Solid("cylinder", "detector", [cylinder(0.4, 0.1, 0.9)]),
        Solid("tube", "detector", [sections([(0.1, 0.2, 0.4), (0.9, 0.2, 0.4)])]),
        Solid("identical-planes", "detector", [steps]),
        Solid("inner-cones", "detector", [sections([(0.1, 0.05, 0.4), (0.5, 0.3, 0.35), (0.9, 0.0, 0.3)])]),
        Solid("level-cone-1e-2", "detector", [[[0.0, 0.5], [0.45, 0.4955], [0.45, 0.6], [0.0, 0.6045]]]),
        Solid("level-cone-1e-4", "detector", [[[0.0, 0.5], [0.45, 0.499955], [0.45, 0.6], [0.0, 0.600045]]]),
        Solid("touching-cylinders", "detector", TOUCHING),
        Solid("coinciding-cylinders", "detector", COINCIDING),
        Solid("hourglass", "detector", [HOURGLASS]),
        Solid("no-thickness", "detector", [FIN]),
        Solid("thin-disc", "detector", [cylinder(0.45, 0.5, 0.501)]),
        Solid("thin-wall", "detector", [sections(WALLS)]),
        Solid("flat", "engine", [[[0.0, 0.5], [0.5, 0.5], [0.4, 0.501], [0.0, 0.501]]]),
        Solid("wide", "engine", [[[0.0, 0.1], [500.0, 0.1], [400.0, 0.9], [0.0, 0.9]]]),
        Solid("needle", "engine", [[[0.0, 0.05], [0.001, 0.1], [0.001, 0.9], [0.0, 0.95]]]),
        Solid("thousandth", "engine", [times(1e-3, steps)]),
        Solid("ten-thousandth", "engine", [times(1e-4, steps)]),
        Solid("glass", "engine", [GLASS]),
        Solid("ball", "offsets", [ball(48)]),
        Solid("comb", "offsets", [comb(12)]),
        Solid("steps-1e-3", "detector", [steps], scaled(1e-3)),
        Solid("steps-1e3", "detector", [steps], scaled(1e3)),
        Solid("stretched", "revmap", [steps], Placement((1.0, 3e4, 3e4), TURNED)),
    ]


def made_at_random(seed, count):
    """Polygons about a point: half of them polycones of up to 6 sections with inner radii, half
    stars with up to 12 corners. The seed decides."""
    dice = random.Random(seed)
    solids = []
    for number in range(count):
        make = _polycone if number % 2 == 0 else _star
        polygon = [[round(r, 5), round(z, 5)] for r, z in make(dice)]
        solids.append(Solid(f"random-{seed}-{number}", "random", [polygon]))
    return solids


def _polycone(dice):
    heights = sorted(0.05 + 0.9 * dice.random() for _ in range(dice.randint(2, 6)))
    heights = [z for k, z in enumerate(heights) if k == 0 or z - heights[k - 1] > 0.01] + [0.96]
    rows = []
    solid = dice.random() < 0.5
    for z in heights:
        for _ in range(2 if dice.random() < 0.3 and 0.05 < z < 0.96 else 1):
            outer = dice.uniform(0.2, 0.48)
            rows.append((z, 0.0 if solid else dice.uniform(0.01, 0.19), outer))
    first, last = rows[0][0], rows[-1][0]
    inside = [row for row in rows if first < row[0] < last]
    return sections([rows[0], *inside, rows[-1]])


def _star(dice):
    count = dice.randint(3, 12)
    middle = dice.uniform(0.0, 0.3)
    low, high = (-math.pi / 2, math.pi / 2) if middle < 0.1 else (0.0, math.tau)
    turns = sorted(dice.uniform(low, high) for _ in range(count))
    turns = [t for k, t in enumerate(turns) if k == 0 or t - turns[k - 1] > 0.05]
    if middle < 0.1:
        turns = [low, *turns[1:-1], high] if len(turns) > 2 else [low, 0.3, high]
        middle = 0.0
    elif len(turns) < 3 or max(_gaps(turns)) > 3.0:
        turns = [0.2, 2.2, 4.2]
    reach = 0.45 if middle == 0.0 else min(middle, 0.48 - middle) * 0.95
    far = [reach * dice.uniform(0.3, 1.0) for _ in turns]
    points = [[middle + f * math.cos(t), 0.5 + f * math.sin(t)] for f, t in zip(far, turns)]
    return [[0.0 if abs(r) < 1e-9 else r, z] for r, z in points]


def _gaps(turns):
    return [(b - a) % math.tau for a, b in zip(turns, turns[1:] + turns[:1])]
