# SPDX-License-Identifier: GPL-3.0-or-later
"""The format of the records that objects keep as JSON. Files may come from anywhere, and panels read
records at every redraw: records that the add-on cannot have written count as missing. No Blender.
"""

import json
from collections.abc import Callable
from typing import Any, TypeAlias

from .errors import FAULT_KINDS, REPAIR_CODES

Form: TypeAlias = Callable[[Any], bool]  # whether a value has this format

# the keys of a read-out, for a surface and for its control mesh
FIGURES = (
    "total_curvature",
    "largest_curvature",
    "curvature_98",
    "worst_fold",
    "worst_fold_with_sharp",
    "deviation",
    "steps",
    "left",
    "faces",
)

_MOST = (
    2**63
)  # of whole numbers: no count is as large, and larger ones cannot be written as decimals


def parse(name: str, text: str) -> dict[str, Any] | None:
    """The record `name` from its JSON; None if it is invalid."""
    try:
        record = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return record if _FORMS[name](record) else None


def _text(value: Any) -> bool:
    return isinstance(value, str)


def _truth(value: Any) -> bool:
    return isinstance(value, bool)


def _whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and abs(value) < _MOST


def _number(value: Any) -> bool:
    return isinstance(value, float) or _whole(value)


def _any_dict(value: Any) -> bool:
    return isinstance(value, dict)


def _id(value: Any) -> bool:
    return _whole(value) and 0 <= value < 2**31


def _pair(value: Any) -> bool:
    return _all(_id)(value) and len(value) == 2


def _matrix(value: Any) -> bool:
    return _all(_all(_number))(value) and [len(row) for row in value] == [4] * 4


def _one_of(names: frozenset[str]) -> Form:
    return lambda value: _text(value) and value in names


def _or_none(form: Form) -> Form:
    return lambda value: value is None or form(value)


def _all(form: Form) -> Form:
    return lambda value: isinstance(value, list) and all(map(form, value))


def _dict(needed: dict[str, Form], others: dict[str, Form] | None = None) -> Form:
    """A dict with the `needed` keys in their formats, and any of the `others` in theirs."""
    known = needed | (others or {})

    def fits(value: Any) -> bool:
        return (
            _any_dict(value)
            and value.keys() >= needed.keys()
            and all(form(value[key]) for key, form in known.items() if key in value)
        )

    return fits


def _counts(value: Any) -> bool:
    return _any_dict(value) and value.keys() <= FAULT_KINDS and all(map(_whole, value.values()))


def _defect(value: Any) -> bool:
    texts = dict.fromkeys(("code", "message", "kind", "severity"), _text)
    if not _dict({**texts, "elements": _all(lambda _: True)})(value):
        return False
    return all(map(_pair if value["kind"] == "edge" else _id, value["elements"]))


_LEVEL = _dict(
    {"steps": _all(_dict({"decrement": _number}))}, {"converged": _truth, "folds": _whole}
)
_REPAIR = _dict({"code": _one_of(REPAIR_CODES), "elements": _all(lambda _: True)})
_FIGURES = _dict({}, dict.fromkeys(FIGURES, _or_none(_number)))
_NAMES = dict.fromkeys(("attributes", "groups", "marks", "keys"), _all(_text))
_SCANS = _dict({"shape": _whole, "places": _all(_matrix)})

_FORMS = {
    "report": _dict({}, {"curvature": _all(_LEVEL), "faults": _counts, "repairs": _all(_REPAIR)}),
    "readout": _dict(
        {
            "after": _FIGURES,
            "before": _or_none(_FIGURES),
            "counts": _all(_whole),
        }
    ),
    "carried": _dict({}, _NAMES),
    "stood": _any_dict,
    "made": _dict(
        {"settings": _any_dict, "source": _whole},
        {"neighbour": _text, "scans": _SCANS, "beside": _SCANS},
    ),
    "defects": _dict(
        {"defects": _all(_defect), "counts": _all(_whole)},
        {"holes": _all(_dict({"edges": _id, "at": _pair})), "cleaned": _all(_text)},
    ),
}
