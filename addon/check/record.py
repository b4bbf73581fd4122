# SPDX-License-Identifier: GPL-3.0-or-later
"""What a check found, kept with the object as JSON in a custom property, for the panel."""

import json

from ..inspection import freshness
from ..native import core
from ..read.mesh import read_mesh
from ..read.source import control_mesh

KEY = "fairing_check"


def check_object(context, target):
    """Runs the core's check on the mesh of `target`, in whatever mode, and remembers what it found. Returns the defects as dicts."""
    with control_mesh(context, target) as mesh:
        arrays = read_mesh(mesh)
    found = core().check(arrays.positions, (arrays.corners, arrays.offsets))
    defects = [
        {
            "code": defect.code,
            "message": defect.message,
            "kind": defect.kind,
            "elements": [list(e) if isinstance(e, tuple) else int(e) for e in defect.elements],
            "severity": defect.severity,
        }
        for defect in found
    ]
    store(context, target, defects)
    return defects


def store(context, target, defects):
    target[KEY] = json.dumps({"defects": defects, "counts": freshness.watch(context, target.data)})
    _parsed.pop(target.name_full, None)


def recall(target):
    """(defects, whether the mesh was changed since), or None if it was never checked."""
    text = target.get(KEY)
    if not isinstance(text, str):
        return None
    record = _parse(target.name_full, text)
    return record["defects"], freshness.is_stale(target.data, record["counts"])


_parsed = {}  # object name: (text, record). The panel asks at every redraw, and lists of elements are long


def _parse(name, text):
    known = _parsed.get(name)
    if known is None or known[0] != text:
        known = _parsed[name] = (text, json.loads(text))
    return known[1]
