# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of Rhino, read back by rhino3dm where that is installed."""

import sys

import control_meshes
import discrete_fairing as df
import numpy as np
import pytest
from spline_measures import evaluate


@pytest.fixture(scope="module")
def house():
    """Triangles and quads: nets of several sizes."""
    return df.fit_patches(*control_meshes.mixed_house(), insist=True, levels=5)


def read(path):
    rhino = pytest.importorskip("rhino3dm", reason="rhino3dm is not installed")
    return rhino, rhino.File3dm.Read(str(path))


def net(surface):
    points = surface.Points
    return np.array(
        [
            [
                (at.X, at.Y, at.Z, at.W)
                for at in (points.GetControlPoint(i, j) for j in range(points.CountV))
            ]
            for i in range(points.CountU)
        ]
    )


def test_every_control_point_comes_back_to_the_last_bit(tmp_path, house):
    pytest.importorskip("rhino3dm", reason="rhino3dm is not installed")
    df.write_3dm(tmp_path / "a.3dm", house, unit="cm", scale=2.5, names="Größe 面")
    rhino, model = read(tmp_path / "a.3dm")
    assert model.Settings.ModelUnitSystem == rhino.UnitSystem.Centimeters
    assert [layer.Name for layer in model.Layers] == ["Größe 面"]
    surfaces = [item.Geometry for item in model.Objects]
    assert len(surfaces) == len(house)
    for p, surface in enumerate(surfaces):
        assert surface.IsValid and not surface.IsRational
        assert (net(surface)[..., :3] == 2.5 * house.net(p)).all()
        assert (net(surface)[..., 3] == 1).all()
        for knots, spans in zip((surface.KnotsU, surface.KnotsV), house.patch_spans[p]):
            assert list(knots) == df.spline_knots(spans)[1:-1].tolist()


def test_the_surface_is_the_patch(tmp_path, house):
    """Rhino's own evaluation, at corners and in the middle, against that of the patches."""
    pytest.importorskip("rhino3dm", reason="rhino3dm is not installed")
    df.write_3dm(tmp_path / "a.3dm", house)
    _, model = read(tmp_path / "a.3dm")
    t = np.array([0.0, 0.3, 0.5, 1.0])
    for p, item in enumerate(model.Objects):
        own, _ = evaluate(house, p, t, t)
        for i, u in enumerate(t.tolist()):
            for j, v in enumerate(t.tolist()):
                at = item.Geometry.PointAt(u, v)
                assert np.allclose((at.X, at.Y, at.Z), own[i, j], rtol=0, atol=1e-12 * house.size)


def test_parts_are_layers_and_patches_have_their_colours(tmp_path, house):
    pytest.importorskip("rhino3dm", reason="rhino3dm is not installed")
    shades = np.linspace(0, 1, 3 * len(house)).reshape(-1, 3)
    df.write_3dm(
        tmp_path / "a.3dm", [house, house], names=["one", "two"], colours=[(1, 0, 0), shades]
    )
    rhino, model = read(tmp_path / "a.3dm")
    assert [(layer.Name, layer.Color) for layer in model.Layers] == [
        ("one", (255, 0, 0, 255)),
        ("two", (0, 0, 0, 255)),
    ]
    first, second = (
        [item.Attributes for item in model.Objects if item.Attributes.LayerIndex == k]
        for k in (0, 1)
    )
    assert len(first) == len(second) == len(house)
    assert {item.ColorSource for item in first} == {rhino.ObjectColorSource.ColorFromLayer}
    assert {item.ColorSource for item in second} == {rhino.ObjectColorSource.ColorFromObject}
    found = np.array([item.ObjectColor[:3] for item in second]) / 255
    assert np.allclose(found, shades, atol=0.5 / 255 + 1e-9)


def test_without_rhino3dm_it_says_what_to_install(tmp_path, house, monkeypatch):
    monkeypatch.setitem(sys.modules, "rhino3dm", None)
    assert not df.can_write_3dm()
    with pytest.raises(df.FairingError, match="pip install rhino3dm") as caught:
        df.write_3dm(tmp_path / "a.3dm", house)
    assert caught.value.code == "MISSING_MODULE"
    assert not list(tmp_path.iterdir())
