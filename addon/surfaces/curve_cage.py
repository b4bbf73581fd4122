# SPDX-License-Identifier: GPL-3.0-or-later
"""The control mesh of a surface from curves: an object that keeps its curves and follows them."""

from collections.abc import Hashable, Sequence
from typing import Any, cast

import bpy
import numpy as np
from bpy.props import CollectionProperty, PointerProperty

from ..blender import Context, Mesh, Object, column, current_context
from ..curves.cubics import Curve
from ..curves.settle import Covered, CoverOptions, covered
from ..errors import JobError
from ..fields import hidden, length, switch, whole
from ..mesh.layers import fill_layer, make_layer
from ..mesh.object import linked_object, session_key
from ..mesh.read_curves import read_curves
from ..settings import values_of
from ..units import Text, Units

HOLD = "On Curves"  # a vertex group: strength 1, which fixes vertices, on curves; 0 elsewhere


def _look_again(settings: Any, _context: Context) -> None:
    """An update callback by which Live notices the change of a curve's settings."""
    for curve in (
        curves_of(cast(Any, settings).id_data) if isinstance(settings, FAIRING_PG_curves) else ()
    ):
        curve.update_tag()


class CageSettings:
    """Mix-in of annotations for an operator or a property group."""

    snap: length(
        "Snap",
        "Curves no farther apart than this meet, in scene units; 0: a hundredth of a typical curve's size",
        soft_max=1.0,
        precision=4,
        update=_look_again,
    )
    per_side: whole(
        "Edges per Side",
        "Edges of the control mesh on the shorter sides of cells; more of them follow the curves more closely",
        4,
        min=1,
        max=64,
        soft_max=16,
        update=_look_again,
    )
    closed: switch(
        "Close", "Fills open ends too, as of a tube, and the outside of a sheet", update=_look_again
    )


class FAIRING_PG_curve(bpy.types.PropertyGroup):
    source: PointerProperty(type=bpy.types.Object)


class FAIRING_PG_curves(CageSettings, bpy.types.PropertyGroup):
    """For a control mesh: the curves that it is made from. For a curve: how surfaces cross it."""

    curves: CollectionProperty(type=FAIRING_PG_curve)
    remarks: hidden("Remarks", "Which curves were not used, and where, one a line")
    counts: hidden("Counts", "Edges on each arc of the network, numbers with spaces between")
    sharp: switch(
        "Sharp",
        "The surface has a sharp edge along this curve, and is smooth across all others",
        update=lambda group, _context: group.id_data.update_tag(),
    )


def curves_of(cage: Object) -> list[Object]:
    """The curve objects of `cage` that still exist; empty for other objects."""
    found = (cast(Object | None, one.source) for one in cage.discrete_fairing_curves.curves)
    return [one for one in found if one is not None and one.users_scene]


def is_cage(cage: Object | None) -> bool:
    return cage is not None and bool(cage.discrete_fairing_curves.curves)


def watched(cage: Object) -> list[Any]:
    """Data-blocks whose changes affect `cage`."""
    return [block for one in curves_of(cage) for block in (one, one.data)]


def made_of(cage: Object) -> tuple[list[np.ndarray], Hashable]:
    """All data that its mesh depends on, for comparison after a change."""
    curves = _read(curves_of(cage))
    return [curve.pieces for curve in curves], (
        _options(cage.discrete_fairing_curves),
        tuple(curve.sharp for curve in curves),
    )


def new_cage(
    context: Context, name: str, sources: Sequence[Object], settings: Any
) -> tuple[Object, Covered]:
    """A new object beside the curves, and its network; raises JobError with the reason."""
    curves = _read(sources)
    found = covered(curves, _options(settings), text=_text(curves))
    cage = linked_object(context, bpy.data.meshes.new(name))
    group = cage.discrete_fairing_curves
    for setting in CageSettings.__annotations__:
        setattr(group, setting, getattr(settings, setting))
    for source in sources:
        group.curves.add().source = source
    _fill(cage, found)
    return cage, found


def follow(cage: Object) -> Covered:
    """Updates its mesh after a change of its curves; raises JobError with the reason."""
    sources = curves_of(cage)
    if not sources:
        raise JobError(f"Undo, or choose another source. The curves of '{cage.name}' were deleted.")
    if cage.mode == "EDIT":
        raise JobError(
            f"Leave Edit Mode (Tab): '{cage.name}' is being edited, but follows its curves."
        )
    group, curves = cage.discrete_fairing_curves, _read(sources)
    found = covered(curves, _options(group), _counts(group), _text(curves))
    _fill(cage, found)
    return found


def _text(curves: Sequence[Curve]) -> Text:
    """A function that writes lengths in the unit that suits the most distant point of the curves."""
    far = max((float(np.abs(curve.pieces).max(initial=0.0)) for curve in curves), default=0.0)
    return Units.of(current_context().scene).lengths(far, digits=4)


def _read(sources: Sequence[Object]) -> list[Curve]:
    return [curve for source in sources for curve in read_curves(source)]


def _options(settings: Any) -> CoverOptions:
    return values_of(CoverOptions, settings)


def remarks_of(cage: Object) -> list[str]:
    """Curves and parts that were ignored when the mesh was made, a sentence each."""
    return cage.discrete_fairing_curves.remarks.splitlines()


def _counts(group: FAIRING_PG_curves) -> np.ndarray | None:
    """The counts, or None if the file has invalid ones."""
    words = group.counts.split()
    if not all(word.isascii() and word.isdecimal() and len(word) < 6 for word in words):
        return None
    return np.array(words, int)


def _fill(cage: Object, found: Covered) -> None:
    mesh, made = cage.data, found.mesh
    cage.discrete_fairing_curves.remarks = "\n".join(found.remarks)
    cage.discrete_fairing_curves.counts = " ".join(map(str, made.counts.tolist()))
    if not _has_faces(mesh, made.faces):
        mesh.clear_geometry()
        mesh.from_pydata(np.zeros_like(made.points), [], made.faces.tolist())
        groups = cage.vertex_groups
        group = groups.get(HOLD) or groups.new(name=HOLD)
        group.add(np.flatnonzero(made.held).tolist(), 1.0, "REPLACE")
    mesh.vertices.foreach_set("co", made.points.astype(np.float32).ravel())
    ends = column(mesh.edges, "vertices", np.int32, 2)
    keys = np.sort(ends, axis=1) @ (len(made.points), 1)
    creased = np.isin(keys, np.sort(made.sharp, axis=1) @ (len(made.points), 1))
    if creased.any() or "crease_edge" in mesh.attributes:
        fill_layer(make_layer(mesh, "crease_edge", "FLOAT", "EDGE"), creased)
    mesh.update()


def _has_faces(mesh: Mesh, faces: np.ndarray) -> bool:
    if len(mesh.loops) != faces.size or len(mesh.polygons) != len(faces):
        return False
    return np.array_equal(column(mesh.loops, "vertex_index", np.int32), faces.ravel())


def keys(blocks: Sequence[Any]) -> set[int]:
    return {session_key(block) for block in blocks}


ATTACHED = ((bpy.types.Object, "discrete_fairing_curves", FAIRING_PG_curves),)
