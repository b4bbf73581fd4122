# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that write a file chosen in the file browser, or given by a script."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import bpy
from bpy_extras.io_utils import ExportHelper

from .. import core
from ..blender import Answer, Context
from ..errors import JobError
from .fair import Fairing
from .mixins import Action


class ByFileBrowser(ExportHelper, Fairing):
    """Mix-in of a run with a `filepath`; after the browser `begin` goes on, responsively."""

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


class WritesText(ExportHelper, Action):
    """Mix-in of operators that write a text file at once."""

    if TYPE_CHECKING:
        filepath: str  # added by ExportHelper


@contextmanager
def written(path: str) -> Iterator[str]:
    """A context that writes the absolute `path`; raises JobError if the file cannot be written."""
    if not path:
        raise JobError("Choose a file: no name is given.")
    place = bpy.path.abspath(path)
    try:
        yield place
    except OSError as error:
        why = error.strerror or error
        raise JobError(f"Choose another file: {place} cannot be written ({why}).") from error


def write_text_file(path: str, text: str) -> None:
    """Writes the whole text, or leaves the file as it was."""
    with written(path) as place, core.module().whole_files.whole_file(place) as part:
        part.write_text(text, encoding="utf-8", newline="")
