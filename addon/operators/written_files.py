# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that write a file, which the file browser asks for, or a script names."""

from typing import TYPE_CHECKING, Any, cast

import bpy
from bpy_extras.io_utils import ExportHelper

from .. import core
from ..blender import Answer, Context
from .fair import Fairing


class ByFileBrowser(ExportHelper, Fairing):
    """Mix-in of a run whose `filepath` the browser fills in. Then it goes on as `begin` says, and the
    window stays alive.
    """

    if TYPE_CHECKING:
        filepath: str  # what ExportHelper adds

    _from_browser = False

    def invoke(self, context: Context, event: bpy.types.Event) -> Answer:
        self._from_browser = True
        helper: Any = ExportHelper  # whose stub says None
        return helper.invoke(self, context, event)

    def execute(self, context: Context) -> Answer:
        """The file browser calls it too."""
        if self._from_browser and not bpy.app.background:
            return self.begin(context)
        return super().execute(context)

    def begin(self, context: Context) -> Answer:
        """As a button does."""
        return Fairing.invoke(self, context, cast(Any, None))


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
