# SPDX-License-Identifier: GPL-3.0-or-later
"""Who watches a run, as callers pass them: checked before it begins."""

from __future__ import annotations

from collections.abc import Callable

from . import _native
from .errors import fairing_error

Progress = Callable[[float, str], bool | None]


def check_watchers(progress: Progress | None, monitor: _native.Monitor | None) -> None:
    """Raises FairingError BAD_OPTION for what can neither be called nor watch; None is nobody."""
    if progress is not None and not callable(progress):
        raise fairing_error(
            "BAD_OPTION",
            f"progress is {progress!r}; it must be callable, as progress(fraction, phase).",
        )
    if monitor is not None and not isinstance(monitor, _native.Monitor):
        raise fairing_error(
            "BAD_OPTION", f"monitor is {monitor!r}; it must be a discrete_fairing.Monitor."
        )
