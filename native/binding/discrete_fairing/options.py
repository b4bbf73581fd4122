# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts the callers' settings to the core's.

AllSettings is the one table, with each setting's type, its converter and its meaning.
Defaults and ranges are the core's (native/fairing/settings.h).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from difflib import get_close_matches
from typing import Annotated, Any, Literal, TypedDict, get_args, get_type_hints

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .converters import (
    choice,
    corner_ids,
    edges_with_values,
    face_ids,
    lengths,
    normal_rows,
    pairs_by_boundary,
    real,
    size,
    switch,
    vertex_pairs,
    weight_array,
    whole,
)


def native_options(settings: Mapping[str, Any]) -> _native.Options:
    """The core's options; settings that are not given keep their defaults.

    Settings in OPTIONAL may be None, which means the default too. The default of `interpolation` is
    "approximate" if there is a tolerance or weights. Raises FairingError BAD_OPTION and BAD_SHAPE, and
    TypeError for a name that is no setting.
    """
    options, given = _native.Options(), {}
    for name, value in settings.items():
        if name not in SETTINGS:
            near = get_close_matches(name, SETTINGS)
            known = "do you mean " if near else "the settings are "
            raise TypeError(f"{name!r} is not a setting; {known}{', '.join(near or SETTINGS)}")
        if value is not None or name not in OPTIONAL:
            given[name] = SETTINGS[name](name, value)
    if "interpolation" not in given and ("weights" in given or np.any(given.get("tolerance", 0))):
        given["interpolation"] = _native.Interpolation.approximate
    for name, value in given.items():
        setattr(options, name, value)
    return options


class CommonSettings(TypedDict, total=False):
    """The settings of all functions that make a surface; `tolerance` and `normals` are others for some."""

    metric_exponent: Annotated[float, real]
    """From 0 to 1, 0.5: charts are made from control edge lengths to this power: 1 the paper's, 0
    uniform, 0.5 centripetal."""

    chart_blend: Annotated[float, real]
    """From 0 to 1, 1: the paper's linear blend of charts: 0 uniform, 1 the chart itself."""

    chart: Annotated[Literal["exponential", "tangent"], choice(_native.Chart.__members__)]
    """Exponential map of the control metric, or projection to its tangent planes."""

    interpolation: Annotated[
        Literal["exact", "approximate", "limit", "auto"] | None,
        choice({**_native.Interpolation.__members__, "auto": _native.Interpolation.exact}),
    ]
    """None: approximate where there is a tolerance or weights, else exact. Auto: as None, but unless other
    settings exclude it, for closed meshes with flat faces at tight rims or in hollows, or slits, such as mugs, and
    for meshes whose walls would swell into each other, such as hands, limit; for closed ones bevelled all around, such as cans and cups, `flat_faces` as
    find_flats() has them and a `metric_exponent` of 0.95 at least. Exact: control vertices stay, to the last bit.
    Approximate: they move, within `tolerance` or against `weights`; vertices on curves always stay. Limit: the surface passes exactly through the vertices' limit positions,
    where Catmull-Clark subdivision would take them, and charts are made of the surface through these:
    for cages drawn to look right under subdivision. The first n rows of `vertices` are then the limit
    positions. Creases, borders and corners have their own rules [DeRose, Kass, Truong 1998]; vertices
    at corners and on straight borders, and those not inside a region, stay."""

    weights: Annotated[ArrayLike | None, weight_array]
    """(n,) float, dimensionless. Approximate: the pull of each control vertex on the surface. 0 leaves
    a vertex free (where there is no tolerance), infinity interpolates it."""

    limit: Annotated[float, real]
    """From 0 to 1, 1. Limit: how closely the surface follows the subdivision surface between the
    limit positions, from 0, not at all, to 1: rims and thin walls then do not wave."""

    edge_sharpness: Annotated[tuple[ArrayLike, ArrayLike] | None, edges_with_values]
    """(edges, sharpness): (k, 2) int and (k,) float or one number, subdivision steps. Limit: vertex
    pairs of semi-sharp edges, and for how many subdivision steps each is sharp; 10 and more is for
    ever. It counts for a crease too, which otherwise is sharp for ever. Blender's crease c has the
    sharpness 10 c**2."""

    vertex_sharpness: Annotated[ArrayLike | None, weight_array]
    """(n,) float, subdivision steps. Limit: the same of vertices; 0: none."""

    epsilon: Annotated[float, real]
    """Mesh units, 0: how far interpolated vertices may move after the solve, to remove cusps [Kobbelt
    1997a, section 5]. For the thin plate only."""

    pad_size: Annotated[float, real]
    """From 0 to 1, 1: what holds control vertices off curves. 0: point forces, which leave a spot of
    curvature at each. Otherwise forces spread over pads, which leave none: each reaches the same
    length along all edges, at 1 up to 1.5 times the shortest edge at its vertex, and less where the
    mesh turns unevenly. The surface still passes through every vertex."""

    tension: Annotated[float, real]
    """From 0 to 1, 0: a membrane stretched over the control mesh beside its bending, against swelling
    and overshoots: 0 none, 1 as taut as is of use."""

    crease_edges: Annotated[ArrayLike | None, vertex_pairs]
    """(k, 2) int: vertex pairs of the edges that are creases."""

    soft_creases: Annotated[tuple[ArrayLike, ArrayLike] | None, edges_with_values]
    """(edges, weights): (k, 2) int and (k,) float or one number: vertex pairs of edges where the surface
    turns softly. A weight c from 0 to 1 has the radius 1 - c, as a share of the faces beside the edge:
    there is the turn, with one hump of curvature. 1 is a crease, 0 none. Along a line of edges the weight
    changes smoothly; where the line ends inside the surface it is 0, where it goes on as a crease 1."""

    flat_faces: Annotated[ArrayLike | None, face_ids]
    """(f,) int: faces that are meant flat: there the surface is a hundred thousand times as stiff, and the
    rest blends into them. For the thin plate; not for limit positions, which are not in these planes."""

    crease_angle: Annotated[float | None, real]
    """Radians: edges folded by more are creases. None: no such rule."""

    corner_vertices: Annotated[ArrayLike | None, corner_ids]
    """(c,) int: vertices where curves end; inside a surface, the tip of a cone."""

    corner_angle: Annotated[float | None, real]
    """Radians: curves that turn by more at a vertex end there. None: no such rule."""

    boundary: Annotated[Literal["curve", "linear", "free"], choice(_native.Boundary.__members__)]
    """A smooth curve through the boundary's own vertices ("curve", the default), its straight edges,
    or fixed at its vertices only."""

    boundary_edges: Annotated[Mapping[str, ArrayLike] | None, pairs_by_boundary]
    """By "curve", "linear" or "free" (k, 2) int: vertex pairs of the boundary edges that are other
    than `boundary` says. Curves end where the kind of boundary changes. Edges that are no boundary are
    left alone."""

    region: Annotated[ArrayLike | None, face_ids]
    """(r,) int: the faces to fair; all others are refined linearly, and stay. None: all faces."""

    joint: Annotated[
        Literal["position", "tangent", "curvature"], choice(_native.RegionContinuity.__members__)
    ]
    """How the region meets the other faces: along straight edges, with their tangent planes (the
    default), or with curvature that fades out as well. A crease on the joint makes it "position"
    there."""

    repair: Annotated[Literal["refuse", "mend"], choice(_native.Repair.__members__)]
    """What happens to a mesh with defects. Mend: duplicate faces, doubled corners, sides without
    length and faces without area go, and faces that look the wrong way turn over (report["repairs"],
    result.mended). All ids, of creases, regions and the result, stay those of the mesh as given."""

    weld: Annotated[float | None, size]
    """Mesh units, with repair="mend": vertices no farther apart become one; 0: those at one point.
    None: no welding."""

    method: Annotated[Literal["multigrid", "back_leg"], choice(_native.Method.__members__)]
    """The solution of the linear system, or the paper's own refine-and-smooth with `sweeps` sweeps a
    level."""

    relative_residual: Annotated[float, real]
    """1e-4: where the solver stops: residual relative to the control polyhedron's, and error relative
    to the solution in the energy norm. 1e-4 leaves nothing to see: positions within 1e-4 of the mesh's
    size, on smooth meshes within 1e-5 in the median. Take 1e-8 for measurements."""

    max_iterations: Annotated[int, whole]
    """200: the most iterations of a linear solve."""

    smoother_degree: Annotated[int, whole]
    """Work of the smoother; 0 is chosen from how the coarse levels converge."""

    step_tolerance: Annotated[float, real]
    """Share of the mesh's size: the Gauss-Newton steps stop when the points still have to move less
    than this. 0: 0.1 of relative_residual, from 1e-6 to 1e-5."""

    max_steps: Annotated[int, whole]
    """20: the most Gauss-Newton steps on a level."""

    sweeps: Annotated[int, whole]
    """10: of method="back_leg"."""

    threads: Annotated[int, whole]
    """0: all cores. The result is the same, to the last bit, for any number."""

    memory_limit: Annotated[int, whole]
    """Bytes: refuse runs that would take more; 0: three quarters of the machine's memory."""

    measure: Annotated[bool, switch]
    """Measure the energies of the result, the control polyhedron and the prediction (else NaN); takes
    up to half of a run's time again."""


class Settings(CommonSettings, total=False):
    """The settings of fair(), Solver, strain() and pieces(), beside `levels` and `energy`."""

    tolerance: Annotated[float | ArrayLike, lengths]
    """Mesh units, one number or (n,), 0. Approximate: the farthest that any control vertex moves, or
    each of them; the energy is as low as that allows. One number 0 means none. In an array, 0
    interpolates a vertex, and infinity leaves it to its weight."""

    normals: Annotated[ArrayLike | None, normal_rows]
    """(n, 3) float: the surface's normal at each control vertex, of any length; NaN or zero: none.
    Vertices on curves take none (report["warnings"]). For the thin plate, from level 1 on."""


class AllSettings(Settings, total=False):
    """All settings: also those that fair() and Solver take as positional arguments."""

    levels: Annotated[int, whole]
    """3: how often every face is refined: a triangle gives 4**levels triangles, a quad 4**levels
    quads."""

    energy: Annotated[
        Literal["thin_plate", "total_curvature", "minimum_variation"],
        choice(_native.Energy.__members__),
    ]
    """Thin plate: the paper's quadratic energy over charts of the control mesh, one linear solve
    [Kobbelt 1997a, section 4]. Total curvature: the integral of k1**2 + k2**2 over the surface itself,
    which turns points on a sphere into that sphere. Minimum variation: the change of curvature along
    the surface [Moreton, Sequin 1992]. Both take Gauss-Newton steps from the thin plate's surface
    (report["curvature"])."""


_HINTS = get_type_hints(AllSettings, include_extras=True)
# the converter of each setting
SETTINGS: dict[str, Callable[[str, Any], Any]] = {
    name: hint.__metadata__[0] for name, hint in _HINTS.items()
}
# settings of one kind: one number a vertex, ids of vertices, ids of faces, pairs of vertices with a number each
ONE_A_VERTEX, VERTEX_IDS, FACE_IDS, EDGES_WITH_VALUES = (
    tuple(name for name, converter in SETTINGS.items() if converter in kind)
    for kind in ([weight_array], [vertex_pairs, corner_ids], [face_ids], [edges_with_values])
)
# settings that may be None
OPTIONAL = {name for name, hint in _HINTS.items() if type(None) in get_args(hint.__origin__)}
