# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender --background --command discrete_fairing …`, as Blender is told of it."""

import bpy

NAME = "discrete_fairing"

_handles = []


def _command(argv):
    from .main import main  # argparse and all: only for those who call it

    return main(argv)


def register():
    if hasattr(bpy.utils, "register_cli_command"):  # from Blender 4.2 on
        _handles.append(bpy.utils.register_cli_command(NAME, _command))


def unregister():
    while _handles:
        bpy.utils.unregister_cli_command(_handles.pop())
