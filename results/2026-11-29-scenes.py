"""Writes the scenes of "Rows of a look", pawns of one colour map each, and 100,000 pawns. In the repository's root:

    python3 results/2026-11-29-scenes.py out/many
"""

import os
import pathlib
import struct
import sys
import zlib

out = pathlib.Path(sys.argv[1])
out.mkdir(parents=True, exist_ok=True)
pawn = os.path.relpath("assets/profiles/pawn.svg", out)
ALL, ROW = 200, 14


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


for i in range(ALL):
    row = bytes([0, i, 255 - i, 128])
    header = struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)
    parts = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(row)) + chunk(b"IEND", b"")
    (out / f"{i}.png").write_bytes(b"\x89PNG\r\n\x1a\n" + parts)
for n in (4, 16, 64):
    text = 'shadow = "hard"\ncamera = { eye = [-12, -10, 9], target = [0, 0, 0.2], fov_y = 45 }\n'
    for k in range(n):
        i = k * ALL // n
        x, y = (0.9 * (at - ROW // 2) for at in (i % ROW, i // ROW))
        text += f'[[object]]\nprofile = "{pawn}"\nposition = [{x:.1f}, {y:.1f}, 0]\ncolor_map = "{i}.png"\n'
    (out / f"{n}.toml").write_text(text)

N, ROW = 100000, 316
rows = "x,y,z,qx,qy,qz,qw,sx,sy,sz\n"
for i in range(N):
    x, y = (0.9 * (at - (ROW - 1) / 2) for at in (i % ROW, i // ROW))
    rows += f"{x:.3f},{y:.3f},0,0,0,0,1,1,1,1\n"
(out / f"{N}.csv").write_text(rows)
camera = "camera = { eye = [-85.32, -71.1, 85.32], target = [0, 0, 0.2], fov_y = 45 }\n"
(out / f"{N}-above.toml").write_text(f'{camera}[[object]]\nprofile = "{pawn}"\ninstances = "{N}.csv"\n')
