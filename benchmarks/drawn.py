# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels and half hulls as drawn: coarse, with rows that turn quickly. Which surface is calm, and which
swings beside a row? The true surface is unknown; Subdivision Surface is the stylist's.
"""

from typing import Any

import discrete_fairing as df
import from_tests
import numpy as np
import rivals
import table
from pads import mean_curvature

LEVELS = 3
OFF_BORDER = 0.2  # cells: nearer to a border or crease nothing is judged
TOLERANCE = 0.02  # edges
SUBDIVISION = {
    "Subdivision Surface": rivals.catmull_clark,
    "cage pushed out": rivals.catmull_clark_through,
}
SETTINGS: dict[str, dict[str, Any]] = {
    "thin plate": {"energy": "thin_plate"},
    "total curvature": {"energy": "total_curvature"},
    "minimum variation": {"energy": "minimum_variation"},
    "minimum variation, near": {"energy": "minimum_variation", "interpolation": "approximate"},
    "thin plate, limit": {"energy": "thin_plate", "interpolation": "limit"},
    "total curvature, limit": {"energy": "total_curvature", "interpolation": "limit"},
    "minimum variation, limit": {"energy": "minimum_variation", "interpolation": "limit"},
}


def roughness(points: np.ndarray, triangles: np.ndarray, judged: np.ndarray) -> float:
    """∫ |grad H|² dS times the area, between points that are `judged`; the same at any size."""
    curvature, edges, weights = mean_curvature(points, triangles)
    inside = judged[edges].all(1)
    change = curvature[edges[:, 0]] - curvature[edges[:, 1]]
    corner = points[triangles]
    across = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    area = np.linalg.norm(across, axis=1).sum() / 2
    return float((weights * change**2)[inside].sum() * area)


def turning(line: np.ndarray) -> float:
    """The sum of the angles of a polyline, in radians."""
    way = np.diff(line, axis=0)
    way /= np.linalg.norm(way, axis=1)[:, None]
    return float(np.arccos(np.clip((way[1:] * way[:-1]).sum(1), -1, 1)).sum())


def swing(points: np.ndarray, places: np.ndarray, sheet: Any) -> float:
    """How much more the surface turns along the inner rows and columns than the cage does, as a share."""
    fine = coarse = 0.0
    for axis in (0, 1):
        for i in range(1, sheet.points.shape[axis] - 1):
            on_line = np.flatnonzero(np.abs(places[:, axis] - i) < 0.01)
            fine += turning(points[on_line[np.argsort(places[on_line, 1 - axis])]])
            coarse += turning(sheet.points.take(i, axis=axis))
    return fine / coarse - 1


def surface(sheet: Any, vertices: np.ndarray, setting: str) -> tuple[np.ndarray, np.ndarray]:
    """Points and triangles about these control vertices."""
    if setting in SUBDIVISION:
        return SUBDIVISION[setting](vertices, sheet.faces, LEVELS, sheet.crease_edges)
    options = dict(SETTINGS[setting])
    if options.get("interpolation") == "approximate":
        corner = vertices[np.array(sheet.faces)]
        options["tolerance"] = (
            TOLERANCE * np.linalg.norm(corner - np.roll(corner, 1, 1), axis=2).mean()
        )
    ours = df.fair(
        vertices,
        sheet.faces,
        LEVELS,
        corner_vertices=sheet.corners,
        crease_edges=sheet.crease_edges or None,
        **options,
    )
    return ours.vertices, ours.triangles.astype(np.int64)


def judged(sheet: Any, setting: str, flat: dict[str, np.ndarray]) -> dict[str, float]:
    """`flat`: rows and columns at which points are, of ours and of Subdivision Surface's."""
    places = flat["theirs" if setting in SUBDIVISION else "ours"]
    points, triangles = surface(sheet, sheet.vertices, setting)
    inside = np.ones(len(points), bool)
    for axis in (0, 1):
        last = sheet.points.shape[axis] - 1
        inside &= np.abs(places[:, axis] - last / 2) < last / 2 - OFF_BORDER
    for row in sheet.creases:
        inside &= np.abs(places[:, 0] - row) > OFF_BORDER
    return {
        "roughness": roughness(points, triangles, inside),
        "swing": swing(points, places, sheet),
    }


def places_of(sheet: Any) -> dict[str, np.ndarray]:
    """A flat grid keeps its rows and columns; points of all surfaces are in the same order."""
    rows, columns = sheet.points.shape[:2]
    grid = np.stack(np.meshgrid(np.arange(rows), np.arange(columns), indexing="ij"), 2)
    vertices = np.concatenate([grid.reshape(-1, 2), np.zeros((rows * columns, 1))], axis=1)
    return {
        "ours": surface(sheet, vertices, "thin plate")[0],
        "theirs": surface(sheet, vertices, "Subdivision Surface")[0],
    }


def run() -> dict[str, Any]:
    """Measures all meshes of examples/panel_meshes.py."""
    meshes = from_tests.drawn_panels()
    result: dict[str, Any] = {}
    for job, models in (("panel", meshes.PANELS), ("hull", meshes.HULLS)):
        for name, make in models.items():
            sheet = make()
            flat = places_of(sheet)
            for setting in (*SUBDIVISION, *SETTINGS):
                found = judged(sheet, setting, flat)
                result.setdefault(job, {}).setdefault(name, {})[setting] = found
    return result


DRAWN = {
    "cage pushed out": "the same, cage pushed out",
    "minimum variation": "minimum variation",
    "minimum variation, near": "*Near*",
    "thin plate": "thin plate",
    "thin plate, limit": "thin plate, *Limit*",
    "total curvature, limit": "total curvature, *Limit*",
    "minimum variation, limit": "minimum variation, *Limit*",
}


def drawn_table(result: dict[str, Any], job: str) -> str:
    """Roughness as a share of Subdivision Surface's, and how much more surfaces turn than the cage."""
    rows = []
    for model, found in result[job].items():
        theirs = found["Subdivision Surface"]
        row = [model, f"{100 * theirs['swing']:.0f} %"]
        for tool in DRAWN:
            ratio = found[tool]["roughness"] / theirs["roughness"]
            row.append(f"{ratio:.2g} · {100 * found[tool]['swing']:.0f} %")
        rows.append(row)
    return table.markdown(["model", "Subdivision Surface", *DRAWN.values()], rows)


def tables(result: dict[str, Any]) -> dict[str, str]:
    """The tables of the documents, by name."""
    return {
        "drawn.panels": drawn_table(result, "panel"),
        "drawn.hulls": drawn_table(result, "hull"),
    }
