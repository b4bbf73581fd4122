# SPDX-License-Identifier: GPL-3.0-or-later
"""What went wrong, in words: the core's own sentence (it names the elements), and what to do about it in Blender."""

_REMEDIES = {
    "EMPTY_MESH": "Add a mesh with faces first",
    "NO_FACES": "Fill the edges with faces (F in Edit Mode)",
    "NON_FINITE": "Delete these vertices or give them a position",
    "REPEATED_VERTEX": "Run Mesh > Clean Up > Degenerate Dissolve",
    "DUPLICATE_FACE": "Delete one of each pair",
    "NONMANIFOLD_EDGE": "Find them with Select > All by Trait > Non Manifold and delete the inner faces",
    "NONMANIFOLD_VERTEX": "Separate the parts that touch in one vertex (Mesh > Split > Faces by Edges, or V)",
    "INCONSISTENT_ORIENTATION": "Recalculate the normals (Shift N in Edit Mode), or switch on Repair Normals",
    "NON_ORIENTABLE": "A one-sided surface has no inside; cut it open along a row of edges",
    "DEGENERATE_FACE": "Run Mesh > Clean Up > Degenerate Dissolve",
    "COINCIDENT_VERTICES": "Merge them with Mesh > Merge > By Distance",
    "UNDERDETERMINED": "Use Through instead of Near, or a smaller tolerance",
    "TOO_LARGE": "Use fewer levels, or raise the Memory Limit",
    "OUT_OF_MEMORY": "Use fewer levels",
    "NOT_CONVERGED": "Set Spacing to ½ or lower, or use fewer levels",
}


def error_text(object_name, error):
    """One paragraph for a FairingError: which object, what is wrong where, what to do."""
    return " ".join(
        _sentence(part) for part in (f"{object_name}: {error}", _REMEDIES.get(error.code, "")) if part
    )


def warning_text(object_name, warning):
    return f"{object_name}: {warning['message']}"


def _sentence(text):
    return text if text.endswith((".", "!", "?")) else text + "."
