# SPDX-License-Identifier: GPL-3.0-or-later
"""What a surface is for: each purpose is a shipped preset, or an operator with settings of its own.

Which energy, borders and tolerance a purpose has is decided by benchmarks (jobs, drawn, limits,
machine_parts and measured_points in benchmarks/), and told in docs/explanation/comparison.md.
"""

from pathlib import Path

FOLDER = Path(__file__).resolve().parent / "presets"
# where Blender looks for the presets of the operator, which are those of the panel
PRESET_FOLDER = "operator/object.fairing_surface"

# identifier, name, description, number in files
PURPOSES = (
    (
        "HULL",
        "Hull",
        "Boats: through the offsets, or within a tolerance of them; marked edges are chines (Minimum Variation)",
        0,
    ),
    (
        "PANEL",
        "Panel",
        "Bonnets, doors, wings: where Subdivision Surface passes, with calmer reflections; corners stay (Thin Plate)",
        1,
    ),
    (
        "MECHANICAL",
        "Mechanical",
        "Machine parts: round between sharp edges, which are folds of 30° and more (Thin Plate)",
        2,
    ),
    (
        "CHARACTER",
        "Character",
        "Characters, animals: where Subdivision Surface passes, and fairer in between (Thin Plate)",
        3,
    ),
    (
        "SCAN_PATCH",
        "Scan Patch",
        "Measured faces in place: takes the noise off the selected ones, or in Object Mode all, and adds no faces",
        4,
    ),
    (
        "POINTS",
        "Points (measured)",
        "Points with an error: eased first, as the shape key Eased, then a surface through them (Thin Plate)",
        5,
    ),
)


EASED_FIRST = {"POINTS"}


def preset_file(purpose: str) -> Path | None:
    """The script with the settings of a purpose; None for the one that is no new surface."""
    path = FOLDER / PRESET_FOLDER / f"{stem(purpose)}.py"
    return path if path.is_file() else None


def stem(purpose: str) -> str:
    """`Scan_Patch` for SCAN_PATCH: of its script and its picture."""
    return purpose.title()


def is_shipped(folder: str) -> bool:
    """Whether the presets in a folder come with the extension."""
    return Path(folder).is_relative_to(FOLDER)
