"""Holds pictures of revmap, and Embree's meshes, to Geant4, Open CASCADE and the reference. See docs/robustness.md."""

import argparse
import concurrent.futures
import fnmatch
import os
import pathlib
import sys
import time
import tomllib

import court
import frames
import rates
import verdict

HERE = pathlib.Path(__file__).parent


def arguments():
    """The command line."""
    parser = argparse.ArgumentParser(prog="lab/judge/run", description=__doc__)
    parser.add_argument("--program", required=True, help="the program revmap")
    parser.add_argument("--set", choices=("small", "full"), default="small")
    parser.add_argument("--scenes", help="judge the scenes of this folder in place of a set")
    parser.add_argument("--seed", type=int, default=1, help="of the random solids of the full set")
    parser.add_argument("--random", type=int, default=40, help="their number")
    parser.add_argument("--views", type=int, default=4, help="the most of a class and solid, full set")
    parser.add_argument("--size", default="161x121", help="pixels across and down")
    parser.add_argument("--solvers", default=court.DEFAULT, help="searches, with commas between")
    parser.add_argument("--embree", type=meshes_of, default="robust:1024", help="meshes, as in plain:256,robust:1024")
    parser.add_argument("--base", type=float, default=verdict.BASE, help="of the tolerance, object units")
    parser.add_argument("--only", default="*", help="solids of this name alone; a pattern")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="pictures at a time")
    parser.add_argument("--out", help="a folder for raw.csv, table.md and the scenes")
    return parser.parse_args()


def meshes_of(text):
    """Kind and number of sectors of each mesh, as in `plain:256,robust:1024`."""
    meshes = []
    for mesh in filter(None, text.split(",")):
        kind, _, sectors = mesh.partition(":")
        if kind not in court.KINDS or not sectors.isdecimal() or int(sectors) < 3:
            kinds = " or ".join(court.KINDS)
            raise argparse.ArgumentTypeError(f"{mesh}: give {kinds}, and 3 sectors or more, as in robust:1024")
        meshes.append((kind, int(sectors)))
    return meshes


def catalogued(row, known):
    """Whether the known failures have the wrong pixels of a row."""
    return any(
        fnmatch.fnmatch(row["solid"], entry["solid"])
        and fnmatch.fnmatch(row["view"], entry["view"])
        and row["wrong"] <= entry.get("wrong", 0)
        and row["normal"] <= entry.get("normal", 0)
        for entry in known
    )


def failures(rows, known):
    """The pictures of the default search that are refused, or have wrong pixels that are not known."""
    own = [row for row in rows if row["voice"].startswith(f"{court.DEFAULT}, ")]
    bad = [row for row in own if row["note"] or row["wrong"] + row["normal"] > 0]
    return [row for row in bad if row["note"] or not catalogued(row, known)]


def judged(chosen, given, size, scenes):
    """The rows of all pictures."""
    solvers = given.solvers.split(",")
    tasks = [(*pair, given.program, size, solvers, given.embree, given.base, scenes) for pair in chosen]
    rows, begun = [], time.monotonic()
    with concurrent.futures.ProcessPoolExecutor(given.jobs) as pool:
        for done, found in enumerate(pool.map(court.hold, tasks), 1):
            rows += found
            if done % 50 == 0:
                spent = time.monotonic() - begun
                print(f"{done} of {len(tasks)} pictures, {spent:.0f} s", file=sys.stderr)
    return rows


def pictures(given):
    """The solids and views that the command line names."""
    if given.scenes:
        chosen = court.scenes_of(given.scenes)
    elif given.set == "small":
        chosen = court.small_set()
    else:
        chosen = court.full_set(given.seed, given.random, given.views)
    return [(solid, view) for solid, view in chosen if fnmatch.fnmatch(solid.name, given.only)]


def main():
    """Exit code 1 for a wrong pixel that is not known, 2 for a picture that cannot be judged."""
    given = arguments()
    size = tuple(int(side) for side in given.size.split("x"))
    known = tomllib.loads((HERE / "known.toml").read_text()).get("known", [])
    scenes = None
    if given.out:
        scenes = pathlib.Path(given.out, "scenes")
        scenes.mkdir(parents=True, exist_ok=True)
    begun = time.monotonic()
    try:
        chosen = pictures(given)
        rows = judged(chosen, given, size, scenes)
    except frames.BadFrame as error:
        print(f"judge: {error}", file=sys.stderr)
        return 2
    table = "\n\n".join([rates.summary(rows), rates.by_class(rows), rates.by_class(rows, "normal")])
    print(table)
    if given.out:
        rates.write(rows, pathlib.Path(given.out, "raw.csv"))
        pathlib.Path(given.out, "table.md").write_text(table + "\n", encoding="utf-8")
    bad = failures(rows, known)
    for row in bad:
        where = f"{row['solid']}, {row['view']}, {row['voice']}"
        kinds = ", ".join(f"{row[kind]} {kind}" for kind in (*verdict.KINDS, "normal") if row[kind])
        print(f"wrong: {where}: {row['note'] or kinds} of {row['hits']} hits")
    spent = time.monotonic() - begun
    print(f"{len(chosen)} pictures judged in {spent:.0f} s: {len(bad)} with wrong pixels that are not known.")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
