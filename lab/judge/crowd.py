"""Soft shadows of ten thousand copies: revmap beside Embree, which has the solid as a mesh and a tree over its copies.

    cargo build --release -p revmap-cli
    target/judge/bin/python lab/judge/crowd.py target/release/revmap [--sectors 64] [--copies 10000]

Both draw one picture of one scene with 16 rays to the light's disc, in this machine's threads. Embree's
rays are traced alone: what revmap does beside them is left out by a frame without shadows.
"""

import argparse
import concurrent.futures
import ctypes
import math
import os
import pathlib
import re
import statistics
import subprocess
import tempfile
import time

import numpy as np

import embree
import mesh

SIZE = (640, 480)
EYE, FOV_Y = np.array([16.0, 3.0, 10.0]), 40.0
TOWARDS, RADIUS = np.array([0.4, 0.6, 0.7]), 2.0
RAYS = 16
OUTLINE = [(0, 0), (0.3, 0), (0.3, 0.08), (0.18, 0.14), (0.13, 0.3), (0.12, 0.55), (0.2, 0.6), (0.2, 0.65),
           (0.13, 0.68), (0.2, 0.76), (0.21, 0.84), (0.16, 0.95), (0.05, 1), (0, 1)]
COLUMN_MAJOR = 1


def places(count):
    """Position, turn about the axis and scale of copies, spread evenly over a square."""
    k = np.arange(count)
    part = lambda step: (k * step) % 1.0
    side = 0.6 * math.sqrt(count)
    x, y = (side * (part(step) - 0.5) for step in (0.754877666, 0.569840291))
    return np.stack([x, y, math.pi * part(0.414214), 0.6 + 0.7 * part(0.618034)], axis=1)


def write_scene(folder, copies, shadow):
    rows = [f"{x},{y},0,0,0,{math.sin(a)},{math.cos(a)},{s},{s},{s}" for x, y, a, s in copies]
    (folder / "copies.csv").write_text("\n".join(rows) + "\n")
    outline = ", ".join(f"[{r}, {z}]" for r, z in OUTLINE)
    text = f"""shadow = "{shadow}"
camera = {{ eye = {EYE.tolist()}, target = [0, 0, 0], fov_y = {FOV_Y} }}
light = [{{ direction = {(-TOWARDS).tolist()}, radius = {RADIUS}, color = [1, 1, 1] }}]
[[object]]
polygon = [{outline}]
instances = "copies.csv"
"""
    path = folder / f"{shadow}.toml"
    path.write_text(text)
    return path


def revmap(program, scene, stage, turns=5):
    """The median time of a frame, milliseconds."""
    size = f"{SIZE[0]}x{SIZE[1]}"
    command = [program, "render", scene, "--size", size, "--stage", stage, "-o", scene.with_suffix(".png")]
    said = [subprocess.run(command, capture_output=True, text=True, check=True).stdout for _ in range(turns)]
    return statistics.median(float(re.search(r"([\d.]+) ms on", line)[1]) for line in said)


class Crowd:
    """Embree's scene of copies of one mesh."""

    def __init__(self, copies, sectors):
        self.solid = embree.Scene([OUTLINE], sectors)
        self._call = call = self.solid._library
        pointer, size, number = ctypes.c_void_p, ctypes.c_size_t, ctypes.c_uint
        call.rtcNewInstance3.restype = number
        call.rtcNewInstance3.argtypes = [pointer, pointer, size, number]
        call.rtcSetTransform2.argtypes = [pointer, number, ctypes.c_int, pointer, size]
        call.rtcOccludedNM.argtypes = call.rtcIntersectNM.argtypes
        kinds = embree.SINGLE | embree.PACKETS | embree.STREAM
        self._scene = call.rtcDeviceNewScene(self.solid._device, embree.STATIC, kinds)
        for k, (x, y, half, s) in enumerate(copies):
            c, d = s * math.cos(2 * half), s * math.sin(2 * half)
            columns = np.array([c, d, 0, -d, c, 0, 0, 0, s, x, y, 0], "<f4")
            call.rtcNewInstance3(self._scene, self.solid._scene, 1, k)
            call.rtcSetTransform2(self._scene, k, COLUMN_MAJOR, columns.ctypes.data, 0)
        call.rtcCommit(self._scene)
        self.solid._check()

    def trace(self, packets, threads, occluded=False):
        """Traces packets in threads, and returns the seconds that this took."""
        trace = self._call.rtcOccludedNM if occluded else self._call.rtcIntersectNM
        context, stride = embree._Context(0, None), packets[0].nbytes

        def part(block):
            trace(self._scene, ctypes.byref(context), block.ctypes.data, embree.WIDE, len(block), stride)

        # Small blocks, so that threads end together.
        blocks = np.array_split(packets, 64)
        begin = time.perf_counter()
        with concurrent.futures.ThreadPoolExecutor(threads) as pool:
            list(pool.map(part, blocks))
        return time.perf_counter() - begin


def eye_rays():
    w, h = SIZE
    ahead = -EYE / np.linalg.norm(EYE)
    right = np.cross(ahead, [0, 0, 1])
    right /= np.linalg.norm(right)
    up = np.cross(right, ahead)
    reach = math.tan(math.radians(FOV_Y) / 2)
    # Pixels of a square of four by four are neighbours in the order of rays.
    y, x = np.divmod(np.arange(w * h), w)
    order = np.lexsort((x % 4, y % 4, x // 4, y // 4))
    x, y = x[order], y[order]
    across = (2 * (x + 0.5) / w - 1) * reach * w / h
    return ahead + across[:, None] * right + ((1 - 2 * (y + 0.5) / h) * reach)[:, None] * up


def field(packets, name):
    return packets[:, embree.AT[name]].reshape(-1)


def disc_rays(points, dice):
    """RAYS rays from each point to the light's disc, a spiral that each point turns by an angle of its own."""
    ahead = TOWARDS / np.linalg.norm(TOWARDS)
    u = np.cross(ahead, [0, 0, 1])
    u /= np.linalg.norm(u)
    v = np.cross(ahead, u)
    k = np.arange(RAYS)
    angle = 2.399963 * k + dice.uniform(0, 2 * math.pi, len(points))[:, None]
    aside = (math.tan(math.radians(RADIUS)) * np.sqrt((k + 0.5) / RAYS))[None, :, None]
    return ahead + aside * (np.cos(angle)[..., None] * u + np.sin(angle)[..., None] * v)


def shade(crowd, threads, turns=5):
    """Rays and milliseconds: those of the eye, those to the light, and the share that something blocks."""
    rays = eye_rays()
    first = embree.packed(EYE, rays)
    kept = first.copy()
    times = []
    for _ in range(turns):
        first[:] = kept
        times.append(crowd.trace(first, threads))
    t = field(first, "far")[: len(rays)].astype(float)
    hit = field(first, "triangle").view("<i4")[: len(rays)] >= 0
    points = EYE + t[hit, None] * rays[hit] + 2e-4 * TOWARDS
    towards = disc_rays(points, np.random.default_rng(1)).reshape(-1, 3)
    second = embree.packed(np.zeros(3), towards)
    lanes = np.zeros((len(second) * embree.WIDE, 3), "<f4")
    lanes[: len(towards)] = np.repeat(points, RAYS, axis=0)
    second[:, 0:3] = lanes.reshape(-1, embree.WIDE, 3).transpose(0, 2, 1)
    kept, shadow_times = second.copy(), []
    for _ in range(turns):
        second[:] = kept
        shadow_times.append(crowd.trace(second, threads, occluded=True))
    blocked = (field(second, "geometry").view("<i4")[: len(towards)] == 0).mean()
    eye, light = (1e3 * statistics.median(t) for t in (times, shadow_times))
    return (len(rays), eye), (len(towards), light), blocked


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("program", help="the program revmap")
    options.add_argument("--sectors", type=int, nargs="+", default=[64])
    options.add_argument("--copies", type=int, default=10_000)
    asked = options.parse_args()
    threads, copies = os.cpu_count(), places(asked.copies)
    with tempfile.TemporaryDirectory() as folder:
        scenes = [write_scene(pathlib.Path(folder), copies, shadow) for shadow in ("off", "hard", "soft")]
        for stage in ("fragment", "compute"):
            off, hard, soft = (revmap(asked.program, scene, stage) for scene in scenes)
            print(f"revmap, {stage}: {off:.0f} ms without shadows, hard {hard:.0f} ({hard / off:.1f}), "
                  f"soft {soft:.0f} ({soft / off:.1f})")
    for sectors in asked.sectors:
        crowd = Crowd(copies, sectors)
        (eye, eye_ms), (light, light_ms), blocked = shade(crowd, threads)
        print(f"Embree, {sectors} sectors, {len(crowd.solid.mesh.triangles)} triangles: {eye} rays of the eye in "
              f"{eye_ms:.0f} ms, {light} rays to the light in {light_ms:.0f} ms ({light / light_ms / 1e3:.1f} million "
              f"a second, {100 * blocked:.0f} % blocked)")


if __name__ == "__main__":
    main()
