# SPDX-License-Identifier: GPL-3.0-or-later
"""Which objects are faired, and the mesh of each: its own, or what its modifiers make of it."""

from contextlib import contextmanager, nullcontext


def source_objects(context):
    """The meshes to fair: the selected ones in Object Mode, those being edited in Edit Mode; the active one alone if none."""
    active = context.active_object
    if context.mode == "EDIT_MESH":
        return list(context.objects_in_mode_unique_data)
    selected = [o for o in context.selected_objects if o.type == "MESH"]
    if not selected and active is not None and active.type == "MESH":
        selected = [active]
    # the active one last, so that its result becomes active
    return sorted(selected, key=lambda o: o == active)


@contextmanager
def control_mesh(context, source, evaluated=False, depsgraph=None):
    """The bpy.types.Mesh to read, with the edits of this moment; valid inside the `with` only.

    `evaluated`: with the modifiers of `source` applied, as `depsgraph` has them already; None: brought up to date first.
    """
    if source.mode == "EDIT":
        source.update_from_editmode()
    if evaluated:
        known = nullcontext(source.evaluated_get(depsgraph)) if depsgraph else _evaluated(context, source)
        with known as owner, _copy_of_mesh(owner) as mesh:
            yield mesh
    elif source.mode == "EDIT":  # then it lists the attributes of the edit, not its own: read a copy
        with _copy_of_mesh(source) as mesh:
            yield mesh
    else:
        yield source.data


@contextmanager
def _copy_of_mesh(owner):
    try:
        yield owner.to_mesh()
    finally:
        owner.to_mesh_clear()


@contextmanager
def _evaluated(context, source):
    """`source` with its modifiers applied. Blender evaluates no object that is hidden, so it is shown meanwhile."""
    hidden = source.hide_get()
    if hidden:
        source.hide_set(False)
    try:
        yield source.evaluated_get(context.evaluated_depsgraph_get())
    finally:
        if hidden:
            source.hide_set(True)
