# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers of the source, copied to another object."""

import bpy
import pytest
from scenes import CUBE, TRIANGLE, add, add_suzanne, settings

from addon.jobs.fair import Job
from addon.mesh.modifiers import copy_modifiers


def copied(source):
    target = add("Target", *TRIANGLE)
    return target, copy_modifiers(bpy.context, source, target)


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
        (["SOLIDIFY", "SIMPLE_DEFORM"], ["Solidify and Simple_Deform", "With Modifiers"]),
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
