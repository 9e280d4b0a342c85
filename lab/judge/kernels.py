"""Two kernels that know nothing of revmap: Geant4's generic polycone, and Open CASCADE.

A kernel is made from the polygon of a solid of revolution. `shoot(origin, direction)`, both in
object units and the direction of length 1, gives the distance of the first surface point and its
normal, or `MISS`. An eye in the solid meets the surface from within. Both kernels count lengths in
mm: an object unit is 1000 mm, so that their fixed tolerances (1e-9 mm and 1e-7 mm) are far below
what is judged.
"""

import contextlib
import itertools
import os
import pathlib
import tempfile

MILLIMETRES = 1000.0
MISS = (float("inf"), (0.0, 0.0, 0.0))
# Else the module offers to fetch data of particle physics, which no solid needs.
os.environ.setdefault("GEANT4_DATA_DIR", "/nonexistent")

import geant4_pybind as g4  # noqa: E402
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon  # noqa: E402
from OCP.BRepGProp import BRepGProp_Face  # noqa: E402
from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol  # noqa: E402
from OCP.gp import gp_Ax1, gp_Dir, gp_Lin, gp_Pnt, gp_Vec  # noqa: E402
from OCP.IntCurvesFace import IntCurvesFace_ShapeIntersector  # noqa: E402

GDML = """<?xml version="1.0"?>
<gdml><define/>
<materials><material name="v" Z="1"><D value="1"/><atom value="1"/></material></materials>
<solids><genericPolycone name="{name}" startphi="0" deltaphi="360" aunit="deg" lunit="mm">
{points}
</genericPolycone></solids>
<structure><volume name="{name}w"><materialref ref="v"/><solidref ref="{name}"/></volume></structure>
<setup name="Default" version="1.0"><world ref="{name}w"/></setup></gdml>
"""


class Geant4:
    """G4GenericPolycone, read from GDML: the module's own constructor takes no lists."""

    name = "Geant4"
    # Geant4 finds solids and volumes by name: each needs its own.
    _made = itertools.count()

    def __init__(self, polygon):
        name = f"solid{next(self._made)}"
        point = '<rzpoint r="{!r}" z="{!r}"/>'
        points = "\n".join(point.format(MILLIMETRES * r, MILLIMETRES * z) for r, z in polygon)
        with tempfile.TemporaryDirectory() as folder, _silence():
            file = pathlib.Path(folder, "solid.gdml")
            file.write_text(GDML.format(name=name, points=points))
            parser = g4.G4GDMLParser()
            parser.Read(str(file), False)
            self._world = parser.GetWorldVolume()
        self._solid = self._world.GetLogicalVolume().GetSolid()

    def shoot(self, origin, direction):
        """See the module."""
        x, y, z = (MILLIMETRES * v for v in origin)
        start, along = g4.G4ThreeVector(x, y, z), g4.G4ThreeVector(*direction)
        within = self._solid.Inside(start) == g4.EInside.kInside
        solid = self._solid
        far = solid.DistanceToOut(start, along) if within else solid.DistanceToIn(start, along)
        if far > 1e30:
            return MISS
        normal = solid.SurfaceNormal(start + along * far)
        return far / MILLIMETRES, (normal.x, normal.y, normal.z)


class OpenCascade:
    """A face with the polygon as its border, turned about z: planes, cylinders and cones."""

    name = "Open CASCADE"

    def __init__(self, polygon):
        border = BRepBuilderAPI_MakePolygon()
        for r, z in polygon:
            border.Add(gp_Pnt(MILLIMETRES * r, 0.0, MILLIMETRES * z))
        border.Close()
        face = BRepBuilderAPI_MakeFace(border.Wire(), True).Face()
        axis = gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0))
        self._shape = BRepPrimAPI_MakeRevol(face, axis).Shape()
        self._rays = IntCurvesFace_ShapeIntersector()
        self._rays.Load(self._shape, 1e-7)

    def shoot(self, origin, direction):
        """See the module."""
        x, y, z = (MILLIMETRES * v for v in origin)
        rays = self._rays
        rays.PerformNearest(gp_Lin(gp_Pnt(x, y, z), gp_Dir(*direction)), 1e-7, 1e30)
        if not rays.IsDone() or rays.NbPnt() == 0:
            return MISS
        point, normal = gp_Pnt(), gp_Vec()
        BRepGProp_Face(rays.Face(1)).Normal(rays.UParameter(1), rays.VParameter(1), point, normal)
        size = normal.Magnitude()
        if size > 0.0:
            normal = normal.Divided(size)
        return rays.WParameter(1) / MILLIMETRES, (normal.X(), normal.Y(), normal.Z())


class Several:
    """The nearest surface of several solids in one place, none of them around the eye."""

    def __init__(self, kernel, polygons):
        self._solids = [kernel(polygon) for polygon in polygons]

    def shoot(self, origin, direction):
        """See the module."""
        return min((solid.shoot(origin, direction) for solid in self._solids), key=lambda a: a[0])


@contextlib.contextmanager
def _silence():
    """Without the lines that Geant4 prints while it reads a file."""
    kept, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nothing)
