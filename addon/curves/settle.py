# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves in, the control mesh out, its free vertices where a first fairing takes them: the charts of
the surface are measured on this mesh, and a patch that knows its rim alone is a poor one there.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import core
from ..errors import JobError
from ..words import counted
from .cells import Cells, border_arcs, find_cells
from .control_mesh import ControlMesh, control_mesh
from .cubics import Curve
from .network import network
from .words import Text, none_text, plain, remarks

# The second moves vertices by a third of what the first has, a third round by a tenth.
_ROUNDS = 2
MOST_FACES = 50_000  # of the control mesh: more are a slip in Edges


@dataclass(frozen=True)
class CoverOptions:
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
                counted(len(found.network.curves), "curve"),
                counted(found.network.crossings, "crossing"),
                f"{counted(len(found.cells), 'cell')} filled",
            ]
        )


def covered(
    curves: Sequence[Curve],
    options: CoverOptions,
    before: np.ndarray | None = None,
    text: Text = plain,
) -> Covered:
    """The control mesh over the network of `curves`; JobError says why there is none. `before`: the
    numbers of edges that an earlier one had on its arcs. `text` says lengths.
    """
    curves = [curve for curve in curves if len(curve.pieces)]
    if not curves:
        raise JobError("Draw curves that cross each other first. There is none with two points.")
    for curve in curves:
        if not np.isfinite(curve.pieces).all():
            raise JobError(f"Delete the point of '{curve.name}' that has no finite position.")
    found = find_cells(network(curves, options.snap), options.closed)
    if not found.cells:
        raise JobError(none_text(found.network, text))
    mesh = control_mesh(found, options.per_side, before)
    if len(mesh.faces) > MOST_FACES:
        raise JobError(
            "Lower Edges per Side, or leave out very short or very long curves. The control mesh would "
            f"have {len(mesh.faces):,} faces."
        )
    mesh = _settled(mesh)
    mesh = replace(mesh, held=mesh.held | _in_caps(mesh, found))
    return Covered(mesh, found, remarks(found.network, text))


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


def _in_caps(mesh: ControlMesh, found: Cells) -> np.ndarray:
    """(n,) bool: in cells whose rim has no corner and goes on into other cells, such as the closed
    end of a tube. They stay where least bending has taken them: other energies swell them.
    """
    borders = border_arcs(found.cells, found.network.arcs)
    caps = [
        k
        for k, cell in enumerate(found.cells)
        if len(cell.sides) == 1 and borders.isdisjoint(half // 2 for half in cell.halves)
    ]
    inside = np.zeros(len(mesh.points), bool)
    inside[mesh.faces[np.isin(mesh.cell_of_face, caps)]] = True
    return inside
