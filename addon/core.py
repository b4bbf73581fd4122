# SPDX-License-Identifier: GPL-3.0-or-later
"""The native core: imported on first use, so that Blender starts even without its wheel.

The only place that knows both names of a setting, Blender's and that of `discrete_fairing.fair`. Plain
arrays, no Blender.
"""

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np

from .control_arrays import ControlArrays
from .settings import AnySettings, PatchOptions, Settings, is_limit, is_near

MISSING = "The native module 'discrete_fairing' could not be loaded: reinstall the extension for this Blender version"

_OF_LIMIT = ("limit", "edge_sharpness", "vertex_sharpness")
# FLATS is exact, and AUTO is resolved where the source is known
_CORE_INTERPOLATION = {"APPROXIMATE": "approximate", "LIMIT": "limit"}
_AT = 0.99  # share of its tolerance from which a vertex counts as at the tolerance


@cache
def _load() -> tuple[Any, str]:
    try:
        import discrete_fairing
    except ImportError as error:
        return None, f"{MISSING} ({error})"
    return discrete_fairing, ""


def module() -> Any:
    """The module `discrete_fairing`; raises ImportError with a text for the user."""
    found, reason = _load()
    if found is None:
        raise ImportError(reason)
    return found


def measured(arrays: ControlArrays) -> Any:
    """The package's ControlMesh of these arrays: lengths, areas, angles, and what follows from them."""
    mesh = arrays.positions, arrays.corners, arrays.offsets, arrays.edges, arrays.corner_edges
    return module().control_mesh.ControlMesh(*mesh)


def why_missing() -> str:
    """Why the core cannot be used, in one sentence; empty if it can."""
    return _load()[1]


def fair_arguments(
    arrays: ControlArrays,
    settings: Settings,
    preferences: Any,
    region: np.ndarray | None = None,
    shapes: np.ndarray | None = None,
    tolerance_factors: np.ndarray | None = None,
    pulls: np.ndarray | None = None,
    edge_length: float = 0.0,
) -> dict[str, Any]:
    """Keyword arguments for `discrete_fairing.fair`, with `vertices` and `faces`.

    `region`: (r,) ids of the faces to fair, None for all. `shapes`: (k, n, 3) further positions, such
    as shape keys. `tolerance_factors`: (n,) shares of the tolerance at each vertex, None for the whole.
    `pulls`: (n,) weights, None for none. `edge_length`: the reference of a relative tolerance.

    Nothing is measured; callers that show a measured number request it.
    """
    threshold = _threshold(settings)
    allowed = tolerance(settings, edge_length)
    flats = flat_faces(arrays, settings)
    arguments = {
        "vertices": arrays.positions,
        "faces": (arrays.corners, arrays.offsets),
        "levels": settings.levels,
        "energy": settings.energy.lower(),
        "metric_exponent": max(
            settings.metric_exponent, 0.0 if flats is None else module().flats.SPACING
        ),
        "interpolation": _CORE_INTERPOLATION.get(settings.interpolation, "exact"),
        "tolerance": allowed if tolerance_factors is None else allowed * tolerance_factors,
        "pad_size": settings.pad_size,
        # the steps of minimum variation fail under it
        "tension": 0.0 if settings.energy == "MINIMUM_VARIATION" else settings.tension,
        "crease_edges": crease_edges(arrays, settings),
        "corner_vertices": _corners(arrays, settings),
        "crease_angle": settings.crease_angle if settings.use_crease_angle else None,
        "corner_angle": settings.corner_angle if settings.use_corner_angle else None,
        "boundary": "curve" if settings.boundary == "CORNERS" else settings.boundary.lower(),
        "boundary_edges": arrays.boundary_edges(),
        "repair": settings.repair.lower(),
        "memory_limit": preferences.memory_limit * 2**20,
        "threads": preferences.threads,
        "measure": False,
    }
    if arrays.normals is not None and keeps_marks(settings):
        arguments["normals"] = arrays.normals
    if flats is not None:
        arguments["flat_faces"] = flats
    if is_limit(settings):
        arguments |= _limit(arrays, settings)
    elif threshold is not None:
        arguments["soft_creases"] = arrays.soft_creases(threshold)
    if pulls is not None:
        arguments["weights"] = pulls
    if settings.weld > 0 and settings.repair == "MEND":
        arguments["weld"] = settings.weld
    if settings.symmetry_plane != "NONE":
        arguments["symmetry_plane"] = settings.symmetry_plane.lower()
    if region is not None:
        arguments |= {"region": region, "joint": settings.joint.lower()}
    if shapes is not None and len(shapes):
        arguments["shapes"] = shapes
    return arguments


def _threshold(settings: Settings) -> float | None:
    """The least weight of a crease; None: no weight makes one."""
    return settings.crease_threshold if settings.use_crease_attribute else None


def crease_edges(arrays: ControlArrays, settings: Settings) -> np.ndarray:
    """(k, 2) int32 vertex pairs of the edges that are creases by their weights, or marked sharp."""
    return arrays.crease_edges(_threshold(settings), settings.use_sharp_edges)


def _limit(arrays: ControlArrays, settings: Settings) -> dict[str, Any]:
    """The arguments for limit positions, and the sharpness of creases as in Subdivision Surface."""
    found: dict[str, Any] = {"limit": settings.limit}
    if not settings.use_crease_attribute:
        return found
    if (edges := arrays.edge_sharpness()) is not None:
        found["edge_sharpness"] = edges
    corners = arrays.vertex_sharpness()
    if corners.any():
        found["vertex_sharpness"] = corners
    return found


def keeps_marks(settings: AnySettings) -> bool:
    """Whether fixed normals apply, and flat faces; the other energies cannot hold them."""
    return settings.energy == "THIN_PLATE"


def keeps_flats(settings: AnySettings) -> bool:
    """Whether flat faces apply: limit positions are not in the planes of the faces."""
    return keeps_marks(settings) and not is_limit(settings)


def flat_faces(arrays: ControlArrays, settings: Settings) -> np.ndarray | None:
    """(f,) ids of the faces that stay flat, marked or found by FLATS; None if there are none."""
    if not keeps_flats(settings):
        return None
    kept = np.zeros(len(arrays.face_sizes), bool)
    if arrays.has_flats:
        kept |= arrays.flat_face
    if settings.interpolation == "FLATS":
        kept |= found_flats(arrays, settings, module().flats.ANGLE)
    return np.flatnonzero(kept) if kept.any() else None


def found_flats(arrays: ControlArrays, settings: Settings, angle: float) -> np.ndarray:
    """(m,) bool: large flat faces between tight rims, of faces that meet at less than `angle` (degrees). They may
    end at edges where the settings let the surface turn.
    """
    sharp = sharp_edges(arrays, settings)
    return np.asarray(module().flats.kept_faces(measured(arrays), angle, sharp))


def sharp_edges(arrays: ControlArrays, settings: Settings) -> np.ndarray:
    """(e,) bool: edges at which the settings let the surface turn."""
    sharp = np.zeros(len(arrays.edges), bool)
    if settings.use_crease_attribute and arrays.edge_crease is not None:
        sharp |= arrays.edge_crease > 0
    if settings.use_sharp_edges and arrays.sharp_edge is not None:
        sharp |= arrays.sharp_edge
    if settings.use_crease_angle:
        sharp |= measured(arrays).fold_angles[0] > np.degrees(settings.crease_angle)
    return sharp


def with_partner(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments with the surface of a `partner`, computed now, as neighbour met half way."""
    own = dict(arguments)
    partner = own.pop("partner", None)
    return own if partner is None else own | {"neighbour": partner(), "halfway": True}


def faired(arguments: Mapping[str, Any], **watchers: Any) -> Any:
    """The Result of discrete_fairing for `fair_arguments`."""
    return module().fair(**with_partner(arguments), **watchers)


def patch_arguments(fairing: Mapping[str, Any], options: PatchOptions) -> dict[str, Any]:
    """Keyword arguments for `discrete_fairing.fit_patches`."""
    left_out = ("levels", "tolerance", "measure")
    return {name: value for name, value in fairing.items() if name not in left_out} | {
        "fair_tolerance": fairing["tolerance"],
        "tolerance": options.fit_tolerance or None,
        "normal_tolerance": options.fit_angle or None,
        "levels": options.fit_levels or None,
        "force": options.force,
    }


# settings of the surface itself, or for vertices that a fit moves anyway
_NOT_OF_FITS = {"energy", "interpolation", "tolerance", "fair_tolerance", "weights", "normals"}
_NOT_OF_FITS |= {"pad_size", "measure"}


def of_fits(fairing: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of `fair_arguments` or `patch_arguments` that a fit to a scan takes too."""
    return {name: value for name, value in fairing.items() if name not in _NOT_OF_FITS}


def patches_on_scan(arguments: Mapping[str, Any], scan: Mapping[str, Any]) -> dict[str, Any]:
    """`patch_arguments` for the surface near a scan; `scan` has arguments of `discrete_fairing.fit`, with
    the levels of that surface.
    """
    # the tolerance is that of the patches
    return of_fits(arguments) | {"tolerance": arguments["tolerance"], "scan": scan}


class SolverFromStart:
    """Like discrete_fairing.Solver, for surfaces that `make` computes from scratch each time."""

    vertex_origin = None

    def __init__(self, make: Callable[..., Any], arguments: Mapping[str, Any]) -> None:
        self._make, self._arguments = make, dict(arguments)

    def solve(self, vertices: np.ndarray | None = None, **watchers: Any) -> Any:
        moved = {} if vertices is None else {"vertices": vertices}
        result = self._make(**(self._arguments | moved), **watchers)
        result.report["warm"] = False
        return result


def solver(arguments: Mapping[str, Any]) -> Any:
    """A solver for moving vertices; may fit a `scan`, or meet a `neighbour`, of the arguments."""
    own = dict(arguments)
    scan = own.pop("scan", None)
    if scan is not None:
        return SolverFromStart(module().fit, {**of_fits(own), **scan})
    return module().Solver(**own)


def plate_arguments(fairing: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments for `strain` and `ease`: the plate on pads; levels above two change nothing."""
    left_out = {"shapes", "measure", "weights", "tolerance", *_OF_LIMIT}
    return {name: value for name, value in fairing.items() if name not in left_out} | {
        "levels": 2,
        "energy": "thin_plate",
        "interpolation": "exact",
        "pad_size": fairing["pad_size"] or 1.0,
    }


def released_arguments(fairing: Mapping[str, Any], free: np.ndarray) -> dict[str, Any]:
    """Arguments of a surface that begins with the vertices, `free` (n,) ones as the plate's."""
    return plate_arguments(fairing) | {
        "interpolation": "approximate",
        "weights": np.where(free, 0.0, np.inf),
        "repair": "refuse",
        "measure": False,
    }


def tolerance(settings: AnySettings, edge_length: float) -> float:
    """The largest allowed distance of a vertex from the surface; 0: passes through all."""
    unit = edge_length if settings.tolerance_unit == "RELATIVE" else 1.0
    return settings.tolerance * unit if is_near(settings) else 0.0


def at_tolerance(arguments: Mapping[str, Any], surface: np.ndarray) -> list[int]:
    """How many vertices of `surface` (N, 3) are as far off as they may be, and off at all."""
    points = arguments["vertices"]
    allowed = np.broadcast_to(arguments["tolerance"], len(points))
    may = (allowed > 0) & np.isin(np.arange(len(points)), arguments["faces"][0])
    off = np.linalg.norm(surface[: len(points)] - points, axis=1)
    may &= off > 0
    return [int((off[may] >= _AT * allowed[may]).sum()), int(may.sum())]


def _corners(arrays: ControlArrays, settings: Settings) -> np.ndarray:
    """All vertices at which the settings let curves end."""
    found = arrays.corner_vertices(_threshold(settings))
    if settings.boundary != "CORNERS":
        return found
    ends = border_corners(arrays)
    # the border does not end at the plane of symmetry
    if settings.symmetry_plane != "NONE" and len(ends):
        near = module().halves.SNAP * np.ptp(arrays.positions, axis=0).max()
        off = np.abs(arrays.positions[ends, "XYZ".index(settings.symmetry_plane)])
        ends = ends[off > near]
    return np.union1d(found, ends)


def border_corners(arrays: ControlArrays) -> np.ndarray:
    """Corners (c,) of the border, except those at edges with a boundary of their own."""
    own = arrays.boundary_edge
    marked = np.zeros(len(arrays.edges), bool) if own is None else own != 0
    return np.asarray(measured(arrays).border_corners(marked))


def are_equal(a: Any, b: Any) -> bool:
    """Whether two values are equal: dictionaries and tuples by their parts, arrays by their elements."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(are_equal(a[name], b[name]) for name in a)
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(are_equal, a, b))
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return np.array_equal(a, b)
    return type(a) is type(b) and a == b


def _finest_level(report: Mapping[str, Any]) -> dict[str, Any] | None:
    """The report's entry for the finest level; None for the thin plate, which takes one solve."""
    levels = report.get("curvature") or [None]
    return levels[-1]


def has_converged(report: Mapping[str, Any]) -> bool:
    """Whether the steps have converged; the thin plate's single solve has a warning of its own."""
    level = _finest_level(report)
    return level is None or level["converged"]


def folds(report: Mapping[str, Any]) -> int:
    """Number of folded edges on the finest level; 0 if they were not counted."""
    level = _finest_level(report)
    return 0 if level is None else level["folds"]
