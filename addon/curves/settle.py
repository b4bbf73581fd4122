# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the control mesh from curves, and moves its free vertices by a first fairing: the surface's
charts are measured on this mesh, and interpolation from the rim alone is a poor start. Reports which parts of the
curves were left out, and where: a sentence each, with the cure.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import core
from ..errors import JobError
from ..triangles import marked
from ..units import Text
from ..words import counted
from .cells import Cells, border_arcs, find_cells
from .control_mesh import ControlMesh, control_mesh
from .crossings import Meeting
from .cubics import Curve, points_at
from .network import Loose, Network, network

_SHOWN = 8  # as warnings
_TOLD = 3  # in an error


def plain(length: float) -> str:
    """The length without a unit, if there is no scene."""
    return f"{length:.4g}"


def place_text(place: np.ndarray, text: Text) -> str:
    return f"({', '.join(text(0.0 if abs(x) < 1e-9 else x) for x in place.tolist())})"


def remarks(network: Network, text: Text = plain) -> list[str]:
    """Remarks on loose ends, near misses, and curves that are no part of the surface."""
    used = {arc.curve for arc in network.arcs}
    said = [_miss(network, miss, text) for miss in network.misses]
    for i, curve in enumerate(network.curves):
        if i not in used:
            said.append(
                f"'{curve.name}' encloses nothing, and was left out. {_nearest(network, i, None, text)}"
            )
    said += [_loose(network, one, text) for one in network.loose if one.curve in used]
    if len(said) > _SHOWN:
        said[_SHOWN:] = [f"There are {len(said) - _SHOWN} more such places."]
    return said


def _miss(network: Network, miss: Meeting, text: Text) -> str:
    first, second = (network.curves[i].name for i in (miss.a, miss.b))
    return (
        f"'{first}' misses '{second}' by {text(miss.distance)} near {place_text(miss.place, text)}: "
        f"move one of them, or raise Snap to {text(1.05 * miss.distance)}."
    )


def _loose(network: Network, one: Loose, text: Text) -> str:
    name = network.curves[one.curve].name
    return (
        f"'{name}' ends loose at {place_text(one.place, text)}: {text(one.length)} of it was left out. "
        f"{_nearest(network, one.curve, one.place, text)}"
    )


def _nearest(network: Network, i: int, place: np.ndarray | None, text: Text) -> str:
    """The nearest curve to a loose place, or to those ends of a curve that meet no other one."""
    curve = network.curves[i]
    others = [(k, _samples(other)) for k, other in enumerate(network.curves) if k != i]
    if not others:
        return "There is no other curve."
    ends = points_at(curve.pieces, np.array([0.0, curve.end])) if place is None else [place]
    gaps = [
        min((float(np.linalg.norm(points - end, axis=1).min()), k) for k, points in others)
        for end in ends
    ]
    loose = [(gap, k) for gap, k in gaps if gap > network.tolerance]
    if not loose:
        return "Draw curves across it."
    gap, k = min(loose)
    return f"'{network.curves[k].name}' is {text(gap)} away from its end: extend it to there, or shorten it."


def _samples(curve: Curve) -> np.ndarray:
    return points_at(curve.pieces, np.linspace(0.0, curve.end, 8 * len(curve.pieces) + 1))


def none_text(network: Network, text: Text = plain) -> str:
    """Why there is no surface; begins with what to do."""
    said = remarks(network, text)
    start = "Draw curves across one another, whose ends lie on others: these enclose nothing. "
    if not network.crossings and len(network.curves) > 1:
        start += f"No two of them come nearer to each other than {text(network.tolerance)} (Snap). "
    return (start + " ".join(said[:_TOLD])).strip()


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
