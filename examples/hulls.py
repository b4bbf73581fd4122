# SPDX-License-Identifier: GPL-3.0-or-later
"""Three hulls as a yard would send them, each in another layout, with three misread offsets.

`offsets_bulb.csv`: half-breadths by waterlines, millimetres, blanks where a waterline misses a station.
`offsets_chine.csv`: keel, chine and sheer by name, metres, semicolons and decimal commas.
`offsets_yacht.tsv`: a list of points, millimetres, tabs. `python hulls.py` writes them again.
"""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
PROFILES = ("Keel", "Sharp keel", "Bulb top")  # of which tables have the heights alone
SCATTER = 1.0  # mm, standard deviation


class Hull(NamedTuple):
    """`points`: {(station, line): (x, y, z)} in millimetres, of the true hull; `wrong`: how far outwards
    three of them were misread.
    """

    file: str
    points: dict[tuple[str, str], tuple[float, float, float]]
    wrong: dict[tuple[str, str], float]


# heights of the waterlines of the hull with a bulb
WATERLINES = {
    "WL 1": -1450.0,
    "WL 2": -1350.0,
    "WL 3": -1170.0,
    "WL 4": -940.0,
    "WL 5": -650.0,
    "WL 6": -330.0,
}
WATERLINES |= {"WL 7": 0.0, "WL 8": 400.0}


def bulb() -> Hull:
    """A round bilge with a bulb before the stem: 12 m."""
    points: dict[tuple[str, str], tuple[float, float, float]] = {}
    for station, x in [("A", -600.0), ("B", -300.0), *((f"{k}", 1200.0 * k) for k in range(11))]:
        low, high = bulb_ends(min(x, 0.0))
        low, high = low if x <= 0 else -1500.0, 800.0 if x >= 0 else high
        points[station, "Keel"] = x, 0.0, low
        for line, z in WATERLINES.items():
            if low < z < high:
                points[station, line] = x, bulb_breadth(x, z), z
        points[station, "Sheer" if x >= 0 else "Bulb top"] = x, bulb_breadth(x, high), high
    points["0", "Bulb top"] = 0.0, 0.0, round(bulb_ends(0.0)[1])  # where it meets the stem
    return Hull(
        "offsets_bulb.csv", points, {("4", "WL 6"): 20, ("7", "WL 4"): -20, ("6", "WL 3"): 20}
    )


def bulb_ends(x: float) -> tuple[float, float]:
    """Heights of the bulb in the middle."""
    high = 420.0 * np.sqrt(1.0 - ((x - 400.0) / 1300.0) ** 2)
    return -940.0 - high, -940.0 + high


def bulb_breadth(x: float, z: float) -> float:
    along = max(0.0, 1.0 - abs(x / 6000.0 - 1.0) ** 2.4)
    depth = np.clip((z + 1500.0) / 1500.0, 0.0, 1.0)
    hull = 1100.0 * along * np.sqrt(depth * (2.0 - depth)) * (1.0 + 0.05 * max(z, 0.0) / 800.0)
    inside = 1.0 - ((x - 400.0) / 1300.0) ** 2 - ((z + 940.0) / 420.0) ** 2
    body = 300.0 * np.sqrt(max(0.0, inside))
    return float((hull**3 + body**3) ** (1 / 3))


def chine() -> Hull:
    """A hard chine with a flat transom: 8 m."""
    points = {}
    for k in range(9):
        t = k / 8
        beam, keel = (
            1400.0 * (1.0 - (1.0 - t) ** 2.5) * (1.0 - 0.1 * t**2),
            -500.0 + 900.0 * (1.0 - t) ** 4,
        )
        sheer = 900.0 + 350.0 * (1.0 - t) ** 2
        low = (0.84 * beam, 50.0 - 150.0 * t + 600.0 * (1.0 - t) ** 3)
        ends = {"Sharp keel": (0.0, keel), "Chine": low, "Sheer": (beam, sheer)}
        inner = {"Bottom": ("Sharp keel", "Chine"), "Side": ("Chine", "Sheer")}
        for line in ("Sharp keel", "Bottom", "Chine", "Side", "Sheer"):
            a, b = (ends[name] for name in inner.get(line, (line, line)))
            y, z = 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])
            points[f"{k}", line] = 1000.0 * k, y, z
    return Hull(
        "offsets_chine.csv", points, {("2", "Side"): -20, ("4", "Side"): 20, ("6", "Side"): -20}
    )


def yacht() -> Hull:
    """A sailing yacht with a plumb bow: 10 m."""
    points = {}
    for k in range(11):
        t = k / 10
        beam = 1700.0 * (1.0 - (1.0 - t) ** 2.2) * (1.0 - 0.25 * t**3)
        bottom, sheer = -450.0 * np.sin(np.pi * t**0.8) ** 1.2, 1000.0 - 250.0 * t + 100.0 * t**2
        for number in range(8):
            angle = 0.5 * np.pi * number / 7
            line = "Keel" if number == 0 else "Sheer" if number == 7 else f"L{number}"
            points[f"{k}", line] = (
                1000.0 * k,
                float(beam * np.sin(angle) ** 0.9) if number else 0.0,
                float(sheer + (bottom - sheer) * np.cos(angle)),
            )
    return Hull("offsets_yacht.tsv", points, {("3", "L3"): 18, ("6", "L5"): -18, ("8", "L3"): 18})


HULLS: tuple[Callable[[], Hull], ...] = (bulb, chine, yacht)


def measured(hull: Hull) -> dict[tuple[str, str], tuple[float, float, float]]:
    """The offsets in whole millimetres, with scatter and some misread ones."""
    rng = np.random.default_rng(1794)
    found = {}
    for key, (x, y, z) in hull.points.items():
        noise = rng.normal(0.0, SCATTER, 2)
        off = hull.wrong.get(key, 0.0)
        out = round(y + noise[0] + off) if y else 0
        moves = not key[1].startswith(("WL", *PROFILES)) and y
        found[key] = x, float(out), float(round(z + noise[1] if moves else z))
    return found


def text(hull: Hull) -> str:
    points = measured(hull)
    stations = list(dict.fromkeys(station for station, _ in points))
    lines = sorted(dict.fromkeys(line for _, line in points), key=lambda line: _place(hull, line))
    if hull.file.endswith(".tsv"):
        rows = [["station", "line", "x (mm)", "y", "z"]]
        rows += [[s, n, *(f"{v:g}" for v in place)] for (s, n), place in points.items()]
        return _joined(rows, "\t")
    metres = "chine" in hull.file
    heads = ["station (m)" if metres else "station (mm)", "x"]
    columns = []
    for line in lines:
        axes = (1,) if line.startswith("WL") else (2,) if line in PROFILES else (1, 2)
        names = {1: "half-breadth", 2: "height"}
        heads += [
            line if len(axes) == 1 and line != "Bulb top" else f"{line} {names[a]}" for a in axes
        ]
        columns += [(line, axis) for axis in axes]
    rows = [heads]
    if "bulb" in hull.file:
        rows.append(
            ["height", "", *(f"{WATERLINES[n]:g}" if n in WATERLINES else "" for n, _ in columns)]
        )
    for station in stations:
        x = next(place[0] for key, place in points.items() if key[0] == station)
        row = [station, x, *(points.get((station, line), (None,) * 3)[a] for line, a in columns)]
        rows.append([v if isinstance(v, str) else _number(v, metres) for v in row])
    return _joined(rows, ";" if metres else ",")


def _place(hull: Hull, line: str) -> float:
    """The mean height of a line."""
    return float(np.mean([place[2] for key, place in hull.points.items() if key[1] == line]))


def _number(value: float | None, metres: bool) -> str:
    if value is None:
        return ""
    return f"{value / 1000:g}".replace(".", ",") if metres else f"{value:g}"


def _joined(rows: list[list[str]], separator: str) -> str:
    return "".join(separator.join(row) + "\r\n" for row in rows)


if __name__ == "__main__":
    for make in HULLS:
        with (HERE / make().file).open("w", newline="") as file:
            file.write(text(make()))
