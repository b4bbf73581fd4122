# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors and warnings as data; their sentences, with places for elements, are written at the end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import _native
from ._native import FairingError


def fairing_error(
    code: str,
    cause: str,
    elements: Sequence[int] = (),
    kind: str = "mesh",
    cure: str = "",
) -> FairingError:
    """A FairingError. In `cause` and `cure` "{face}", "{vertex}" and "{edge}" stand for the elements,
    "{has|have}" for the word that agrees with their number.
    """
    return _native.error(code, cause, cure, list(elements), kind)


def about(error: FairingError, elements: Sequence[int], prefix: str = "") -> FairingError:
    """The same error for other elements of its kind; `prefix` starts its first sentence."""
    cause, cure = error._sentences
    return fairing_error(error.code, prefix + cause, elements, error.kind, cure)


def written(entry: Mapping[str, Any]) -> dict[str, Any]:
    """A warning or repair of the core's report for callers: its sentences, and both as "message"."""
    kind, elements = entry["kind"], entry["elements"]
    cause, cure = (_native.text(entry[name], kind, elements) for name in ("cause", "cure"))
    message = f"{cause} {cure}".rstrip()
    return {**entry, "cause": cause, "cure": cure, "message": message}


def written_report(found: dict[str, Any]) -> dict[str, Any]:
    """The core's result with the report as callers read it."""
    report = found["report"]
    lists = {name: [written(entry) for entry in report[name]] for name in ("warnings", "repairs")}
    return {**found, "report": {**report, **lists}}
