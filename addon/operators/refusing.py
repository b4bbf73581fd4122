# SPDX-License-Identifier: GPL-3.0-or-later
"""How operators answer: a JobError refuses, and is said."""

from collections.abc import Callable
from functools import wraps
from typing import Any

from ..blender import Answer, Context, OperatorBase
from ..errors import JobError
from ..poll import ExplainedPoll


def refusing(call: Callable[..., Answer]) -> Callable[..., Answer]:
    """Of an operator's method that takes a context: a JobError is reported, and nothing was done."""

    @wraps(call)
    def answered(self: Any, context: Context) -> Answer:  # Blender counts the arguments
        try:
            return call(self, context)
        except JobError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}

    return answered


class Action(ExplainedPoll, OperatorBase):
    """Mix-in of operators that are done at once."""

    def act(self, context: Context) -> str | None:
        """Does it; what is to be said of it. Raises JobError."""
        raise NotImplementedError

    @refusing
    def execute(self, context: Context) -> Answer:
        said = self.act(context)
        if said:
            self.report({"INFO"}, said)
        return {"FINISHED"}
