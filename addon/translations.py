# SPDX-License-Identifier: GPL-3.0-or-later
"""The hook for translations: Blender looks every label and tooltip of the add-on up here, by its English text.

A language is a dictionary from ("*" or "Operator", English) to its own words; operators' labels have a context of
their own.
"""

import bpy

_GERMAN = {
    ("*", "Fair Surface"): "Glatte Fläche",
    ("Operator", "Fair Surface"): "Fläche glätten",
    ("Operator", "Fair Selected Faces"): "Ausgewählte Flächen glätten",
    ("Operator", "Recompute"): "Neu berechnen",
    ("Operator", "Check Mesh"): "Netz prüfen",
    ("*", "This Surface"): "Diese Fläche",
    ("*", "Levels"): "Stufen",
    ("*", "Energy"): "Energie",
    ("*", "Thin Plate"): "Dünne Platte",
    ("*", "Total Curvature"): "Gesamtkrümmung",
    ("*", "Minimum Variation"): "Geringste Änderung",
    ("*", "Through"): "Hindurch",
    ("*", "Near"): "Nahe",
    ("*", "Tolerance"): "Toleranz",
    ("*", "Live Levels"): "Stufen bei Live",
    ("*", "Creases"): "Falten",
    ("*", "Spacing"): "Abstände",
    ("*", "Keep Symmetry"): "Symmetrie erhalten",
    ("*", "Selected Faces Only"): "Nur ausgewählte Flächen",
    ("*", "Joint"): "Anschluss",
    ("*", "Touching"): "Berührend",
    ("*", "Tangent"): "Tangential",
    ("*", "Hide Source"): "Quelle ausblenden",
    ("*", "Copy Modifiers"): "Modifikatoren übernehmen",
}

LANGUAGES = {"de": _GERMAN, "de_DE": _GERMAN}  # before and after Blender 4.0's renaming


def register():
    bpy.app.translations.register(__package__, LANGUAGES)


def unregister():
    bpy.app.translations.unregister(__package__)
