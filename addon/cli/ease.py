# SPDX-License-Identifier: GPL-3.0-or-later
"""`--ease` and `--strain` on the command line: ease control meshes before they are faired, and write
tables of their vertices' strain.
"""

import argparse
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from ..blender import Object, current_context
from ..errors import JobError
from ..settings import Settings
from ..strain import table
from ..strain.ease import EaseJob, EaseOptions
from ..strain.measure import StrainJob
from ..strain.strained import Strained
from ..units import digits_of
from .places import Place, tables
from .rna import number

_STIFFNESS = number("a number, 0 or more", lambda value: 0.0 <= value < inf)
_LENGTH = number("a length above 0", lambda value: 0.0 < value < inf)


@dataclass(frozen=True)
class PrepareOptions:
    options: EaseOptions | None  # None: no easing
    tables: tuple[Path, ...] | None  # tables of strain, one an input; None: none are written

    @property
    def runs(self) -> int:
        """Number of runs for each mesh, without fairing it."""
        return (self.options is not None) + (self.tables is not None)


def add_options(parser: argparse.ArgumentParser) -> None:
    group = parser.add_argument_group("measured points")
    group.add_argument(
        "--ease",
        action="store_true",
        help="first remove the scatter of the vertices, by an amount estimated from them [off]",
    )
    group.add_argument(
        "--ease-tolerance",
        type=_LENGTH,
        metavar="LENGTH",
        help="the same with no vertex moved farther than this, in the file's unit; implies --ease",
    )
    group.add_argument(
        "--ease-stiffness",
        type=_STIFFNESS,
        metavar="X",
        help="all vertices as with a batten, whatever their scatter: the larger, the farther they move; implies --ease",
    )
    group.add_argument(
        "--strain",
        metavar="FILE.csv",
        help="write a table of the vertices: how far the surface would move at each if that vertex were released, "
        "and with --ease where it was moved; for several inputs a pattern with {name}",
    )


def options_of(arguments: argparse.Namespace, files: Sequence[Place]) -> PrepareOptions:
    """From the arguments. Raises ValueError for contradictory options, and BadPlaces."""
    bound, stiffness = arguments.ease_tolerance, arguments.ease_stiffness
    if bound is not None and stiffness is not None:
        raise ValueError("--ease-tolerance and --ease-stiffness are two amounts: give one")
    eases = arguments.ease or bound is not None or stiffness is not None
    if eases or arguments.strain is not None:
        named = "--ease" if eases else "--strain"
        for other in ("fill", "clean"):
            if getattr(arguments, other):
                raise ValueError(f"{named} is for fairing, and --{other} does not fair: call twice")
        if arguments.pieces is not None:
            raise ValueError(f"{named} needs the whole mesh and cannot be used with --pieces")
    amount = "TOLERANCE" if bound is not None else "AUTOMATIC" if stiffness is None else "STIFFNESS"
    return PrepareOptions(
        EaseOptions(amount, bound or 0.0, stiffness=stiffness or 0.0) if eases else None,
        tables(arguments.strain, files, arguments.json) if arguments.strain is not None else None,
    )


def shown(prepare: PrepareOptions) -> dict[str, Any]:
    if prepare.options is None:
        return {}
    options = prepare.options
    return {
        "ease": True,
        "ease_tolerance": options.tolerance if options.amount == "TOLERANCE" else None,
        "ease_stiffness": options.stiffness if options.amount == "STIFFNESS" else None,
    }


def prepare(
    source: Object,
    options: PrepareOptions,
    settings: Settings,
    asked: dict[str, Any],
    done: Callable[[], None],
    **watchers: Any,
) -> tuple[dict[str, Any], list[table.Table]]:
    """Measures a mesh's strain and eases it, `done` after each; returns its entry, and a table if wanted.

    `asked`: arguments of the core that replace those made from the settings.
    """
    entry: dict[str, Any] = {}
    strained = places = None
    if options.tables is not None:
        measured = StrainJob(current_context(), source, settings=settings)
        measured.arguments |= asked
        measured.compute(**watchers)
        done()
        strained = measured.result
    if options.options is not None:
        job = EaseJob(current_context(), source, options.options, settings)
        job.arguments |= asked
        job.compute(**watchers)
        places = job.positions
        source.data.vertices.foreach_set("co", np.float32(places).ravel())
        source.data.update()
        done()
        entry["eased"] = _what_moved(job)
    if strained is None:
        return entry, []
    entry["strain"] = _largest(strained)
    return entry, [table.rows(strained.positions, strained.lengths, places, strained.names)]


def require_one(sources: Sequence[Object], prepare: PrepareOptions) -> None:
    """Raises JobError if one table would contain the vertices of several meshes."""
    if prepare.tables is not None and len(sources) > 1:
        raise JobError(
            f"--strain: Give each mesh a file of its own. The table is of one, and this file has {len(sources)}: "
            f"{', '.join(source.name for source in sources)}."
        )


def _largest(strained: Strained) -> dict[str, Any]:
    worst = strained.worst(1).tolist()
    return {
        "largest": float(strained.lengths[worst[0]]) if worst else 0.0,
        "vertex": worst[0] if worst else -1,
        "floor": strained.floor,
        "wrong": strained.wrong.tolist(),
    }


def _what_moved(job: EaseJob) -> dict[str, Any]:
    moves = job.moves
    return {
        "noise": job.result.noise,
        "amount": job.result.amount,
        "moved": int(np.count_nonzero(moves)),
        "largest": float(moves.max(initial=0.0)),
        "vertex": int(np.argmax(moves)) if moves.any() else -1,
        "said": job.said(digits_of),
    }
