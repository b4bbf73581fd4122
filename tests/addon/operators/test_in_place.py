# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Selected Faces in Place: the moves, the joint, and that the surface is the core's."""

import bmesh
import bpy
import discrete_fairing as df
import numpy as np
import pytest
from lattices import lattice_faces
from scenes import CUBE, add, edit, faces_at_edges, positions, refused, settings, to_object_mode

from addon import prediction
from addon.in_place import InPlaceJob, InPlaceOptions
from addon.operators import redo
from addon.operators.fair import Fairing
from addon.queue import Queue

RADIUS = 3.0
SIZE = 12  # faces a side


def cap(noise=0.1):
    """A noisy piece of a sphere whose middle faces are selected; the object, and the mask of the noisy vertices."""
    axis = np.linspace(-1, 1, SIZE + 1)
    x, y = (values.ravel() for values in np.meshgrid(axis, axis, indexing="ij"))
    points = np.stack([x, y, np.sqrt(RADIUS**2 - x**2 - y**2)], axis=1)
    middle = (np.abs(x) < 0.4) & (np.abs(y) < 0.4)
    points[middle] += np.random.default_rng(1).uniform(-noise, noise, (int(middle.sum()), 3))
    target = add("Cap", points.tolist(), lattice_faces(SIZE + 1, SIZE + 1).tolist())
    select(target, lambda ids: middle[ids].any())
    return target, middle


def select(target, wanted):
    edit(target, "FACE", [p.index for p in target.data.polygons if wanted(list(p.vertices))])


def fair(target, **options):
    assert bpy.ops.object.fairing_in_place(**options) == {"FINISHED"}
    to_object_mode()
    return positions(target.data)


def off_sphere(points):
    return np.abs(np.linalg.norm(points, axis=1) - RADIUS)


@pytest.mark.parametrize("joint", ["POSITION", "TANGENT", "CURVATURE"])
def test_only_what_is_inside_moves_and_the_noise_goes(joint):
    target, middle = cap()
    before = positions(target.data)
    faces = [tuple(p.vertices) for p in target.data.polygons]
    after = fair(target, joint=joint)
    assert np.array_equal(after[~middle], before[~middle]), "to the bit"
    assert [tuple(p.vertices) for p in target.data.polygons] == faces
    assert off_sphere(before[middle]).max() > 0.05
    limit = {"POSITION": 0.05, "TANGENT": 0.012, "CURVATURE": 0.012}[joint]
    assert off_sphere(after[middle]).max() < limit


def test_factor_goes_part_of_the_way():
    target, middle = cap()
    before = positions(target.data)
    whole = fair(target)
    target, _ = cap()
    half = fair(target, factor=0.5)
    assert np.allclose(half, (before + whole) / 2, atol=1e-6)


@pytest.mark.parametrize("release", [False, True])
def test_refined_in_place_joins_without_a_gap(release):
    target, middle = cap()
    before = positions(target.data)
    selected = sum(p.select for p in target.data.polygons)
    after = fair(target, levels=2, release=release, joint="TANGENT")
    mesh = target.data
    kept = ~middle if release else np.ones(len(before), bool)
    assert np.array_equal(after[: len(before)][kept], before[kept])
    assert 16 * selected <= sum(p.select for p in mesh.polygons) <= 32 * selected
    # the old border and no other: no gap, no T-junction
    assert faces_at_edges(mesh).count(1) == 4 * SIZE
    assert not [a for a in mesh.attributes if a.name.startswith("fairing")]
    inside = (np.abs(after[:, :2]) < 0.45).all(axis=1)
    if release:
        assert off_sphere(after[inside]).max() < 0.03
    assert off_sphere(after[len(before) :][inside[len(before) :]]).max() > 1e-4


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_refined_points_are_those_of_the_core(noise):
    """Noise warps quads, so that the core splits them."""
    target, middle = cap(noise)
    before = positions(target.data)
    faces = [tuple(p.vertices) for p in target.data.polygons]
    region = [i for i, p in enumerate(target.data.polygons) if p.select]
    whole = df.fair(before, faces, levels=1, region=region, joint="curvature")
    after = fair(target, levels=1, joint="CURVATURE")
    assert (len(whole.faces[0]) > 0) == (noise > 0)
    pieces = zip(whole.faces, (whole.triangle_polygon, whole.quad_polygon), strict=True)
    inner = np.unique(np.concatenate([f[np.isin(of, region)].ravel() for f, of in pieces]))
    used = np.unique(np.concatenate([p.vertices for p in target.data.polygons if p.select]))
    apart = np.abs(after[:, None] - whole.vertices[None, inner]).max(axis=2)
    assert apart.min(axis=0).max() < 1e-5, "cut out or whole"
    assert apart[used].min(axis=1).max() < 1e-5


def test_layers_of_the_mesh_are_refined_with_it():
    target, _ = cap()
    to_object_mode()
    target.data.uv_layers.new(name="UV")
    for corner, loop in enumerate(target.data.loops):
        target.data.uv_layers["UV"].data[corner].uv = positions(target.data)[loop.vertex_index, :2]
    bpy.ops.object.mode_set(mode="EDIT")
    after = fair(target, levels=1)
    flat = [
        (target.data.uv_layers["UV"].data[i].uv[:], after[loop.vertex_index, :2])
        for i, loop in enumerate(target.data.loops)
    ]
    assert max(abs(u[0] - p[0]) + abs(u[1] - p[1]) for u, p in flat) < 0.2


def funnel(rows=3, count=4):
    """A square hole at the end of walls that lean out, each `count` faces wide, filled with one face."""
    along = [2.0 * i / count - 1.0 for i in range(count)]
    ring = [(t, -1.0) for t in along] + [(1.0, t) for t in along]
    ring += [(-x, -y) for x, y in ring]
    points = [
        ((1 + 0.6 * row) * x, (1 + 0.6 * row) * y, 0.5 * row)
        for row in range(rows + 1)
        for x, y in ring
    ]
    n = len(ring)
    faces = lattice_faces(rows + 1, n, (False, True))[:, [0, 3, 2, 1]]
    target = add("Funnel", points, [*faces.tolist(), list(range(rows * n, len(points)))])
    select(target, lambda ids: len(ids) == n)
    return target


def test_a_filled_hole_that_ends_in_a_fold_is_told(capfd):
    fair(funnel(), levels=2, joint="TANGENT")
    said = capfd.readouterr().out
    assert "What was faired is folded (" in said and "Raise Tension" in said
    fair(funnel(), levels=2, joint="POSITION")
    assert "folded" not in capfd.readouterr().out, "any angle is right there"


def test_refusals_say_what_to_do_and_change_nothing():
    box = add("Box", *CUBE)
    select(box, lambda _ids: False)
    refused("Select the faces", bpy.ops.object.fairing_in_place)
    bpy.ops.mesh.select_all(action="SELECT")
    refused("Leave out some faces of each part", bpy.ops.object.fairing_in_place)
    select(box, lambda ids: 0 in ids and 1 in ids and 2 in ids)
    refused("Select more faces", bpy.ops.object.fairing_in_place, levels=0)
    assert np.array_equal(positions(box.data), np.array(CUBE[0], np.float32))
    to_object_mode()


def begun(target, **options):
    """A job as the button begins it, before it is computed."""
    plain = {"levels": 0, "joint": "TANGENT", "energy": "THIN_PLATE", "tension": 0.0}
    asked = InPlaceOptions(**plain | {"release": False} | options)
    return InPlaceJob(bpy.context, target, settings(), asked)


def test_a_long_run_is_computed_beside_the_window_and_applied_at_its_end():
    target, _ = cap()
    expected = fair(target, levels=2)
    target, _ = cap()
    job = begun(target, levels=2)
    assert job.predicted_seconds > 0.0 and job.triangles > 16 * 2 * 16
    queue = Queue([job], df.Monitor)
    queue.start()
    bpy.ops.mesh.select_all(action="DESELECT")  # what is selected meanwhile does not matter
    queue.join()
    assert queue.error is None and len(bmesh.from_edit_mesh(target.data).faces) == SIZE**2
    assert job.why_outdated(bpy.context) == ""
    job.apply()
    to_object_mode()
    assert np.array_equal(positions(target.data), expected)


def move_a_vertex(target):
    edited = bmesh.from_edit_mesh(target.data)
    edited.verts.ensure_lookup_table()
    edited.verts[0].co.z += 0.5
    bmesh.update_edit_mesh(target.data)


CHANGES = {
    "was edited": move_a_vertex,
    "changed its mode": lambda _target: to_object_mode(),
    "was deleted": lambda target: bpy.data.objects.remove(target),
}


@pytest.mark.parametrize("said", CHANGES)
def test_a_mesh_that_changes_during_the_run_is_left_alone(said):
    target, _ = cap()
    job = begun(target)
    job.compute()
    CHANGES[said](target)
    assert f"Cap {said}" in job.why_outdated(bpy.context)


def test_adjust_last_operation_lets_a_long_run_begin_anew(monkeypatch):
    target, _ = cap()
    before, asked = positions(target.data), []
    monkeypatch.setattr(Fairing, "is_redone", lambda self: True)
    monkeypatch.setattr(prediction, "_AT_FIRST", {"THIN_PLATE": 1.0})
    monkeypatch.setattr(redo, "invoke_soon", lambda *given: asked.append(given[1:]))
    after = fair(target, levels=1, factor=0.5)
    assert np.array_equal(after, before)
    ((operator, properties),) = asked
    assert operator.idname_py() == "object.fairing_in_place"
    assert (properties["levels"], properties["factor"], properties["joint"]) == (1, 0.5, "TANGENT")


@pytest.mark.parametrize("slant, scale", [(0, 1), (0.7, 3)])
def test_corners_of_the_mesh_stay(slant, scale):
    """Also where only the object's scale makes them: a border at 125 degrees would run around."""
    points = [(x - slant * y, y, 0.5 * (x == 2 and y == 2)) for y in range(5) for x in range(5)]
    target = add("Sheet", points, lattice_faces(5, 5)[:, ::-1].tolist())
    target.scale.y = scale
    select(target, lambda ids: max(max(v % 5, v // 5) for v in ids) < 3)
    after = fair(target, levels=2)
    after[:, 0] += slant * after[:, 1]
    border = after[(after[:, :2] < 0.1).any(axis=1)]
    assert len(border) > 16 and np.abs(border[:, :2].min(axis=1)).max() < 1e-6


def cap_with_keys(*names):
    target, middle = cap()
    to_object_mode()
    for name in ("Basis", *names):
        target.shape_key_add(name=name)
    return target, middle


def keys_of(target):
    to_object_mode()
    keys = target.data.shape_keys.key_blocks
    return {key.name: np.array([point.co[:] for point in key.data]) for key in keys}


@pytest.mark.parametrize("release", [False, True])
@pytest.mark.parametrize("levels", [0, 1, 2])
def test_shape_keys_follow_what_is_faired(levels, release):
    target, middle = cap_with_keys("Shift", "Twice")
    keys = target.data.shape_keys.key_blocks
    for name, shift in (("Shift", 1.0), ("Twice", 2.0)):
        for point in keys[name].data:
            point.co.x += shift
    keys["Twice"].relative_key = keys["Shift"]
    target.active_shape_key_index = 0
    select(target, lambda ids: middle[ids].any())
    fair(target, levels=levels, release=release)
    found = keys_of(target)
    assert len(found["Basis"]) == len(target.data.vertices)
    for name, shift in (("Shift", 1.0), ("Twice", 2.0)):
        assert np.abs(found[name] - found["Basis"] - [shift, 0, 0]).max() < 1e-5, name
