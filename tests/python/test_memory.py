# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory grows as the surface does."""

import control_meshes as meshes
import discrete_fairing as df


def test_levels_quadruple_memory():
    """A triangle costs no more on a finer level."""
    peaks = [
        df.fair(*meshes.cube(), levels, measure=False, relative_residual=1e-2).report["peak_bytes"]
        for levels in (5, 6, 7)
    ]
    assert all(3.5 < fine / coarse < 4.2 for coarse, fine in zip(peaks, peaks[1:]))
