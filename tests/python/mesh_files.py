# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads polygons from OBJ and STL; ValueError. STL shares equal vertices alone."""

import struct
from pathlib import Path

import numpy as np
from shared_data import read_obj

SUFFIXES = (".obj", ".stl")


def read_mesh(path: Path) -> tuple[np.ndarray, list[list[int]]]:
    """Vertices (n, 3) and polygons as lists of vertex ids."""
    reader = {".obj": read_obj, ".stl": read_stl}[path.suffix.lower()]
    try:
        return reader(path)
    except (IndexError, OverflowError, UnicodeDecodeError) as error:
        raise ValueError(f"{path.name} is corrupt: {error!r}") from error


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
