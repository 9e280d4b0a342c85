"""Faults planted in right answers: the judges must report each, and nothing else."""

import math
import pathlib
import struct
import tempfile
import unittest
import zlib

import numpy as np

import court
import frames
import judge
import kernels
import rates
import solids
import verdict
import views

SIZE = (41, 31)


def jar():
    """The lid's whole view with judges, the reference's place taken by Geant4's own answers."""
    solid = next(solid for solid in solids.catalogue() if solid.name == "lid")
    view = views.views(solid)[0]
    kernel = kernels.Geant4(solid.polygons[0])
    rays = view.camera.rays(*SIZE).reshape(-1, 3).tolist()
    shot = [kernel.shoot(view.camera.eye, ray) for ray in rays]
    frame = [np.array([answer[k] for answer in shot]) for k in (0, 1)]
    held, answers = court.picture(solid, view, SIZE, lambda stage, solver: frame)
    return held, answers("fragment", "exact")


class Faults(unittest.TestCase):
    """Each fault in five pixels of a picture."""

    @classmethod
    def setUpClass(cls):
        cls.held, cls.right = jar()
        hits = np.isfinite(cls.right.distance)
        near = np.isfinite(np.roll(cls.right.distance, 3)) & np.isfinite(np.roll(cls.right.distance, -3))
        cls.inner = np.flatnonzero(hits & near)[::29][:5]
        cls.empty = np.arange(5)

    def spoiled(self, pixels, change):
        """The counts of a picture with a change in these pixels."""
        frame = verdict.Answers(self.right.distance.copy(), self.right.normal.copy())
        change(frame, pixels)
        return court.row({}, self.held, "planted", frame, None)

    def test_a_right_picture_has_none(self):
        found = self.spoiled(self.inner, lambda frame, pixels: None)
        self.assertEqual((found["wrong"], found["normal"], found["undecided"]), (0, 0, 0))
        self.assertGreater(found["hits"], 200)

    def test_missed_pixels_are_wrong(self):
        def change(frame, pixels):
            frame.distance[pixels] = math.inf

        found = self.spoiled(self.inner, change)
        self.assertEqual((found["wrong"], found["missed"]), (5, 5))

    def test_ghosts_are_wrong(self):
        def change(frame, pixels):
            frame.distance[pixels] = 1.0

        found = self.spoiled(self.empty, change)
        self.assertEqual((found["wrong"], found["ghost"]), (5, 5))

    def test_depths_off_by_five_tolerances_are_wrong(self):
        for way in (1, -1):
            def change(frame, pixels):
                frame.distance[pixels] += way * 50 * 5 * self.held.tolerance

            found = self.spoiled(self.inner, change)
            self.assertEqual((found["wrong"], found["depth"]), (5, 5))

    def test_normals_off_by_a_degree_are_wrong(self):
        def change(frame, pixels):
            turn = math.radians(1.0)
            side = np.cross(frame.normal[pixels], (0.6, 0.0, 0.8))
            side /= np.linalg.norm(side, axis=1, keepdims=True)
            frame.normal[pixels] = math.cos(turn) * frame.normal[pixels] + math.sin(turn) * side

        found = self.spoiled(self.inner, change)
        self.assertEqual((found["wrong"], found["normal"]), (0, 5))

    def test_roundings_are_right(self):
        def change(frame, pixels):
            frame.distance *= 1.0 + 2.0**-23

        found = self.spoiled(self.inner, change)
        self.assertEqual((found["wrong"], found["normal"]), (0, 0))

    def test_a_judge_that_is_alone_is_wrong(self):
        answers = self.held.judges["Open CASCADE"]
        kept = answers.distance.copy()
        answers.distance[self.inner] += 0.3
        try:
            held = verdict.Picture.__new__(verdict.Picture)
            held.__dict__.update(self.held.__dict__)
            wrong, *_ = held.judge(answers, "Open CASCADE")
        finally:
            answers.distance[:] = kept
        self.assertEqual(int(wrong.sum()), 5)

    def test_wrong_pixels_fail_unless_they_are_known(self):
        row = {"voice": "exact, fragment", "solid": "lid", "view": "close", "note": ""}
        row |= {"wrong": 3, "normal": 0}
        known = {"solid": "lid", "view": "cl*", "wrong": 3}
        self.assertEqual(judge.failures([row], []), [row])
        self.assertEqual(judge.failures([row], [known]), [])
        self.assertEqual(judge.failures([row], [{**known, "wrong": 2}]), [row])
        refused = {**row, "wrong": 0, "note": "refused"}
        self.assertEqual(judge.failures([refused], [known]), [refused])
        self.assertEqual(judge.failures([{**row, "voice": "live, fragment"}], []), [])


class Rates(unittest.TestCase):
    """Upper limits, against the shares at which the binomial sums are 5 %."""

    def test_limits(self):
        self.assertAlmostEqual(rates.upper(0, 1000), 1 - 0.05**0.001, 9)
        share = rates.upper(2, 50)
        chance = sum(math.comb(50, k) * share**k * (1 - share) ** (50 - k) for k in range(3))
        self.assertAlmostEqual(chance, 0.05, 9)
        self.assertEqual(rates.upper(7, 7), 1.0)


class Exr(unittest.TestCase):
    """The reader refuses what is no frame, and says so in a line."""

    def test_a_broken_file_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "a.exr")
            for data in (b"", b"v/1\x01", b"v/1\x01" + struct.pack("<i", 2) + zlib.compress(b"x")):
                file.write_bytes(data)
                with self.assertRaisesRegex(frames.BadFrame, "a.exr: cannot be read"):
                    frames.read(file)


if __name__ == "__main__":
    unittest.main()
