# SPDX-License-Identifier: GPL-3.0-or-later
"""Reports of a call: a line for each input, JSON for programs."""

import json
from collections.abc import Iterable
from math import isfinite
from typing import Any

from .places import Place

SCHEMA = 1
DONE, FAILED, CANCELLED, NOT_RUN = "done", "failed", "cancelled", "not_run"


def counts(mesh: Any) -> dict[str, int]:
    return {"vertices": len(mesh.vertices), "faces": len(mesh.polygons)}


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
