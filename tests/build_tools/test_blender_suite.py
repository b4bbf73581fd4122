# SPDX-License-Identifier: GPL-3.0-or-later
"""Which scripts run in which real Blender."""

import blender_suite
from debian_root import ROOTS
from shell import DevError


def test_scripts_that_are_named_are_there():
    there = {path.name for path in blender_suite.SCRIPTS.glob("*.py")}
    assert {*blender_suite.LONG, *blender_suite.TIMED} <= there


def test_every_long_script_runs_in_one_blender():
    taken = [set(blender_suite.LONG) - blender_suite.left_to_others(root) for root in ROOTS]
    assert sorted(script for scripts in taken for script in scripts) == sorted(blender_suite.LONG)


def test_a_blender_that_cannot_be_had_is_one_failure(monkeypatch):
    """The others run all the same."""

    def of_debian(root):
        if root == ROOTS[0]:
            raise DevError("no mirror")
        return blender_suite.RealBlender("5.2.2", root)

    monkeypatch.setattr(blender_suite, "of_debian", of_debian)
    found = blender_suite.in_each(lambda blender: blender_suite.Tally(passed=3))
    bad, *good = (found[root.suite] for root in ROOTS)
    assert (bad.passed, bad.failed, bad.note) == (0, 1, "no mirror")
    assert [(each.passed, each.note) for each in good] == [(3, "Blender 5.2.2")]


def test_each_line_of_a_script_is_a_test():
    text = "PASS test_one 1.25 s\nnoise\nFAIL test_two 0.50 s\nRAN 2\n"
    assert blender_suite.count(1, text, "window_a.py") == blender_suite.Tally(passed=1, failed=1)
