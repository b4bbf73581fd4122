# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of a call: a progress line, a line for each input, JSON for programs."""

import json
from collections.abc import Iterable
from math import isfinite
from typing import Any, TextIO

from .places import Place

SCHEMA = 1
DONE, FAILED, CANCELLED, NOT_RUN = "done", "failed", "cancelled", "not_run"


def counts(mesh: Any) -> dict[str, int]:
    return {"vertices": len(mesh.vertices), "faces": len(mesh.polygons)}


class Progress:
    """Shows the runs of one file's objects as one progress."""

    def __init__(self, stream: TextIO, file_name: str, runs: int) -> None:
        self._stream = stream
        self._name = file_name
        self._runs = runs
        self._done = 0
        self._shown: tuple[int, str] | None = None
        self._over = stream.isatty()

    def __call__(self, fraction: float, phase: str) -> None:
        """The `progress` of `discrete_fairing.fair`."""
        percent = int(100 * (self._done + fraction) / self._runs)
        state = (percent, phase) if self._over else (self._done, phase)
        if state == self._shown:
            return
        self._shown = state
        text = f"{self._name}: {percent:3d} % {phase}"
        self._stream.write(f"\r{text:<79}" if self._over else text + "\n")
        self._stream.flush()

    def next_run(self) -> None:
        self._done += 1

    def clear(self) -> None:
        if self._over and self._shown is not None:
            self._stream.write("\r" + " " * 79 + "\r")
            self._shown = None


def new_record(place: Place, settings: dict[str, Any]) -> dict[str, Any]:
    """The entry of an input that has not been run yet. `settings`: a dict."""
    return {
        "input": str(place.source),
        "output": str(place.target),
        "status": NOT_RUN,
        "error": None,
        "notes": [],
        "warnings": [],
        "seconds": 0.0,
        "settings": settings,
        "objects": [],
    }


def error_entry(code: str, message: str, elements: Iterable[int] = ()) -> dict[str, Any]:
    return {"code": code, "message": message, "elements": [int(element) for element in elements]}


def document(versions: dict[str, str], exit_code: int, records: list[dict[str, Any]]) -> str:
    """The whole report as JSON text; NaN, which JSON does not have, becomes null."""
    whole = {"schema": SCHEMA, **versions, "exit_code": exit_code, "inputs": records}
    return json.dumps(_finite(whole), indent=2, allow_nan=False, default=str) + "\n"


def line(record: dict[str, Any]) -> str:
    """For example `in.obj: 24 faces → 384 faces in 0.21 s`, of a finished input."""
    objects = record["objects"]
    before = sum(item["control"]["faces"] for item in objects)
    kind = "patches" if "patches" in objects[0]["result"] else "faces"
    after = sum(item["result"][kind] for item in objects)
    return f"{record['input']}: {before:,} faces → {after:,} {kind} in {record['seconds']:.2f} s"


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not isfinite(value) else value
