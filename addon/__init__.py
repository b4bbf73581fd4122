# SPDX-License-Identifier: GPL-3.0-or-later
"""Discrete Fairing: the fairest surface through the vertices of a coarse mesh.

The data's way through the modules: `read_mesh` → `features` → `request` → the native core → `write_mesh` →
`write_object`; `operator` walks it, `settings` and `panel` ask for it.
"""

from . import operator, panel, settings

_MODULES = (settings, operator, panel)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
