# SPDX-License-Identifier: GPL-3.0-or-later
"""File types that are only read."""

from pathlib import Path

import bpy
import pytest
from cli_runs import imported, run
from scenes import CUBE, EXAMPLES, add, set_edge_attribute

# on the way to glTF and USD and back the axes are turned twice
WRITERS = {
    "cube.blend": lambda path: bpy.ops.wm.save_as_mainfile(filepath=path),
    "cube.glb": lambda path: bpy.ops.export_scene.gltf(
        filepath=path, export_shared_accessors=False
    ),
    "cube.usda": lambda path: bpy.ops.wm.usd_export(filepath=path),
}


@pytest.mark.parametrize("name", WRITERS)
def test_blenders_own_types_are_read(name):
    cube = add("Cube", *CUBE)
    rim = [(1, 3), (3, 7), (7, 5), (5, 1)]
    set_edge_attribute(cube.data, "crease_edge", "FLOAT", rim, 1.0)
    cube.location.x = 5.0
    WRITERS[name](str(Path(name).absolute()))
    assert run(name, "out.obj", "--levels", 1, "--weld", 0, "--quiet") == 0
    points, faces = imported("out.obj")
    # of quads, or of the two triangles that glTF has of each
    assert len(faces) in (24, 48) and points[:, 0].min() > 3.0
    if name != "cube.glb":  # which has no creases
        top = points[points[:, 2] > points[:, 2].max() - 1e-6]
        assert len(top) >= 8, "a sharp rim stays in its plane"


def test_a_table_of_offsets_is_read(capfd):
    assert run(EXAMPLES / "offsets_yacht.tsv", "hull.obj", "--levels", 1, "--quiet") == 0
    assert imported("hull.obj")[0][:, 0].max() == pytest.approx(10.0, abs=1e-5)
    Path("bad.csv").write_text("station (mm),Keel,WL 0\n0,1,2\n1,2,3x\n")
    assert run("bad.csv", "bad.obj", "--quiet") == 1
    assert "Row 3, column 3: '3x' is not a number" in capfd.readouterr().err
