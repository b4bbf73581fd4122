# SPDX-License-Identifier: GPL-3.0-or-later
"""A scan as it comes, made into a closed surface: one step a file."""

from .holes import hole_width, holes_to_fill
from .run import Act, Cleaned, clean

__all__ = ["Act", "Cleaned", "clean", "hole_width", "holes_to_fill"]
