# SPDX-License-Identifier: GPL-3.0-or-later
"""A source with defects: the repairs, their report, and the data that comes along."""

import numpy as np
from live_scenes import live, pull, through
from refined import corner_vertices, values
from scenes import add, again, fair, positions, recompute, snapshot

from addon.memory import recall

# two triangles over the edge 0-1, one below it in two parts with the vertex 4 between, and the
# triangle without area that fills the gap
VERTICES = [(0, 0, 0), (4, 0, 0), (2, 3, 1), (2, -3, 1), (1, 0, 0)]
FACES = [(0, 1, 2), (0, 4, 1), (4, 0, 3), (1, 4, 3), (1, 2, 0)]
SAID = "1 duplicate face dropped, 1 face without area dissolved; Check Mesh shows them."


def add_defective():
    """UVs are the positions; each face has a colour, and each corner its number as an attribute."""
    source = add("Bad", VERTICES, FACES)
    mesh = source.data
    corners = np.array([v for face in FACES for v in face])
    uv = mesh.uv_layers.new(name="Map")
    uv.data.foreach_set("uv", np.array(VERTICES, np.float32)[corners, :2].ravel())
    number = mesh.attributes.new("number", "INT", "FACE")
    number.data.foreach_set("value", np.arange(len(FACES), dtype=np.int32) + 10)
    corner = mesh.attributes.new("corner", "INT", "CORNER")
    corner.data.foreach_set("value", np.arange(len(corners), dtype=np.int32))
    return source


def test_mending_is_the_default_and_leaves_the_source_alone(capfd):
    source = add_defective()
    before = snapshot(source)
    result = fair(levels=2)
    assert snapshot(source) == before
    assert SAID in capfd.readouterr().out
    assert result.discrete_fairing.repair == "MEND"
    acts = recall(result, "report")["repairs"]
    assert [(a["code"], a["elements"]) for a in acts] == [
        ("DUPLICATE_FACE", [4]),
        ("DEGENERATE_FACE", [1]),
    ]
    assert np.array_equal(positions(result.data)[:5], np.array(VERTICES, np.float32))


def test_weld_joins_what_lies_close(capfd):
    """Two quads that share no vertex, a little apart."""
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    points = [(x + 1.01 * k, y, 0.2 * x * k) for k in (0, 1) for x, y in square]
    source = add("Cut", points, [(0, 1, 2, 3), (4, 5, 6, 7)])
    before = snapshot(source)
    apart = fair(levels=1)
    assert len(apart.data.vertices) == 2 * 9 and "merged" not in capfd.readouterr().out
    welded = again(source, levels=1, weld=0.02)
    assert snapshot(source) == before
    used = {v for p in welded.data.polygons for v in p.vertices}
    assert len(welded.data.polygons) == 8 and len(used) == 9 + 6
    assert "2 vertices" in capfd.readouterr().out
    acts = recall(welded, "report")["repairs"]
    assert [(a["code"], a["elements"]) for a in acts] == [("COINCIDENT_VERTICES", [4, 7])]
    assert welded.discrete_fairing.weld == np.float32(0.02)
    welded.discrete_fairing.repair = "REFUSE"  # which does not weld
    recompute()
    assert len(welded.data.vertices) == 2 * 9


def test_uvs_and_attributes_follow():
    add_defective()
    mesh = fair(levels=1).data
    vertices = corner_vertices(mesh)
    own = vertices < len(VERTICES)
    uv = values(mesh, "Map", "vector", 2)
    assert np.allclose(uv[own], np.array(VERTICES)[vertices[own], :2], rtol=0, atol=1e-6)
    assert 4 in vertices[own]
    number = values(mesh, "number", dtype=np.int32)
    assert set(number.tolist()) == {10, 12, 13}
    # each refined corner has the number of a corner of its own face
    face = np.repeat(number - 10, [len(p.vertices) for p in mesh.polygons])
    corner = values(mesh, "corner", dtype=np.int32)
    assert np.array_equal(corner // 3, face)


def test_a_live_surface_of_a_source_with_defects():
    source = add_defective()
    result = fair(levels=2)
    result.discrete_fairing_live.levels = 1
    live(result)
    pull(source, index=2)
    assert through(result, source)
    uv = values(result.data, "Map", "vector", 2)
    assert np.isfinite(uv).all() and uv.any()
