# SPDX-License-Identifier: GPL-3.0-or-later
"""Ease Control Mesh: its call of the core, the place of the answer, and the messages."""

from types import SimpleNamespace

import bpy
import discrete_fairing
import numpy as np
import pytest
from dunes import OFF, WRONG, add_dune, dune
from scenes import activate, fair, positions, recompute, refused, shown, snapshot

from addon.mesh.shape_keys import EASED


@pytest.fixture
def core(monkeypatch):
    """Replaces the core's ease: it moves the wrong vertex back and remembers its arguments."""
    asked = {}

    def ease(vertices, faces, *, tolerance=None, most=None, fixed=None, amount=None, **options):
        asked.clear()
        asked.update(options, tolerance=tolerance, most=most, fixed=fixed, vertices=vertices)
        strain = discrete_fairing.strain(vertices, faces, **options)
        moves = np.zeros_like(vertices)
        if fixed is None or not fixed[WRONG]:
            moves[WRONG, 2] = -OFF if tolerance is None else -min(OFF, tolerance)
        return SimpleNamespace(
            vertices=vertices + moves,
            moves=np.linalg.norm(moves, axis=1),
            strain_before=strain.excess,
            wrong=strain.wrong,
            strain_after=strain.excess,
            floor=strain.floor,
            amount=1.0,
            noise=0.01,
            iterations=3,
        )

    monkeypatch.setattr(discrete_fairing, "ease", ease, raising=False)
    return asked


def key(source):
    values = np.empty(3 * len(source.data.vertices), np.float32)
    source.data.shape_keys.key_blocks[EASED].data.foreach_get("co", values)
    return values.reshape(-1, 3)


def eased(**settings):
    assert bpy.ops.object.fairing_ease(**settings) == {"FINISHED"}


def test_the_mesh_stays_and_the_shape_key_has_the_new_places(core):
    source = add_dune()
    before = snapshot(source)
    eased()
    after = snapshot(source)
    assert after[0] == before[0] and after[1:] == before[1:]
    moved = key(source) - np.float32(dune())
    assert moved[WRONG] == pytest.approx([0.0, 0.0, -OFF], abs=1e-6)
    assert not np.delete(moved, WRONG, axis=0).any()
    block = source.data.shape_keys.key_blocks[EASED]
    assert block.value == 1.0 and block.relative_key.name == "Basis"


def test_again_it_is_the_same_key_of_the_same_mesh(core):
    source = add_dune()
    eased()
    eased(amount="TOLERANCE", tolerance=0.02)
    assert list(source.data.shape_keys.key_blocks.keys()) == ["Basis", EASED]
    assert np.allclose(core["vertices"], dune(), atol=1e-6), "of the mesh, not of what was eased"
    assert (key(source) - dune())[WRONG, 2] == pytest.approx(-0.02, abs=1e-5)


def test_or_it_goes_on_from_there(core):
    source = add_dune()
    eased(amount="TOLERANCE", tolerance=0.02)
    eased(amount="TOLERANCE", tolerance=0.03, go_on=True)
    assert (core["vertices"] - dune())[WRONG, 2] == pytest.approx(-0.02, abs=1e-5)
    assert (key(source) - dune())[WRONG, 2] == pytest.approx(-0.05, abs=1e-5)


def test_other_shape_keys_stay(core):
    source = add_dune()
    source.shape_key_add(name="Basis")
    source.shape_key_add(name="Other").value = 0.5
    eased()
    blocks = source.data.shape_keys.key_blocks
    assert list(blocks.keys()) == ["Basis", "Other", EASED] and blocks["Other"].value == 0.5
    assert not (key(source) - np.float32(dune()))[:WRONG].any(), "not as the others mix"
    source.data.shape_keys.use_relative = False
    refused("absolute shape keys", bpy.ops.object.fairing_ease)


def test_what_the_core_is_asked_for(core):
    source = add_dune()
    scene = bpy.context.scene.discrete_fairing
    scene.energy, scene.interpolation, scene.tolerance = "TOTAL_CURVATURE", "APPROXIMATE", 0.3
    scene.use_selection = True
    eased()
    assert core["energy"] == "thin_plate" and core["interpolation"] == "exact"
    assert core["tolerance"] is core["most"] is core["fixed"] is None and "region" not in core
    eased(amount="TOLERANCE", tolerance=0.02, count=5)
    assert core["tolerance"] == pytest.approx(0.02) and core["most"] is None
    source.data.vertices.foreach_set("select", np.arange(63) == WRONG)
    eased(amount="WORST", count=2, tolerance=0.5, use_selection=True)
    assert core["tolerance"] is None and core["most"] == 2
    assert np.flatnonzero(~core["fixed"]).tolist() == [WRONG]
    source.data.vertices.foreach_set("select", np.zeros(63, bool))
    refused("No vertex is selected", bpy.ops.object.fairing_ease, use_selection=True)


def test_lengths_are_those_of_the_world(core):
    source = add_dune()
    source.scale = (1.0, 1.0, 0.5)
    bpy.context.view_layer.update()
    eased(amount="TOLERANCE", tolerance=0.02)
    assert (key(source) - dune())[WRONG, 2] == pytest.approx(-0.04, abs=1e-5)


def test_the_surface_stands_for_its_source_and_gets_the_key(core):
    source = add_dune()
    surface = fair(levels=2, hide_source=False)
    before = positions(surface.data)[WRONG]
    eased()
    assert EASED in source.data.shape_keys.key_blocks
    recompute(surface)
    assert surface.data.shape_keys.key_blocks[EASED].value == 1.0
    assert moved(surface, before) == pytest.approx(-OFF, abs=1e-4)


def moved(surface, before):
    return (shown(surface)[WRONG] - before)[2]


def test_with_modifiers_live_follows_the_slider(core):
    source = add_dune()
    surface = fair(levels=2, hide_source=False, mesh_source="EVALUATED")
    before = positions(surface.data)[WRONG]
    surface.discrete_fairing_live.on = True
    activate(source)
    eased()
    bpy.context.view_layer.update()
    assert moved(surface, before) == pytest.approx(-OFF, abs=1e-4)
    source.data.shape_keys.key_blocks[EASED].value = 0.5
    bpy.context.view_layer.update()
    assert moved(surface, before) == pytest.approx(-0.5 * OFF, abs=1e-4)
    surface.discrete_fairing_live.on = False


def test_the_worst_vertex_goes_back_and_no_other_moves():
    source = add_dune()
    eased(amount="WORST", count=1)
    moved = key(source) - np.float32(dune())
    assert moved[WRONG, 2] == pytest.approx(-OFF, rel=0.15)
    assert not np.delete(moved, WRONG, axis=0).any()


def test_selected_vertices_alone_move():
    source = add_dune(wrong=(24, WRONG))
    source.data.vertices.foreach_set("select", np.isin(np.arange(63), (WRONG, 32)))
    eased(use_selection=True, amount="WORST", count=5)
    moves = np.linalg.norm(key(source) - np.float32(dune(wrong=(24, WRONG))), axis=1)
    assert moves[WRONG] > 0.3 * OFF and set(np.flatnonzero(moves)) <= {WRONG, 32}
