# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks whether an exporter has written a complete file, since exporters ignore a full disk."""

from pathlib import Path

_BLOCK = 1 << 20


def why_incomplete(path: Path, faces: int, corners: int) -> str:
    """What is missing in a file with so many faces and corners, in a few words; else empty."""
    size = path.stat().st_size if path.exists() else 0
    if not size:
        return "nothing was written"
    checks = {".obj": _obj_has_all, ".ply": _ply_has_all, ".stl": _stl_has_all}
    complete = checks[path.suffix.lower()](path, size, faces, corners)
    return "" if complete else "the file ends too early; is the disk full?"


def _obj_has_all(path: Path, _size: int, faces: int, _corners: int) -> bool:
    found, before = 0, b"\n"
    with path.open("rb") as stream:
        while block := stream.read(_BLOCK):
            text = before + block  # a line may begin in the previous block
            found += text.count(b"\nf ")
            before = text[-2:]
    return found == faces and before.endswith(b"\n")


def _ply_has_all(path: Path, size: int, faces: int, corners: int) -> bool:
    """Checks a binary file of Blender: one byte for the size of each face, then 4 a corner."""
    with path.open("rb") as stream:
        header, vertex_bytes, vertices = 0, 0, 0
        element = b""
        for line in stream:
            header += len(line)
            words = line.split()
            if words[:1] == [b"element"]:
                element = words[1]
                if element == b"vertex":
                    vertices = int(words[2])
            elif words[:1] == [b"property"] and element == b"vertex":
                vertex_bytes += _PLY_BYTES.get(words[1], 0)
            elif words == [b"end_header"]:
                return size >= header + vertices * vertex_bytes + faces + 4 * corners
    return False


_PLY_BYTES = {b"float": 4, b"double": 8, b"uchar": 1, b"int": 4, b"uint": 4, b"short": 2}


def _stl_has_all(path: Path, size: int, _faces: int, _corners: int) -> bool:
    with path.open("rb") as stream:
        head = stream.read(84)
    return len(head) == 84 and size == 84 + 50 * int.from_bytes(head[80:], "little")
