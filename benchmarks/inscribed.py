# SPDX-License-Identifier: GPL-3.0-or-later
"""Control meshes with vertices on the unit sphere, which is their surface of least total curvature."""

import from_tests
import numpy as np

meshes = from_tests.small_meshes()


def on_sphere(points: np.ndarray) -> np.ndarray:
    """The same points, moved and scaled so that the sphere through them is the unit sphere."""
    rows = np.concatenate([2 * points, np.ones((len(points), 1))], 1)
    centre = np.linalg.lstsq(rows, (points**2).sum(1), rcond=None)[0][:3]
    radius = np.linalg.norm(points - centre, axis=1)
    assert np.ptp(radius) <= 1e-12 * radius.max()
    return (points - centre) / radius[:, None]


def hull_polygons(points: np.ndarray) -> list[list[int]]:
    """The faces of a convex hull, coplanar triangles joined, counter-clockwise from outside."""
    _, triangles = meshes.hull(points)
    corner = points[triangles]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    height = np.einsum("fi,fi->f", normal, corner[:, 0])
    polygons, done = [], np.zeros(len(triangles), bool)
    for f in range(len(triangles)):
        if done[f]:
            continue
        done |= (normal @ normal[f] > 1 - 1e-9) & (np.abs(height - height[f]) < 1e-9)
        members = np.nonzero(np.abs(points @ normal[f] - height[f]) < 1e-9)[0]
        centre = points[members].mean(0)
        right = points[members[0]] - centre
        up = np.cross(normal[f], right)
        arms = points[members] - centre
        polygons.append(members[np.argsort(np.arctan2(arms @ up, arms @ right))].tolist())
    return polygons


def cut_large(polygons: list[list[int]]) -> list[list[int]]:
    """Polygons of five and more sides as triangles, by ears from alternate sides; no vertex is
    added."""
    faces = []
    for polygon in polygons:
        rest, front = list(polygon), True
        while len(rest) > 4 or (len(polygon) > 4 and len(rest) > 3):
            faces.append([rest[-1], rest[0], rest[1]] if front else [rest[-2], rest[-1], rest[0]])
            rest.pop(0 if front else -1)
            front = not front
        faces.append(rest)
    return faces


def inscribed(points, cut: bool) -> tuple[np.ndarray, list[list[int]]]:
    points = on_sphere(np.asarray(points, float))
    polygons = hull_polygons(points)
    return points, cut_large(polygons) if cut else polygons


def signs(*values: float) -> np.ndarray:
    """All cyclic permutations of these coordinates, with all signs."""
    some = np.stack(np.meshgrid(*[sorted({v, -v}) for v in values], indexing="ij"), -1).reshape(
        -1, 3
    )
    return np.unique(
        np.concatenate([some, some[:, [1, 2, 0]], some[:, [2, 0, 1]]]).round(14), axis=0
    )


def turned(points: np.ndarray, angle: float) -> np.ndarray:
    """The points rotated about the z axis."""
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1.0]])


def cupola(sides: int) -> np.ndarray:
    """A cupola with edges of length 1; its large face lies in z = 0."""
    small, large = 0.5 / np.sin(np.pi / sides), 0.5 / np.sin(np.pi / (2 * sides))
    above = 2 * np.pi / sides * (np.arange(sides) + 0.5)
    below = np.pi / sides * (np.arange(2 * sides) + 0.5)
    top = np.stack([small * np.cos(above), small * np.sin(above), 0 * above], -1)
    base = np.stack([large * np.cos(below), large * np.sin(below), 0 * below], -1)
    top[:, 2] = np.sqrt(1 - ((top[0] - base[0])[:2] ** 2).sum())
    return np.concatenate([top, base])


def upright_icosahedron() -> np.ndarray:
    """An icosahedron with a vertex on the z axis."""
    angle = 2 * np.pi / 5 * np.arange(5)
    ring = np.stack([2 * np.cos(angle), 2 * np.sin(angle), 1 + 0 * angle], -1) / 5**0.5
    return np.concatenate([[[0, 0, 1.0]], ring, -ring, [[0, 0, -1.0]]])


def rotunda() -> np.ndarray:
    """Half an icosidodecahedron; the decagon lies in z = 0."""
    points = upright_icosahedron()
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    middle = np.array([points[[i, j]].mean(0) for i, j in np.argwhere(apart < 1.1) if i < j])
    return middle[middle[:, 2] > -1e-9]


def both_sides(points: np.ndarray) -> np.ndarray:
    """The points with their mirror images in z = 0."""
    return np.concatenate([points, points[points[:, 2] > 1e-9] * [1, 1, -1]])


def rhombicuboctahedron() -> np.ndarray:
    return signs(1, 1, 1 + 2**0.5)


def gyrate_rhombicuboctahedron() -> np.ndarray:
    points = rhombicuboctahedron()
    below = points[:, 2] < -2
    return np.concatenate([points[~below], turned(points[below], np.pi / 4)])


def without(points: np.ndarray, *gone: int) -> np.ndarray:
    return np.delete(points, gone, 0)


JOHNSON = {
    2: lambda: upright_icosahedron()[:6],
    3: lambda: cupola(3),
    4: lambda: cupola(4),
    5: lambda: cupola(5),
    6: rotunda,
    11: lambda: upright_icosahedron()[:11],
    19: lambda: rhombicuboctahedron()[rhombicuboctahedron()[:, 2] > -2],
    27: lambda: both_sides(cupola(3)),
    34: lambda: both_sides(rotunda()),
    37: gyrate_rhombicuboctahedron,
    62: lambda: without(upright_icosahedron(), 0, 8),
    63: lambda: without(upright_icosahedron(), 0, 6, 7),
}


def johnson(number: int, cut: bool = False):
    """Johnson's solid of that number; `cut`: larger faces than quads into triangles, without a
    vertex in the middle."""
    return inscribed(JOHNSON[number](), cut)


def dodecahedron():
    """The dodecahedron with its pentagons cut into triangles."""
    points, pentagons = meshes.dodecahedron()
    return points, cut_large(pentagons)


NAMED = from_tests.solids() | {"dodecahedron_cut": dodecahedron}
NAMED |= {f"J{number}": lambda number=number: johnson(number) for number in JOHNSON}
NAMED |= {
    f"J{number}_cut": lambda number=number: johnson(number, True)
    for number in JOHNSON
    if number not in (3, 27, 37)
}
