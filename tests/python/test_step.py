# SPDX-License-Identifier: GPL-3.0-or-later
"""STEP files: what Open CASCADE reads back, and how they are written."""

import control_meshes
import discrete_fairing as df
import numpy as np
import pytest
import step_files
from spline_measures import volume

open_cascade = pytest.mark.skipif(step_files.OCP is None, reason=step_files.ABSENT)
CURVED = {"energy": "total_curvature"}


@pytest.fixture(scope="module")
def cube():
    return df.fit_patches(*control_meshes.cube(), **CURVED)


@open_cascade
def test_a_mesh_turned_inside_out_is_a_solid_of_positive_volume(tmp_path):
    points, faces = control_meshes.cube()
    patches = df.fit_patches(points, faces[:, ::-1], levels=4, **CURVED)
    assert volume(patches) < 0
    df.write_step(tmp_path / "a.step", patches, unit="mm")
    read = step_files.read(tmp_path / "a.step")
    assert read.valid
    assert read.volume == pytest.approx(-volume(patches), rel=1e-6)


@open_cascade
@pytest.mark.parametrize(
    ("unit", "millimetres"), [("m", 1000), ("cm", 10), ("in", 25.4), ("ft", 304.8)]
)
def test_units_and_scale(tmp_path, cube, unit, millimetres):
    df.write_step(tmp_path / "a.step", cube, unit=unit, scale=2.5)
    read = step_files.read(tmp_path / "a.step")
    assert read.volume == pytest.approx(volume(cube) * (2.5 * millimetres) ** 3, rel=1e-6)


@open_cascade
def test_several_parts_with_several_shells(tmp_path, cube):
    points, faces = control_meshes.cube()
    twins = df.fit_patches(
        np.concatenate([points, points + 10]), np.concatenate([faces, faces + 8]), levels=3
    )
    assert twins.shell_closed.tolist() == [True, True]
    df.write_step(
        tmp_path / "a.step",
        [cube, twins],
        names=["one", "two"],
        colours=[(1, 0, 0), np.linspace(0, 1, 36).reshape(12, 3)],
    )
    read = step_files.read(tmp_path / "a.step")
    assert (read.solids, read.faces, read.valid) == (3, 18, True)
