# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/images/pieces/rings.png from benchmarks/results/tables/pieces.rings.md. Needs matplotlib, which nothing else here
does but plot_convergence.py: where .venv has none, the picture stays.
"""

import sys
from pathlib import Path

try:
    from matplotlib import pyplot
except ImportError:
    print("matplotlib is not here: rings.png stays")
    sys.exit(0)

ROOT = Path(__file__).resolve().parent.parent
TABLE = ROOT / "benchmarks" / "results" / "tables" / "pieces.rings.md"
PICTURE = ROOT / "docs" / "images" / "pieces" / "rings.png"
LINES = {"torus, triangles": "-", "sphere, quads": "--", "rough sphere": ":"}
COLOURS = {
    "thin plate": "#1f5a8a",
    "total curvature": "#c2571a",
    "minimum variation": "#3c8a4e",
}


def draw() -> None:
    head, _, *lines = [line.strip("|").split("|") for line in TABLE.read_text("utf-8").splitlines()]
    rings = [int(cell) for cell in head[1:]]
    figure, axes = pyplot.subplots(figsize=(7.2, 4.6), dpi=140)
    for name, *cells in lines:
        energy, mesh = name.strip().split(", ", 1)
        axes.semilogy(
            rings,
            [float(cell) for cell in cells],
            LINES[mesh],
            color=COLOURS[energy],
            marker="o",
            markersize=3.5,
            label=name.strip(),
        )
    axes.semilogy(rings, [5e-3 * 2.6**-r for r in rings], color="#aaaaaa", linewidth=4, zorder=0)
    axes.text(
        rings[-1], 5e-3 * 2.6 ** -(rings[-1] - 0.9), "0.005 / 2.6^r", ha="right", color="#777777"
    )
    axes.set_xlabel("rings r of control faces around each piece")
    axes.set_ylabel("largest difference to the whole / size")
    axes.set_xticks(rings)
    axes.grid(which="major", color="#dddddd")
    axes.legend(fontsize=7, frameon=False)
    figure.tight_layout()
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE)


if __name__ == "__main__":
    draw()
