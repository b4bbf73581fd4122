# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender --background --command discrete_fairing …`: files in, files out."""

from typing import Any

import bpy

NAME = "discrete_fairing"

_handles: list[Any] = []


def _command(argv: list[str]) -> int:
    from .main import main  # argparse and all: only for those who call it

    return main(argv)


def register() -> None:
    if hasattr(bpy.utils, "register_cli_command"):  # from Blender 4.2 on
        tell: Any = bpy.utils.register_cli_command  # whose stub says None
        _handles.append(tell(NAME, _command))


def unregister() -> None:
    while _handles:
        bpy.utils.unregister_cli_command(_handles.pop())
