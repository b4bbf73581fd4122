# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that write a file which the file browser asks for, or that a script names."""

from typing import TYPE_CHECKING, Any, cast

import bpy
from bpy_extras.io_utils import ExportHelper

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
