"""Writes the crowds of times.csv. In the repository's root:

    python3 results/2026-11-27-nvidia-h100/scenes.py out/crowds
"""

import math
import os
import pathlib
import random
import sys

HEAD = "x,y,z,qx,qy,qz,qw,sx,sy,sz\n"
out = pathlib.Path(sys.argv[1])
out.mkdir(parents=True, exist_ok=True)


def scene(name, camera, profile, copies, more=""):
    path = os.path.relpath(f"assets/profiles/{profile}", out)
    text = f'{more}camera = {camera}\n[[object]]\nprofile = "{path}"\ninstances = "{copies}.csv"\n'
    (out / f"{name}.toml").write_text(text)


random.seed(1)
for n in (4, 16, 64, 256, 1024, 10000):
    k, rows = int(n**0.5), HEAD
    for i in range(n):
        a = random.random() * 6.28
        x = (i % k - (k - 1) / 2) * 0.9 + random.uniform(-0.15, 0.15)
        y = (i // k - (k - 1) / 2) * 0.9 + random.uniform(-0.15, 0.15)
        rows += f"{x:.3f},{y:.3f},0,0,0,{math.sin(a / 2):.5f},{math.cos(a / 2):.5f},1,1,1\n"
    (out / f"{n}.csv").write_text(rows)
    d = k * 0.9
    above = f"{{ eye = [{-d * 0.75:.3f}, {-d * 0.6:.3f}, {d * 0.75 + 0.5:.3f}], target = [0, 0, 0.2], fov_y = 45 }}"
    scene(f"{n}-above", above, "pawn.svg", n)
    side = f"{{ eye = [{-d * 0.8:.3f}, {-d * 0.3:.3f}, 0.8], target = [0, 0, 0.3], fov_y = 35 }}"
    scene(f"{n}-side", side, "pawn.svg", n)

rows = HEAD
for i in range(10000):
    part = lambda step: (i * step) % 1.0
    x, y = (60 * (part(step) - 0.5) for step in (0.754877666, 0.569840291))
    a, s = math.pi * part(0.414214), 0.6 + 0.7 * part(0.618034)
    rows += f"{x:.6g},{y:.6g},0,0,0,{math.sin(a):.6g},{math.cos(a):.6g},{s:.6g},{s:.6g},{s:.6g}\n"
(out / "rooks.csv").write_text(rows)
for shadow in ("off", "hard", "soft"):
    light = "light = [{ direction = [-0.4, -0.6, -0.7], radius = 2, color = [1, 1, 1] }]\n"
    camera = "{ eye = [16, 3, 10], target = [0, 0, 0], fov_y = 40 }"
    scene(f"rooks-{shadow}", camera, "rook.svg", "rooks", f'shadow = "{shadow}"\n{light}')
