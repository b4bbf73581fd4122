# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces in excluded collections, in library overrides, and in modes begun meanwhile."""

import bpy
import pytest
from live_scenes import follow, move
from scenes import CUBE, TRIANGLE, activate, add, computed, exclude, fair, refused, settings

from addon.jobs.fair import Job
from addon.operators.fair import Fairing
from addon.settings import Settings
from addon.surfaces.freshness import stale_surfaces


def counts():
    return len(bpy.data.objects), len(bpy.data.meshes)


def test_what_is_out_of_date_in_an_excluded_collection_is_made_again():
    box = add("Box", *CUBE)
    box.vertex_groups.new(name="Half").add([0, 1, 2, 3], 1.0, "REPLACE")
    away = fair(levels=1)
    crate = add("Crate", *CUBE)
    here = fair(levels=1)
    exclude(box, away)
    for source in (box, crate):
        move(source)
    follow()
    assert set(stale_surfaces()) == {away, here}
    activate(here)
    assert bpy.ops.object.fairing_recompute_stale() == {"FINISHED"}
    assert not list(stale_surfaces())
    assert bpy.context.selected_objects == [here] and bpy.context.active_object == here


def test_vertices_of_a_source_that_is_excluded_cannot_be_selected():
    box = add("Box", *CUBE)
    fair(levels=1)
    exclude(box)
    for name in ("fairing_select_strained", "fairing_go_to_strained", "fairing_show_source"):
        assert not getattr(bpy.ops.object, name).poll(), name
    refused("Link 'Box' to this scene first", bpy.ops.object.fairing_select_strained)


def overridden(tmp_path):
    """A mesh object of a library override, active."""
    box = add("Box", *CUBE)
    library = bpy.data.collections.new("Library")
    library.objects.link(box)
    bpy.context.scene.collection.objects.unlink(box)
    bpy.context.scene.collection.children.link(library)
    path = str(tmp_path / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.collections = ["Library"]
    instance = bpy.data.objects.new("Instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", wanted.collections[0]
    bpy.context.scene.collection.objects.link(instance)
    scene, layer = bpy.context.scene, bpy.context.view_layer
    instance.instance_collection.override_hierarchy_create(scene, layer)
    found = next(o for o in scene.objects if o.name.startswith("Box"))
    activate(found)
    return found


def test_an_object_of_a_library_override_is_faired(tmp_path):
    source = overridden(tmp_path)
    assert source.override_library and bpy.context.active_object == source
    target = fair(levels=1)
    assert target.discrete_fairing.source == source
    assert list(target.users_collection) == [bpy.context.scene.collection]
    assert bpy.ops.object.fairing_recompute() == {"FINISHED"}


def test_an_error_leaves_nothing_behind(monkeypatch):
    """The second of two fails unexpectedly: the first is removed too, since no step of undo has it."""
    box, crate = add("Box", *CUBE), add("Crate", *CUBE)
    box.select_set(True)
    write = Job.write

    def fail(job, *arguments):
        made = write(job, *arguments)
        assert job.source != crate, "on purpose"
        return made

    monkeypatch.setattr(Job, "write", fail)
    before = counts()
    refused("on purpose", bpy.ops.object.fairing_surface, levels=1)
    assert counts() == before


class Run(Fairing):
    """A run that was begun in Object Mode."""

    _mode = "OBJECT"
    hide_source = True

    def report(self, *_):
        pass


def finish(job):
    Run().finish(bpy.context, [computed(job)])


@pytest.mark.parametrize("mode", ["SCULPT", "EDIT", "VERTEX_PAINT"])
def test_a_run_that_ends_leaves_whoever_has_begun_something_else_alone(source, mode):
    job = Job(bpy.context, source, settings())
    other = add("Other", *TRIANGLE)
    bpy.ops.object.mode_set(mode=mode)
    finish(job)
    assert other.mode == mode and bpy.context.active_object == other
    assert bpy.context.selected_objects == [other]
    assert bpy.data.objects["Box Fair"].data.polygons


def test_a_surface_that_is_being_sculpted_is_made_again_in_object_mode(source):
    target = fair(levels=1)
    move(source)
    job = Job(bpy.context, source, Settings.of(target.discrete_fairing), target)
    bpy.ops.object.mode_set(mode="SCULPT")
    finish(job)
    assert target.mode == "OBJECT" and not list(stale_surfaces())
