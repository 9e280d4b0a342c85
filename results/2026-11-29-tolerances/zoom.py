"""The largest error of a silhouette in a zoom of a pawn from 10 to 2,000 pixels: python3 zoom.py PROGRAM SCENE.

Each of 44 sizes has a second view from 0.1 % nearer. The last line is the largest sum of both errors, which bounds the
step of a silhouette between them.
"""

import json
import math
import subprocess
import sys

PROGRAM, SCENE = sys.argv[1:]
SIZES = 44
ELEVATION = math.radians(20)


def error(distance):
    x, z = distance * math.cos(ELEVATION), 0.5 + distance * math.sin(ELEVATION)
    keys = [f"camera.eye=[{x:.9g}, 0, {z:.9g}]", "camera.target=[0, 0, 0.5]", "camera.fov_y=20"]
    view = [part for key in keys for part in ("--set", key)]

    def run(*arguments):
        return subprocess.run([PROGRAM, *arguments, *view], check=True, capture_output=True, text=True).stdout

    drawn = ["--size", "800x600", "--quiet"]
    run("render", SCENE, "-o", "truth.exr", "--stage", "reference", *drawn)
    run("render", SCENE, "-o", "frame.exr", "--tolerance", "0.25", *drawn)
    return json.loads(run("compare", "truth.exr", "frame.exr", "--scene", SCENE, "--json"))["silhouette_max_px"]


steps = []
for n in range(SIZES):
    pixels = 10 * 200 ** (n / (SIZES - 1))
    distance = 300 / (math.tan(math.radians(10)) * pixels)
    errors = [error(distance), error(0.999 * distance)]
    steps.append(sum(errors))
    print(f"{pixels:.0f} pixels: {errors[0]:.4f}, {errors[1]:.4f}", flush=True)
print(f"largest step: {max(steps):.4f} pixels")
