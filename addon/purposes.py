# SPDX-License-Identifier: GPL-3.0-or-later
"""The jobs of Fair for …: each is a shipped preset, or an operator with its own settings.

Benchmarks (jobs, drawn, limits, machine_parts and measured_points in benchmarks/) decide the energy,
borders and tolerance of a job; docs/developers/notes/figures.md has their results.
"""

import ast
from functools import cache
from math import isclose
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parent / "presets"
# the folder of Blender's presets for the operator, which the panel uses too
PRESET_FOLDER = "operator/object.fairing_surface"
_DEFAULT = "Default.py"

# identifier, name, description, number in files
# fmt: off
PURPOSES = (
    ("HULL", "Hull",
     "Boats: through the offsets, or within a tolerance of them; marked edges are chines (Flow Lines)", 0),
    ("PANEL", "Panel",
     "Bonnets, doors, wings: through the points where Subdivision Surface passes; corners stay (Bending)", 1),
    ("MECHANICAL", "Mechanical",
     "Machine parts of few sides: round between sharp edges, which are folds of 30° and more (Bending)", 2),
    ("CHARACTER", "Character",
     "Characters, cases, mugs: where Subdivision Surface passes, and fairer in between (Bending)", 3),
    ("SCAN_PATCH", "Scan Patch",
     "Measured faces: removes the noise of the selected ones, in Object Mode of all; adds no faces", 4),
    ("POINTS", "Points (measured)",
     "Points with an error: eased first, as the shape key Eased, then a surface through them (Bending)", 5),
    ("SCAN_SURFACE", "Scan to Surface",
     "A scan, and a cage drawn over it if there is one: the fairest surface near its points, as a new object", 6),
)
# fmt: on


# words by which Blender's search finds the entries of the menu
TRADES = {
    "HULL": "boats, offsets",
    "PANEL": "bonnets, doors, bodywork",
    "MECHANICAL": "machine parts, turned parts",
    "CHARACTER": "animals, products",
    "SCAN_PATCH": "noise, measured faces",
    "POINTS": "offsets, probes, scatter",
    "SCAN_SURFACE": "reverse engineering, CAD",
}
EASED_FIRST = {"POINTS"}
# jobs on the vertices themselves, so never on those that a modifier makes
OWN_VERTICES = {"HULL", *EASED_FIRST}
# jobs that are operators of their own, not settings of Fair Surface
OPERATORS = {"SCAN_SURFACE": "fairing_fit"}
# settings that may be changed without changing the job
OFFERED = {
    "levels",
    "limit",
    "tolerance",
    "tolerance_unit",
    "mesh_source",
    "copy_modifiers",
    "joint",
}
_DIGITS = 1e-6  # precision of Blender's numbers, which are single


def preset_file(purpose: str) -> Path | None:
    """The preset of a job; None for operators."""
    path = FOLDER / PRESET_FOLDER / f"{stem(purpose)}.py"
    return path if path.is_file() else None


@cache
def preset_values(path: Path) -> dict[str, Any]:
    """A preset's {setting: value}, read, not run; shipped ones are differences from Default."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    default = path.with_name(_DEFAULT)
    return (preset_values(default) if path != default else {}) | {
        node.targets[0].attr: ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute)
    }


def job_of(settings: Any) -> str:
    """The job whose values the `settings` have; empty if none, or if it eases its source."""
    for purpose, *_ in PURPOSES:
        path = preset_file(purpose)
        if (
            path is not None
            and purpose not in EASED_FIRST
            and _serve(settings, preset_values(path))
        ):
            return purpose
    return ""


def _serve(settings: Any, wanted: dict[str, Any]) -> bool:
    for name in wanted.keys() - OFFERED:
        value, own = wanted[name], getattr(settings, name)
        same = isclose(value, own, rel_tol=_DIGITS) if isinstance(value, float) else value == own
        if not same:
            return False
    return True


def name_of_purpose(purpose: str) -> str:
    """`Points (measured)` for POINTS."""
    return next(name for key, name, *_ in PURPOSES if key == purpose)


def stem(purpose: str) -> str:
    """`Scan_Patch` for SCAN_PATCH, the name of its script and its picture."""
    return purpose.title()


def is_shipped(folder: str) -> bool:
    """Whether the presets in a folder are part of the extension."""
    return Path(folder).is_relative_to(FOLDER)
