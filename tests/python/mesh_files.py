# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads polygons from OBJ, PLY, STL and OFF; ValueError. STL shares equal vertices alone."""

import struct
from pathlib import Path

import numpy as np
from shared_data import read_obj

SUFFIXES = (".obj", ".ply", ".stl", ".off")
PLY_TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I"}
PLY_TYPES |= {"int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I"}
PLY_TYPES |= {"float": "f", "double": "d", "float32": "f", "float64": "d"}


def read_mesh(path: Path) -> tuple[np.ndarray, list[list[int]]]:
    """Vertices (n, 3) and polygons as lists of vertex ids."""
    reader = {".obj": read_obj, ".ply": read_ply, ".stl": read_stl, ".off": read_off}[
        path.suffix.lower()
    ]
    try:
        return reader(path)
    except (
        IndexError,
        KeyError,
        MemoryError,
        OverflowError,
        StopIteration,
        struct.error,
        UnicodeDecodeError,
    ) as error:
        raise ValueError(f"{path.name} is corrupt: {error!r}") from error


def read_ply(path: Path) -> tuple[np.ndarray, list[list[int]]]:
    head, body = path.read_bytes().split(b"end_header", 1)
    body = body[body.index(b"\n") + 1 :]
    elements, form = [], ""
    for words in (line.split() for line in head.decode("latin-1").splitlines()):
        if words[:1] == ["format"]:
            form = words[1]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append([words[-1], *(PLY_TYPES[t] for t in words[1:-1] if t != "list")])
    take = (
        ascii_values(body)
        if form == "ascii"
        else binary_values(body, ">" if "big" in form else "<")
    )
    vertices, faces = [], []
    for element, count, properties in elements:
        if count > len(body):
            raise ValueError(f"{path.name} has {count} elements in {len(body)} bytes")
        for _ in range(count):
            row = {name: read_property(take, types) for name, *types in properties}
            if element == "vertex":
                vertices.append([row["x"], row["y"], row["z"]])
            elif element == "face":
                ids = row.get("vertex_indices", row.get("vertex_index"))
                faces.append([int(v) for v in ids])
    return np.array(vertices, float).reshape(-1, 3), faces


def read_property(take, types):
    if len(types) == 1:
        return take(types[0])
    return [take(types[1]) for _ in range(int(take(types[0])))]


def ascii_values(body: bytes):
    words = iter(body.split())
    return lambda kind: float(next(words)) if kind in "fd" else int(next(words))


def binary_values(body: bytes, order: str):
    at = 0

    def take(kind: str):
        nonlocal at
        (value,) = struct.unpack_from(order + kind, body, at)
        at += struct.calcsize(kind)
        return value

    return take


def read_stl(path: Path) -> tuple[np.ndarray, list[list[int]]]:
    data = path.read_bytes()
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else -1
    if len(data) == 84 + 50 * count:
        records = np.frombuffer(
            data,
            np.dtype([("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("more", "<u2")]),
            count,
            84,
        )
        soup = records["corner"].reshape(-1, 3).astype(float)
    else:
        words = [line.split() for line in data.decode("latin-1").splitlines()]
        soup = np.array(
            [[float(x) for x in w[1:4]] for w in words if w[:1] == ["vertex"]], float
        ).reshape(-1, 3)
    points, number = np.unique(soup, axis=0, return_inverse=True)
    return points, number.reshape(-1, 3).tolist()


def read_off(path: Path) -> tuple[np.ndarray, list[list[int]]]:
    lines = [line.split("#")[0] for line in path.read_text(errors="replace").splitlines()]
    words = iter(" ".join(lines).split())
    if next(words) != "OFF":
        raise ValueError(f"{path.name} is no OFF file")
    vertex_count, face_count, _ = (int(next(words)) for _ in range(3))
    vertices = [[float(next(words)) for _ in range(3)] for _ in range(vertex_count)]
    faces = [[int(next(words)) for _ in range(int(next(words)))] for _ in range(face_count)]
    return np.array(vertices, float).reshape(-1, 3), faces
