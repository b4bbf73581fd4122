# SPDX-License-Identifier: GPL-3.0-or-later
"""Any cleaned mesh can be written: old faces with new vertices, fillings of faces of several sizes."""

from collections import Counter

import bpy
import numpy as np
import pytest
from scenes import add, add_group, positions, to_object_mode

from addon.core import module
from addon.mesh.read import control_mesh, read_mesh
from addon.mesh.write_cleaned import Cleaned, write_cleaned

# a row of squares from x = 0 to 4, split into triangles; corners at (x, 0) are 0 … 4, at (x, 1) 5 … 9
POINTS = [(x, y, 0.0) for y in (0.0, 1.0) for x in range(5)]
TRIANGLES = [t for x in range(4) for t in ((x, x + 1, x + 6), (x, x + 6, x + 5))]


def strip():
    target = add("Strip", POINTS, TRIANGLES)
    mesh = target.data
    uv = mesh.uv_layers.new(name="Map")
    for loop in mesh.loops:
        uv.data[loop.index].uv = mesh.vertices[loop.vertex_index].co[:2]
    for polygon in mesh.polygons:
        polygon.material_index = polygon.index
    for edge in mesh.edges:
        edge.use_seam = True
    add_group(target, dict.fromkeys(range(5), 0.5))
    target.shape_key_add(name="Basis")
    for point in target.shape_key_add(name="Up").data:
        point.co.z += 1.0
    return target


def cleaned(new, rows):
    """`new` points follow those of the strip; `rows` are (origin of the face, its vertices, corners' origins)."""
    points = np.array([*POINTS, *new])
    sizes = [len(row[1]) for row in rows]
    return Cleaned(
        points,
        points,
        np.concatenate([row[1] for row in rows]),
        np.append(0, np.cumsum(sizes)),
        np.append(np.arange(len(POINTS)), np.full(len(new), -1)),
        np.array([row[0] for row in rows]),
        np.concatenate([row[2] if len(row) > 2 else [-1] * len(row[1]) for row in rows]),
    )


def old(face, *turn):
    """A face of the strip, as it was; `turn`: the order of its corners."""
    order = list(turn or range(3))
    return face, [TRIANGLES[face][k] for k in order], [3 * face + k for k in order]


def cyclic(corners):
    corners = [tuple(np.round(co, 5).tolist()) for co in corners]
    first = corners.index(min(corners))
    return tuple(corners[first:] + corners[:first])


MESHES = {
    "old faces with a new vertex, which a filling shares": (
        [(0.5, -1.0, 0.0)],
        [(0, [0, 10, 6], [0, 0, 2]), (-1, [10, 1, 6]), *map(old, range(1, 8))],
    ),
    "an old face with a new vertex of its own": (
        [(0.5, -1.0, 0.0)],
        [(0, [0, 10, 1, 6], [0, 1, 1, 2]), *map(old, range(1, 8))],
    ),
    "fillings of triangles and quads that share new vertices": (
        [(4.0, 2.0, 0.0), (3.0, 2.0, 0.0), (2.0, 2.0, 0.0), (3.0, 3.0, 0.0)],
        [
            *map(old, range(8)),
            (-1, [8, 9, 10, 11]),
            (-1, [7, 8, 11]),
            (-1, [7, 11, 12]),
            (-1, [11, 10, 13]),
            (-1, [12, 11, 13]),
        ],
    ),
    "a part with new vertices only": (
        [(0.0, 5.0, 0.0), (1.0, 5.0, 0.0), (1.0, 6.0, 0.0)],
        [*map(old, range(8)), (-1, [10, 11, 12])],
    ),
    "corners in another order, turned or not": (
        [],
        [old(0, 1, 2, 0), old(1, 1, 0, 2), *map(old, range(2, 8))],
    ),
    "a face where another was": (
        [(0.5, -1.0, 0.0)],
        [(0, [0, 10, 6], [0, 0, 2]), (1, [0, 1, 6], [3, 1, 4]), *map(old, range(2, 8))],
    ),
}


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT"])
@pytest.mark.parametrize("name", MESHES)
def test_the_mesh_is_the_cleaned_one_and_has_its_data(name, mode):
    target, made = strip(), cleaned(*MESHES[name])
    with control_mesh(bpy.context, target) as mesh:
        arrays = read_mesh(mesh)
    if mode == "EDIT":
        bpy.ops.object.mode_set(mode="EDIT")
    write_cleaned(target, arrays, made)
    to_object_mode()
    mesh, places = target.data, positions(target.data)
    assert not mesh.validate(verbose=True)
    assert Counter(map(tuple, places.round(5).tolist())) == Counter(
        map(tuple, made.positions[np.unique(made.corners)].round(5).tolist())
    )
    wanted = np.split(made.positions[made.corners], made.offsets[1:-1])
    assert Counter(cyclic(places[list(f.vertices)]) for f in mesh.polygons) == Counter(
        map(cyclic, wanted)
    )
    after = module().arrays.following(made.offsets)
    ends = np.sort(np.stack([made.corners, made.corners[after]], axis=1), axis=1)
    assert len(mesh.edges) == len(np.unique(ends, axis=0))
    origin = {cyclic(its): f for its, f in zip(wanted, made.face_origin.tolist(), strict=True)}
    uv = mesh.uv_layers["Map"].data
    for polygon in mesh.polygons:
        before = origin[cyclic(places[list(polygon.vertices)])]
        if before < 0:
            continue
        assert polygon.material_index == before
        for loop in polygon.loop_indices:
            place = places[mesh.loops[loop].vertex_index]
            if 0.0 <= place[1] <= 1.0:
                assert np.allclose(uv[loop].uv, place[:2], atol=1e-6)
    own = [vertex for vertex in mesh.vertices if tuple(vertex.co) in POINTS]
    assert all(bool(vertex.groups) == (vertex.co.y == 0) for vertex in own)
    up = np.empty(3 * len(places))
    mesh.shape_keys.key_blocks["Up"].data.foreach_get("co", up)
    known = (places[:, 1] >= 0.0) & (places[:, 1] <= 1.0)
    assert np.allclose((up.reshape(-1, 3) - places)[known], (0.0, 0.0, 1.0), atol=1e-6)
    seams = {tuple(sorted(e.vertices)) for e in mesh.edges if e.use_seam}
    assert len(seams) >= 15
