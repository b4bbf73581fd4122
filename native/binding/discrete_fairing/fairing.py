# SPDX-License-Identifier: GPL-3.0-or-later
"""fair(): makes the fair surface of a control mesh."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

from numpy.typing import ArrayLike

from . import _native
from .arrays import shape_array
from .errors import written_report
from .halves import Control
from .joints.matching import MatchedBorder
from .options import Settings, native_options
from .result import Result
from .strain import strain_of
from .watching import Progress, check_watchers


def fair(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    levels: int = 3,
    energy: str = "thin_plate",
    *,
    symmetry_plane: str | None = None,
    neighbour: tuple[ArrayLike, Any] | None = None,
    border: ArrayLike | None = None,
    halfway: bool = False,
    shapes: ArrayLike | Sequence[ArrayLike] | None = None,
    strain: bool = False,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
    **settings: Unpack[Settings],
) -> Result:
    """Refine a control mesh 1-to-4 and fair it: the new vertices minimize a bending energy.

    After Kobbelt, *Fairing by Finite Difference Methods* (1997). Neither array is changed. Any
    layout and any float or integer type works.

    Parameters
    ----------
    vertices : (n, 3) float
        Control vertices, in any unit of length.
    faces : (m, 3) or (m, 4) int, a list of polygons, or the pair (corners, offsets) of flat arrays
        Counter-clockwise. Polygons of five and more sides, and quads too concave or warped, are
        split by shape.
    levels : int
        How often every face is refined: a triangle gives 4**levels triangles, a quad 4**levels
        quads.
    energy : "thin_plate", "total_curvature" or "minimum_variation"
        The paper's quadratic energy; the curvature of the surface itself; or its change
        (AllSettings).
    symmetry_plane : "x", "y", "z" or None
        The mesh is half of a symmetric one: at its border in the plane x = 0 (y, z) the surface crosses
        to its mirror image. The result is the half; the report is that of the whole.
    neighbour : tuple
        Vertices and faces of another mesh, refined or not, which the border meets as `joint` says: its
        border is the surface's, and its tangent planes and curvatures there. Faces as `faces`, or
        (triangles, quads) as Result.faces.
    border : (k, 2) int
        Vertex pairs of the border edges that meet the neighbour. None: those whose ends lie on its border
        within a twentieth of their length.
    halfway : bool
        The border meets the mean of both surfaces, so that two meshes that are each the other's neighbour
        share the change. The neighbour is then as it is without a neighbour of its own.
    shapes : (k, n, 3) float, or a list of (n, 3)
        Further positions of the same control vertices, such as shape keys. Their surfaces
        (result.shapes) use the charts and stencils of `vertices`, so the surface is linear in the
        positions.
    strain : bool
        Measure result.strain too, the lengths of strain(); of total curvature those of the thin plate
        through the same vertices.
    progress : callable(fraction, phase)
        Called from this thread some 40 times a second; returning False cancels.
    monitor : Monitor
        For watching and cancelling from another thread.
    **settings
        See discrete_fairing.Settings for their meanings, ranges and defaults.

    Returns
    -------
    Result
        vertices, triangles, faces, shapes, report.

    Raises
    ------
    FairingError
        With `code`, `elements` and a message that says what to do; CANCELLED if cancelled.
    """
    given: dict[str, Any] = {**settings, "levels": levels, "energy": energy}
    check_watchers(progress, monitor)
    control = Control(vertices, faces, given, symmetry_plane)
    others = shape_array(shapes, control.count)
    if control.half:
        others = control.half.shapes(others)
    watch = monitor or _native.Monitor()
    matched = None
    if neighbour is not None:
        matched = MatchedBorder(control, neighbour, border, halfway, len(others))
    strained = strain_of(control, _of_plate(control), watch).lengths if strain else None
    with control.named():
        found = _native.fair(*control.arrays, others, control.options, watch, progress)
        if matched is not None:
            matched.meet(found)
    result = Result(written_report(control.cut(found)))
    result.strain = strained
    return result


def _of_plate(control: Control) -> _native.Options:
    """The options of the thin plate from which total curvature starts; others as they are."""
    if control.settings.get("energy") != "total_curvature":
        return control.options
    return native_options(control.settings | {"energy": "thin_plate"})
