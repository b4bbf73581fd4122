# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair surfaces: refine a control mesh and minimize a bending energy of the refined one.

>>> import discrete_fairing as df
>>> result = df.fair(vertices, faces, levels=3)
>>> result.vertices, result.triangles, result.report["energy"]
"""

from . import lattice as lattice  # the add-on uses these two
from . import whole_files as whole_files
from ._native import FairingError, Monitor, __version__
from .cad.fitting import fit_patches
from .cad.patches import SplinePatches, spline_knots
from .cad.step import write_step
from .checking import Defect, check, predicted_size
from .cleaning import Act, Cleaned, clean, hole_width, holes_to_fill
from .denoising import Denoised, denoise
from .easing import Eased, ease
from .fairing import fair
from .flats import find_flats
from .holes.filled import Filled, FilledHole, SkippedHole
from .holes.filling import fill_holes, find_holes, with_islands
from .joints.joint import Joint, joint
from .options import AllSettings, Settings
from .piecewise import Part, Piece, join, pieces
from .result import Result
from .scan_fitting import Fitted, fit
from .solver import Solver
from .strain import Strain, strain

__all__ = [
    "Act",
    "AllSettings",
    "Cleaned",
    "Defect",
    "Denoised",
    "Eased",
    "FairingError",
    "Filled",
    "Fitted",
    "FilledHole",
    "Joint",
    "Monitor",
    "Part",
    "Piece",
    "Result",
    "SkippedHole",
    "Settings",
    "Solver",
    "SplinePatches",
    "Strain",
    "__version__",
    "check",
    "clean",
    "denoise",
    "ease",
    "fair",
    "fill_holes",
    "find_flats",
    "find_holes",
    "fit",
    "fit_patches",
    "hole_width",
    "holes_to_fill",
    "join",
    "joint",
    "pieces",
    "predicted_size",
    "spline_knots",
    "strain",
    "with_islands",
    "write_step",
]
