# SPDX-License-Identifier: GPL-3.0-or-later
"""STEP files of many shapes, as Open CASCADE reads them: without gaps, borders where the surface has
them, a solid for each closed part, and the volume of the patches."""

from functools import cache

import control_meshes as meshes
import discrete_fairing as df
import example_meshes
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
