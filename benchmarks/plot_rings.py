# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/images/pieces/rings.png from out/bench/piecewise.json. Needs matplotlib, which nothing else
here does: run it with a Python that has it.
"""

import json
import sys
from pathlib import Path

from matplotlib import pyplot

HERE = Path(__file__).resolve().parent
PICTURE = HERE.parent / "docs" / "images" / "pieces" / "rings.png"
LINES = {"torus, triangles": "-", "sphere, quads": "--", "rough sphere": ":"}
COLOURS = {
    "thin_plate": "#1f5a8a",
    "total_curvature": "#c2571a",
    "minimum_variation": "#3c8a4e",
}


def draw(source: Path) -> None:
    entries = json.loads(source.read_text())["result"]["rings"]
    figure, axes = pyplot.subplots(figsize=(7.2, 4.6), dpi=140)
    for energy, mesh in dict.fromkeys((e["energy"], e["mesh"]) for e in entries):
        own = [e for e in entries if (e["energy"], e["mesh"]) == (energy, mesh)]
        axes.semilogy(
            [e["rings"] for e in own],
            [e["difference"] for e in own],
            LINES[mesh],
            color=COLOURS[energy],
            marker="o",
            markersize=3.5,
            label=f"{energy.replace('_', ' ')}, {mesh}",
        )
    rings = sorted({e["rings"] for e in entries})
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
    draw(Path(sys.argv[1]) if sys.argv[1:] else HERE.parent / "out" / "bench" / "piecewise.json")
