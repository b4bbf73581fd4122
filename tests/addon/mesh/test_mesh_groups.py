# SPDX-License-Identifier: GPL-3.0-or-later
"""Vertex groups: names, members and weights, and what an armature makes of them."""

import bpy
import numpy as np
from mathutils import Matrix
from refined import refine
from scenes import CUBE, add, add_suzanne, positions

from addon.mesh.modifiers import copy_modifiers


def weights(target, name):
    """(N,) weight of each vertex in a group, NaN outside of it."""
    group = target.vertex_groups[name].index
    found = np.full(len(target.data.vertices), np.nan)
    for vertex in target.data.vertices:
        for element in vertex.groups:
            if element.group == group:
                found[vertex.index] = element.weight
    return found


def test_weights_are_linear_and_control_vertices_keep_theirs():
    source = add("Cube", *CUBE)
    group = source.vertex_groups.new(name="Height")
    for vertex in source.data.vertices:
        group.add([vertex.index], 0.5 + 0.3 * vertex.co.z, "REPLACE")
    made = refine(source)
    expected = 0.5 + 0.3 * made.transfer.point(made.arrays.positions)[:, 2]
    found = weights(made.target, "Height")
    assert np.allclose(found, expected, atol=1e-6)
    assert np.array_equal(found[:8], weights(source, "Height"))


def test_sums_of_one_stay_one():
    source = add_suzanne()
    first, second = source.vertex_groups.new(name="A"), source.vertex_groups.new(name="B")
    for i, w in enumerate(np.random.default_rng(3).random(len(source.data.vertices)).tolist()):
        first.add([i], w, "REPLACE")
        second.add([i], 1 - w, "REPLACE")
    target = refine(source).target
    assert np.allclose(weights(target, "A") + weights(target, "B"), 1, atol=1e-6)


def test_groups_stay_sparse_and_keep_their_order():
    source = add("Cube", *CUBE)
    for name in ("Zero", "One", "None", "Part"):
        source.vertex_groups.new(name=name)
    source.vertex_groups["Zero"].add([0, 3], 0.0, "REPLACE")
    source.vertex_groups["One"].add(range(8), 1.0, "REPLACE")
    source.vertex_groups["Part"].add([0], 0.25, "REPLACE")
    source.vertex_groups["One"].lock_weight = True
    source.vertex_groups.active_index = 2
    target = refine(source, 1).target
    assert [g.name for g in target.vertex_groups] == ["Zero", "One", "None", "Part"]
    assert [g.lock_weight for g in target.vertex_groups] == [False, True, False, False]
    assert target.vertex_groups.active_index == 2
    assert np.flatnonzero(weights(target, "Zero") == 0).tolist() == [0, 3]
    assert (weights(target, "One") == 1).all()
    assert np.isnan(weights(target, "None")).all()
    # vertex 0, and the middles of its 3 edges and 3 faces
    assert np.isfinite(weights(target, "Part")).sum() == 7
    assert target.data.validate() is False


def test_a_name_that_an_attribute_has():
    source = add("Cube", *CUBE)
    source.data.attributes.new("Same", "FLOAT", "POINT").data.foreach_set(
        "value", np.full(8, 3.0, np.float32)
    )
    source.vertex_groups.new(name="Other").add([1], 1.0, "REPLACE")
    target = refine(source, 1).target
    assert "Same" in target.data.attributes and "Other" in target.vertex_groups
    assert {a.name for a in target.data.attributes if "weight" in a.name} == set()


def test_armature_bends_the_refined_surface():
    source = add_suzanne()
    armature = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    bpy.context.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for name in ("Ears", "Rest"):
        bone = armature.data.edit_bones.new(name)
        bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    armature.pose.bones["Ears"].matrix_basis = Matrix.Translation((0, 2, 0))
    ears, rest = source.vertex_groups.new(name="Ears"), source.vertex_groups.new(name="Rest")
    for vertex in source.data.vertices:
        weight = min(abs(vertex.co.x), 1.0)
        ears.add([vertex.index], weight, "REPLACE")
        rest.add([vertex.index], 1.0 - weight, "REPLACE")
    source.modifiers.new("Rig", "ARMATURE").object = armature
    made = refine(source)
    assert copy_modifiers(bpy.context, source, made.target) == []
    rest = positions(made.mesh)
    evaluated = made.target.evaluated_get(bpy.context.evaluated_depsgraph_get())
    moved = positions(evaluated.to_mesh())
    shift = np.linalg.norm(moved - rest, axis=1)
    weight = np.nan_to_num(weights(made.target, "Ears"))
    assert shift.max() > 1.5
    assert np.allclose(shift, 2 * weight, atol=1e-5)
