# SPDX-License-Identifier: GPL-3.0-or-later
"""How the finest level of a run went, from the core's report."""


def finest(report):
    """The report's last entry on the energies that take several steps; None for the thin plate, which takes one solve."""
    levels = report.get("curvature") or [None]
    return levels[-1]


def has_converged(report):
    """Whether the steps came to their end; the one solve of the thin plate has a warning of its own."""
    level = finest(report)
    return level is None or level["converged"]


def steps(report):
    """How many steps the finest level took, None for the thin plate."""
    level = finest(report)
    return None if level is None else len(level["steps"])


def decrement(report):
    """What the last step still found to gain, None where there was none: its square is a share of the energy."""
    level = finest(report)
    return level["steps"][-1]["decrement"] if level and level["steps"] else None
