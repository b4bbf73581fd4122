# SPDX-License-Identifier: GPL-3.0-or-later
"""The format of the records that objects keep as JSON. Files may come from anywhere, and panels read
records at every redraw: records that the add-on cannot have written count as missing. No Blender.
"""

import json
from typing import Any

from .errors import FAULT_KINDS, REPAIR_CODES

# limit of whole numbers: no count is as large, and larger ones cannot be written as decimals
_MOST = 2**63


def parse(name: str, text: str) -> dict[str, Any] | None:
    """The record `name` from its JSON; None if it is invalid."""
    try:
        record = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return record if _has(record, _FORMS[name]) else None


def _has(value: Any, form: Any) -> bool:
    """Whether `value` has a form. A form is a type, a function that tests the value, a tuple of forms of
    which one must fit, a list with the form of all elements, or a dict with the form of each key; a key
    that ends in ? may be missing.
    """
    if isinstance(form, tuple):
        return any(_has(value, each) for each in form)
    if isinstance(form, list):
        return isinstance(value, list) and all(_has(each, form[0]) for each in value)
    if isinstance(form, dict):
        return isinstance(value, dict) and all(_has_key(value, *item) for item in form.items())
    if form is int:
        return isinstance(value, int) and not isinstance(value, bool) and abs(value) < _MOST
    return isinstance(value, form) if isinstance(form, type) else bool(form(value))


def _has_key(record: dict[str, Any], key: str, form: Any) -> bool:
    name = key.rstrip("?")
    return _has(record[name], form) if name in record else name != key


def _id(value: Any) -> bool:
    return _has(value, int) and 0 <= value < 2**31


def _pair(value: Any) -> bool:
    return _has(value, [_id]) and len(value) == 2


def _matrix(value: Any) -> bool:
    return _has(value, [[_NUMBER]]) and [len(row) for row in value] == [4] * 4


def _repair(value: Any) -> bool:
    return _has(value, {"code": str, "elements": list}) and value["code"] in REPAIR_CODES


def _counts(value: Any) -> bool:
    return _has(value, {f"{kind}?": int for kind in FAULT_KINDS}) and value.keys() <= FAULT_KINDS


def _defect(value: Any) -> bool:
    texts = dict.fromkeys(("code", "message", "kind", "severity"), str)
    if not _has(value, {**texts, "elements": list}):
        return False
    return _has(value["elements"], [_pair if value["kind"] == "edge" else _id])


_NUMBER = (int, float)
_LEVEL = {"steps": [{"decrement": _NUMBER}], "converged?": bool, "folds?": int}
_NAMES = {f"{name}?": [str] for name in ("attributes", "groups", "marks", "keys")}
_SCANS = {"shape": int, "places": [_matrix]}

_FORMS: dict[str, Any] = {
    "report": {"curvature?": [_LEVEL], "faults?": _counts, "repairs?": [_repair]},
    "carried": _NAMES,
    "stood": dict,
    "made": {
        "settings": dict,
        "source": int,
        "neighbour?": str,
        "scans?": _SCANS,
        "beside?": _SCANS,
    },
    "defects": {
        "defects": [_defect],
        "counts": [int],
        "holes": [{"edges": _id, "at": _pair, "width": _NUMBER}],
        "cleaned": [str],
    },
}
