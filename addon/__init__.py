# SPDX-License-Identifier: GPL-3.0-or-later
"""Discrete Fairing: the fairest surface through the vertices of a coarse mesh.

The data's way through the folders: `read` → `check` → `request` → the native core → `carry` → `write`. `run` walks it,
`settings` and `interface` ask for it, `inspection` shows what came of it.
"""

from . import preferences, translations
from .check import operators as check_operators
from .command_line import command
from .inspection import freshness
from .inspection import operators as inspection_operators
from .inspection import properties as inspection_properties
from .interface import check as check_panel
from .interface import inspection as inspection_panel
from .interface import panel
from .live import operator as live_operator
from .live import properties as live_properties
from .live import watch as live_watch
from .run import operator, show_source
from .settings import presets, properties

_MODULES = (
    properties,
    preferences,
    presets,
    inspection_properties,
    freshness,
    operator,
    show_source,
    live_properties,
    live_watch,
    live_operator,
    check_operators,
    inspection_operators,
    panel,
    check_panel,
    inspection_panel,
    translations,
    command,
)


def register():
    for module in _MODULES:
        module.register()


def unregister():
    for module in reversed(_MODULES):
        module.unregister()
