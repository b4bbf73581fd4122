# SPDX-License-Identifier: GPL-3.0-or-later
"""How the settings are laid out, for the sidebar and for the redo panel alike."""


def draw_shape(layout, settings, triangle_text=""):
    """The few that everyone needs; `triangle_text` stands under the levels: beside them a narrow sidebar cuts it."""
    layout.prop(settings, "levels")
    if triangle_text:
        row = layout.row()
        row.alignment = "RIGHT"
        row.label(text=triangle_text)
    layout.prop(settings, "energy")
    layout.prop(settings, "interpolation")
    if settings.interpolation == "APPROXIMATE":
        layout.prop(settings, "tolerance")
    layout.prop(settings, "boundary")
    layout.prop(settings, "shade_smooth")


def draw_creases(layout, settings):
    _switched(layout, settings, "use_crease_attribute", "crease_threshold")
    layout.prop(settings, "use_sharp_edges")
    _switched(layout, settings, "use_crease_angle", "crease_angle")
    _switched(layout, settings, "use_corner_angle", "corner_angle")


def draw_advanced(layout, settings):
    layout.prop(settings, "metric_exponent")
    layout.prop(settings, "epsilon")
    layout.prop(settings, "repair_orientation")
    layout.prop(settings, "memory_limit")


def _switched(layout, settings, switch, value):
    """A value with its switch before it, grey while that is off."""
    row = layout.row(align=True, heading=settings.bl_rna.properties[switch].name)
    row.prop(settings, switch, text="")
    sub = row.row(align=True)
    sub.active = getattr(settings, switch)
    sub.prop(settings, value, text="")
