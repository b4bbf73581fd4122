# SPDX-License-Identifier: GPL-3.0-or-later
"""Waves of the rims of thin walls and fins, beside Subdivision Surface: the angle by which a rim turns, once
around, in degrees.
"""

from typing import Any

import from_tests
import table
import thin_models
from from_tests import thin_walls

LEVELS = 3
SETTINGS: dict[str, dict[str, Any]] = {
    "limit": {},
    "Character": {"metric_exponent": 0.45, "pad_size": 0.7},
    "total curvature": {"energy": "total_curvature"},
    "minimum variation": {"energy": "minimum_variation"},
    "limit, Follow 0": {"limit": 0.0},
}


def mug() -> tuple[Any, Any, Any]:
    """The mug of the examples, and its outer lip."""
    mesh = from_tests.modelled().mug()
    around = from_tests.modelled().AROUND
    return (
        mesh.vertices,
        [list(map(int, face)) for face in mesh.faces],
        list(range(7 * around, 8 * around)),
    )


def run() -> dict[str, Any]:
    """Measures all models."""
    result = {}
    for name, make in {"mug": mug, **thin_models.MODELS}.items():
        model = make()
        result[name] = {"Subdivision Surface": thin_walls.of_subdivision(model, LEVELS)}
        for setting, options in SETTINGS.items():
            result[name][setting] = thin_walls.of_surface(
                model, LEVELS, interpolation="limit", **options
            )
    return result


def rims_table(result: dict[str, Any]) -> str:
    """The angles by which rims turn, once around, in degrees."""
    rows = [[name, *(f"{angle:.1f}" for angle in found.values())] for name, found in result.items()]
    return table.markdown(
        [
            "model",
            "Subdivision Surface",
            "thin plate",
            "*Character*",
            "total curvature",
            "minimum variation",
            "thin plate, *Follow* at 0",
        ],
        rows,
    )


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {"rims": rims_table(result)}
