# SPDX-License-Identifier: GPL-3.0-or-later
"""Sentences about patches."""

from math import radians

import pytest

from addon.cad import words

pytestmark = pytest.mark.plain


def told(off, angle):
    return words.miss_text(off, 0.01, 100.0, radians(angle), radians(0.05), lambda x: f"{x:g} mm")


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
