# SPDX-License-Identifier: GPL-3.0-or-later
"""Discrete Fairing: the fairest surface through the vertices of a coarse mesh.

The data's way: `operators` → `job` → `mesh` (read) → `core` → `transfer` → `mesh` (write).
`settings` has what is asked for, `memory` what surfaces remember; `check` looks at meshes before,
`inspection` at surfaces afterwards, `live` follows edits, `strain` says which vertices spoil them. `ui` shows it, `cli` does it without a
window, `cad` makes spline patches of it.
"""

import atexit
from types import ModuleType

import bpy


def _modules() -> tuple[ModuleType, ...]:
    """In the order of registration. Imported here, for the package's own names stay those of its parts:
    `addon.in_place` is no operator's module.
    """
    from . import cli, curve_cage, freshness, memory, preferences, properties
    from .inspection import overlay, viewport_shading
    from .inspection import settings as inspection_settings
    from .live import handlers, kept, switch, undo
    from .mesh import mesh_changes
    from .operators import (
        boundary,
        cancel,
        check,
        clean,
        compare,
        curves,
        ease,
        fair,
        fill_holes,
        fit,
        fixed_normals,
        flat_faces,
        hull,
        hydrostatics,
        in_place,
        inspect,
        joints,
        live,
        offsets,
        presets,
        purposes,
        sections,
        step,
    )
    from .operators import strain as strain_operators
    from .strain import known as known_strain
    from .strain import overlay as strain_overlay
    from .strain import settings as strain_settings
    from .ui import check as check_panel
    from .ui import compare as compare_panel
    from .ui import curves as curves_panel
    from .ui import hull as hull_panel
    from .ui import inspect as inspect_panel
    from .ui import main as main_panel
    from .ui import menus, outliner, pictures
    from .ui import strain as strain_panel

    return (
        properties,
        memory,
        curve_cage,
        preferences,
        inspection_settings,
        overlay,
        viewport_shading,
        strain_settings,
        known_strain,
        strain_overlay,
        mesh_changes,
        freshness,
        switch,
        handlers,
        kept,
        undo,
        fair,
        fill_holes,
        cancel,
        in_place,
        curves,
        boundary,
        fixed_normals,
        flat_faces,
        compare,
        live,
        check,
        joints,
        clean,
        fit,
        inspect,
        offsets,
        hull,
        hydrostatics,
        sections,
        strain_operators,
        ease,
        presets,
        purposes,
        pictures,
        step,
        main_panel,
        curves_panel,
        inspect_panel,
        strain_panel,
        hull_panel,
        check_panel,
        compare_panel,
        menus,
        outliner,
        cli,
    )


def register() -> None:
    for module in _modules():
        module.register()
    if (
        not bpy.app.binary_path
    ):  # the module `bpy` ends by a signal, or never, where classes are left registered
        atexit.register(unregister)


def unregister() -> None:
    from . import queue

    atexit.unregister(unregister)
    queue.end_all()
    for module in reversed(_modules()):
        module.unregister()
