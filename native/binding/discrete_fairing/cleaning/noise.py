# SPDX-License-Identifier: GPL-3.0-or-later
"""The step that takes noise off, by denoise()."""

from __future__ import annotations

import numpy as np

from ..denoising import denoised
from .state import State


def without_noise(state: State, fixed: np.ndarray, passes: int) -> tuple[State, int]:
    """With vertices moved as denoise() moves them: by so many `passes`, or for 0 by as much as is found;
    what is `fixed`, (n,) bool, stays. Also how many have moved.
    """
    found = denoised(state.points, state.corners, state.offsets, fixed, None, passes)
    return state.replaced(points=found.vertices), int(np.count_nonzero(found.moves))
