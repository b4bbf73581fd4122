# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair surfaces: refine a control mesh and place the new vertices so that a bending energy is minimal.

>>> import discrete_fairing as df
>>> result = df.fair(vertices, faces, levels=3)
>>> result.vertices, result.triangles, result.report["energy"]
"""

from ._native import FairingError, Monitor, __version__
from .arrays import predicted_size
from .checking import Defect, check, repair_orientation
from .fairing import fair
from .result import Result
from .solver import Solver

__all__ = [
    "Defect",
    "FairingError",
    "Monitor",
    "Result",
    "Solver",
    "__version__",
    "check",
    "fair",
    "predicted_size",
    "repair_orientation",
]
