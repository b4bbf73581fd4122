# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that Adjust Last Operation, or a file browser, shows of an operator."""

from collections.abc import Iterable
from typing import cast

import bpy

from ..blender import Context, OperatorBase


class Shown(OperatorBase):
    """Mix-in of operators that show some of their properties below one another."""

    def shown(self, context: Context) -> Iterable[str]:
        """The names of the properties that apply now."""
        raise NotImplementedError

    def draw(self, context: Context) -> None:
        layout = cast(bpy.types.UILayout, self.layout)
        layout.use_property_split = True
        for name in self.shown(context):
            layout.prop(self, name)
