# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of filled holes, by the names under which documents have them."""

from collections.abc import Callable

from results import result, short, table


def lengths_table() -> str:
    """Seconds of the processor against the length of a ragged loop."""
    heads = ["edges", "triangles between them alone", "all of it", "new faces", "folds"]
    rows = [
        [
            f"{int(edges):,}",
            f"{short(entry['triangulated'])} s",
            f"{short(entry['filled'])} s",
            f"{entry['faces']:,}",
            str(entry["folds"]),
        ]
        for edges, entry in result("fill_lengths").items()
    ]
    return table(heads, rows)


FILL: dict[str, Callable[[], str]] = {"fill.lengths.table": lengths_table}
