"""Files of `revmap mesh`, as trimesh reads them: watertight, and their volume that of Pappus' theorem."""

import math
import os
import pathlib
import subprocess
import tempfile
import tomllib
import unittest

import numpy as np
import trimesh

SCENES = pathlib.Path(__file__).parents[2] / "assets" / "scenes"
NAMES = "bell bishop bottle goblet king pawn ridges ring rook sphere spindle vase".split()
TOLERANCE = 5e-4


def pappus(polygon):
    """Volume of a polygon of the half-plane turned about its axis, and the area of its surface."""
    points = np.array(polygon, dtype=float)
    after = np.roll(points, -1, axis=0)
    cross = points[:, 0] * after[:, 1] - after[:, 0] * points[:, 1]
    volume = math.pi / 3 * np.sum(cross * (points[:, 0] + after[:, 0]))
    lengths = np.hypot(*(after - points).T)
    return abs(volume), math.pi * np.sum(lengths * (points[:, 0] + after[:, 0]))


class Files(unittest.TestCase):
    """Each of twelve solids in each format."""

    def load(self, scene, ending, *options):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, f"solid.{ending}")
            line = [os.environ["REVMAP"], "mesh", scene, "-o", file, "--quiet", *options]
            subprocess.run(line, check=True)
            mesh = trimesh.load(file, force="mesh")
        mesh.merge_vertices(merge_tex=True, merge_norm=True)
        return mesh

    def test_twelve_solids(self):
        for name in NAMES:
            scene = SCENES / f"{name}.toml"
            volumes = []
            for ending in ("glb", "obj", "stl"):
                with self.subTest(solid=name, ending=ending):
                    mesh = self.load(scene, ending)
                    self.assertTrue(mesh.is_watertight)
                    self.assertTrue(mesh.is_winding_consistent)
                    self.assertGreater(mesh.volume, 0)
                    volumes.append(mesh.volume)
            self.assertLess(np.ptp(volumes), 1e-5)
            polygon = tomllib.loads(scene.read_text())["object"][0].get("polygon")
            if polygon:
                volume, area = pappus(polygon)
                self.assertLess(abs(volumes[0] - volume), area * TOLERANCE, name)

    def test_an_offset_is_seen(self):
        scene = SCENES / "sphere.toml"
        plain, wider = (self.load(scene, "stl", "--set", f"object.0.extend={e}") for e in (0, 0.05))
        self.assertGreater(wider.volume, 1.3 * plain.volume)


if __name__ == "__main__":
    unittest.main()
