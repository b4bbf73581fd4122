# SPDX-License-Identifier: GPL-3.0-or-later
"""The texts of errors: what to do in Blender, and then the core's own sentence."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from . import core
from .settings import AnySettings
from .words import counted, listed

# The core calls a hole whose rim has no width there DEGENERATE_FACE.
VERTEX_ON_EDGE = "VERTEX_ON_EDGE"
_OR_MEND = ", or set Defects to Mend"
# One sentence for every code that a user of Blender can meet; it begins with an instruction, like all
# refusals.
REMEDIES = {
    "EMPTY_MESH": "Add a mesh with faces",
    "NO_FACES": "Fill the edges with faces (F in Edit Mode)",
    "NON_FINITE": "Delete these vertices, or type a position for them in the sidebar (N, Item)",
    "REPEATED_VERTEX": "Run Mesh > Clean Up > Degenerate Dissolve",
    "DUPLICATE_FACE": "Delete one of each pair",
    "NONMANIFOLD_EDGE": "Leave them: the sheets meet in a curve. Delete inner faces that you do not want",
    "NONMANIFOLD_VERTEX": "Leave them, or separate the parts (V)",
    "INCONSISTENT_ORIENTATION": f"Recalculate the normals (Shift N in Edit Mode){_OR_MEND}",
    "NON_ORIENTABLE": "Set Fairness to Bending, or cut it open along a row of edges (V in Edit Mode)",
    "DEGENERATE_FACE": "Run Mesh > Clean Up > Degenerate Dissolve",
    "COINCIDENT_VERTICES": "Merge them with Mesh > Merge > By Distance, unless the surface is meant to be open there",
    "ISOLATED_VERTICES": "Leave them, or run Mesh > Clean Up > Delete Loose",
    "OPEN_HOLE": "Fill them with Fill Hole Fair, unless the surface is meant to be open there",
    "CROSSING_FACES": "Run Clean Scan with Noise if they come from noise, or select these and the faces around (Ctrl Numpad +), and use Fill Hole Fair",
    VERTEX_ON_EDGE: "Cut the edges there, and merge the new vertices with these, or fill by hand",
    "UNDERDETERMINED": "Set Vertices to Through, or a smaller tolerance",
    "TOO_EXTREME": "Move far vertices back to the others or delete them, and even out very thin faces",
    "TOO_LARGE": "Use fewer levels, or raise the Memory Limit",
    "OUT_OF_MEMORY": "Use fewer levels, or close other programs",
    "STRAIGHT_CURVE": "Add vertices along the border or crease, or widen the faces beside it",
    "MEMORY_EXCEEDED": "Use fewer levels, if memory is short",
    "NO_THREAD": "Close other programs",
    "UNRESOLVED": "Move or add vertices there, crease the edges where it turns, or export with Write Faulty Faces",
    "PATCH_TOLERANCE": "Raise Levels, Tolerance or Angle of the export, or add vertices there",
    "SURFACE_TOLERANCE": "Raise Tolerance, or set Fairness to Curvature: it settles sooner",
    "FIT_TOO_COARSE": "Add edges to these faces of the cage (Loop Cut, Subdivide), and press Recompute",
    "FIT_NO_POINTS": "Leave them: the surface is as fair there as its surroundings allow; or scan that place again",
    "FIT_OUTLIERS": "Leave them: they have no effect; or delete them",
    "NOT_CONVERGED": "Set Spacing to ½ or lower, or use fewer levels",
}
_UNRESOLVED_TAUTER = "Move or add vertices there, crease the edges where it turns, raise Tension, or export with Write Faulty Faces"
# The same where there is no setting Defects, for scans, and for holes.
WITHOUT_MENDING = {code: text.removesuffix(_OR_MEND) for code, text in REMEDIES.items()}
OF_FITS = REMEDIES | {
    "INCONSISTENT_ORIENTATION": "Recalculate the normals of cage and scan (Shift N in Edit Mode), or flip those of an open one (Alt N)",
    "SURFACE_TOLERANCE": "Raise Tolerance, or add edges there to the cage, and press Recompute",
}
OF_HOLES = WITHOUT_MENDING | {
    "BAD_OPTION": "Select the hole without its islands, or fill it by hand",
    "NONMANIFOLD_EDGE": "Delete the surplus faces at its rim",
    "NONMANIFOLD_VERTEX": "Fill it by hand, or separate its rim there (V)",
    "REPEATED_VERTEX": "Cut it there into two holes",
    "TOO_LARGE": "Lower Density, or fill it in parts",
}
# by code, of one element or several
_WHAT = {
    "NON_FINITE": "{vertex has|vertices have} no finite position",
    "REPEATED_VERTEX": "{face uses|faces use} a vertex twice",
    "DUPLICATE_FACE": "{face lies on another one|faces lie on one another}",
    "NONMANIFOLD_EDGE": "{edge joins|edges join} more than two faces",
    "NONMANIFOLD_VERTEX": "{vertex joins|vertices join} parts that touch only there",
    "INCONSISTENT_ORIENTATION": "{face points against its|faces point against their} neighbours",
    "DEGENERATE_FACE": "{face has|faces have} no area",
    "COINCIDENT_VERTICES": "{vertex lies on another one|vertices lie on others} without being joined",
    "ISOLATED_VERTICES": "{vertex has|vertices have} no face",
    "OPEN_HOLE": "{edge is at a hole|edges are at holes}",
    VERTEX_ON_EDGE: "{vertex lies on a border edge|vertices lie on border edges} without being joined to {it|them}",
    "CROSSING_FACES": "{face passes|faces pass} through others",
    "UNRESOLVED": "{face has|faces have} a surface that folds or turns too sharply for patches",
    "PATCH_TOLERANCE": "{face has a patch that misses|faces have patches that miss} the tolerance",
    "FIT_TOO_COARSE": "{face is|faces are} too large to follow the scan",
    "FIT_NO_POINTS": "{face has|faces have} no points of the scan",
    "FIT_OUTLIERS": "{point is|points are} far off the surface near this scan",
    "SURFACE_TOLERANCE": "{face has|faces have} a surface that still changes by more than the tolerance from level to level",
}
_WHOLE = {
    "EMPTY_MESH": "The mesh is empty",
    "NO_FACES": "The mesh has no faces",
    "NON_ORIENTABLE": "The surface has only one side, like a Möbius strip, so it has no outside",
}


class JobError(Exception):
    """Why an object cannot be faired, as a sentence for its user.

    `code`, `kind`, `elements`: those of the core's error; "", "mesh", () if the core did not raise it.
    """

    def __init__(
        self, sentence: str, code: str = "", kind: str = "mesh", elements: Iterable[Any] = ()
    ) -> None:
        super().__init__(sentence)
        self.code = code
        self.kind = kind
        self.elements = list(elements)


class JobCancelled(JobError):
    """The user has cancelled."""


def what(defect: dict[str, Any]) -> str:
    """A defect (of defects.check_object) with the number of its elements, in one sentence."""
    code, count = defect["code"], len(defect["elements"])
    if code in _WHAT and count:
        return f"{counted(count, _WHAT[code])}."
    return _sentence(_WHOLE.get(code, defect["message"]))


def remedy(
    code: str, settings: AnySettings | None = None, remedies: Mapping[str, str] = REMEDIES
) -> str:
    """What to do about an error, in one sentence; empty if nothing is known."""
    if code not in remedies:
        return ""
    more = code == "UNRESOLVED" and settings is not None and _may_be_tauter(settings)
    return _sentence(_UNRESOLVED_TAUTER if more else remedies[code])


def _may_be_tauter(settings: AnySettings) -> bool:
    """Whether the `settings` allow more Tension; Flow Lines have none."""
    return settings.energy != "MINIMUM_VARIATION" and settings.tension < 1.0


def error_text(object_name: str, error: Any, remedies: Mapping[str, str] = REMEDIES) -> str:
    """One paragraph for a FairingError: the object, what to do, and the cause with its place."""
    # The core's cure is for callers in Python; this module has one for Blender.
    cause, cure = error.cause, remedies.get(error.code, error.cure)
    if cure and "_" not in cause.partition(" ")[0]:  # without names of Python's parameters
        cause = cause[:1].upper() + cause[1:]
    return f"{object_name}: {' '.join(_sentence(part) for part in (cure, cause) if part)}"


@contextmanager
def explained(object_name: str, remedies: Mapping[str, str] = REMEDIES) -> Iterator[None]:
    """A context in which an error of the core becomes a JobError with a text for the user."""
    fairing_error = core.module().FairingError
    try:
        yield
    except fairing_error as error:
        kind = JobCancelled if error.code == "CANCELLED" else JobError
        raise kind(
            error_text(object_name, error, remedies), error.code, error.kind, error.elements
        ) from error


# For surfaces that are usable but not exact, by the core's code: what to do, and the cause.
# fmt: off
_UNFINISHED = {
    "NOT_CONVERGED": ("Use fewer levels, or set Fairness to Bending, for an exact answer",
                      "The surface can be used, but could be a little fairer"),
    "NOT_CONVERGED_TOLERANCE": ("Lower the tolerance for an exact answer",
                                "The tolerance is kept, but the surface could be a little fairer"),
    "NOT_CONVERGED_TURNED_OVER": ("Turn the fixed normals towards the faces around them, or free them",
                                  "At one of them the surface is flipped"),
    "NOT_CONVERGED_NORMALS": ("Fix fewer normals, or turn them towards the faces around",
                              "The surface does not have all of them exactly"),
    "NOT_CONVERGED_PADS": ("Lower Hold Softly for an exact answer",
                           "The surface can be used, but could be a little fairer around its vertices"),
    "NOT_CONVERGED_SWOLLEN": ("Set Fairness to Bending: most of the surface would swell to a bubble",
                              "This is the surface of Bending"),
    "NOT_CONVERGED_START": ("Use fewer levels, or set Fairness to Bending",
                            "No fairer surface was found than the initial one, which you have now"),
}
# fmt: on


def is_unfinished(warning: Mapping[str, Any]) -> bool:
    """Whether one of the core's warnings says that the surface is not exact."""
    return warning["code"] in _UNFINISHED


# The core's cures for a change of thickness or a bulge: its name of a setting, and the panel's.
_CURES = {
    "energy": "set Fairness to Bending",
    "tension": "raise Tension",
    "metric_exponent": "set Spacing to ¼",
    "interpolation": "set Vertices to Limit",
    "creases": "crease the edges where it turns",
    "vertices": "add vertices there",
}


def _thickness_text(warning: Mapping[str, Any]) -> tuple[str, str]:
    """What to do and the cause, for the core's warning of a change of thickness or of a bulge."""
    settings = core.module().errors.settings_to_change(warning)
    words = listed([_CURES[setting] for setting in settings], "or")
    return words[0].upper() + words[1:], warning["cause"]


def warning_text(object_name: str, warning: Mapping[str, Any]) -> str:
    if warning["code"] in ("THICKNESS_CHANGED", "BULGES"):
        return f"{object_name}: {' '.join(map(_sentence, _thickness_text(warning)))}"
    sentences = _UNFINISHED.get(warning["code"], (warning["message"],))
    return f"{object_name}: {' '.join(map(_sentence, sentences))}"


def unfinished_text(object_name: str, energy: str) -> str:
    """The text for a surface whose steps ended early; `energy`: its name in the interface."""
    return (
        f"{object_name}: Even out the thinnest faces of the source and the sharpest folds, which Mesh Analysis shows in Edit "
        "Mode, or set Fairness to Bending, for an exact answer. "
        f"The surface can be used, but {energy} could make it a little fairer."
    )


_FAULTS = {
    "crossing": "crosses itself",
    "far": "bulges by more than the edges of its source are long",
    "folded": "is folded",
}
FAULT_KINDS = frozenset(_FAULTS)


def faults_text(
    object_name: str, counts: Mapping[str, int], settings: AnySettings, is_fit: bool
) -> str:
    """The faults of a surface, from the number of points at each, and what helps."""
    summary = faults_summary(counts)
    return f"{object_name}: {faults_remedy(settings, is_fit)} T{summary[1:]}: Select Places in the panel shows where."


def faults_in_place_text(object_name: str, counts: Mapping[str, int], settings: AnySettings) -> str:
    """The same for faces faired in their own mesh, which have no panel."""
    reasons = listed([f"{_FAULTS[kind]} ({count:,} points)" for kind, count in counts.items()])
    return f"{object_name}: {faults_remedy(settings)} Ctrl Z undoes it. What was faired {reasons}."


def faults_summary(counts: Mapping[str, int]) -> str:
    """For example `the surface crosses itself and is folded`, from counts by kind of fault."""
    return f"the surface {listed([_FAULTS[kind] for kind in counts])}"


def faults_remedy(settings: AnySettings, is_fit: bool = False) -> str:
    """What to do about faults, in one sentence; `settings`: those of the surface, which may be near a scan."""
    if settings.energy == "MINIMUM_VARIATION":
        return "Set Fairness to Bending, or to Curvature with Tension."
    help_by = [] if settings.energy == "THIN_PLATE" else ["set Fairness to Bending"]
    if _may_be_tauter(settings):
        help_by.insert(0, "raise Tension")
    if is_fit:
        help_by.append("draw the cage nearer to the scan")
    elif settings.interpolation in ("EXACT", "FLATS"):
        help_by.append("set Vertices to Limit or Near")
    help_by.append("add vertices there")
    words = listed(help_by, "or")
    return _sentence(words[0].upper() + words[1:])


def pads_text(pads: Mapping[str, Any]) -> str:
    """How many vertices are held by points instead of pads, in one sentence; empty if none."""
    gone = pads.get("gone", 0)
    if not gone:
        return ""
    if not any(pads.get("widths", ())):
        return "Not held softly, as the steps did not settle with it: faces turn sharply."
    return f"Not held softly at {counted(gone, '{vertex|vertices}')}, where faces turn sharply."


# repairs of one element or several
_DONE = {
    "BAD_SHAPE": "{face|faces} of fewer than three corners dropped",
    "INDEX_OUT_OF_RANGE": "{face with a vertex that does|faces with vertices that do} not exist dropped",
    "NON_FINITE": "{vertex|vertices} without a finite position moved",
    "REPEATED_VERTEX": "{face freed of a doubled corner|faces freed of doubled corners}",
    "COINCIDENT_VERTICES": "{vertex|vertices} merged",
    "DUPLICATE_FACE": "duplicate {face|faces} dropped",
    "DEGENERATE_FACE": "{face|faces} without area dissolved",
    "INCONSISTENT_ORIENTATION": "{face|faces} flipped",
}
REPAIR_CODES = frozenset(_DONE)


def repairs_text(repairs: Iterable[Mapping[str, Any]]) -> str:
    """The repairs, in one sentence from the report's `repairs`; empty if there were none."""
    done = [counted(len(act["elements"]), _DONE[act["code"]]) for act in repairs]
    return f"{', '.join(done)}; Check Mesh shows them." if done else ""


def _sentence(text: str) -> str:
    return text if text.endswith((".", "!", "?")) else text + "."
