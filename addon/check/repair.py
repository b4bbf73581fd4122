# SPDX-License-Identifier: GPL-3.0-or-later
"""Repairs of the user's own mesh, one for each button: each is a step of Clean Scan by itself."""

from ..blender import Context, Object
from ..cleaning import STEPS, CleanJob, CleanOptions

# by code of a defect: the text of the button, and the step
_REPAIRS = {
    "INCONSISTENT_ORIENTATION": ("Flip Faces", "normals"),
    "COINCIDENT_VERTICES": ("Join Borders", "join"),
    "REPEATED_VERTEX": ("Mend Faces", "mend"),
    "DEGENERATE_FACE": ("Mend Faces", "mend"),
    "ISOLATED_VERTICES": ("Delete Loose", "mend"),
    "DUPLICATE_FACE": ("Delete Extra Faces", "mend"),
    "NONMANIFOLD_EDGE": ("Delete Extra Faces", "fins"),
}


def label(code: str) -> str | None:
    """The text of the button, or None if no step mends this."""
    return _REPAIRS[code][0] if code in _REPAIRS else None


def repair(context: Context, target: Object, code: str) -> None:
    """Mends the defects of this kind; raises JobError."""
    steps = dict.fromkeys((name for name, *_ in STEPS), False) | {_REPAIRS[code][1]: True}
    job = CleanJob(context, target, CleanOptions(steps, islands=0.0, largest=0.0))
    job.compute()
    job.apply(context)
