# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the control mesh from curves, and moves its free vertices by a first fairing: the surface's
charts are measured on this mesh, and interpolation from the rim alone is a poor start.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import core
from ..errors import JobError
from ..triangles import marked
from ..words import counted
from .cells import Cells, border_arcs, find_cells
from .control_mesh import ControlMesh, control_mesh
from .cubics import Curve
from .network import network
from .words import Text, none_text, plain, remarks

# The second round moves vertices by a third of the first round's distance, a third round by a tenth.
_ROUNDS = 2
MOST_FACES = 50_000  # of the control mesh; more are a mistake in Edges


@dataclass(frozen=True)
class CoverOptions:
    # the distance at which curves meet; 0: a hundredth of the median size of curves
    snap: float = 0.0
    per_side: int = 4  # edges on the shorter sides of cells; longer sides have more
    closed: bool = False  # whether the walk around the outside of a sheet is a cell too


@dataclass(frozen=True)
class Covered:
    mesh: ControlMesh
    cells: Cells
    remarks: list[str]  # the parts that were left out, and where

    @property
    def summary(self) -> str:
        of, cells = self.cells.network, counted(len(self.cells.cells), "cell")
        return f"{counted(len(of.curves), 'curve')}, {counted(of.crossings, 'crossing')}, {cells} filled"


def covered(
    curves: Sequence[Curve],
    options: CoverOptions,
    before: np.ndarray | None = None,
    text: Text = plain,
) -> Covered:
    """The control mesh over `curves`; JobError without one. `before`: numbers of edges on arcs."""
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
        except fairing.FairingError:  # the run itself will report it
            break
        points = np.where(mesh.held[:, None], mesh.points, surface.vertices[: len(points)])
    return replace(mesh, points=points)


def _in_caps(mesh: ControlMesh, found: Cells) -> np.ndarray:
    """(n,) bool: vertices in cells whose rim has no corner and continues into other cells, such as the
    closed end of a tube. They stay at the positions of least bending, since other energies swell them.
    """
    borders = border_arcs(found.cells, found.network.arcs)
    caps = [
        k
        for k, cell in enumerate(found.cells)
        if len(cell.sides) == 1 and borders.isdisjoint(half // 2 for half in cell.halves)
    ]
    return marked(mesh.faces[np.isin(mesh.cell_of_face, caps)], len(mesh.points))
