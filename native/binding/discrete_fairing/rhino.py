# SPDX-License-Identifier: GPL-3.0-or-later
"""write_3dm(): spline patches as a file of Rhino, by the module rhino3dm where it is installed."""

from __future__ import annotations

import errno
import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .cad_files import Part, cad_parts, require_unit
from .errors import fairing_error
from .patches import SplinePatches, spline_knots
from .whole_files import file_name, whole_file

_UNITS = {"m": "Meters", "cm": "Centimeters", "mm": "Millimeters", "in": "Inches", "ft": "Feet"}
_RHINO = 6  # the oldest that reads the file
_ORDER = 4
_PLAIN = (0, 0, 0, 255)  # of layers, as Rhino begins them


def write_3dm(
    path: str | os.PathLike,
    patches: SplinePatches | Sequence[SplinePatches],
    *,
    unit: str = "m",
    scale: float = 1.0,
    names: str | Sequence[str] | None = None,
    colours: ArrayLike | Sequence[ArrayLike | None] | None = None,
) -> None:
    """Write patches to a file of Rhino 6 and newer: a layer for each part, a surface for each patch.

    Surfaces lie edge to edge; Rhino's command Join makes solids of them. Arguments are those of
    write_step. Needs the module rhino3dm (pip install rhino3dm).

    Raises FairingError BAD_OPTION, MISSING_MODULE without rhino3dm, and OSError where the file
    cannot be written.
    """
    rhino = _rhino()
    if rhino is None:
        raise fairing_error(
            "MISSING_MODULE", "The module rhino3dm is missing: pip install rhino3dm."
        )
    require_unit(unit)
    parts = cad_parts(patches, scale, names, colours)
    name = file_name(path)
    model = rhino.File3dm()
    model.Settings.ModelUnitSystem = getattr(rhino.UnitSystem, _UNITS[unit])
    for part in parts:
        _add(rhino, model, part)
    with whole_file(name) as place:
        if not model.Write(str(place), _RHINO):
            raise OSError(errno.EIO, "rhino3dm could not write all of it; is the disk full?")


def can_write_3dm() -> bool:
    """Whether rhino3dm is there, which write_3dm needs."""
    return _rhino() is not None


def _rhino() -> Any:
    try:
        import rhino3dm
    except ImportError:
        return None
    return rhino3dm


def _add(rhino: Any, model: Any, part: Part) -> None:
    """A layer with the surfaces of a part."""
    patches, colours = part.patches, part.colours
    one = colours if colours is not None and colours.ndim == 1 else None
    layer = model.Layers.AddLayer(part.name, _PLAIN if one is None else _bytes(one))
    for p in range(len(patches)):
        attributes = rhino.ObjectAttributes()
        attributes.Name = part.name
        attributes.LayerIndex = layer
        if colours is not None and colours.ndim == 2:
            attributes.ColorSource = rhino.ObjectColorSource.ColorFromObject
            attributes.ObjectColor = _bytes(colours[p])
        model.Objects.AddSurface(_surface(rhino, patches.net(p)), attributes)


def _surface(rhino: Any, net: np.ndarray) -> Any:
    rows, columns, _ = net.shape
    surface = rhino.NurbsSurface.Create(3, False, _ORDER, _ORDER, rows, columns)
    for knots, count in ((surface.KnotsU, rows), (surface.KnotsV, columns)):
        for k, at in enumerate(
            spline_knots(count - 3)[1:-1].tolist()
        ):  # Rhino has one less at ends
            knots[k] = at
    for i, row in enumerate(net.tolist()):
        for j, (x, y, z) in enumerate(row):
            surface.Points[i, j] = rhino.Point4d(x, y, z, 1.0)
    return surface


def _bytes(colour: np.ndarray) -> tuple[int, ...]:
    return (*np.rint(255 * colour).astype(int).tolist(), 255)
