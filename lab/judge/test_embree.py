"""Embree's answers: right on a fine mesh, found wrong on a coarse, shifted or levelled one."""

import argparse
import math
import unittest

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

import court
import embree
import judge
import solids
import verdict
from test_faults import SIZE, jar


class Meshes(unittest.TestCase):
    """The lid's whole view by Embree, held to the judges."""

    @classmethod
    def setUpClass(cls):
        cls.held, _ = jar()
        cls.polygons = next(solid for solid in solids.catalogue() if solid.name == "lid").kernel_polygons()

    def counts(self, sectors, polygons=None, flags=embree.ROBUST):
        scene = embree.Scene(polygons or self.polygons, sectors, flags)
        answers = verdict.Answers(*scene.shoot(self.held.origin, self.held.rays))
        return court.row({}, self.held, "Embree", answers, None)

    def test_a_fine_mesh_is_right(self):
        for flags in (0, embree.ROBUST, embree.HIGH_QUALITY):
            found = self.counts(1024, flags=flags)
            self.assertEqual((found["wrong"], found["normal"], found["undecided"]), (0, 0, 0))

    def test_few_sectors_are_wrong(self):
        found = self.counts(16)
        self.assertGreater(found["wrong"], found["hits"] // 4)
        self.assertGreater(found["depth"], 0)

    def test_a_solid_shifted_by_ten_tolerances_is_wrong(self):
        up = [[[r, z + 10 * self.held.tolerance] for r, z in polygon] for polygon in self.polygons]
        self.assertGreater(self.counts(1024, up)["wrong"], 20)

    def test_a_lid_without_its_slope_has_wrong_normals(self):
        level = [[[r, 0.6] if z == 0.62 else [r, z] for r, z in polygon] for polygon in self.polygons]
        found = self.counts(1024, level)
        self.assertGreater(found["wrong"] + found["normal"], 20)

    def test_embreex_gives_the_same(self):
        """Its own interface, which traces single rays."""
        scene = embree.Scene(self.polygons, 64, embree.ROBUST)
        distance, _ = scene.shoot(self.held.origin, self.held.rays)
        other = EmbreeScene(robust=True)
        made = TriangleMesh(other, scene.mesh.positions[:, :3].copy(), scene.mesh.triangles)
        rays = self.held.rays.astype("<f4")
        starts = np.tile(self.held.origin.astype("<f4"), (len(rays), 1))
        far = other.run(starts, rays, query="DISTANCE")
        del made
        np.testing.assert_array_equal(np.where(far > 1e36, np.inf, far), distance)

    def test_packets_keep_the_order_of_rays(self):
        """A number of rays that fills no last packet."""
        count = SIZE[0] * SIZE[1] - 3
        scene = embree.Scene(self.polygons, 64)
        whole, normals = scene.shoot(self.held.origin, self.held.rays)
        part, some = scene.shoot(self.held.origin, self.held.rays[:count])
        np.testing.assert_array_equal(part, whole[:count])
        np.testing.assert_array_equal(some, normals[:count])


class Normals(unittest.TestCase):
    """The interpolated normals of a cone are those of the cone, within half a sector."""

    def test_a_cone(self):
        polygon = [[0.0, 0.1], [0.4, 0.1], [0.0, 0.9]]
        scene = embree.Scene([polygon], 256)
        eye = np.array([2.0, 1.0, 0.7])
        way = np.array([0.01, 0.02, 0.4]) - eye
        far, normal = scene.shoot(eye, way[None] / np.linalg.norm(way))
        x, y, z = eye + far[0] * way / np.linalg.norm(way)
        right = np.array([0.8 * x, 0.8 * y, 0.4 * math.hypot(x, y)])
        right /= np.linalg.norm(right)
        self.assertLess(np.linalg.norm(normal[0] - right), math.pi / 256)
        self.assertAlmostEqual(math.hypot(x, y), 0.4 * (0.9 - z) / 0.8, 4)

    def test_the_command_line_names_meshes(self):
        self.assertEqual(judge.meshes_of("plain:256,robust:1024"), [("plain", 256), ("robust", 1024)])
        self.assertEqual(judge.meshes_of(""), [])
        for wrong in ("robust", "fast:64", "plain:2", "plain:x"):
            with self.assertRaisesRegex(argparse.ArgumentTypeError, wrong):
                judge.meshes_of(wrong)


if __name__ == "__main__":
    unittest.main()
