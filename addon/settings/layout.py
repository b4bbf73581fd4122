# SPDX-License-Identifier: GPL-3.0-or-later
"""How the settings are laid out, for the sidebar, the redo panel and a faired object's memory alike."""

from .properties import ENERGY_MEANINGS


def draw_shape(layout, settings, triangle_text=""):
    """The few that everyone needs; `triangle_text` stands under the levels: beside them a narrow sidebar cuts it."""
    layout.prop(settings, "levels")
    if triangle_text:
        _remark(layout, triangle_text)
    layout.prop(settings, "energy")
    _remark(layout, ENERGY_MEANINGS[settings.energy])
    layout.prop(settings, "interpolation")
    if settings.interpolation == "APPROXIMATE":
        layout.prop(settings, "tolerance")
    layout.prop(settings, "boundary")


def draw_source(layout, settings):
    layout.prop(settings, "use_selection")
    if settings.use_selection:
        layout.prop(settings, "joint")
    row = layout.row()
    row.enabled = not settings.use_selection
    row.prop(settings, "mesh_source")
    if settings.use_selection:
        _reason(layout, "Faces are selected on the mesh as modelled")
    layout.prop(settings, "keep_symmetry")
    layout.prop(settings, "repair_orientation")


def draw_creases(layout, settings):
    _switched(layout, settings, "use_crease_attribute", "crease_threshold")
    layout.prop(settings, "use_sharp_edges")
    _switched(layout, settings, "use_crease_angle", "crease_angle")
    _switched(layout, settings, "use_corner_angle", "corner_angle")


def draw_result(layout, settings):
    layout.prop(settings, "shade_smooth")
    layout.prop(settings, "hide_source")
    evaluated = settings.mesh_source == "EVALUATED" and not settings.use_selection
    column = layout.column()
    column.enabled = not evaluated
    column.prop(settings, "use_shape_keys")
    column.prop(settings, "copy_modifiers")
    if evaluated:
        _reason(layout, "Both are already in the mesh With Modifiers")


def draw_advanced(layout, settings):
    layout.prop(settings, "metric_exponent")
    layout.prop(settings, "epsilon")
    layout.prop(settings, "memory_limit")


FOLDED = (
    ("Source", draw_source),
    ("Creases", draw_creases),
    ("Result", draw_result),
    ("Advanced", draw_advanced),
)


def draw_settings(layout, settings, identifier, triangle_text=""):
    """All of them, the rare ones folded; `identifier` tells Blender which of them are open."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    draw_shape(layout, settings, triangle_text)
    for label, draw in FOLDED:
        header, body = layout.panel(f"{identifier}.{label}", default_closed=True)
        header.label(text=label)
        if body is not None:
            draw(body, settings)


def _reason(layout, text):
    """Why what stands above is grey."""
    _remark(layout, text, icon="INFO")


def _remark(layout, text, icon="NONE"):
    """A few words on what stands above."""
    row = layout.row()
    row.alignment = "RIGHT"
    row.label(text=text, icon=icon)


def _switched(layout, settings, switch, value):
    """A value with its switch before it, grey while that is off."""
    row = layout.row(align=True, heading=settings.bl_rna.properties[switch].name)
    row.prop(settings, switch, text="")
    sub = row.row(align=True)
    sub.active = getattr(settings, switch)
    sub.prop(settings, value, text="")
