# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar tab "Fairing": few controls first, the rest folded."""

from typing import Any, cast

import bpy
from bl_ui.utils import PresetPanel

from .. import core, errors, prediction, size, vertex_values
from ..blender import Context, Mesh, Object
from ..check.cages import REASONS, shown_settings
from ..choices import INTERPOLATION_NAMES
from ..core import keeps_marks, tolerance
from ..live import switch
from ..memory import FAIRING_PG_surface, recall, source_problem
from ..mesh import marks
from ..mesh.mesh_changes import coarse_triangles, shown
from ..mesh.object import session_key
from ..mesh.read import read_mesh, source_objects
from ..mesh.read_curves import has_curves
from ..mesh.world_shape import world_shape
from ..mesh.write import FAULTS, NO_POINTS
from ..properties import FairingSettings
from ..purposes import PRESET_FOLDER, is_shipped, job_of
from ..queue import running, status_text
from ..settings import Settings, halves, is_evaluated, is_limit, is_near, subdivision
from ..surfaces import neighbours
from ..surfaces.freshness import stale_surfaces, why_stale
from ..units import length_text
from ..words import listed
from .active import active_settings, live_surface, near_scans, remembered, sources_of
from .layout import (
    Remarks,
    Sidebar,
    amount_names,
    draw_fairness,
    draw_folded,
    draw_job,
    draw_notice,
    draw_shape,
    split,
)
from .pictures import PRESETS, draw_pictures, draw_purposes

_MEASURED = 100_000  # edges: some 30 ms


class VIEW3D_PT_fairing_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Fairing Presets"
    preset_subdir = PRESET_FOLDER
    preset_operator = "object.fairing_preset_apply"
    preset_add_operator = "object.fairing_preset_add"

    def draw(self, context: Context) -> None:
        draw_pictures(cast(bpy.types.UILayout, self.layout))
        super().draw(context)

    def path_menu(self, searchpaths: list[str], *args: Any, **names: Any) -> Any:
        """The user's presets, and a field to save one; shipped presets are pictures."""
        own = [path for path in searchpaths if not is_shipped(path)]
        # without a folder Blender would report it as missing; that of the pictures has no presets
        return bpy.types.Menu.path_menu(cast(Any, self), own or [str(PRESETS)], *args, **names)


class VIEW3D_PT_fairing(Sidebar, bpy.types.Panel):
    bl_label = "Fair Surface"

    @classmethod
    def poll(cls, context: Context) -> bool:
        """Not for selections of curves only, which have their own panel."""
        active = context.active_object
        of_curves = active is not None and active.type != "MESH" and has_curves(active)
        return not of_curves or bool(source_objects(context))

    def draw_header_preset(self, _context: Context) -> None:
        VIEW3D_PT_fairing_presets.draw_panel_header(self.layout)

    def draw(self, context: Context) -> None:
        layout = split(self.layout)
        if core.why_missing():
            draw_notice(layout, core.why_missing())
            return
        memory = remembered(context)
        followed = None if memory is not None else live_surface(context)
        if memory is not None:
            _draw_source(layout, memory)
            _draw_repairs(layout, context.active_object)
        elif followed is not None:
            layout.label(text=f"Live: {followed.name}", icon="REC")
        settings = active_settings(context)
        if memory is None and followed is None:
            _draw_purposes(layout)
        near = near_scans(context) if memory is not None else None
        job = "SCAN_SURFACE" if near is not None else job_of(settings)
        sources = sources_of(context, memory)
        triangles = sum(coarse_triangles(o.data) for o in sources) * 4**settings.levels
        found = [shown_settings(settings, source) for source in sources]
        limit = any(own is not None and is_limit(own) for own in found)
        flats = flats_text(settings, sources, limit)
        remarks: Remarks = {
            "levels": [_size_text(settings, sources, triangles)],
            "interpolation": [vertices_text(found, settings, sources)],
            "tolerance": [tolerance_text(context, settings, sources), _held_text(memory)],
            "boundary": [marks.boundaries_text(filter(_is_small, sources))],
            "symmetry_plane": [normals_text(settings, sources), flats],
            **missing_groups(settings, sources),
        }
        draw_job(layout, settings, remarks, job, limit)
        if near is not None:
            for name in amount_names(near):
                layout.prop(near, name)
            draw_notice(layout, near.said, icon="INFO")
        if triangles >= size.LARGE:
            draw_notice(
                layout,
                size.why_too_large(triangles) or "A large result: Blender may be slow to draw it",
            )
        queue = running()
        if queue is not None:
            layout.progress(factor=queue.fraction, text=status_text(queue))
            layout.operator("object.fairing_cancel", icon="X")
        elif memory is not None:
            draw_stale(layout, cast(Object, context.active_object))
            _draw_button(layout, "object.fairing_recompute", "FILE_REFRESH", "Recompute")
            _draw_places(layout, memory)
        elif followed is None:
            _draw_surface(layout, context, settings, bool(sources))
        draw_live(layout, context)
        if memory is not None:
            _draw_neighbour(layout, memory)
        if (memory is None or memory.neighbour is None) and neighbours.pair(context):
            layout.operator("object.fairing_match_border", icon="SNAP_EDGE")
        if memory is not None:
            _draw_cad(layout)
        header, more = layout.panel("fairing.more", default_closed=True)
        header.label(text="More")
        if more is not None:
            if job and near is None:
                draw_fairness(more, settings, remarks)
            draw_shape(more, settings, remarks)
            _draw_flats(more, bool(flats))
            draw_folded(more, settings, "fairing")


def _draw_surface(
    layout: bpy.types.UILayout, context: Context, settings: FairingSettings, has_source: bool
) -> None:
    """The button that makes a surface."""
    text = "Fair Selected Faces" if settings.use_selection else "Fair Surface"
    _draw_button(layout, "object.fairing_surface", "SURFACE_DATA", text)
    if not has_source:
        layout.label(text="Select a mesh object first", icon="INFO")
    if context.mode == "EDIT_MESH" and settings.use_selection:
        layout.operator("object.fairing_in_place", icon="MOD_SMOOTH")
    draw_stale_surfaces(layout, context.active_object)


def _size_text(settings: FairingSettings, sources: list[Object], triangles: int) -> str:
    """For example `61,952 triangles, about 12 s`; empty without sources."""
    mesh = session_key(sources[0]) if len(sources) == 1 else None
    work = triangles * halves(settings)
    time = prediction.text(prediction.seconds(settings.energy, work, mesh))
    return ", ".join(filter(None, (size.count_text(triangles), time))) if triangles else ""


def _draw_places(layout: bpy.types.UILayout, memory: FAIRING_PG_surface) -> None:
    """The faults found when the surface was made, as long as its mesh has their places."""
    target = cast(Object, memory.id_data)
    attributes = target.data.attributes
    counts = (recall(target, "report") or {}).get("faults", {})
    is_faulty = any(FAULTS[kind] in attributes for kind in counts)
    if is_faulty:
        summary = errors.faults_summary(counts)
        is_fit = len(target.discrete_fairing_fit.scans) > 0
        draw_notice(layout, f"T{summary[1:]}. {errors.faults_remedy(memory, is_fit)}")
    if is_faulty or NO_POINTS in attributes:
        layout.operator("object.fairing_select_faults", icon="RESTRICT_SELECT_OFF")


def tolerance_text(context: Context, settings: FairingSettings, sources: list[Object]) -> str:
    """The length of the tolerance, with its unit; empty if it does not apply, or takes long to find."""
    if not is_near(settings) or is_evaluated(settings) or len(sources) != 1:
        return ""
    if not _is_small(sources[0]) or sources[0].mode == "EDIT":
        return ""
    mesh, shape = sources[0].data, world_shape(sources[0])

    def mean(mesh: Mesh) -> float:
        return shape.of_arrays(read_mesh(mesh)).mean_edge_length

    length = tolerance(settings, shown(mesh, ("mean edge", shape.rows), mean, 0.0))
    return "= " + length_text(context.scene, length, digits=4) if length else ""


def _is_small(source: Object) -> bool:
    """Whether panels may read the whole mesh while they are drawn."""
    return len(source.data.edges) <= _MEASURED


def _held_text(memory: FAIRING_PG_surface | None) -> str:
    """For example `37 of 63 vertices at the limit`; empty if none may move."""
    if memory is None or not is_near(memory):
        return ""
    held = (recall(cast(Object, memory.id_data), "report") or {}).get("at_tolerance")
    return f"{held[0]:,} of {held[1]:,} vertices at the limit" if held and held[1] else ""


def normals_text(settings: FairingSettings, sources: list[Object]) -> str:
    """For example `Normals: 3 fixed`; empty if there are none."""
    count = marks.count(filter(_is_small, sources), marks.NORMAL)
    if not count:
        return ""
    return f"Normals: {count} fixed" + ("" if keeps_marks(settings) else ", by Bending only")


def flats_text(settings: FairingSettings, sources: list[Object], limit: bool) -> str:
    """For example `Flat faces: 6`, or why they do not apply; empty if none is marked."""
    count = marks.count(filter(_is_small, sources), marks.FLAT)
    if not count:
        return ""
    if not keeps_marks(settings):
        return f"Flat faces: {count}, choose Bending"
    return f"Flat faces: {count}" + (", choose Through" if limit else "")


def vertices_text(
    found: list[Settings | None], settings: FairingSettings, sources: list[Object]
) -> str:
    """The meaning of Auto, or that an applied modifier is not followed; else empty. `found`: shown_settings."""
    if None in found or not sources or settings.interpolation not in ("AUTO", "LIMIT"):
        return ""
    ways = {own.interpolation for own in found if own is not None}
    subdivided = any(subdivision(source) is not None for source in sources)
    if is_evaluated(settings) and subdivided and "LIMIT" not in ways:
        return "Through: subdivided already"
    if settings.interpolation == "LIMIT":
        return ""
    if len(ways) > 1:
        return f"{listed(sorted(INTERPOLATION_NAMES[way] for way in ways))}, by their shapes"
    (way,) = ways
    if way == "EXACT":
        return "Through every vertex"
    return (
        "Limit: has Subdivision Surface"
        if subdivided
        else f"{INTERPOLATION_NAMES[way]}: {REASONS[way]}"
    )


def missing_groups(settings: FairingSettings, sources: list[Object]) -> Remarks:
    """The source that lacks a group, by setting; none if modifiers may make it."""
    found = {}
    for setting in ("tolerance_group", "pull_group"):
        name = getattr(settings, setting)
        if not name or is_evaluated(settings):
            continue
        lacking = [o.name for o in sources if not vertex_values.exists(o, o.data, name)]
        if lacking:
            found[setting] = [f"Not in {lacking[0]}"]
    return found


def _draw_source(layout: bpy.types.UILayout, memory: FAIRING_PG_surface) -> None:
    row = layout.row(align=True)
    row.prop(memory, "source")
    row.operator("object.fairing_show_source", text="", icon="RESTRICT_SELECT_OFF")
    layout.prop(memory, "follow_transform")
    problem = source_problem(cast(Object, memory.id_data))
    if problem:
        draw_notice(layout, problem)


def _draw_repairs(layout: bpy.types.UILayout, surface: Object | None) -> None:
    """What was mended of the source when this surface was made."""
    report = (recall(surface, "report") if surface else None) or {}
    mended = errors.repairs_text(report.get("repairs", ()))
    if mended:
        draw_notice(layout, mended, icon="INFO")


def _draw_purposes(layout: bpy.types.UILayout) -> None:
    header, body = layout.panel("fairing.purposes")
    header.label(text="Fair for")
    if body is not None:
        draw_purposes(body)


def _draw_button(layout: bpy.types.UILayout, operator: str, icon: Any, text: str) -> None:
    row = layout.row(align=True)
    row.scale_y = 1.5
    row.operator(operator, text=text, icon=icon)


def _draw_flats(layout: bpy.types.UILayout, marked: bool) -> None:
    """Faces that stay flat, and a button that unmarks them."""
    row = layout.row(align=True)
    row.operator("object.fairing_flat_faces")
    if marked:
        button: Any = row.operator("object.fairing_flat_faces", text="", icon="X")
        button.clear = True


def _draw_neighbour(layout: bpy.types.UILayout, memory: FAIRING_PG_surface) -> None:
    """The object that the border meets, if any, and how."""
    if memory.neighbour is not None:
        layout.prop(memory, "neighbour")
        layout.prop(memory, "joint")
        if neighbours.is_mutual(cast(Object, memory.id_data)):
            layout.label(text="Both change, each by half", icon="ARROW_LEFTRIGHT")


def _draw_cad(layout: bpy.types.UILayout) -> None:
    row = layout.row(align=True)
    row.operator("export_scene.fairing_step", text="Export STEP", icon="EXPORT")
    row.operator("object.fairing_show_patches", icon="OUTLINER_OB_SURFACE")


def draw_live(layout: bpy.types.UILayout, context: Context) -> None:
    """For the active object: a faired surface, or a mesh whose surfaces are or become live."""
    active = context.active_object
    if active is None or active.type != "MESH":
        return
    is_surface = active.discrete_fairing.source is not None
    # a surface whose source is gone must still say so
    targets = [active] if is_surface or switch.problem(active) else switch.live_surfaces_of(active)
    on = any(map(switch.is_on, targets))
    row = layout.row()
    row.operator("object.fairing_live", icon="REC" if on else "RADIOBUT_OFF", depress=on)
    for target in targets:
        _draw_target(layout, context, target)


def draw_stale(layout: bpy.types.UILayout, target: Object) -> None:
    reason = "" if switch.is_seen_to(target) else why_stale(target)
    if reason:
        row = layout.row()
        row.alert = True
        row.label(text=f"Out of date: {reason[0].lower()}{reason[1:]}", icon="ERROR")


def draw_stale_surfaces(layout: bpy.types.UILayout, source: Object | None) -> None:
    """The same for the surfaces of a source."""
    stale = (
        [] if source is None else [t for t in stale_surfaces(source) if not switch.is_seen_to(t)]
    )
    for target in stale:
        row = layout.row()
        row.alert = True
        row.label(text=f"{target.name} is out of date", icon="ERROR")
    if stale:
        layout.operator("object.fairing_recompute_stale", icon="FILE_REFRESH")


def _draw_target(layout: bpy.types.UILayout, context: Context, target: Object) -> None:
    live = target.discrete_fairing_live
    layout.prop(live, "levels")
    if live.on:
        switches = layout.column(align=True, heading="Options")
        for name in ("cage_as_wire", "in_renders"):
            switches.prop(live, name)
        render = context.scene.render
        if live.in_renders and not render.use_lock_interface:
            switches.prop(render, "use_lock_interface")
            draw_notice(layout, "Live in Renders needs Lock Interface")
    column = layout.column(align=True)
    for line in switch.lines(target):
        column.label(text=line)
    if switch.problem(target):
        draw_notice(layout, switch.problem(target))
