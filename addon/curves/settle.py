# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves in, the control mesh out, its free vertices where a first fairing takes them: the charts of
the surface are measured on this mesh, and a patch that knows its rim alone is a poor one there.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import core
from ..errors import JobError
from .cells import Cells, find_cells
from .control_mesh import ControlMesh, control_mesh
from .cubics import Curve
from .network import network
from .words import none_text, remarks

# The second moves vertices by a third of what the first has, a third round by a tenth.
_ROUNDS = 2
MOST_FACES = 50_000  # of the control mesh: more are a slip in Edges


@dataclass(frozen=True)
class Wish:
    snap: float = 0.0  # the distance at which curves meet; 0: a hundredth of the usual curve's size
    per_side: int = 4  # edges on the shorter sides of cells; longer ones have more
    closed: bool = False  # whether what looks like the outside of a sheet is a cell, too


@dataclass(frozen=True)
class Covered:
    mesh: ControlMesh
    cells: Cells
    remarks: list[str]  # what did not take part, and where

    @property
    def summary(self) -> str:
        found = self.cells
        return ", ".join(
            [
                _count(len(found.network.curves), "curve"),
                _count(found.network.crossings, "crossing"),
                f"{_count(len(found.cells), 'cell')} filled",
            ]
        )


def covered(curves: Sequence[Curve], wish: Wish, before: np.ndarray | None = None) -> Covered:
    """The control mesh over the network of `curves`; JobError says why there is none. `before`: the
    numbers of edges that an earlier one had on its arcs.
    """
    curves = [curve for curve in curves if len(curve.pieces)]
    if not curves:
        raise JobError("There is no curve with two points. Draw some first.")
    for curve in curves:
        if not np.isfinite(curve.pieces).all():
            raise JobError(f"'{curve.name}' has a point without a proper position. Delete it.")
    found = find_cells(network(curves, wish.snap), wish.closed)
    if not found.cells:
        raise JobError(none_text(found.network))
    mesh = control_mesh(found, wish.per_side, before)
    if len(mesh.faces) > MOST_FACES:
        raise JobError(
            f"The control mesh would have {len(mesh.faces):,} faces. Lower Edges per Side, or leave "
            "out very short or very long curves."
        )
    return Covered(_settled(mesh), found, remarks(found.network))


def _settled(mesh: ControlMesh) -> ControlMesh:
    points, weights = mesh.points, np.where(mesh.held, np.inf, 0.0)
    if mesh.held.all():
        return mesh
    fairing = core.module()
    for _ in range(_ROUNDS):
        try:
            surface = fairing.fair(
                points,
                mesh.faces,
                levels=1,
                energy="thin_plate",
                interpolation="approximate",
                tolerance=0.0,
                weights=weights,
                crease_edges=mesh.sharp,
                measure=False,
            )
        except fairing.FairingError:  # the run to come will say why
            break
        points = np.where(mesh.held[:, None], mesh.points, surface.vertices[: len(points)])
    return replace(mesh, points=points)


def _count(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
