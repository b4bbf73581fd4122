# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads and writes files with Blender's own importers and exporters, in the files' coordinates."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

import bpy

from .. import core
from ..blender import Object, current_context
from .places import FORMATS, file_format

# With the same axes for reading and writing, coordinates in the file are those of the mesh.
_AXES = {"forward_axis": "Y", "up_axis": "Z"}
_BLOCK = 1 << 20


def _append_meshes(filepath: str) -> None:
    """The mesh objects of a .blend file, as stored."""
    libraries: Any = bpy.data.libraries  # its stub has no context manager
    with libraries.load(filepath, link=False) as (there, here):
        here.objects = there.objects
    for found in here.objects:
        if found.type == "MESH":
            current_context().scene.collection.objects.link(found)
        else:
            bpy.data.objects.remove(found)


def _import_usd(filepath: str) -> None:
    importer: Any = bpy.ops.wm.usd_import  # its stub returns None
    importer(filepath=filepath, import_materials=False, import_cameras=False, import_lights=False)


_USD = dict.fromkeys(("usd", "usda", "usdc", "usdz"), _import_usd)
_OFFSETS = dict.fromkeys(("csv", "tsv"), cast(Any, bpy.ops).import_mesh.fairing_offsets)
_GLTF = dict.fromkeys(("glb", "gltf"), cast(Any, bpy.ops.import_scene).gltf)
_IMPORTERS: dict[str, Any] = {
    "obj": bpy.ops.wm.obj_import,
    "ply": bpy.ops.wm.ply_import,
    "stl": bpy.ops.wm.stl_import,
    "blend": _append_meshes,
    **_USD,
    **_OFFSETS,
    **_GLTF,
}


class FileError(Exception):
    """Why a file cannot be read or written, as a sentence."""


def read_file(path: Path) -> list[Object]:
    """The mesh objects of a file, alone in an empty scene without the user's startup file."""
    _readable(path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene: Any = current_context().scene
    scene.unit_settings.system = "NONE"  # coordinates are those of the file, in any unit
    kind = file_format(path)
    axes = _AXES if kind in FORMATS else {}
    try:
        _IMPORTERS[kind](filepath=str(path), **axes)
    except (RuntimeError, OSError) as error:
        raise FileError(f"{path} cannot be read: {_reason(error)}") from error
    found = [o for o in current_context().scene.objects if o.type == "MESH"]
    if not found:
        raise FileError(f"{path} has no mesh that Blender can read.")
    return found


def write_file(path: Path) -> None:
    """Writes the scene to a file and an OBJ's materials to another, or leaves all as it was."""
    with _explained(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        files = core.module().whole_files
        target = files.real_place(path)
        with files.whole_file(path, path.suffix) as part:
            part.write_bytes(b"")  # its error is clearer than those of the exporters
            _export(part)
            materials = part.with_suffix(".mtl")
            if materials.exists():
                files.put(materials, target.with_name(materials.name))


def write_whole(path: Path, write: Callable[[str], None]) -> None:
    """Lets `write` write a complete file or none."""
    with _explained(path):
        path.parent.mkdir(parents=True, exist_ok=True)
        write(str(path))


class _NotWritten(Exception):
    """Why an exporter has not written a complete file."""


@contextmanager
def _explained(path: Path) -> Iterator[None]:
    """A context in which errors of writing become a FileError."""
    try:
        yield
    except (OSError, _NotWritten) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise FileError(f"{path} cannot be written: {reason}.") from error
    except core.module().FairingError as error:
        raise FileError(f"{path} cannot be written: {error}") from error


def _export(path: Path) -> None:
    export: dict[str, Any] = {
        "obj": _write_obj,
        "ply": bpy.ops.wm.ply_export,
        "stl": bpy.ops.wm.stl_export,
    }
    try:
        export[file_format(path)](filepath=str(path), check_existing=False, **_AXES)
    except RuntimeError as error:
        raise _NotWritten(_reason(error).rstrip(".")) from error
    # exporters ignore a full disk, which has no room for another block either
    with path.open("ab") as stream:
        end = stream.tell()
        stream.write(bytes(_BLOCK))
        stream.flush()
        os.fsync(stream.fileno())
        stream.truncate(end)
    if not end:
        raise _NotWritten("nothing was written")


def _write_obj(**arguments: Any) -> set[Any]:
    # without materials, no .mtl file remains
    materials = any(mesh.materials for mesh in bpy.data.meshes)
    export: Any = bpy.ops.wm.obj_export  # its stub returns None
    return export(export_materials=materials, export_colors=True, **arguments)


def _readable(path: Path) -> None:
    """Raises the errors that importers hide or print to the console only."""
    try:
        with path.open("rb") as stream:
            if not stream.read(1):
                raise FileError(f"{path} is empty.")
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror}.") from error


def _reason(error: Exception) -> str:
    return str(error).strip().removeprefix("Error: ")
