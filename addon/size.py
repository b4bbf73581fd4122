# SPDX-License-Identifier: GPL-3.0-or-later
"""The size of a result, from the face sizes of the control mesh alone."""

import numpy as np

LARGE = 4_000_000  # triangles; above this the user is asked first
MOST_CORNERS = 2**31 - 1  # Blender counts face corners in 32 bits


def coarse_triangles(face_sizes: np.ndarray) -> int:
    """Triangles of the control mesh: 1 per triangle, 2 per quad, n per larger n-gon."""
    sizes = np.asarray(face_sizes, np.int64)
    return int(np.where(sizes > 4, sizes, sizes - 2).sum())


def triangle_count(face_sizes: np.ndarray, levels: int) -> int:
    """Triangles after `levels` refinements; a control quad counts two for each fine quad."""
    return coarse_triangles(face_sizes) * 4**levels


def count_text(triangles: int) -> str:
    """For example `12,345 triangles`; rounded if large."""
    if triangles >= 100_000_000:
        return f"{triangles / 1e6:,.0f} M triangles"
    if triangles >= 1_000_000:
        return f"{triangles / 1e6:.1f} M triangles"
    return f"{triangles:,} triangles"


def why_too_large(triangles: int) -> str:
    """A sentence if Blender itself cannot store that many faces; else empty."""
    if 3 * triangles > MOST_CORNERS:
        return f"Use fewer levels: {count_text(triangles)} are more than a Blender mesh can hold"
    return ""
