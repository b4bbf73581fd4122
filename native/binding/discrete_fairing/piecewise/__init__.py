# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface of any size, piece by piece.

Interpolation makes a surface local: what happens at one control vertex is felt some 2.6 times less
with every ring of control faces. So a piece with a few rings around it, faired alone, is the whole's
surface there, and pieces know nothing of each other.

In the order of the data: `outline` asks the core what is one for the whole; `partition` says which
piece a face belongs to; `cutting` cuts out pieces, with their `settings`; a `piece` fairs itself;
its `part` is what it owns of the surface, whose points a `lattice` numbers; `joining` puts parts
together.
"""

from .cutting import pieces
from .joining import join, largest_jump
from .part import Part
from .piece import Piece

__all__ = ["Part", "Piece", "join", "largest_jump", "pieces"]
