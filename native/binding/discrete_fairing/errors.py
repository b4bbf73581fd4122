# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors and warnings as data; their sentences, with places for elements, are written at the end."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from . import _native
from ._native import FairingError

_LENGTH = re.compile(r"\{length:([^}]*)\}")
_SETTING = re.compile(r"\{setting:(\w+)[^}]*\}")


def fairing_error(
    code: str, cause: str, elements: Sequence[int] = (), kind: str = "mesh", cure: str = ""
) -> FairingError:
    """A FairingError. In `cause` and `cure` "{face}", "{vertex}" and "{edge}" stand for the elements,
    "{has|have}" for the word that agrees with their number, "{length:0.25}" for a length.
    """
    return _native.error(code, cause, cure, list(elements), kind)


def about(error: FairingError, elements: Sequence[int], prefix: str = "") -> FairingError:
    """The same error for other elements of its kind; `prefix` starts its first sentence."""
    cause, cure = error._sentences
    return fairing_error(error.code, prefix + cause, elements, error.kind, cure)


def written(entry: Mapping[str, Any]) -> dict[str, Any]:
    """A warning or repair for callers: "message" is both sentences, filled in."""
    kind, elements = entry["kind"], entry["elements"]
    sentences = entry["cause"], entry["cure"]
    cause, cure = (_native.text(sentence, kind, elements) for sentence in sentences)
    message = f"{cause} {cure}".rstrip()
    return {**entry, "cause": cause, "cure": cure, "message": message, "sentences": sentences}


def with_lengths(entry: Mapping[str, Any], length: Callable[[float], str]) -> dict[str, Any]:
    """The same warning of a report; `length` formats its lengths."""
    cause, cure = (_with(length, sentence) for sentence in entry["sentences"])
    return written({**entry, "cause": cause, "cure": cure})


def error_with_lengths(error: FairingError, length: Callable[[float], str]) -> FairingError:
    """The same error; `length` formats its lengths."""
    cause, cure = (_with(length, sentence) for sentence in error._sentences)
    return fairing_error(error.code, cause, error.elements, error.kind, cure)


def _with(length: Callable[[float], str], sentence: str) -> str:
    return _LENGTH.sub(lambda found: length(float(found[1])), sentence)


def settings_to_change(entry: Mapping[str, Any]) -> list[str]:
    """The names of the settings in the cure of a warning, the best cure first."""
    return _SETTING.findall(entry["sentences"][1])


def written_report(found: dict[str, Any]) -> dict[str, Any]:
    """The core's result with the report as callers read it."""
    report = found["report"]
    lists = {name: [written(entry) for entry in report[name]] for name in ("warnings", "repairs")}
    return {**found, "report": {**report, **lists}}
