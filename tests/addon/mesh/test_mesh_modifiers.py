# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers of the source, copied to another object."""

import bpy
import pytest
from scenes import CUBE, TRIANGLE, add, add_suzanne, settings

from addon.job import Job
from addon.mesh.modifiers import copy_modifiers


def copied(source):
    target = add("Target", *TRIANGLE)
    return target, copy_modifiers(bpy.context, source, target)


def test_settings_and_order():
    source = add("Cube", *CUBE)
    mirror = source.modifiers.new("Mirror", "MIRROR")
    mirror.use_axis, mirror.mirror_object = (False, True, True), add("Plane", *TRIANGLE)
    source.vertex_groups.new(name="Group")
    rig = source.modifiers.new("Rig", "ARMATURE")
    rig.object = bpy.data.objects.new("Rig", bpy.data.armatures.new("Rig"))
    rig.vertex_group, rig.show_viewport = "Group", False
    target, notes = copied(source)
    assert notes == []
    assert [m.name for m in target.modifiers] == ["Mirror", "Rig"]
    found = target.modifiers["Mirror"]
    assert tuple(found.use_axis) == (False, True, True)
    assert found.mirror_object == mirror.mirror_object
    found = target.modifiers["Rig"]
    assert (found.object, found.vertex_group, found.show_viewport) == (rig.object, "Group", False)
    assert [m.name for m in source.modifiers] == ["Mirror", "Rig"]


def test_geometry_nodes_and_their_inputs():
    tree = bpy.data.node_groups.new("Tree", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    socket = tree.interface.new_socket("Value", in_out="INPUT", socket_type="NodeSocketFloat")
    source = add("Cube", *CUBE)
    nodes = source.modifiers.new("Nodes", "NODES")
    nodes.node_group = tree
    nodes[socket.identifier] = 3.5
    target, notes = copied(source)
    assert notes == []
    assert target.modifiers["Nodes"].node_group == tree
    assert target.modifiers["Nodes"][socket.identifier] == 3.5


@pytest.mark.parametrize(
    "kind, said",
    [
        ("HOOK", "'Special' is not copied"),
        ("COLLISION", "'Special' is not copied"),
        ("MULTIRES", "sculpted"),
    ],
)
def test_what_blender_does_not_copy_is_said(kind, said):
    source = add("Cube", *CUBE)
    source.modifiers.new("Special", kind)
    source.modifiers.new("Mirror", "MIRROR")
    target, notes = copied(source)
    assert len(notes) == 1 and said in notes[0]
    assert [m.name for m in target.modifiers] == ["Mirror"]


def test_bindings_are_undone():
    cage = add("Cage", *CUBE)
    source = add_suzanne()
    modifier = source.modifiers.new("Follow", "SURFACE_DEFORM")
    modifier.target = cage
    bpy.ops.object.surfacedeform_bind(modifier="Follow")
    assert modifier.is_bound
    target, notes = copied(source)
    found = target.modifiers["Follow"]
    assert not found.is_bound and found.target == cage
    assert len(notes) == 1 and "bind it again" in notes[0]
    assert modifier.is_bound


@pytest.mark.parametrize(
    ("kinds", "said"),
    [
        (["SUBSURF"], []),
        (["MIRROR", "SUBSURF"], ["Mirror", "Copy Modifiers", "Symmetry Plane to X"]),
        (["SOLIDIFY", "SIMPLE_DEFORM"], ["Solidify, Simple_Deform", "With Modifiers"]),
    ],
)
def test_what_the_surface_lacks_is_said_with_the_cure(kinds, said):
    """Half a head came without a word."""
    source = add("Cube", *CUBE)
    for kind in kinds:
        source.modifiers.new(kind.title(), kind)
    notes = [n for n in Job(bpy.context, source, settings()).notes if "is without" in n]
    assert len(notes) == bool(said) and all(word in notes[0] for word in said)
    cured = Job(bpy.context, source, settings(copy_modifiers=True))
    assert not [n for n in cured.notes if "is without" in n]
    source.modifiers[0].show_viewport = False
    hidden = Job(bpy.context, source, settings(copy_modifiers=False)).notes
    assert not [n for n in hidden if kinds[0].title() in n]
