"""What the same pictures cost revmap and Embree, each on one thread of one core.

    target/judge/bin/python lab/judge/times.py --program revmap --out out/times

revmap's time is that of a whole frame by `revmap bench` on the software driver: rays, search, shading
and writing. The frame without its search stands beside it. Embree's time is that of the rays alone:
they are made before, in the order of 8 x 8 pixels, and nothing is shaded.
"""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import tempfile
import time

import numpy as np

import embree
import solids
import views

SOLIDS = ("identical-planes", "ball", "tube", "glass", "comb", "double-cone")
VIEWS = ("around", "close")
STAGES = ("fragment", "compute")
SIZE = (800, 600)
SECTORS = (16, 64, 128, 256, 1024, 4096, 16384)
KINDS = {"plain": 0, "robust": embree.ROBUST, "fine": embree.HIGH_QUALITY}
MOST = {"plain": 16384, "robust": 4096, "fine": 4096}


def pictures():
    """Solid and view by name."""
    named = [solid for solid in solids.catalogue() if solid.name in SOLIDS]
    return {(solid.name, v.name): (solid, v) for solid in named for v in views.views(solid) if v.name in VIEWS}


def measure_revmap(program, chosen):
    """Milliseconds of frames and of frames without search, by picture; bytes on the device, by solid."""
    frames, floors, held = {}, {}, {}
    size = "{}x{}".format(*SIZE)
    with tempfile.TemporaryDirectory() as folder:
        for (name, view), (solid, at) in chosen.items():
            scene = pathlib.Path(folder, f"{name}_{view}.toml")
            scene.write_text(at.camera.toml() + solid.toml(), encoding="utf-8")
            printed = run([program, "render", scene, "-o", scene.with_suffix(".exr"), "--json", "--size", size])
            held[name] = sum(json.loads(printed)["objects"][0][key] for key in ("table_bytes", "instance_bytes"))
        out = pathlib.Path(folder, "out")
        scenes = sorted(pathlib.Path(folder).glob("*.toml"))
        run([program, "bench", *scenes, "--solver", "exact,floor", "--size", size, "--passes", "4", "--out", out])
        with open(out / "results.csv", newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                into = {"exact": frames, "floor": floors}.get(row["solver"])
                if into is not None and row["gpu_ms_median"]:
                    key = (tuple(row["scene"].split("_")), row["stage"])
                    into[key] = float(row["gpu_ms_median"])
    return frames, floors, held


def run(command):
    """What a command prints."""
    few = {**os.environ, "LP_NUM_THREADS": "1"}
    return subprocess.run([str(part) for part in command], capture_output=True, text=True, check=True, env=few).stdout


def tiled(rays):
    """Rays of a picture in the order of 8 x 8 pixels."""
    height, width, _ = rays.shape
    return rays.reshape(height // 8, 8, width // 8, 8, 3).swapaxes(1, 2).reshape(-1, 3)


def measure_embree(chosen):
    """For each solid, kind and number of sectors: seconds to build, bytes, milliseconds of its pictures."""
    for name in SOLIDS:
        for sectors in SECTORS:
            for kind, flags in KINDS.items():
                if sectors > MOST[kind]:
                    continue
                polygons = chosen[name, VIEWS[0]][0].kernel_polygons()
                begun = time.process_time()
                scene = embree.Scene(polygons, sectors, flags)
                built = time.process_time() - begun
                traced = {}
                for view in VIEWS:
                    camera = chosen[name, view][1].camera
                    rays, spent = tiled(camera.rays(*SIZE)), []
                    for _ in range(7):
                        packets = embree.packed(camera.eye, rays)
                        begun = time.perf_counter()
                        scene.trace(packets)
                        spent.append(time.perf_counter() - begun)
                    traced[view] = 1e3 * float(np.median(spent))
                held = {"build_s": built, "mesh_bytes": scene.mesh.bytes(), "tree_bytes": scene.tree_bytes}
                for view, spent in traced.items():
                    yield {"solid": name, "view": view, "mesh": kind, "sectors": sectors, "ms": spent, **held}


def of_frames(frames, floors):
    """revmap's milliseconds, as a Markdown table of pictures."""
    lines = ["| picture | frame, fragment | frame, compute | without search, fragment | without search, compute |"]
    lines.append("|---|---:|---:|---:|---:|")
    for key in sorted({key for key, _ in frames}):
        cells = [of.get((key, stage)) for of in (frames, floors) for stage in STAGES]
        lines.append(f"| {', '.join(key)} | " + " | ".join(f"{ms:.2f}" if ms else "" for ms in cells) + " |")
    return "\n".join(lines)


def of_meshes(frames, floors, meshes):
    """Embree's times over those of revmap's faster stage, as a Markdown table of kinds and sectors."""
    names = "mesh | sectors | ms of a picture | times the frame | in pictures | times the search | build, s | mesh, MB"
    lines = [f"| {names} | tree, MB |", "|---|" + "---:|" * 8]
    frame = {key: min(ms for (k, _), ms in frames.items() if k == key) for key, _ in frames}
    search = {key: min(ms - floors[key, s] for (k, s), ms in frames.items() if k == key) for key in frame}
    for kind, sectors in dict.fromkeys((m["mesh"], m["sectors"]) for m in meshes):
        own = [m for m in meshes if (m["mesh"], m["sectors"]) == (kind, sectors)]
        pairs = [(m["ms"], (m["solid"], m["view"])) for m in own]
        frames_of, searches_of = ([ms / of[key] for ms, key in pairs] for of in (frame, search))
        cells = [f"{sectors:,}", span([ms for ms, _ in pairs], ".1f"), f"{mean(frames_of):.2f}", span(frames_of, ".2f")]
        cells += [f"{mean(searches_of):.2f}", span([m["build_s"] for m in own], ".3f")]
        cells += [span([m[key] / 1e6 for m in own], ".2g") for key in ("mesh_bytes", "tree_bytes")]
        lines.append(f"| {kind} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def mean(ratios):
    """The geometric mean."""
    return float(np.exp(np.mean(np.log(ratios))))


def span(values, form):
    """The least and the largest."""
    return f"{min(values):{form}} to {max(values):{form}}"


def main():
    """Writes times.md and the times of Embree, times.csv."""
    parser = argparse.ArgumentParser(prog="times.py", description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, help="the program revmap")
    parser.add_argument("--out", required=True, help="a folder for times.csv and times.md")
    given = parser.parse_args()
    out = pathlib.Path(given.out)
    out.mkdir(parents=True, exist_ok=True)
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    chosen = pictures()
    frames, floors, held = measure_revmap(given.program, chosen)
    meshes = list(measure_embree(chosen))
    with open(out / "times.csv", "w", newline="", encoding="utf-8") as file:
        rows = csv.DictWriter(file, meshes[0], lineterminator="\n")
        rows.writeheader()
        rows.writerows(meshes)
    kept = f"On the device revmap holds {min(held.values()):,} to {max(held.values()):,} bytes of a solid."
    text = "\n\n".join([of_frames(frames, floors), kept, of_meshes(frames, floors, meshes)])
    (out / "times.md").write_text(text + "\n", encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
