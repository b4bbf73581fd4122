# SPDX-License-Identifier: GPL-3.0-or-later
"""The reported total curvature, against cotangents and angle defects in NumPy, within a tenth."""

import control_meshes as meshes
import discrete_fairing as df
import pytest
import sliver_meshes as slivers
import surface_measures as measures
from bevelled_boxes import bevelled_box

REFINED = {
    name: make for name, make in meshes.ALL.items() if name not in ("grid", "single_triangle")
}
THIN = {
    "hull stretched by 100": lambda: slivers.stretched(meshes.random_hull(400), 100),
    "hull stretched by 3": lambda: slivers.stretched(meshes.random_hull(400), 3),
    "strips across the caps": lambda: slivers.prism(60, 0.2),
    "fans from the rim": lambda: slivers.prism(60, 0.2, slivers.rim_fan),
    "sheet stretched by 100": lambda: slivers.stretched_sheet(200, 100),
    "sheared sheet": lambda: slivers.stretched_sheet(200, 100, sheared=True),
    "bevel": lambda: bevelled_box((1, 0.2, 0.1), 0.002),
}


def both(mesh, levels: int) -> tuple[float, float]:
    """The total curvature that is reported on point forces, and NumPy's."""
    result = df.fair(*mesh, levels, pad_size=0, measure=True)
    own = measures.total_curvature_of_faces(result.vertices, *result.faces)
    return result.report["energy"]["result"]["total_curvature"], own


@pytest.mark.parametrize("name", sorted(REFINED))
def test_agrees_on_refined_surfaces(name):
    reported, own = both(REFINED[name](), 3)
    assert reported == pytest.approx(own, rel=0.1)


@pytest.mark.parametrize("levels", [1, 2])
@pytest.mark.parametrize("name", sorted(THIN))
def test_agrees_on_thin_triangles(name, levels):
    reported, own = both(THIN[name](), levels)
    assert reported == pytest.approx(own, rel=0.1)


@pytest.mark.parametrize("stretch", [1, 3, 100])
def test_agrees_on_the_control_mesh_itself(stretch):
    """Of 400 random points, fits once gave up to a million times the true curvature."""
    reported, own = both(slivers.stretched(meshes.random_hull(400), stretch), 0)
    assert reported == pytest.approx(own, rel=0.1)
