# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that write a file chosen in the file browser, or given by a script."""

from typing import TYPE_CHECKING, Any, cast

import bpy
from bpy_extras.io_utils import ExportHelper

from .. import core
from ..blender import Answer, Context
from .fair import Fairing


class ByFileBrowser(ExportHelper, Fairing):
    """Mix-in of a run with a `filepath` from the browser. Then `begin` continues, and the window stays
    responsive.
    """

    if TYPE_CHECKING:
        filepath: str  # added by ExportHelper

    _from_browser = False

    def invoke(self, context: Context, event: bpy.types.Event) -> Answer:
        self._from_browser = True
        helper: Any = ExportHelper  # its stub returns None
        return helper.invoke(self, context, event)

    def execute(self, context: Context) -> Answer:
        """Called by scripts and by the file browser."""
        if self._from_browser and not bpy.app.background:
            return self.begin(context)
        return super().execute(context)

    def begin(self, context: Context) -> Answer:
        """Starts the run like a button."""
        return Fairing.invoke(self, context, cast(Any, None))


def write_text_file(operator: bpy.types.Operator, path: str, text: str) -> bool:
    """Returns whether the file was written; otherwise reports why not. The file is complete or
    unchanged.
    """
    place = bpy.path.abspath(path)
    try:
        with core.module().whole_files.whole_file(place) as part:
            part.write_text(text, encoding="utf-8", newline="")
    except OSError as error:
        why = error.strerror or error
        operator.report({"ERROR"}, f"Choose another file: {place} cannot be written ({why}).")
        return False
    return True
