# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects remembered so that undo and deleting, which leave pointers to nowhere, do no harm."""

import bpy


def key(block):
    """What a data-block is known by until its file is closed, undo or not."""
    return getattr(block, "session_uid", None) or block.name_full


class Reference:
    """Finds its object again; None once that is gone."""

    def __init__(self, target):
        self.key = key(target)
        self._name = target.name

    def find(self):
        target = bpy.data.objects.get(self._name)
        if target is None or key(target) != self.key:
            target = next((o for o in bpy.data.objects if key(o) == self.key), None)
        if target is not None:
            self._name = target.name
        return target


def is_in_a_scene(target):
    """Deleting takes an object out of its scenes; it goes itself only if nobody else refers to it."""
    return any(scene.objects.get(target.name) == target for scene in bpy.data.scenes)
