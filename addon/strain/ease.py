# SPDX-License-Identifier: GPL-3.0-or-later
"""Eases control vertices: all a little, the worst, or the selected ones."""

from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from .. import core, errors
from ..blender import Context, Mesh, Object
from ..errors import JobError
from ..jobs.in_place import floats
from ..live.switch import look_again
from ..mesh.edited import edited
from ..mesh.shape_keys import EASED, key_positions, put_key
from ..transfer.cut_out import inside
from ..triangles import marked
from . import words
from .measure import PlateRun, knuckle_of


@dataclass(frozen=True)
class EaseOptions:
    amount: str  # AUTOMATIC, TOLERANCE, STIFFNESS, WORST
    tolerance: float = 0.0  # in scene units
    count: int = 1
    use_selection: bool = False  # whether vertices that are not selected stay
    go_on: bool = False  # whether to start from the shape key of an earlier run
    stiffness: float = 0.0  # the amount of df.ease


class _Moving(PlateRun):
    """New positions of the vertices of one source: read, computed on any thread, then written."""

    kind, again = "EASE", "Ease"

    def __init__(self, context: Context, source: Object, go_on: bool = False) -> None:
        """Reads the mesh with the settings of its surface; `go_on`: from an earlier result. Raises
        JobError.
        """

        def start(_mesh: Mesh) -> np.ndarray:
            own = self.arrays.positions
            eased = key_positions(source, EASED, len(own)) if go_on else None
            return own if eased is None else eased

        self._read_plate(context, source, start)

    def _compute(self, watchers: dict[str, Any]) -> None:
        with errors.explained(self.name):
            places = self._run(watchers)
        sent = self._world.positions
        self.moves = np.linalg.norm(places - sent, axis=1)  # (n,) in scene units
        self.positions = self.shape.back(places, sent, self.positions)

    def _run(self, watchers: dict[str, Any]) -> np.ndarray:
        """The new positions, (n, 3) in the world's shape; sets the result."""
        raise NotImplementedError

    @property
    def longest(self) -> float:
        """The longest length reported by a finished job, in scene units."""
        return float(self.moves.max(initial=0.0))


class EaseJob(_Moving):
    """Eases the mesh itself, without its shape keys, by `options`."""

    def __init__(self, context: Context, source: Object, options: EaseOptions) -> None:
        super().__init__(context, source, options.go_on)
        self.knuckle: list[int] = []
        self._options = options
        if options.use_selection and not self.selected.any():
            raise JobError(
                f"{self.name}: Select the vertices that may move in Edit Mode, or switch off Selected "
                "Vertices Only. No vertex is selected."
            )
        keys = source.data.shape_keys
        if keys is not None and not keys.use_relative:
            raise JobError(
                f"{self.name}: Ease a copy. It has absolute shape keys, which are not mixed."
            )

    def _run(self, watchers: dict[str, Any]) -> np.ndarray:
        options, fixed = self._options, None
        if options.use_selection:
            fixed = ~self.selected
        elif options.amount == "WORST":
            fixed = self._on_knuckle(watchers)
        self.result = core.module().ease(
            **core.plate_arguments(self.arguments),
            tolerance=options.tolerance if options.amount == "TOLERANCE" else None,
            most=options.count if options.amount == "WORST" else None,
            amount=options.stiffness if options.amount == "STIFFNESS" else None,
            fixed=fixed,
            **watchers,
        )
        return self.result.vertices

    def _on_knuckle(self, watchers: dict[str, Any]) -> np.ndarray:
        """(n,) bool: vertices in a row that look like a knuckle. They stay until the user selects them."""
        watch = {name: value for name, value in watchers.items() if name == "monitor"}
        arguments = core.plate_arguments(self.arguments)
        found = core.module().strain(**arguments, **watch)
        self.knuckle = knuckle_of(found.excess, self.arrays, self._world.positions)
        return marked(self.knuckle, len(self.positions))

    def said(self, text: words.Text) -> str:
        eased, options = self.result, self._options
        before = eased.strain_before
        if options.amount == "WORST":
            said = words.moved(self.moves, text, self.names)
            if not self.knuckle:
                return said
            asked = words.looks_like_knuckle(self.knuckle, self.names)
            return f"{said}. {asked} Crease Knuckle does; they stay unless you select them"
        if options.amount == "STIFFNESS":
            return words.moved(self.moves, text, self.names)
        if options.amount == "TOLERANCE":
            return words.moved_within(self.moves, options.tolerance, before, text, self.names)
        return words.eased(
            eased.noise, self.moves, before, eased.wrong, eased.floor, text, self.names
        )

    def write_key(self) -> None:
        """Writes a shape key of the source, so that its mesh and its live surfaces stay."""
        source = cast(Object, self.reference.find())
        put_key(source, EASED, self.positions)
        look_again(source)


class EaseSelectedJob(_Moving):
    """Moves selected vertices, in Edit Mode, by `factor` to the surface through all others."""

    kind = "THIN_PLATE"

    def __init__(self, context: Context, source: Object, factor: float) -> None:
        super().__init__(context, source)
        self._factor = factor
        self._free = self.selected & inside(self.arrays, np.ones(len(self.arrays.face_sizes), bool))
        if not self._free.any():
            raise JobError(
                f"{self.name}: Select vertices inside of the mesh. Those on open borders stay."
            )
        if floats(self.arrays, self._free):
            raise JobError(
                f"{self.name}: Leave out some vertices of each part. One is selected whole, so nothing holds it."
            )

    def _run(self, watchers: dict[str, Any]) -> np.ndarray:
        given = core.released_arguments(self.arguments, self._free)
        self.result, sent = core.module().fair(**given, **watchers), self._world.positions
        found = self.result.vertices[: len(sent)]
        return np.where(self._free[:, None], sent + self._factor * (found - sent), sent)

    def said(self, text: words.Text) -> str:
        return words.moved(self.moves, text, self.names)

    def write(self) -> None:
        with edited(cast(Object, self.reference.find())) as bm:
            bm.verts.ensure_lookup_table()
            for index in np.flatnonzero(self.moves).tolist():
                bm.verts[index].co = self.positions[index].tolist()
            bm.normal_update()
