# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Selected Faces in Place: the moves, the joint, and that the surface is the core's."""

import bmesh
import bpy
import discrete_fairing as df
import numpy as np
import pytest
from lattices import lattice_faces
from scenes import CUBE, add, edit, positions, refused, settings, to_object_mode

from addon import prediction
from addon.jobs.in_place import InPlaceJob, InPlaceOptions
from addon.mesh.edited import edited
from addon.operators import modal as redo
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


def funnel(rows=3, count=4):
    """A square hole at the end of walls that lean out, each `count` faces wide, filled with rings of faces."""
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
    with edited(target) as bm:
        poked = bmesh.ops.poke(bm, faces=[face for face in bm.faces if len(face.verts) == n])
        spokes = list(poked["verts"][0].link_edges)
        bmesh.ops.subdivide_edges(bm, edges=spokes, cuts=2)
    select(target, lambda ids: all(target.data.vertices[i].co.z > 0.5 * rows - 1e-6 for i in ids))
    return target


def test_a_filled_hole_that_ends_in_a_fold_is_told(capfd):
    fair(funnel(), joint="TANGENT")
    said = capfd.readouterr().out
    assert "What was faired is folded (" in said and "Raise Tension" in said
    fair(funnel(), joint="POSITION")
    assert "folded" not in capfd.readouterr().out, "any angle is right there"


def test_refusals_say_what_to_do_and_change_nothing():
    box = add("Box", *CUBE)
    select(box, lambda _ids: False)
    refused("Select the faces", bpy.ops.object.fairing_in_place)
    bpy.ops.mesh.select_all(action="SELECT")
    refused("Leave out some faces of each part", bpy.ops.object.fairing_in_place)
    select(box, lambda ids: 0 in ids and 1 in ids and 2 in ids)
    refused("Select more faces", bpy.ops.object.fairing_in_place)
    assert np.array_equal(positions(box.data), np.array(CUBE[0], np.float32))
    to_object_mode()


def begun(target, **options):
    """A job as the button begins it, before it is computed."""
    plain = {"joint": "TANGENT", "energy": "THIN_PLATE", "tension": 0.0}
    asked = InPlaceOptions(**plain | options)
    return InPlaceJob(bpy.context, target, settings(), asked)


def test_a_long_run_is_computed_beside_the_window_and_applied_at_its_end():
    target, _ = cap()
    expected = fair(target)
    target, _ = cap()
    job = begun(target)
    assert job.predicted_seconds > 0.0 and job.triangles > 0
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
    after = fair(target, factor=0.5)
    assert np.array_equal(after, before)
    ((operator, properties),) = asked
    assert operator.idname_py() == "object.fairing_in_place"
    assert (properties["factor"], properties["joint"]) == (0.5, "TANGENT")


@pytest.mark.parametrize("slant, scale", [(0, 1), (0.7, 3)])
def test_corners_of_the_mesh_stay(slant, scale):
    """Also where only the object's scale makes them: a border at 125 degrees would run around."""
    points = [(x - slant * y, y, 0.5 * (x == 2 and y == 2)) for y in range(5) for x in range(5)]
    target = add("Sheet", points, lattice_faces(5, 5)[:, ::-1].tolist())
    target.scale.y = scale
    select(target, lambda ids: max(max(v % 5, v // 5) for v in ids) < 3)
    after = fair(target)
    after[:, 0] += slant * after[:, 1]
    border = after[(after[:, :2] < 0.1).any(axis=1)]
    assert len(border) == 9 and np.abs(border[:, :2].min(axis=1)).max() < 1e-6


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


def test_shape_keys_follow_what_is_faired():
    target, middle = cap_with_keys("Shift", "Twice")
    keys = target.data.shape_keys.key_blocks
    for name, shift in (("Shift", 1.0), ("Twice", 2.0)):
        for point in keys[name].data:
            point.co.x += shift
    keys["Twice"].relative_key = keys["Shift"]
    target.active_shape_key_index = 0
    select(target, lambda ids: middle[ids].any())
    fair(target)
    found = keys_of(target)
    assert len(found["Basis"]) == len(target.data.vertices)
    for name, shift in (("Shift", 1.0), ("Twice", 2.0)):
        assert np.abs(found[name] - found["Basis"] - [shift, 0, 0]).max() < 1e-5, name
