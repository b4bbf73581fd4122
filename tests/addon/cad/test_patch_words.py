# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences about patches."""

from math import radians

import pytest

from addon.cad import words

pytestmark = pytest.mark.plain


def told(off, angle):
    return words.miss_text(off, 0.01, 100.0, radians(angle), radians(0.05), lambda x: f"{x:g} mm")


def test_what_patches_miss_and_what_finer_levels_would_move_are_told_apart():
    assert words.summary(96, 0.003, 0.0412, "mm", radians(0.02), 0.2) == (
        "96 patches, 0.003 mm off a surface known to 0.041 mm, 0.02° at edges, 0.2 mm from the mesh shown"
    )


def test_what_is_missed_is_told_with_the_settings_that_allow_it():
    assert told(0.0512, 0.02) == (
        "At most 0.0512 mm off (0.01 mm is allowed): Tolerance 0.00052 allows it."
    )
    assert told(0.01, 0.561) == (
        "At most 0.56° at edges (0.05° is allowed): Angle 0.57° allows it."
    )
    assert told(0.02, 0.557) == (
        "At most 0.02 mm off (0.01 mm is allowed) and 0.56° at edges (0.05° is allowed):"
        " Tolerance 0.0002 and Angle 0.56° allow it."
    )
    assert told(0.01, 0.05) == ""
