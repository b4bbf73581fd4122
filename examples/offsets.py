# SPDX-License-Identifier: GPL-3.0-or-later
"""Half a hull from its table of offsets: `offsets.csv` beside this file.

In Blender: open this file in the Text Editor and press Run Script; the mesh is named Offsets.
In Python: `vertices, faces = offsets.mesh(offsets.read(PATH))`.

The table is made up, as a yard would send it: half-breadths and heights of eight lines at eleven stations, in millimetres,
taken off with a scatter of 2 mm; three are wrong by 18 mm (`WRONG`). `python offsets.py` writes it again.
"""

import csv
from pathlib import Path

import numpy as np

TABLE = Path(__file__).with_name("offsets.csv")
STATIONS = 11
LINES = ("Keel", "A", "B", "C", "D", "E", "F", "G", "Sheer")
LENGTH, BEAM, DEPTH, RISE = 10_000.0, 1_550.0, 900.0, 350.0  # mm; half the beam, rise of the sheer
SCATTER = 2.0  # mm, standard deviation of each number
# station, line, mm outwards: read off wrong, 18 mm on one side or the other
WRONG = ((3, 5, 18.0), (6, 3, -18.0), (8, 6, 18.0))


def read(path: Path = TABLE) -> np.ndarray:
    """(stations, lines, 3) metres: station, half-breadth, height."""
    with path.open(newline="") as file:
        rows = [row for row in csv.reader(file) if row and not row[0].startswith("#")]
    places = {}
    for line, what, *numbers in rows[1:]:
        places[line, what] = np.array(numbers, float)
    stations = np.array(rows[0][2:], float)
    lines = list(dict.fromkeys(line for line, _ in places))
    points = [
        np.stack([stations, places[line, "half-breadth"], places[line, "height"]], axis=1)
        for line in lines
    ]
    return np.stack(points, axis=1) / 1000.0


def mesh(offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3), station by station from the keel up, and quads (m, 4) whose normals point outwards."""
    stations, lines = offsets.shape[:2]
    at = np.arange(stations * lines).reshape(stations, lines)
    quads = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=2)
    return offsets.reshape(-1, 3), quads.reshape(-1, 4)


def fair_hull() -> np.ndarray:
    """(stations, lines, 3) mm: the true hull of the table, half ellipses between the keel and the sheer."""
    x = np.linspace(0.0, 1.0, STATIONS)[:, None]
    t = 0.5 * np.pi * np.linspace(0.0, 1.0, len(LINES))[None, :]
    along = 1.0 - np.abs(2.0 * x - 1.0 - 0.1) ** 2.4 / 1.1**2.4 * 0.82
    bottom = -DEPTH * (1.0 - (2.0 * x - 1.0) ** 2 * 0.75)
    sheer = RISE * (2.0 * x - 0.9) ** 2 + 250.0
    breadth = BEAM * along * np.sin(t)
    height = sheer + (bottom - sheer) * np.cos(t)
    return np.stack([np.broadcast_to(LENGTH * x, breadth.shape), breadth, height], axis=2)


def taken_off(hull: np.ndarray) -> np.ndarray:
    """The measured hull. The keel is put into the middle plane."""
    rng = np.random.default_rng(1794)
    measured = hull.copy()
    measured[:, :, 1:] += rng.normal(0.0, SCATTER, hull[:, :, 1:].shape)
    measured[:, 0, 1] = 0.0
    for station, line, off in WRONG:
        after, before = hull[station, line + 1], hull[station, line - 1]
        up, out = (after - before)[2], (after - before)[1]
        measured[station, line, 1:] += off * np.array([up, -out]) / np.hypot(up, out)
    return measured


def write(path: Path, offsets: np.ndarray) -> None:
    """`offsets` (stations, lines, 3) in whole millimetres."""
    with path.open("w", newline="") as file:
        file.write("# Offsets of a cruising hull to the moulded surface, in millimetres\r\n")
        rows = csv.writer(file)
        rows.writerow(["line", "station", *map(round, offsets[:, 0, 0])])
        for place, name in ((1, "half-breadth"), (2, "height")):
            for line, numbers in zip(LINES, offsets[:, :, place].T, strict=True):
                rows.writerow([line, name, *map(round, numbers)])


def add_to_scene() -> None:
    """The mesh as an object of the scene, with its own plane of symmetry where the keel is."""
    import bpy

    vertices, faces = mesh(read())
    data = bpy.data.meshes.new("Offsets")
    data.from_pydata(vertices.tolist(), [], faces.tolist())
    bpy.context.collection.objects.link(bpy.data.objects.new("Offsets", data))


if __name__ == "__main__":
    try:
        import bpy  # noqa: F401
    except ImportError:
        write(TABLE, taken_off(fair_hull()))
    else:
        add_to_scene()
