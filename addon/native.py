# SPDX-License-Identifier: GPL-3.0-or-later
"""The native core: imported on first use, so that a missing wheel never keeps Blender from starting."""

from functools import cache

MISSING = "The native module 'discrete_fairing' could not be loaded: reinstall the extension for this Blender version"


@cache
def _load():
    try:
        import discrete_fairing
    except ImportError as error:
        return None, f"{MISSING} ({error})"
    return discrete_fairing, ""


def core():
    """The module `discrete_fairing`; raises ImportError with a text for the user."""
    module, reason = _load()
    if module is None:
        raise ImportError(reason)
    return module


def why_missing():
    """Why the core cannot be used, in one sentence; empty when it can."""
    return _load()[1]
