# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of the slowest tests, from the reports that suites leave."""

import os

import durations


def test_the_slowest_of_recent_reports_come_first(tmp_path, monkeypatch):
    monkeypatch.setattr(durations, "REPORTS", tmp_path)
    durations.write_report(tmp_path / "python.xml", [("b", 2.25), ("quick", 0.5), ("a", 30.0)])
    durations.write_report(tmp_path / "window.xml", [("c", 7.0)])
    durations.write_report(tmp_path / "old.xml", [("of another run", 99.0)])
    os.utime(tmp_path / "old.xml", (0, 0))
    assert [line.split() for line in durations.slowest(since=1)[1:]] == [
        ["30.0", "python:", "a"],
        ["7.0", "window:", "c"],
        ["2.2", "python:", "b"],
    ]


def test_only_so_many_are_shown(tmp_path, monkeypatch):
    monkeypatch.setattr(durations, "REPORTS", tmp_path)
    many = [(str(k), float(k)) for k in range(1, 100)]
    durations.write_report(tmp_path / "python.xml", many)
    assert len(durations.slowest(since=1)) == 1 + durations.SHOWN


def test_without_slow_tests_there_is_no_table(tmp_path, monkeypatch):
    monkeypatch.setattr(durations, "REPORTS", tmp_path)
    durations.write_report(tmp_path / "python.xml", [("quick", 0.5)])
    assert durations.slowest(since=1) == []
