# SPDX-License-Identifier: GPL-3.0-or-later
"""Cleans a scan in its own mesh, to a closed surface."""

from typing import Any, cast

import numpy as np

from .. import core, errors
from ..blender import Context, Object
from ..check.defects import as_dicts, listed_holes, store_defects
from ..mesh.read import control_mesh, read_mesh
from ..mesh.timed_run import TimedRun
from ..mesh.write_cleaned import Cleaned, write_cleaned
from ..units import Units

# steps that can be turned off: name, label, description
# fmt: off
STEPS = (
    ("mend", "Bad Faces", "Removes duplicate faces and parts, faces without area and vertices without a face"),
    ("join", "Join Borders", "Joins border edges that lie on one another, and cuts those with vertices on them"),
    ("fins", "Fins", "Removes sheets that are attached to an edge of the surface"),
    ("normals", "Normals", "Flips faces that point the wrong way"),
    ("inner", "Inner Parts", "Removes parts inside others; hollows stay"),
    ("pinched", "Pinched Vertices", "Separates parts that touch in a vertex or an edge"),
    ("spikes", "Spikes", "Flattens tips higher than 1.6 edges; creased and sharp ones stay"),
    ("folds", "Folds", "Flattens faces that point away from all faces around, or cross those beside them"),
    ("fill", "Holes", "Fills holes with a surface that continues the faces around"),
    ("noise", "Noise",
     "Takes noise off, around each vertex as much as the scan there allows: edges and details stay sharp"),
)
# fmt: on


class CleanJob(TimedRun):
    """The cleaning of one object: read, computed on any thread, then written."""

    kind, again = "CLEAN", "Run Clean Scan"

    def __init__(self, context: Context, target: Object, options: dict[str, Any]) -> None:
        """`options`: arguments of discrete_fairing.clean."""
        self._options, self._units = options, Units.of(context.scene)
        with self._reading(context, target):
            pass
        self.triangles = int((self.arrays.face_sizes - 2).sum())

    def _compute(self, watchers: dict[str, Any]) -> None:
        arrays = self.arrays
        with errors.explained(self.name, errors.WITHOUT_MENDING):
            self.result = core.module().clean(
                self.shape.of(arrays.positions),
                (arrays.corners, arrays.offsets),
                fixed=_marked(arrays),
                **self._options,
                **watchers,
            )

    def apply(self, context: Context) -> list[str]:
        """Writes the mesh. Returns sentences on what was done; the last one describes the result."""
        target, found = cast(Object, self.reference.find()), self.result
        origin = found.vertex_origin[found.vertex_origin >= 0]
        sent = self.shape.of(self.arrays.positions)[origin]
        corners, offsets = core.module().arrays.face_arrays(found.faces)
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
        store_defects(context, target, self._left(arrays), listed_holes(arrays, self.shape), said)
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

    def _left(self, arrays: core.ControlArrays) -> list[dict[str, Any]]:
        """The remaining defects, with element ids of the written mesh."""
        if not self.result.left:
            return []
        mesh = self.shape.of(arrays.positions), (arrays.corners, arrays.offsets)
        found = as_dicts(core.module().cleaning.left_in(*mesh))
        said = {defect.code: defect.message for defect in self.result.left}
        return [each | {"message": said.get(each["code"], each["message"])} for each in found]


# by code of a defect: the text of a button, and the step that mends it
_REPAIRS = {
    "INCONSISTENT_ORIENTATION": ("Flip Faces", "normals"),
    "COINCIDENT_VERTICES": ("Join Borders", "join"),
    "REPEATED_VERTEX": ("Mend Faces", "mend"),
    "DEGENERATE_FACE": ("Mend Faces", "mend"),
    "ISOLATED_VERTICES": ("Delete Loose", "mend"),
    "DUPLICATE_FACE": ("Delete Extra Faces", "mend"),
    "NONMANIFOLD_EDGE": ("Delete Extra Faces", "fins"),
}


def repair_label(code: str) -> str:
    """The text of the button that mends such a defect; empty if no step does."""
    return _REPAIRS.get(code, ("", ""))[0]


def repair(context: Context, target: Object, code: str) -> None:
    """Mends the defects of this kind by one step; raises JobError."""
    steps = dict.fromkeys((name for name, *_ in STEPS), False) | {_REPAIRS[code][1]: True}
    job = CleanJob(context, target, {**steps, "islands": 0.0})
    job.compute()
    job.apply(context)


def _marked(arrays: core.ControlArrays) -> np.ndarray:
    """(n,) bool: vertices with a crease, or at an edge with a crease or marked sharp."""
    found = np.zeros(len(arrays.positions), bool)
    if arrays.vertex_crease is not None:
        found |= arrays.vertex_crease > 0.0
    for marks in (arrays.edge_crease, arrays.sharp_edge):
        if marks is not None:
            found[arrays.edges[marks > 0]] = True
    return found
