# SPDX-License-Identifier: GPL-3.0-or-later
"""Which scripts run in which of the real Blenders."""

import blender_suite
from debian_root import ROOTS


def test_every_long_script_is_there():
    there = {path.name for path in blender_suite.SCRIPTS.glob("*.py")}
    assert set(blender_suite.LONG) <= there


def test_every_long_script_runs_in_one_blender():
    taken = [set(blender_suite.LONG) - blender_suite.left_to_others(root.suite) for root in ROOTS]
    assert sorted(script for scripts in taken for script in scripts) == sorted(blender_suite.LONG)


def test_a_blender_without_a_screen_takes_none():
    assert blender_suite.left_to_others("path") == set(blender_suite.LONG)
