# SPDX-License-Identifier: GPL-3.0-or-later
"""The data that a faired object keeps, and the results of checks on any mesh: hidden properties in the
file.

Records are JSON in text properties. Settings in a file may be invalid; these count as unset when the
file is opened or objects are appended from it.
"""

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, cast

import bpy
from bpy.props import CollectionProperty, FloatVectorProperty, PointerProperty

from . import events, records
from .blender import Context, Object, all_objects, all_scenes
from .fields import hidden, number, switch
from .properties import FairingSettings, FitAmount, copy_settings
from .settings import Settings

# by object and record: panels read them at every redraw, and records are long
_parsed: dict[tuple[str, str], tuple[str, dict[str, Any] | None]] = {}


def why_unfit(target: Object, source: Object) -> str:
    """Why `source` cannot control the surface `target`, in one sentence; empty if it can."""
    if source.type != "MESH":
        return f"'{source.name}' is not a mesh: choose a mesh object as the source"
    seen, above = set(), cast(Object | None, source)
    while above is not None and above.type == "MESH" and above not in seen:
        if above == target:
            return f"'{source.name}' is made from '{target.name}' itself: choose another source"
        seen.add(above)
        above = above.discrete_fairing.source
    return ""


class FAIRING_PG_surface(FairingSettings, bpy.types.PropertyGroup):
    """The source of a faired object, and how it was made."""

    source: PointerProperty(
        name="Source",
        description="The object whose mesh controls this surface",
        type=bpy.types.Object,
        poll=lambda group, source: not why_unfit(group.id_data, source),
    )
    neighbour: PointerProperty(
        name="Neighbour",
        description="The object that the border of this surface meets, where the two have vertices in common. Two"
        " surfaces that name each other meet half way",
        type=bpy.types.Object,
        poll=lambda group, other: (
            other.type == "MESH" and other not in {group.id_data, group.source}
        ),
    )
    report: hidden("Report", "What the core has reported, as JSON")
    carried: hidden("Carried", "What came from the source, by name, as JSON")
    made: hidden("Made of", "Settings and source as they were when the surface was made, as JSON")
    stood: hidden("Stood", "Where the source stood when the surface followed it last, as JSON")
    follow_transform: switch(
        "Follow Transform",
        "Moves, turns and scales with its source, until you transform the surface yourself",
        True,
    )
    unfinished: switch(
        "Unfinished",
        "The mesh has fewer levels than the settings say: Recompute makes the whole surface",
        options={"HIDDEN"},
    )
    defects: hidden("Defects", "What Check Mesh has found, as JSON")


class FAIRING_PG_scan(bpy.types.PropertyGroup):
    target: PointerProperty(
        name="Scan",
        description="The object whose points the surface is near",
        type=bpy.types.Object,
    )


class FAIRING_PG_fit(FitAmount, bpy.types.PropertyGroup):
    """The scans of a surface near scans; empty for other surfaces."""

    scans: CollectionProperty(type=FAIRING_PG_scan)
    weight: number("Weight", "How strongly points pull", options={"HIDDEN"})
    said: hidden("Fit", "How near the surface is")


class FAIRING_PG_mesh(bpy.types.PropertyGroup):
    """Properties of a mesh that belong to its curvature colours and its normals."""

    curvature_range: FloatVectorProperty(
        name="Curvature Range",
        description="The values that have the lowest and the highest colour",
        size=2,
        options={"HIDDEN"},
    )
    joint_normals: switch(
        "Joint Normals",
        "The mesh has custom normals where its border meets another's",
        options={"HIDDEN"},
    )


def remember(target: Object, source: Object, settings: Settings, report: Mapping[str, Any]) -> None:
    """Stores on `target` its source and settings, so that it can be recomputed, and the core's report."""
    target.discrete_fairing.source = source
    target.discrete_fairing.unfinished = False
    copy_settings(settings, target.discrete_fairing)
    keep(target, "report", report)


def remember_fit(
    target: Object, scans: Sequence[Object], tolerance: float | None, weight: float, said: str
) -> None:
    """Stores on `target` its scans and amount. `tolerance`: None: as near as the noise allows."""
    kept = target.discrete_fairing_fit
    kept.scans.clear()
    for scan in scans:
        kept.scans.add().target = scan
    kept.amount = "AUTO" if tolerance is None else "TOLERANCE"
    if tolerance is not None:
        kept.tolerance = tolerance
    kept.weight, kept.said = weight, said


def scans_of(target: Object) -> list[Object]:
    """The scans of a surface that still exist."""
    kept: Any = target.discrete_fairing_fit.scans
    return [each.target for each in kept if each.target is not None]


def keep(target: Object, name: str, record: Mapping[str, Any]) -> None:
    """Stores a dict with the object `target`. `name`: one of the records in records.py."""
    setattr(target.discrete_fairing, name, json.dumps(record, default=_plain))


def recall(target: Object, name: str) -> dict[str, Any] | None:
    """The record stored by `keep`, which must not be changed; None if there is none, or an invalid one."""
    text = getattr(target.discrete_fairing, name)
    known = _parsed.get((target.name_full, name))
    if known is None or known[0] != text:
        known = _parsed[target.name_full, name] = (text, records.parse(name, text))
    return known[1]


def source_of(target: Object) -> Object | None:
    """The mesh object that `target` can be made from, or None."""
    if target.type != "MESH" or target.discrete_fairing.source is None or source_problem(target):
        return None
    return target.discrete_fairing.source


def active_source(context: Context) -> Object | None:
    """The active object, or the source of the active surface."""
    active = context.active_object
    if active is None or active.type != "MESH":
        return None
    return source_of(active) or active


def source_problem(target: Object) -> str:
    """Why `target` cannot be made from its source, in one sentence; else empty."""
    source = target.discrete_fairing.source
    return "" if source is None else why_unfit(target, source)


def no_source_reason(target: Object | None) -> str:
    """Why `target`, for which `source_of` is None, cannot be recomputed, in one sentence."""
    problem = source_problem(target) if target is not None and target.type == "MESH" else ""
    return problem or "Select a faired surface whose source still exists"


def _plain(value: Any) -> Any:
    """NumPy scalars and arrays, and other mappings, as JSON values."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "items"):
        return dict(value)
    return str(value)


_GROUPS = (
    "discrete_fairing",
    "discrete_fairing_curves",
    "discrete_fairing_live",
    "discrete_fairing_inspection",
    "discrete_fairing_strain",
    "discrete_fairing_fit",
)


def unset_unsound_settings(*_: Any) -> None:
    """Unsets invalid settings, of linked data too, since panels show these as well."""
    for owner in cast(Iterable[Any], (*all_objects(), *all_scenes())):
        for group in _GROUPS:
            _unset_unsound(getattr(owner, group, None))
    for mesh in bpy.data.meshes:
        _unset_unsound(cast(Any, mesh).discrete_fairing)


def _unset_unsound(group: Any) -> None:
    """Unsets a file's values that are not finite, out of range, or choices unknown here."""
    if group is None:
        return
    for known in group.bl_rna.properties:
        name = known.identifier
        if group.is_property_set(name) and not _is_sound(known, getattr(group, name)):
            group.property_unset(name)


def _is_sound(known: Any, value: Any) -> bool:
    if known.type == "ENUM":
        return value != ""
    if known.type not in {"INT", "FLOAT"}:
        return True
    numbers = value if known.is_array else (value,)
    return all(known.hard_min <= number <= known.hard_max for number in numbers)


HANDLERS = dict.fromkeys(("load_post", "blend_import_post"), unset_unsound_settings)


ATTACHED = (
    (bpy.types.Object, "discrete_fairing", FAIRING_PG_surface),
    (bpy.types.Object, "discrete_fairing_fit", FAIRING_PG_fit),
    (bpy.types.Mesh, "discrete_fairing", FAIRING_PG_mesh),
)
TIMERS = (unset_unsound_settings,)


def register() -> None:
    """Looks at the file that is open, as preferences.py does."""
    if not bpy.app.background:
        events.start_timer(unset_unsound_settings, 0.0)
