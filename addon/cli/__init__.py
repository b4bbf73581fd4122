# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender --background --command discrete_fairing …`: files in, files out."""

from typing import Any

import bpy

NAME = "discrete_fairing"

_handles: list[Any] = []


def _command(argv: list[str]) -> int:
    from .main import main  # with argparse: imported on first use

    return main(argv)


def register() -> None:
    tell: Any = bpy.utils.register_cli_command  # its stub returns None
    _handles.append(tell(NAME, _command))


def unregister() -> None:
    while _handles:
        bpy.utils.unregister_cli_command(_handles.pop())
