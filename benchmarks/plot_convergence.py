# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/images/convergence.png from benchmarks/results/tables/exact.levels.md. Needs matplotlib."""

import sys
from pathlib import Path

try:
    from matplotlib import pyplot
except ImportError:
    print("matplotlib is not here: convergence.png stays")
    sys.exit(0)

ROOT = Path(__file__).resolve().parent.parent
TABLE = ROOT / "benchmarks" / "results" / "tables" / "exact.levels.md"
PICTURE = ROOT / "docs" / "images" / "convergence.png"
COLOURS = {"6×5": "#1f5a8a", "8×6": "#c2571a", "10×8": "#3c8a4e"}
PIECES = [2, 4, 8, 16]  # of a control edge, on levels 1 to 4


def draw() -> None:
    figure, axes = pyplot.subplots(figsize=(7.2, 4.4), dpi=140)
    for line in TABLE.read_text("utf-8").splitlines()[2:]:
        name, held, *errors = [cell.strip() for cell in line.strip("|").split("|")][:6]
        size, kind = name.split()
        if held == "pads":
            axes.loglog(
                PIECES,
                [float(e) for e in errors],
                "-" if kind == "quads" else "--",
                color=COLOURS[size],
                marker="o",
                markersize=4,
                label=f"{size} {kind}",
            )
    axes.loglog(PIECES, [0.16 * n**-2.0 for n in PIECES], color="#bbbbbb", linewidth=4, zorder=0)
    axes.text(8.5, 0.16 * 8.5**-2, "order 2", va="bottom", color="#777777")
    axes.set_xlabel("pieces of a control edge, levels 1 to 4")
    axes.set_ylabel("rms distance from the torus / tube radius")
    axes.set_xticks(PIECES, [str(n) for n in PIECES])
    axes.minorticks_off()
    axes.grid(which="major", color="#dddddd")
    axes.legend(fontsize=8, frameon=False)
    figure.tight_layout()
    figure.savefig(PICTURE)


if __name__ == "__main__":
    draw()
