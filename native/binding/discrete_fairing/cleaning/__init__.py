# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps by which clean() makes a closed surface of a raw scan."""

from .holes import hole_width, holes_to_fill
from .left import left_in as left_in  # the add-on uses it
from .run import clean
from .steps import Act, Cleaned

__all__ = ["Act", "Cleaned", "clean", "hole_width", "holes_to_fill"]
