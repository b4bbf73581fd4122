# SPDX-License-Identifier: GPL-3.0-or-later
"""Mix-ins of operators: reporting of errors, and the list of shown properties."""

from collections.abc import Callable, Iterable
from functools import wraps
from typing import Any, cast

import bpy

from ..blender import Answer, Context, OperatorBase
from ..errors import JobError
from ..poll import ExplainedPoll


def refusing(call: Callable[..., Answer]) -> Callable[..., Answer]:
    """Makes an operator's method report a JobError and cancel the operator."""

    @wraps(call)
    def answered(self: Any, context: Context) -> Answer:  # Blender counts the arguments
        try:
            return call(self, context)
        except JobError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

    return answered


class Action(ExplainedPoll, OperatorBase):
    """Mix-in of operators without a background run."""

    def act(self, context: Context) -> str | None:
        """Carries out the operator and returns its report, if any. Raises JobError."""
        raise NotImplementedError

    @refusing
    def execute(self, context: Context) -> Answer:
        said = self.act(context)
        if said:
            self.report({"INFO"}, said)
        return {"FINISHED"}


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
