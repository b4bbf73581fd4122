# SPDX-License-Identifier: GPL-3.0-or-later
"""A scan made into a closed surface, in its own mesh."""

from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from . import core, errors
from .blender import Context, Object
from .check.defects import as_dicts, store_defects
from .check.holes import listed
from .mesh.read import control_mesh, read_mesh
from .mesh.timed_run import TimedRun
from .mesh.write_cleaned import Cleaned, write_cleaned
from .units import Units

# what can be turned off: name, label, what it does
STEPS = (
    (
        "mend",
        "Bad Faces",
        "Removes duplicate faces, faces without area and vertices without a face",
    ),
    (
        "join",
        "Join Borders",
        "Joins border edges that lie on one another, and cuts those with vertices on them",
    ),
    ("fins", "Fins", "Removes sheets that are attached to an edge of the surface"),
    ("normals", "Normals", "Flips faces that point the wrong way"),
    (
        "inner",
        "Inner Parts",
        "Removes parts inside others; hollows stay",
    ),
    ("pinched", "Pinched Vertices", "Separates parts that touch in a vertex or an edge"),
    (
        "spikes",
        "Spikes",
        "Flattens tips higher than 1.6 edges; creased and sharp ones stay",
    ),
    ("folds", "Folds", "Flattens faces that point away from all faces around"),
    ("fill", "Holes", "Fills holes with a surface that continues the faces around"),
)


@dataclass(frozen=True)
class CleanOptions:
    """Arguments of discrete_fairing.clean."""

    steps: dict[str, bool]
    islands: float
    largest: float
    noise: int | str  # passes, or "auto"


class CleanJob(TimedRun):
    """One object: read, cleaned on any thread, then written."""

    kind, again = "CLEAN", "Run Clean Scan"

    def __init__(self, context: Context, target: Object, options: CleanOptions) -> None:
        self._options, self._units = options, Units.of(context.scene)
        with self._reading(context, target):
            pass
        self.triangles = int((self.arrays.face_sizes - 2).sum())

    def _compute(self, watchers: dict[str, Any]) -> None:
        arrays = self.arrays
        with errors.explained(self.name, errors.WITHOUT_MENDING):
            self.result = core.module().clean(
                self.shape.of(arrays.positions),
                (arrays.corners.astype(np.int64), arrays.offsets.astype(np.int64)),
                islands=self._options.islands,
                largest=self._options.largest,
                noise=self._options.noise,
                fixed=_marked(arrays),
                **self._options.steps,
                **watchers,
            )

    def apply(self, context: Context) -> list[str]:
        """Writes the mesh; what was done, a sentence each, the last of which says how it ended."""
        target, found = cast(Object, self.reference.find()), self.result
        origin = found.vertex_origin[found.vertex_origin >= 0]
        sent = self.shape.of(self.arrays.positions)[origin]
        flat = isinstance(found.faces, tuple)
        corners = found.faces[0] if flat else found.faces.ravel()
        offsets = found.faces[1] if flat else np.arange(len(found.faces) + 1) * 3
        made = Cleaned(
            self.shape.back(found.vertices, sent, self.arrays.positions[origin]),
            found.vertices,
            corners,
            offsets,
            found.vertex_origin,
            found.face_origin,
            found.corner_origin,
        )
        said = [act.text[:1].upper() + act.text[1:] for act in found.done] or ["Nothing to do"]
        said.append(self._end())
        if found.done:
            write_cleaned(target, self.arrays, made)
        with control_mesh(context, target) as mesh:
            arrays = read_mesh(mesh)
        store_defects(context, target, self._left(arrays, made), listed(arrays, self.shape), said)
        self.note()
        return said

    def _end(self) -> str:
        found = self.result
        if found.watertight:
            begin = f"Watertight: yes; volume {self._units.volume(found.volume)}"
        else:
            begin = "Watertight: no"
        left = "; ".join(errors.what(defect).rstrip(".") for defect in as_dicts(found.left))
        return f"{begin}; left: {left or 'nothing'}"

    def _left(self, arrays: core.ControlArrays, made: Cleaned) -> list[dict[str, Any]]:
        """What is left, its elements as the mesh numbers them now."""
        found = as_dicts(self.result.left)
        vertex, face = _numbers(arrays, made)
        for defect in found:
            if defect["kind"] == "face":
                ids = [face.get(frozenset(made.corners[made.offsets[f] : made.offsets[f + 1]].tolist())) for f in defect["elements"]]  # fmt: skip
                defect["elements"] = [i for i in ids if i is not None]
            elif defect["kind"] == "vertex":
                defect["elements"] = vertex[defect["elements"]].tolist()
            elif defect["kind"] == "edge":
                defect["elements"] = vertex[np.array(defect["elements"])].tolist()
        return found


def _numbers(
    arrays: core.ControlArrays, made: Cleaned
) -> tuple[np.ndarray, dict[frozenset[int], int]]:
    """(N,) the vertex of the mesh now that each is; and by its vertices as they were made the face that
    it is. Places tell: BMesh numbers what it makes on its own.
    """
    order = {tuple(p): i for i, p in enumerate(arrays.positions.astype(np.float32).tolist())}
    places = made.positions.astype(np.float32).tolist()
    vertex = np.array([order.get(tuple(p), 0) for p in places], np.int64)
    back = np.full(len(arrays.positions), -1)
    back[vertex] = np.arange(len(vertex))
    named = back[arrays.corners].tolist()
    ends = arrays.offsets.tolist()
    faces = {
        frozenset(named[a:b]): f for f, (a, b) in enumerate(zip(ends[:-1], ends[1:], strict=True))
    }
    return vertex, faces


def _marked(arrays: core.ControlArrays) -> np.ndarray:
    """(n,) vertices with a crease, or on edges with one, or on sharp ones: these are meant."""
    found = np.zeros(len(arrays.positions), bool)
    if arrays.vertex_crease is not None:
        found |= arrays.vertex_crease > 0.0
    for marks in (arrays.edge_crease, arrays.sharp_edge):
        if marks is not None:
            found[arrays.edges[marks > 0]] = True
    return found
