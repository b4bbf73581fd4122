# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and drawings that operators write."""

import bpy

from .. import core


def write_text_file(operator: bpy.types.Operator, path: str, text: str) -> bool:
    """Whether it was written; why not is reported. The file is whole or as it was."""
    place = bpy.path.abspath(path)
    try:
        with core.module().whole_files.whole_file(place) as part:
            part.write_text(text, encoding="utf-8", newline="")
    except OSError as error:
        why = error.strerror or error
        operator.report({"ERROR"}, f"Choose another file: {place} cannot be written ({why}).")
        return False
    return True
