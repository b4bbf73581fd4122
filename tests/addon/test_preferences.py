# SPDX-License-Identifier: GPL-3.0-or-later
"""The user's preferences reach the core."""

from threading import current_thread, main_thread
from types import SimpleNamespace

import bpy
from scenes import CUBE, add, settings

from addon import core, preferences
from addon.core import fair_arguments
from addon.jobs.fair import Job
from addon.jobs.in_place import InPlaceJob, InPlaceOptions
from addon.mesh.read import read_mesh
from addon.queue import Queue
from addon.strain.ease import EaseJob, EaseOptions
from addon.strain.measure import StrainJob


def prefer(monkeypatch, **values):
    chosen = SimpleNamespace(**{"memory_limit": 0, "threads": 0, **values})
    monkeypatch.setattr(preferences, "preferences", lambda: chosen)
    return chosen


def test_memory_and_threads_reach_the_core(monkeypatch):
    chosen = prefer(monkeypatch, memory_limit=7, threads=1)
    arrays = read_mesh(add("Box", *CUBE).data)
    given = fair_arguments(arrays, settings(), chosen)
    assert given["memory_limit"] == 7 * 2**20 and given["threads"] == 1


def test_blender_is_asked_on_its_own_thread_alone(monkeypatch):
    """Jobs have all that they need before they compute."""
    asked = []
    now = preferences.current_context

    def context():
        asked.append(current_thread() is main_thread())
        return now()

    monkeypatch.setattr(preferences, "current_context", context)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3)
    source = bpy.context.object
    options = InPlaceOptions("TANGENT", "THIN_PLATE", 0.0, measured=True)
    jobs = [
        Job(bpy.context, source, settings()),
        StrainJob(bpy.context, source),
        EaseJob(bpy.context, source, EaseOptions("AUTOMATIC", 0.0, 3, False, False)),
        InPlaceJob(bpy.context, source, settings(), options),
    ]
    queue = Queue(jobs, core.module().Monitor)
    queue.start()
    queue.join()
    assert queue.error is None and asked and all(asked)
