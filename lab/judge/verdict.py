"""Which voices are wrong in which pixels of one picture.

Three judges answer each ray: two outside kernels, and the reference of revmap in double precision.
A frame of revmap is compared with them. Two answers **agree** where both miss, or where both hit,
the drawn point is within the tolerance of the judge's tangent plane, and the normals are within
`NORMAL`. Where a kernel disagrees, it gets rays moved aside by the tolerance and by 1/4, 1/16 and 1/64 of it,
in eight directions each. A miss agrees if one of these misses. A hit agrees if its distance is
that of one of them, or is between the distances of those whose normals agree. So every side is right
at a silhouette, along an edge and at a tip.

A voice is **wrong** where two judges agree with each other, and the voice agrees with neither. It is
**undecided** where it is not wrong, but fewer than two judges agree with it. A **wrong normal** is a
pixel that is wrong only because of its normal.

The tolerance is, in object units: a base of `BASE` (the tenth of a texel of 512 rows that exact
searches promise) times the larger of 1 and the solid's size, and 8 roundings of 2^-24 of the size of
the solid and of the picture at its distance, because rays of the device are 32-bit numbers. A
distance may differ by 4 roundings more, as it is stored in 32 bits. Along a face, distances differ
by more than points do: by 1 / cos of the angle between ray and normal, at most `STEEPEST` times.
"""

import dataclasses

import numpy as np

BASE = 0.1 / 512
NORMAL = np.radians(0.25)
STEEPEST = 50.0
ROUNDING = 2.0**-24
JUDGES = ("Geant4", "Open CASCADE", "reference")
KINDS = ("missed", "ghost", "depth")


@dataclasses.dataclass
class Answers:
    """A voice's answers to rays: distances (infinite: a miss), and normals of length 1."""

    distance: np.ndarray
    normal: np.ndarray

    def of(self, pixels):
        """The answers of these pixels."""
        return Answers(self.distance[pixels], self.normal[pixels])


class Picture:
    """The rays of one picture in object space, and the answers of the judges.

    `origin`: the eye, object units. `rays`: a direction of length 1 in each row. `kernels`: the two
    outside ones by name. `reference`: the reference's answers. `tolerance`: object units.
    """

    def __init__(self, origin, rays, kernels, reference, tolerance):
        self.origin, self.rays, self.tolerance = np.array(origin, float), rays, tolerance
        self._kernels = kernels
        self._aside = {name: {} for name in kernels}
        starts = np.broadcast_to(self.origin, rays.shape)
        shot = {name: self._shoot(name, starts, rays) for name in kernels}
        self.judges = {**shot, JUDGES[2]: reference}
        one, two, third = JUDGES
        self._pairs = {(a, third): self._agree(self.judges[third], a)[1] for a in (one, two)}
        forth, back = self._agree(self.judges[one], two), self._agree(self.judges[two], one)
        self._pairs[one, two] = forth[1] | back[1]

    def hits(self):
        """Where any judge hits."""
        return np.any([np.isfinite(j.distance) for j in self.judges.values()], axis=0)

    def judge(self, voice, name=None):
        """Masks of the pixels of a voice that are wrong, wrong in the normal alone, and undecided;
        `name`: of a judge itself."""
        agrees = {judge: self._agree(voice, judge) for judge in JUDGES if judge != name}
        wrong = np.zeros((2, len(voice.distance)), bool)
        for (a, b), together in self._pairs.items():
            if name not in (a, b):
                wrong |= together & ~agrees[a] & ~agrees[b]
        count = np.sum([agree[1] for agree in agrees.values()], axis=0)
        return wrong[0], wrong[1] & ~wrong[0], ~wrong[1] & (count < 2)

    def kinds(self, voice, wrong):
        """The numbers of wrong pixels by kind, measured from the judges' common answer."""
        hit, drawn = np.isfinite(self.truth().distance), np.isfinite(voice.distance)
        parts = (wrong & hit & ~drawn, wrong & ~hit & drawn, wrong & hit & drawn)
        return dict(zip(KINDS, (int(part.sum()) for part in parts)))

    def truth(self):
        """The reference's answer, or Geant4's where that and Open CASCADE agree against it."""
        first, reference = self.judges[JUDGES[0]], self.judges[JUDGES[2]]
        wrong, *_ = self.judge(reference, JUDGES[2])
        distance = np.where(wrong, first.distance, reference.distance)
        return Answers(distance, np.where(wrong[:, None], first.normal, reference.normal))

    def _agree(self, voice, judge):
        """Where a voice agrees with a judge: without regard to normals, and with them."""
        first = self.judges[judge]
        hit = np.isfinite(voice.distance) & np.isfinite(first.distance)
        near = self._near(voice, first, self.rays)
        agrees = np.array([near, near & (~hit | self._parallel(voice, first))])
        pixels = np.flatnonzero(~agrees[1])
        if judge not in self._kernels or len(pixels) == 0:
            return agrees
        one, rays = voice.of(pixels), self.rays[pixels]
        aside = [self._rays_aside(judge, pixel) for pixel in pixels.tolist()]
        low, high = np.full(len(pixels), np.inf), np.full(len(pixels), -np.inf)
        for k in range(-1, len(aside[0].distance)):
            moved = first.of(pixels) if k < 0 else _each(aside, k)
            missed = ~np.isfinite(one.distance) & ~np.isfinite(moved.distance)
            agrees[:, pixels] |= missed
            agrees[0, pixels] |= self._near(one, moved, rays)
            fits = np.isfinite(moved.distance) & self._parallel(one, moved)
            bound = self._bound(moved, rays)
            low[fits] = np.minimum(low, moved.distance - bound)[fits]
            high[fits] = np.maximum(high, moved.distance + bound)[fits]
        agrees[:, pixels] |= (low <= one.distance) & (one.distance <= high)
        return agrees

    def _parallel(self, voice, judge):
        """Where normals are within `NORMAL`."""
        apart = np.linalg.norm(voice.normal - judge.normal, axis=-1)
        return apart <= 2 * np.sin(NORMAL / 2)

    def _near(self, voice, judge, rays):
        """Where both miss, or both hit and the distances are within the bound."""
        with np.errstate(invalid="ignore"):
            near = np.abs(voice.distance - judge.distance) <= self._bound(judge, rays)
        hits = np.isfinite(voice.distance), np.isfinite(judge.distance)
        return np.where(hits[0] & hits[1], near, hits[0] == hits[1])

    def _bound(self, judge, rays):
        """By how much distances may differ from a judge's."""
        steep = np.abs(np.sum(judge.normal * rays, axis=-1))
        far = np.where(np.isfinite(judge.distance), judge.distance, 0.0)
        return self.tolerance / np.clip(steep, 1 / STEEPEST, 1.0) + 4 * ROUNDING * far

    def _rays_aside(self, judge, pixel):
        """The answers of a kernel to the rays about a pixel's ray. They are kept."""
        known = self._aside[judge]
        if pixel not in known:
            ray = self.rays[pixel]
            side = np.cross(ray, np.eye(3)[np.argmin(np.abs(ray))])
            side /= np.linalg.norm(side)
            turns = np.arange(8) * np.pi / 4
            ring = np.outer(np.cos(turns), side) + np.outer(np.sin(turns), np.cross(side, ray))
            starts = self.origin + self.tolerance * np.concatenate([ring / 4**k for k in range(4)])
            known[pixel] = self._shoot(judge, starts, np.broadcast_to(ray, starts.shape))
        return known[pixel]

    def _shoot(self, name, starts, rays):
        """The answers of a kernel to rays."""
        shoot = self._kernels[name].shoot
        answers = [shoot(start, ray) for start, ray in zip(starts.tolist(), rays.tolist())]
        distance = np.array([distance for distance, _ in answers])
        return Answers(distance, np.array([normal for _, normal in answers]))


def _each(answers, k):
    """Answer `k` of each of several answers."""
    distance = np.array([one.distance[k] for one in answers])
    return Answers(distance, np.array([one.normal[k] for one in answers]))


def tolerance(base, size, far, half_picture):
    """The tolerance of a picture. `size`: of the solid; `far`: the distance of its middle from the
    eye; object units. `half_picture`: half the picture's diagonal at depth 1.
    """
    return base * max(size, 1.0) + 8 * ROUNDING * (size + half_picture * far)
