# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of a call: a progress line, a table for people, JSON for programs."""

import json
from collections.abc import Iterable, Mapping
from math import isfinite, nan
from typing import Any, TextIO

from .. import core
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
        "warnings": [],
        "seconds": 0.0,
        "settings": settings,
        "objects": [],
    }


def log_line(record: dict[str, Any]) -> str:
    """Status, seconds, input, output, and the error or the number of warnings, between tabs."""
    error, count = record["error"], len(record["warnings"])
    said = error["message"] if error else f"{count} warnings" if count else ""
    fields = (record["status"], f"{record['seconds']:.3f}", record["input"], record["output"], said)
    return "\t".join(" ".join(str(field).split()) for field in fields) + "\n"


def error_entry(code: str, message: str, elements: Iterable[int] = ()) -> dict[str, Any]:
    return {"code": code, "message": message, "elements": [int(element) for element in elements]}


def document(versions: dict[str, str], exit_code: int, records: list[dict[str, Any]]) -> str:
    """The whole report as JSON text; NaN, which JSON does not have, becomes null."""
    whole = {"schema": SCHEMA, **versions, "exit_code": exit_code, "inputs": records}
    return json.dumps(_finite(whole), indent=2, allow_nan=False, default=str) + "\n"


_SHARED = {"faces in": 10, "faces out": 11, "seconds": 8}


def cells(objects: list[dict[str, Any]], record: dict[str, Any]) -> tuple[str, ...]:
    """Cells of a finished input's row in the table: sums over its objects, and the worst accuracy."""
    before, after = (
        sum(_energy(item["report"], record, state) for item in objects)
        for state in ("polyhedron", "result")
    )
    energies, reports = f"{before:.4g} → {after:.4g}", [item["report"] for item in objects]
    if record["settings"]["energy"] == "THIN_PLATE":
        residual = max(_number(report.get("residuals", [nan])[-1]) for report in reports)
        return energies, f"{residual:.1e}"
    steps = max(core.step_count(report) or 0 for report in reports)
    decrement = max(core.last_decrement(report) or 0.0 for report in reports)
    return energies, f"{steps}", f"{decrement:.1e}"


def _columns(module: Any, energy: str) -> dict[str, int]:
    """Titles and widths of columns; `module`: the module that has `cells`, this one for faired meshes."""
    if hasattr(module, "COLUMNS"):
        return _SHARED | module.COLUMNS
    accuracy = {"residual": 9} if energy == "THIN_PLATE" else {"steps": 6, "decrement": 9}
    return _SHARED | {"energy before → after": 25} | accuracy


def table_head(width: int, module: Any, energy: str) -> str:
    columns = _columns(module, energy)
    return _row("file", width, columns, columns)


def table_line(record: dict[str, Any], width: int, module: Any) -> str:
    objects = record["objects"]
    faces = sum(item["control"]["faces"] for item in objects)
    out = sum(item["result"].get("faces") or item["result"].get("patches", 0) for item in objects)
    cells = (f"{faces:,}", f"{out:,}", f"{record['seconds']:.2f}", *module.cells(objects, record))
    return _row(
        record["input"], width, _columns(module, record["settings"].get("energy", "")), cells
    )


def _row(name: str, width: int, columns: dict[str, int], cells: Iterable[str]) -> str:
    padded = (f"{cell:>{wide}}" for cell, wide in zip(cells, columns.values(), strict=True))
    return " ".join([f"{name:<{width}}", *padded])


def _energy(report: Mapping[str, Any], record: dict[str, Any], state: str) -> float:
    # energies before and after are reported for two energies; the third may increase total curvature
    energy = "thin_plate" if record["settings"]["energy"] == "THIN_PLATE" else "total_curvature"
    return _number(report.get("energy", {}).get(state, {}).get(energy, nan))


def _number(value: float | None) -> float:
    """A number from another process's JSON, which has no NaN."""
    return nan if value is None else value


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not isfinite(value) else value
