# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors of the Python layer, of the same type as the core's."""

from ._native import FairingError


class MemoryWarning(RuntimeWarning):
    """A run is about to take more memory than was predicted."""


def fairing_error(
    code: str, message: str, elements: list[int] | None = None, kind: str = "mesh"
) -> FairingError:
    """A FairingError with its code, element ids and their kind set."""
    error = FairingError(message)
    error.code = code
    error.elements = elements or []
    error.kind = kind
    return error
