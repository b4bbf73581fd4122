# SPDX-License-Identifier: GPL-3.0-or-later
"""fair(): from a control mesh to its fair surface, in one call."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import nullcontext

from numpy.typing import ArrayLike

from . import _native
from .arrays import face_arrays, shape_array, vertex_array
from .halves import Half
from .options import SETTINGS, native_options
from .result import Result
from .strain import require_strain, strain_of
from .watching import Progress, check_watchers


def fair(
    vertices: ArrayLike,
    faces: ArrayLike | Sequence[Sequence[int]],
    levels: int = 3,
    energy: str = "thin_plate",
    *,
    metric_exponent: float = 0.5,
    chart_blend: float = 1.0,
    chart: str = "exponential",
    interpolation: str | None = None,
    tolerance: float | ArrayLike = 0.0,
    weights: ArrayLike | None = None,
    limit: float = 1.0,
    edge_sharpness: tuple[ArrayLike, ArrayLike] | None = None,
    vertex_sharpness: ArrayLike | None = None,
    epsilon: float = 0.0,
    pad_size: float = 1.0,
    normals: ArrayLike | None = None,
    tension: float = 0.0,
    crease_edges: ArrayLike | None = None,
    crease_angle: float | None = None,
    corner_vertices: ArrayLike | None = None,
    corner_angle: float | None = None,
    boundary: str = "curve",
    boundary_edges: Mapping[str, ArrayLike] | None = None,
    region: ArrayLike | None = None,
    joint: str = "tangent",
    symmetry_plane: str | None = None,
    shapes: ArrayLike | Sequence[ArrayLike] | None = None,
    repair: str = "refuse",
    weld: float | None = None,
    method: str = "multigrid",
    relative_residual: float = 1e-4,
    max_iterations: int = 200,
    smoother_degree: int = 0,
    step_tolerance: float = 0.0,
    max_steps: int = 20,
    sweeps: int = 10,
    threads: int = 0,
    memory_limit: int = 0,
    measure: bool = False,
    strain: bool = False,
    progress: Progress | None = None,
    monitor: _native.Monitor | None = None,
) -> Result:
    """Refine a control mesh 1-to-4 and fair it: the new vertices minimize a bending energy.

    After Kobbelt, *Fairing by Finite Difference Methods* (1997). Neither array is changed. Any
    layout and any float or integer type works.

    Parameters
    ----------
    vertices : (n, 3) float
        Control vertices, in any unit of length.
    faces : (m, 3) or (m, 4) int, a list of polygons, or the pair (corners, offsets) of flat arrays
        Counter-clockwise. Polygons of five and more sides, and quads too concave or warped, are
        split by shape.
    levels : int
        How often every face is refined: a triangle gives 4**levels triangles, a quad 4**levels
        quads.
    energy : "thin_plate", "total_curvature" or "minimum_variation"
        Thin plate: the paper's quadratic energy over charts of the control mesh, one linear solve
        [Kobbelt 1997a, section 4]. Total curvature: the integral of k1**2 + k2**2 over the surface
        itself, which turns points on a sphere into that sphere. Minimum variation: the change of
        curvature along the surface [Moreton, Sequin 1992]. Both take Gauss-Newton steps from the
        thin plate's surface (report["curvature"]).
    metric_exponent : float from 0 to 1
        Charts are made from control edge lengths to this power: 1 the paper's, 0 uniform, 0.5
        centripetal.
    chart_blend : float from 0 to 1
        The paper's linear blend of charts: 0 uniform, 1 the chart itself.
    chart : "exponential" or "tangent"
        Exponential map of the control metric, or projection to its tangent planes.
    interpolation : "exact", "approximate", "limit" or None
        None: approximate where there is a tolerance or weights, else exact. Exact: control vertices stay, to the last bit. Approximate: they move, within `tolerance` or
        against `weights`. Vertices on curves always stay. Limit: the surface passes exactly through
        the vertices' limit positions, where Catmull-Clark subdivision would take them, and
        charts are made of the surface through these, level by level: for cages drawn to look right
        under subdivision. The first n rows of `vertices` are then the limit positions. Creases,
        borders and corners have their own rules [DeRose, Kass, Truong 1998]; vertices at corners
        and on straight borders, and those not inside a region, stay.
    limit : float from 0 to 1
        Limit: how closely the thin plate follows the subdivision surface between the limit positions,
        from 0, not at all, to 1: rims and thin walls then do not wave. Other energies do not follow.
    edge_sharpness : (edges, sharpness), (k, 2) int and (k,) float or one number, subdivision steps
        Limit: vertex pairs of semi-sharp edges, and for how many subdivision steps each is sharp; 10
        and more is for ever. It counts for a crease too, which otherwise is sharp for ever. Blender's
        crease c has the sharpness 10 c**2.
    vertex_sharpness : (n,) float, subdivision steps
        Limit: the same of vertices; 0: none.
    tolerance : float or (n,) float, mesh units
        Approximate: the farthest that any control vertex moves, or each of them; the energy is as
        low as that allows. One number 0 means none. In an array, 0 interpolates a vertex, and
        infinity leaves it to its weight.
    weights : (n,) float, dimensionless
        Approximate: the pull of each control vertex on the surface. 0 leaves a vertex free (where
        there is no tolerance), infinity interpolates it.
    epsilon : float, mesh units
        How far interpolated vertices may move after the solve, to remove cusps [Kobbelt 1997a,
        section 5]. For the thin plate only.
    pad_size : float from 0 to 1
        What holds control vertices off curves. 0: point forces, which leave a spot of curvature at
        each. Otherwise forces spread over pads, which leave none: each reaches the same length
        along all edges, at 1 up to 1.5 times the shortest edge at its vertex, and less where the
        mesh turns unevenly. The surface still passes through every vertex.
    normals : (n, 3) float
        The surface's normal at each control vertex, of any length; NaN or zero: none. Vertices on
        curves take none (report["warnings"]). For the thin plate, from level 1 on.
    tension : float from 0 to 1
        A membrane stretched over the control mesh beside its bending, against swelling and
        overshoots: 0 none, 1 as taut as is of use.
    crease_edges : (k, 2) int
        Vertex pairs of the edges that are creases.
    crease_angle, corner_angle : float, radians
        Edges folded by more are creases; curves that turn by more at a vertex end there. None: no
        such rule.
    corner_vertices : (c,) int
        Vertices where curves end; inside a surface, the tip of a cone.
    boundary : "curve", "linear" or "free"
        A smooth curve through the boundary's own vertices, its straight edges, or fixed at its
        vertices only.
    boundary_edges : mapping from "curve", "linear" or "free" to (k, 2) int
        Vertex pairs of the boundary edges that are other than `boundary` says. Curves end where the
        kind of boundary changes. Edges that are no boundary are left alone.
    region : (r,) int
        The faces to fair; all others are refined linearly, and stay. None: all faces.
    joint : "position", "tangent" or "curvature"
        How the region meets the other faces: along straight edges, with their tangent planes, or
        with curvature that fades out as well. A crease on the joint makes it "position" there.
    symmetry_plane : "x", "y", "z" or None
        The mesh is half of a symmetric one: its border in the plane x = 0 (y, z) is no border, but
        where the surface crosses to its mirror image. The result is the half. The report is that
        of the whole.
    shapes : (k, n, 3) float, or a list of (n, 3)
        Further positions of the same control vertices, such as shape keys. Each becomes a surface
        on the charts and stencils of `vertices` (result.shapes), so the surface is one linear map
        of the positions.
    repair : "refuse" or "mend"
        What happens to a mesh with defects. Mend: duplicate faces, doubled corners, sides without
        length and faces without area go, and faces that look the wrong way turn over
        (report["repairs"], result.mended). All ids, of creases, regions and the result, stay those
        of the mesh as given.
    weld : float, mesh units
        With repair="mend": vertices no farther apart become one; 0: those at one point. None: no
        welding.
    method : "multigrid" or "back_leg"
        The solution of the linear system, or the paper's own refine-and-smooth with `sweeps` sweeps
        a level.
    relative_residual : float
        Where the solver stops: residual relative to the control polyhedron's, and error relative to
        the solution in the energy norm. 1e-4 leaves nothing to see: positions
        within 1e-4 of the mesh's size, on smooth meshes within 1e-5 in the median. Take 1e-8 for measurements.
    step_tolerance : float, share of the mesh's size
        The Gauss-Newton steps stop when the points still have to move less than this. 0: 0.1 of
        relative_residual, from 1e-6 to 1e-5.
    max_steps : int
        The most Gauss-Newton steps on a level.
    max_iterations, smoother_degree, sweeps : int
        Limits and work of the solver; degree 0 is chosen from how the coarse levels converge.
    threads : int
        0: all cores. The result is the same, to the last bit, for any number.
    memory_limit : int, bytes
        Refuse runs that would take more; 0: three quarters of the machine's memory.
    measure : bool
        Measure the energies of the result, the control polyhedron and the prediction (else NaN);
        takes up to half of a run's time again.
    strain : bool
        Measure how the control vertices fight the surface (result.strain, report["strain"]), as
        strain() does: with total curvature too, for the thin plate through the same vertices.
        Not with minimum variation, whose vertices stand on no pads, and not where vertices move.
    progress : callable(fraction, phase)
        Called from this thread some 40 times a second; returning False cancels.
    monitor : Monitor
        For watching and cancelling from another thread.

    Returns
    -------
    Result
        vertices, triangles, faces, shapes, report.

    Raises
    ------
    FairingError
        With `code`, `elements` and a message that says what to do. CANCELLED after a cancel.
    """
    # locals() holds just the arguments here, so that no setting is listed again.
    settings = {name: value for name, value in locals().items() if name in SETTINGS}
    check_watchers(progress, monitor)
    points = vertex_array(vertices)
    corners, offsets = face_arrays(faces)
    others = shape_array(shapes, len(points))
    half = None
    if symmetry_plane is not None:
        given = native_options(
            **settings
        )  # refuses what the caller has given, not what is made of it
        half = Half(points, corners, offsets, symmetry_plane, given.repair)
        points, others, settings = half.points(points), half.shapes(others), half.settings(settings)
        corners, offsets = half.faces(corners, offsets)
    options = native_options(**settings)
    watch = monitor or _native.Monitor()
    if strain:
        require_strain(settings)
    with half.named() if half else nullcontext():
        found = _native.fair(points, corners, offsets, others, options, watch, progress)
    result = Result(half.cut(found) if half else found)
    if strain:
        strained = strain_of(points, corners, offsets, settings, half, watch)
        result.strain = strained.lengths
        result.report["strain"] = strained.report()
    return result
