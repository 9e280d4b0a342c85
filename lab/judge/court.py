"""Draws pictures of revmap and holds each to the judges."""

import functools
import math
import pathlib
import tempfile
import tomllib

import numpy as np

import embree
import frames
import kernels
import rays
import solids
import verdict
import views

STAGES = ("fragment", "compute")
DEFAULT = "exact"
# Embree's ways to trace that are judged.
KINDS = {"plain": 0, "robust": embree.ROBUST}
# Ten solids, each with one class of rays beside the whole view.
SMALL = {
    "lid": "ordinary",
    "thin-ring": "ordinary",
    "cone": "vertex",
    "tube": "grazing",
    "identical-planes": "edge",
    "inner-cones": "axis",
    "level-cone-1e-2": "grazing",
    "touching-cylinders": "ordinary",
    "no-thickness": "edge",
    "steps-1e3": "start",
}


def small_set():
    """Two views of each of ten solids."""
    named = {solid.name: solid for solid in solids.catalogue()}
    chosen = []
    for name, kind in SMALL.items():
        whole, *others = views.views(named[name])
        chosen.append((named[name], whole))
        chosen.append((named[name], [view for view in others if view.kind == kind][-1]))
    return chosen


def full_set(seed, count, most):
    """All named solids and `count` random ones, each with at most `most` views of each class."""
    chosen = []
    for solid in solids.catalogue() + solids.made_at_random(seed, count):
        every = views.views(solid)
        for kind in views.CLASSES:
            of_kind = [view for view in every if view.kind == kind]
            step = max(1.0, len(of_kind) / most)
            picks = sorted({int(k * step) for k in range(min(most, len(of_kind)))})
            chosen += [(solid, of_kind[k]) for k in picks]
    return chosen


def scenes_of(folder):
    """The scenes of a folder: files with a camera, and polygons in one place."""
    chosen = []
    for file in sorted(pathlib.Path(folder).glob("*.toml")):
        scene = tomllib.loads(file.read_text(encoding="utf-8"))
        try:
            keys = [{k: tuple(v) for k, v in o.items() if k != "polygon"} for o in scene["object"]]
            camera = rays.Camera(**{k: _tuple(v) for k, v in scene["camera"].items()})
            polygons = [object["polygon"] for object in scene["object"]]
            if any(other != keys[0] for other in keys):
                raise ValueError("objects in several places")
            solid = solids.Solid(file.stem, "scene", polygons, rays.Placement(**keys[0]))
        except (KeyError, TypeError, ValueError) as error:
            message = f"{file}: cannot be judged ({error!r}); give polygons in one place, and a camera"
            raise frames.BadFrame(message) from error
        chosen.append((solid, views.View("scene", "scene", camera)))
    if not chosen:
        raise frames.BadFrame(f"{folder}: has no scene; give a folder with .toml files")
    return chosen


def _tuple(value):
    return tuple(value) if isinstance(value, list) else value


@functools.lru_cache(maxsize=4)
def _kernels(name, polygons):
    """Both kernels of a solid; the polygons as text, by which they are remembered."""
    shapes = eval(polygons, {"__builtins__": {}})  # noqa: S307: the text is this module's own repr
    one, two = kernels.Geant4, kernels.OpenCascade
    return {kind.name: kernels.Several(kind, shapes) for kind in (one, two)}


@functools.lru_cache(maxsize=8)
def _embree(name, polygons, kind, sectors):
    """Embree's mesh of a solid, remembered as the kernels are."""
    return embree.Scene(eval(polygons, {"__builtins__": {}}), sectors, KINDS[kind])  # noqa: S307: as above


def peer(solid, held, kind, sectors):
    """Embree's answers to a picture's rays, on a mesh of so many sectors."""
    scene = _embree(solid.name, repr(solid.kernel_polygons()), kind, sectors)
    return verdict.Answers(*scene.shoot(held.origin, held.rays))


def picture(solid, view, size, draw, base=verdict.BASE):
    """The picture of a view with its judges; `draw(stage, solver)` gives Z and N of a frame."""
    width, height = size
    place, camera = solid.placement, view.camera
    world = camera.rays(width, height).reshape(-1, 3)
    inner = place.vector_in(world)
    stretch = np.linalg.norm(inner, axis=1)
    origin = place.point_in(camera.eye)
    radius, low, high = solid.bounds()
    far = np.linalg.norm(origin - (0.0, 0.0, 0.5 * (low + high)))
    half = 0.5 * camera.pixel(height) * math.hypot(width, height)
    bound = verdict.tolerance(base, math.hypot(2 * radius, high - low), far, half)

    def answers(stage, solver):
        z, normal = draw(stage, solver)
        return verdict.Answers(z.ravel() * stretch, place.normal_in(normal.reshape(-1, 3)))

    judges = _kernels(solid.name, repr(solid.kernel_polygons()))
    reference = answers("reference", "default")
    return verdict.Picture(origin, inner / stretch[:, None], judges, reference, bound), answers


def hold(task):
    """Judges one picture by all searches in both stages, and Embree's: a row for each voice."""
    solid, view, program, size, solvers, meshes, base, kept = task
    about = {"class": view.kind, "solid": solid.name, "family": solid.family, "view": view.name}
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(kept or folder, f"{solid.name}-{view.name}.toml")
        scene.write_text(view.camera.toml() + solid.toml(), encoding="utf-8")

        def draw(stage, solver):
            return frames.draw(program, scene, pathlib.Path(folder, "a.exr"), size, stage, solver)

        held, answers = picture(solid, view, size, draw, base)
        rows = []
        for name in verdict.JUDGES:
            rows.append(row(about, held, name, held.judges[name], name))
        for solver in solvers:
            for stage in STAGES:
                voice = f"{solver}, {stage}"
                try:
                    rows.append(row(about, held, voice, answers(stage, solver), None))
                except frames.BadFrame as refusal:
                    rows.append({**about, "voice": voice, **empty(), "note": str(refusal)})
        for kind, sectors in meshes:
            rows.append(row(about, held, f"Embree, {kind}, {sectors}", peer(solid, held, kind, sectors), None))
    return rows


def empty():
    """Counts of a picture that is not drawn."""
    return dict.fromkeys(("rays", "hits", "wrong", "normal", "undecided", *verdict.KINDS), 0)


def row(about, held, voice, answers, name):
    """What a voice did in a picture; `name`: of a judge among the judges."""
    wrong, normal, undecided = held.judge(answers, name)
    hits = held.hits() | np.isfinite(answers.distance)
    counts = {"rays": len(hits), "hits": int(hits.sum()), "wrong": int(wrong.sum())}
    counts |= {"normal": int(normal.sum()), "undecided": int(undecided.sum())}
    return {**about, "voice": voice, **counts, **held.kinds(answers, wrong), "note": ""}
