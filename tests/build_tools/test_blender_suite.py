# SPDX-License-Identifier: GPL-3.0-or-later
"""Which scripts run in which of the real Blenders."""

from time import sleep

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


def test_timed_scripts_are_there():
    there = {path.name for path in blender_suite.SCRIPTS.glob("*.py")}
    assert set(blender_suite.TIMED) <= there


def test_two_lanes_never_run_in_one_another(monkeypatch):
    """Each lane has one script at a time, and the results stand in the order of the scripts."""
    busy, most = set(), []

    def run_script(lane, script):
        assert lane not in busy
        busy.add(lane)
        most.append(len(busy))
        sleep(0.01)
        busy.remove(lane)
        return script

    monkeypatch.setattr(blender_suite, "run_script", run_script)
    done = blender_suite.run_in_lanes(["a", "b"], list(range(20)))
    assert done == list(range(20)) and max(most) == 2


def test_each_line_of_a_script_is_a_test():
    text = "PASS test_one 1.25 s\nnoise\nFAIL test_two 0.50 s\nRAN 2\n"
    assert blender_suite.count(1, text, "window_a.py") == blender_suite.Tally(passed=1, failed=1)
