# SPDX-License-Identifier: GPL-3.0-or-later
"""STEP files of many shapes, as Open CASCADE reads them: without gaps, borders where the surface has
them, a solid for each closed part, and the volume of the patches."""

from functools import cache

import control_meshes as meshes
import discrete_fairing as df
import example_meshes
import flat_parts
import numpy as np
import pytest
import step_colours
import step_files
from spline_measures import volume

pytestmark = pytest.mark.skipif(step_files.OCP is None, reason=step_files.ABSENT)

CURVED = {"energy": "total_curvature"}


def made(mesh, levels=5, **options):
    return lambda: (mesh(), {"levels": levels, **options})


def with_creases(make, **options):
    def of():
        mesh, creases = make()
        return mesh, {"levels": 5, "crease_edges": creases, **options}

    return of


CLOSED = [
    pytest.param(made(meshes.cube, **CURVED), id="cube"),
    pytest.param(made(meshes.octahedron, **CURVED), id="octahedron"),
    pytest.param(made(meshes.random_hull, **CURVED), id="random hull"),
    pytest.param(made(meshes.torus, **CURVED), id="Clifford torus"),
    pytest.param(with_creases(example_meshes.hull), id="hull with creases"),
    pytest.param(with_creases(example_meshes.hull, corner_angle=0.1), id="creases with corners"),
    pytest.param(made(example_meshes.branching, **CURVED), id="genus 2"),
    pytest.param(with_creases(meshes.box_with_creases), id="box with creases"),
    pytest.param(made(meshes.mixed_house), id="triangles and quads"),
]
OTHERS = [
    pytest.param(made(meshes.wavy_patch, boundary="linear"), id="kinks of straight borders"),
    pytest.param(made(example_meshes.fender), id="fender with its border"),
    pytest.param(
        made(example_meshes.fender, corner_vertices=[0, 8, 45, 53]), id="fender, corners kept"
    ),
    pytest.param(made(example_meshes.fender, boundary="linear"), id="fender, straight border"),
]


@cache
def fitted(of):
    mesh, options = of()
    return df.fit_patches(*mesh, force=True, **options)


@pytest.mark.parametrize("of", [*CLOSED, *OTHERS])
def test_valid_closed_and_without_gaps(tmp_path, of):
    patches, path = fitted(of), tmp_path / "a.step"
    df.write_step(path, patches, unit="mm", scale=1000)
    read = step_files.read(path)
    assert read.valid and read.tolerance == 1e-7
    assert read.faces == len(patches)
    assert read.solids == patches.shell_closed.sum()
    assert read.shells == len(patches.shell_closed)
    assert read.free_edges == (patches.edge_kind == 2).sum()


@pytest.mark.parametrize("of", CLOSED)
def test_the_volume_is_that_of_the_patches(tmp_path, of):
    patches = fitted(of)
    df.write_step(tmp_path / "a.step", patches, unit="mm")
    known = abs(volume(patches))
    assert step_files.read(tmp_path / "a.step").volume == pytest.approx(known, rel=1e-6)


def test_names_and_colours(tmp_path):
    patches = fitted(CLOSED[0].values[0])
    names = ["a')b", "a',b", "a''b", "'", "');", "\\X2\\0041\\X0\\", "a\nb", "Größe 'a' \\ 面 🙂"]
    shades = np.linspace(0, 1, 18).reshape(6, 3)
    df.write_step(
        tmp_path / "a.step",
        [patches] * len(names),
        names=names,
        colours=[(1, 0.5, 0.25), *[shades] * (len(names) - 1)],
    )
    read = step_colours.names_and_colours(tmp_path / "a.step")
    assert [name for name, _ in read] == names
    assert np.allclose(read[0][1], [(1, 0.5, 0.25)], atol=1e-3)
    for _, found in read[1:]:
        assert np.allclose(found, shades, atol=1e-3)


def flat_comb(teeth=6):
    """A plate with narrow gaps, whose top and bottom are polygons of 26 corners; edges by 30° are creased."""
    line = [(0.0, 0.0), (2.0 * teeth, 0.0)]
    for k in range(teeth - 1, -1, -1):
        line += [(2 * k + x, y) for x, y in ((2, 3), (1.2, 3), (1.2, 1), (0.02, 1))]
    count = len(line)
    points = np.array([(x, y, z) for z in (0.0, 0.5) for x, y in line])
    around = [(k, (k + 1) % count) for k in range(count)]
    faces = [list(range(count))[::-1], list(range(count, 2 * count))]
    faces += [[a, b, b + count, a + count] for a, b in around]
    x, y = np.array(line).T
    return points, faces, abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 4


def test_flat_polygons_are_planes(tmp_path):
    points, faces, solid = flat_comb()
    patches = df.fit_patches(points, faces, levels=5, crease_angle=np.radians(30))
    assert np.array_equal(np.unique(patches.patch_plane), range(len(faces)))
    assert not len(patches.unmet)
    colours = np.zeros((len(patches), 3))
    colours[patches.patch_polygon == 1] = 1, 0, 0
    name = tmp_path / "comb.step"
    mirrored = patches.transformed(np.diag([-1.0, 1, 1, 1]))
    df.write_step(name, [patches, mirrored], unit="mm", colours=[colours, colours])
    read = step_files.read(name)
    assert read.valid and read.solids == 2 and read.faces == 2 * len(patches.written)
    assert len(patches.written) == len(faces)
    assert not read.free_edges
    assert read.volume == pytest.approx(2 * solid, rel=1e-9)
    text = name.read_text()
    assert text.count("=PLANE(") == 2 * len(faces) and "B_SPLINE_SURFACE" not in text


def test_flat_polygons_with_smooth_rims_are_planes(tmp_path):
    patches = df.fit_patches(*flat_parts.chamfered_cylinder(16, ""), interpolation="auto", levels=4)
    name = tmp_path / "can.step"
    df.write_step(name, patches, unit="mm")
    read = step_files.read(name)
    assert read.valid and read.solids == 1 and not read.free_edges and read.tolerance == 1e-7
    assert read.faces == 36 and name.read_text().count("=PLANE(") == 2


@pytest.mark.parametrize("rise, planes, others", [(0.0, 6, 0), (0.2, 5, 4)])
def test_grids_of_flat_quads_between_creases_are_planes(tmp_path, rise, planes, others):
    """The sides of a box, of 2 by 2 quads each; raised in its middle, one is none."""
    index, faces = {}, []
    for axis, end in np.ndindex(3, 2):
        for i, j in np.ndindex(2, 2):
            ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)][:: 1 if end else -1]
            corners = [np.roll([2 * end, a, b], axis) for a, b in ring]
            faces.append([index.setdefault(tuple(at), len(index)) for at in corners])
    points = np.array(list(index), float)
    points[(points == (1, 1, 2)).all(axis=1), 2] += rise
    patches = df.fit_patches(points, faces, levels=3, crease_angle=np.radians(50))
    assert len(patches.written) == planes + others and (others or not len(patches.unmet))
    df.write_step(tmp_path / "a.step", patches, unit="mm")
    read = step_files.read(tmp_path / "a.step")
    assert read.valid and read.solids == 1 and not read.free_edges
    assert (tmp_path / "a.step").read_text().count("=PLANE(") == planes


def test_a_flat_polygon_whose_border_crosses_itself_is_no_plane():
    line = [(0, 0), (2, 0), (2, 1), (1.2, 1), (1.1, -0.2), (1, 1), (0, 1)]
    points = np.array([(x, y, 0.0) for x, y in line])
    faces = [list(range(len(line)))]
    with pytest.raises(df.FairingError, match="folds"):
        df.fit_patches(points, faces, levels=4, boundary="linear")
