# SPDX-License-Identifier: GPL-3.0-or-later
"""What holds for every call of fair(), whatever goes in."""

import math
from typing import Any

import discrete_fairing as df
import numpy as np
from cases import Case


def check(case: Case) -> str:
    """A refusal in words, or a surface that is whole, the same twice. Returns which."""
    points, faces = case.points, [list(face) for face in case.faces]
    first = outcome(points, faces, case.options)
    assert points.tobytes() == case.points.tobytes(), "the vertices have changed"
    assert faces == case.faces, "the faces have changed"
    if isinstance(first, df.FairingError):
        check_refusal(first, case)
        return first.code
    check_surface(first, case)
    again = outcome(points, faces, case.options | {"threads": 1})
    assert isinstance(again, df.Result), f"refused at the second time: {again}"
    assert again.vertices.tobytes() == first.vertices.tobytes(), "other bits on one thread"
    return "surfaces"


def outcome(
    points: np.ndarray, faces: list, options: dict[str, Any]
) -> df.Result | df.FairingError:
    """A surface or a refusal; any other exception is a defect."""
    try:
        return df.fair(points, faces, **options)
    except df.FairingError as error:
        return error


def check_refusal(error: df.FairingError, case: Case) -> None:
    """A code, a sentence, elements that exist."""
    assert error.code.isupper()
    text = str(error)
    assert len(text) > 15 and text[-1] in ".)", text
    assert "std::" not in text and "bad_alloc" not in text, text
    most = max(len(case.vertices), len(case.faces))
    if (error.code, error.kind) == ("INDEX_OUT_OF_RANGE", "vertex"):
        return  # it names what the mesh does not have
    assert all(0 <= element < max(most, 2) for element in error.elements), error.elements


def check_surface(result: df.Result, case: Case) -> None:
    """Finite; of the right size; through its control vertices; an honest report."""
    count = len(case.vertices)
    assert np.isfinite(result.vertices).all(), "the surface is not finite"
    for fine in result.faces:
        assert fine.size == 0 or (fine.min() >= 0 and fine.max() < len(result.vertices))
        used = np.sort(fine, axis=1)
        assert (used[:, 1:] != used[:, :-1]).all(), "a face has a vertex twice"
        assert len(np.unique(used, axis=0)) == len(used), "a face comes twice"
    control = result.vertices[:count]
    moves = case.options.get("interpolation") == "approximate" or case.options.get("epsilon")
    if not moves and case.options.get("repair") != "mend":
        kept = put_into_the_plane(case, control)
        assert control.tobytes() == kept.tobytes(), "a control vertex has moved"
    bound = largest_move(case)
    if math.isfinite(bound):
        stray = [v for act in result.report["repairs"] for v in moved_by(act)]
        moved = np.delete(np.linalg.norm(control - case.points, axis=1), stray).max(initial=0)
        size = np.ptp(case.points, axis=0).max()
        assert moved <= bound + 0.02 * bound + 1e-3 * size, f"moved by {moved}, tolerance {bound}"
    check_report(result.report)


def check_report(report: dict[str, Any]) -> None:
    """What has not converged is said, and nothing else is."""
    for level in report["levels"]:
        assert not level["converged"] or math.isfinite(level["residual"])
    for level in report["curvature"]:
        assert not level["converged"] or math.isfinite(level["left"])
        assert level["converged"] or not ends_worse(level), "a level ends worse than it began"
        assert not (level["converged"] and level["kept_start"])
    told = sum(w["code"].startswith("NOT_CONVERGED") for w in report["warnings"])
    unconverged = [s for s in report["shapes"] if not s["converged"]]
    assert (told == 0) == report["converged"], "what has not converged is said"
    assert told >= len(unconverged)


def ends_worse(level: dict[str, Any]) -> bool:
    """By the energy that its steps lower; where a start is a spike, the plate is kept in its place."""
    if level["start_variation"] > 0:
        return level["variation"] > 1.0101 * level["start_variation"] + 1e-2
    begun = level["plate_energy"] if level["kept_start"] else level["start_energy"]
    return level["energy"] > 1.0101 * max(begun, level["start_energy"]) + 1e-9


def put_into_the_plane(case: Case, control: np.ndarray) -> np.ndarray:
    """The control vertices as given, but for those in the plane of symmetry that were next to it."""
    points = case.points
    plane = case.options.get("symmetry_plane")
    if plane is None:
        return points
    height = points[:, "xyz".index(plane)]
    used = points[np.unique(np.concatenate([np.asarray(face, int) for face in case.faces]))]
    put = (np.abs(height) <= 1e-6 * np.ptp(used, axis=0).max()) & (
        control[:, "xyz".index(plane)] == 0
    )
    height[put] = control[put, "xyz".index(plane)]
    return points


def moved_by(act: dict) -> list[int]:
    """The vertices without a face that this repair has moved, since they lay out of reach."""
    return act["elements"] if act["code"] == "NON_FINITE" else []


def largest_move(case: Case) -> float:
    """The most that any control vertex may move; infinity: no bound."""
    if case.options.get("interpolation") != "approximate" or "weights" in case.options:
        return math.inf
    tolerance = np.asarray(case.options.get("tolerance", 0.0), float)
    if tolerance.ndim == 0 and tolerance == 0:
        return math.inf
    return float(tolerance.max()) + float(case.options.get("epsilon", 0.0))
