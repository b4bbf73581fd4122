# SPDX-License-Identifier: GPL-3.0-or-later
"""A surface of any size, piece by piece.

Interpolation makes a surface local: the effect of a control vertex decreases by a factor of about 2.6
with every ring of control faces. So a piece with a few rings around it, faired alone, has the surface of
the whole mesh there, and pieces are independent.

In the order of the data: `outline` asks the core for the decisions about the whole mesh; `cutting` assigns
faces to pieces and cuts these out, with their settings; a `piece` is faired alone and returns its `part`
of the surface, whose points `numbering` has; `joining` joins the parts.
"""

from .cutting import pieces
from .joining import join
from .part import Part
from .piece import Piece

__all__ = ["Part", "Piece", "join", "pieces"]
