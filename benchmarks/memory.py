# SPDX-License-Identifier: GPL-3.0-or-later
"""Predicted against actual peak memory, over sizes and shapes: by the run's own ledger and by the
system's."""

from typing import Any

import million
import table

TARGET_BYTES = 250
CASES = {
    f"{kind}, L = {levels}": (kind, size, levels)
    for kind, sizes in {
        "sphere": {2: 40, 3: 20, 4: 10, 6: 3},
        "quad_sphere": {2: 50, 3: 25, 4: 12, 6: 4},
    }.items()
    for levels, size in sizes.items()
}


def run() -> dict[str, Any]:
    """One run a case: memory does not vary."""
    result = {name: million.spawn(case, 0) for name, case in CASES.items()}
    rows = []
    for name, r in result.items():
        n = r["triangles"]
        rows.append(
            [
                name,
                n,
                r["predicted_bytes"] / n,
                r["peak_bytes"] / n,
                r["resident_bytes"] / n,
                r["predicted_bytes"] / r["peak_bytes"],
                r["predicted_bytes"] / r["resident_bytes"],
            ]
        )
    table.show(
        f"Peak memory in bytes a triangle (target {TARGET_BYTES})",
        [
            "mesh",
            "triangles",
            "predicted",
            "ledger",
            "resident",
            "predicted/ledger",
            "predicted/resident",
        ],
        rows,
    )
    return result
