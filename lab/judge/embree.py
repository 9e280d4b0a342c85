"""Embree 2.17.7, called as a renderer in C calls it: one thread, streams of packets of 16 rays.

The Python package embreex carries the library. Its own interface traces single rays, and spends
more time in Python than in Embree; so the library's C interface is called here. Rays and mesh are
32-bit numbers, in object space.
"""

import ctypes
import functools
import pathlib

import numpy as np
from embreex import rtcore_scene  # loads the library, and those that it needs

import mesh

WIDE = 16
STATIC, HIGH_QUALITY, ROBUST = 0, 1 << 11, 1 << 16
SINGLE, PACKETS, STREAM = 1 << 0, 1 << 3, 1 << 5
INDICES, VERTICES = 0x01000000, 0x02000000
# The rows of a packet of rays, `WIDE` numbers each.
ROWS = "ox oy oz dx dy dz near far time mask nx ny nz u v geometry triangle instance".split()
AT = {name: row for row, name in enumerate(ROWS)}


class _Context(ctypes.Structure):
    """How rays are traced: flags (0: coherent rays) and a pointer of the user's."""

    _fields_ = [("flags", ctypes.c_int), ("extension", ctypes.c_void_p)]


Watch = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_ssize_t, ctypes.c_bool)


@functools.lru_cache(maxsize=1)
def _library():
    folder = pathlib.Path(rtcore_scene.__file__).parent.parent / "embreex.libs"
    library = ctypes.CDLL(str(next(folder.glob("libembree*"))))
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    calls = {
        "rtcNewDevice": (pointer, [ctypes.c_char_p]),
        "rtcDeviceGetError": (ctypes.c_int, [pointer]),
        "rtcDeviceSetMemoryMonitorFunction": (None, [pointer, Watch]),
        "rtcDeviceNewScene": (pointer, [pointer, ctypes.c_int, ctypes.c_int]),
        "rtcNewTriangleMesh": (ctypes.c_uint, [pointer, ctypes.c_int, size, size, size]),
        "rtcSetBuffer2": (None, [pointer, ctypes.c_uint, ctypes.c_int, pointer, size, size, size]),
        "rtcCommit": (None, [pointer]),
        "rtcIntersectNM": (None, [pointer, ctypes.POINTER(_Context), pointer, size, size, size]),
        "rtcDeleteScene": (None, [pointer]),
        "rtcDeleteDevice": (None, [pointer]),
    }
    for name, (gives, takes) in calls.items():
        call = getattr(library, name)
        call.restype, call.argtypes = gives, takes
    return library


class Scene:
    """A mesh with its tree. `tree_bytes`: what Embree holds beside the mesh.

    `flags`: 0 is Embree's default. `ROBUST` loses no ray between two triangles, `HIGH_QUALITY` makes
    a better tree in more time.
    """

    def __init__(self, polygons, sectors, flags=0):
        self.mesh, self.tree_bytes = mesh.Mesh(polygons, sectors), 0
        self._library, self._watch = _library(), Watch(self._count)
        call = self._library
        self._device = call.rtcNewDevice(b"threads=1")
        call.rtcDeviceSetMemoryMonitorFunction(self._device, self._watch)
        self._scene = call.rtcDeviceNewScene(self._device, STATIC | flags, SINGLE | PACKETS | STREAM)
        points, corners = self.mesh.positions, self.mesh.triangles
        made = call.rtcNewTriangleMesh(self._scene, 0, len(corners), len(points), 1)
        call.rtcSetBuffer2(self._scene, made, VERTICES, points.ctypes.data, 0, 16, len(points))
        call.rtcSetBuffer2(self._scene, made, INDICES, corners.ctypes.data, 0, 12, len(corners))
        call.rtcCommit(self._scene)
        self._check()

    def _count(self, bytes, _done):
        self.tree_bytes += bytes
        return True

    def _check(self):
        error = self._library.rtcDeviceGetError(self._device)
        if error:
            raise RuntimeError(f"Embree returned error {error}")

    def trace(self, packets):
        """The first hits of packets of rays, which are written into them."""
        stride = packets[0].nbytes
        context, rays = _Context(0, None), packets.ctypes.data
        self._library.rtcIntersectNM(self._scene, ctypes.byref(context), rays, WIDE, len(packets), stride)

    def shoot(self, origin, rays):
        """Distances (infinite: a miss) and normals of rays from one eye."""
        packets = packed(origin, rays)
        self.trace(packets)
        self._check()
        rows = packets.transpose(1, 0, 2).reshape(len(ROWS), -1)[:, : len(rays)]
        triangle = rows[AT["triangle"]].view("<i4")
        hit = triangle >= 0
        distance = np.where(hit, rows[AT["far"]].astype(float), np.inf)
        normal = np.zeros((len(rays), 3))
        u, v = (rows[AT[name]][hit].astype(float) for name in "uv")
        normal[hit] = self.mesh.normals(triangle[hit], u, v)
        return distance, normal

    def __del__(self):
        if hasattr(self, "_scene"):
            self._library.rtcDeleteScene(self._scene)
            self._library.rtcDeleteDevice(self._device)


def packed(origin, rays):
    """Rays of one eye in packets; those that fill the last packet are void."""
    count = -(-len(rays) // WIDE)
    space = np.zeros(count * len(ROWS) * WIDE + 16, "<f4")
    begin = -space.ctypes.data % 64 // 4
    packets = space[begin : begin + count * len(ROWS) * WIDE].reshape(count, len(ROWS), WIDE)
    whole = np.zeros((count * WIDE, 3), "<f4")
    whole[: len(rays)] = rays
    packets[:, 0:3] = np.asarray(origin, "<f4")[None, :, None]
    packets[:, 3:6] = whole.reshape(count, WIDE, 3).transpose(0, 2, 1)
    far = np.full(count * WIDE, -1.0)
    far[: len(rays)] = np.inf
    packets[:, AT["far"]] = far.reshape(count, WIDE)
    bits = packets.view("<i4")
    for name in ("mask", "geometry", "triangle", "instance"):
        bits[:, AT[name]] = -1
    return packets
