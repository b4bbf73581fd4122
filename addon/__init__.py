# SPDX-License-Identifier: GPL-3.0-or-later
"""Discrete Fairing: the fairest surface through the vertices of a coarse mesh.

The data's way: `operators` → `job` → `mesh` (read) → `core` → `transfer` → `mesh` (write).
`settings` has what is asked for, `memory` what surfaces remember; `check` looks at meshes before,
`inspection` at surfaces afterwards, `live` follows edits, `strain` says which vertices spoil them. `ui` shows it, `cli` does it without a
window, `cad` makes spline patches of it.
"""

import atexit
from typing import Any

import bpy


def _modules() -> tuple[Any, ...]:
    """In the order of registration, that of the imports; not names of the package itself."""
    # isort: off
    from . import properties, memory, preferences
    from .surfaces import curve_cage
    from .inspection import settings as inspection_settings, overlay, viewport_shading
    from .strain import settings as strain_settings, cache, overlay as strain_overlay
    from .mesh import mesh_changes
    from .surfaces import freshness
    from .live import switch, handlers, restored
    from .operators import (
        fair, modal, in_place, curves, marks, live, check, joints, clean, fit, inspect, offsets, hull, sections, strain,
        presets, step,
    )  # fmt: skip
    from .ui import (
        pictures, main, curves as curves_panel, inspect as inspect_panel, menus,
    )  # fmt: skip
    from . import cli
    # isort: on

    return tuple(locals().values())


def register() -> None:
    from . import registration

    for module in _modules():
        registration.register(module)
    # the module `bpy` ends by a signal, or never, where classes are left registered
    if not bpy.app.binary_path:
        atexit.register(unregister)


def unregister() -> None:
    from . import queue, registration

    atexit.unregister(unregister)
    queue.end_all()
    for module in reversed(_modules()):
        registration.unregister(module)
