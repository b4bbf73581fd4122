# SPDX-License-Identifier: GPL-3.0-or-later
"""One call of df.fair, and what the tables want of it."""

from typing import Any

import discrete_fairing as df
import numpy as np


def fair(mesh: tuple[np.ndarray, Any], **options: Any) -> dict[str, Any]:
    """The report, with the surface's size as triangles; the surface itself is let go."""
    result = df.fair(*mesh, **options)
    triangles, quads = result.faces
    return {**result.report, "triangles": len(triangles) + 2 * len(quads)}


def finest(report: dict[str, Any]) -> dict[str, Any]:
    """The finest level's entry."""
    return report["levels"][-1]
