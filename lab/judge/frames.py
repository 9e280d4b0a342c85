"""Frames of revmap: draws a scene with the program and reads Z and N of the EXR file."""

import pathlib
import struct
import subprocess
import zlib

import numpy as np

NO_COMPRESSION, ZIP_LINES = 0, {2: 1, 3: 16}
FLOAT = 2


class BadFrame(Exception):
    """A picture that cannot be drawn or read. The text is one line."""


def draw(program, scene, picture, size, stage, solver="default"):
    """Draws the scene file into the EXR file `picture`. `size` is (width, height) in pixels."""
    command = [str(program), "render", str(scene), "-o", str(picture), "-q"]
    command += ["--size", f"{size[0]}x{size[1]}", "--stage", stage]
    if stage != "reference":
        command += ["--solver", solver]
    done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        said = (done.stderr.strip().splitlines() or ["no message"])[-1]
        raise BadFrame(f"{scene}: {stage}, {solver}: {said}")
    return read(picture)


def read(path):
    """Z (distance along the ray, infinite without a hit; height x width) and N (the same x 3)."""
    data = pathlib.Path(path).read_bytes()
    try:
        channels = _channels(data)
        normal = np.stack([channels[f"N.{axis}"] for axis in "XYZ"], axis=-1)
        return channels["Z"].astype(float), normal.astype(float)
    except (KeyError, ValueError, IndexError, struct.error, zlib.error) as error:
        raise BadFrame(f"{path}: cannot be read as a frame of revmap ({error!r}); draw it anew") from error


def _channels(data):
    """All channels by name, each an array of rows. Only float scan lines, plain or zipped."""
    if data[:4] != b"v/1\x01":
        raise ValueError("no EXR file")
    attributes, at = _header(data, 8)
    names = _names(attributes["channels"])
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    method = attributes["compression"][0]
    lines = 1 if method == NO_COMPRESSION else ZIP_LINES[method]
    chunks = -(-height // lines)
    rows = np.empty((height, len(names), width), "<f4")
    for offset in struct.unpack_from(f"<{chunks}Q", data, at):
        y, length = struct.unpack_from("<2i", data, offset)
        block = data[offset + 8 : offset + 8 + length]
        count = min(lines, y1 + 1 - y)
        raw = 4 * count * len(names) * width
        if length != raw:
            block = _unzip(block)
        rows[y - y0 : y - y0 + count] = np.frombuffer(block, "<f4").reshape(count, len(names), width)
    return {name: rows[:, k] for k, name in enumerate(names)}


def _header(data, at):
    """The attributes by name, and where the table of offsets begins."""
    attributes = {}
    while data[at] != 0:
        name_end = data.index(0, at)
        type_end = data.index(0, name_end + 1)
        (length,) = struct.unpack_from("<i", data, type_end + 1)
        begin = type_end + 5
        attributes[data[at:name_end].decode()] = data[begin : begin + length]
        at = begin + length
    return attributes, at + 1


def _names(channels):
    """The names of the channels, in the order of the file."""
    names, at = [], 0
    while channels[at] != 0:
        end = channels.index(0, at)
        if struct.unpack_from("<i", channels, end + 1)[0] != FLOAT:
            raise ValueError("a channel is not of 32-bit floats")
        names.append(channels[at:end].decode())
        at = end + 17
    return names


def _unzip(block):
    """Inflates a block, adds up its differences, and puts the two halves' bytes in turn."""
    packed = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    packed[1:] -= 128
    summed = (np.cumsum(packed) & 255).astype(np.uint8)
    half = (len(summed) + 1) // 2
    turned = np.empty_like(summed)
    turned[0::2], turned[1::2] = summed[:half], summed[half:]
    return turned.tobytes()
