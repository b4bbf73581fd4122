# SPDX-License-Identifier: GPL-3.0-or-later
"""Discrete Fairing: the fairest surface through the vertices of a coarse mesh.

The data's way through the folders: `read` → `check` → `request` → the native core → `carry` → `write`. `run` walks it,
`settings` and `interface` ask for it.
"""

from . import preferences, translations
from .command_line import command
from .interface import panel
from .run import operator
from .settings import presets, properties

_MODULES = (properties, preferences, presets, operator, panel, translations, command)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
