# SPDX-License-Identifier: GPL-3.0-or-later
"""Spline patches: what fit_patches() returns."""

from __future__ import annotations

from copy import copy
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..arrays import connected_parts, numbers
from ..errors import fairing_error
from ..result import Result


def spline_knots(spans: int) -> np.ndarray:
    """(spans + 7,) float64: the knots of a cubic, uniform on [0, 1] and clamped at both ends."""
    inside = np.linspace(0.0, 1.0, spans + 1)
    return np.concatenate([[0.0] * 3, inside, [1.0] * 3])


class SplinePatches:
    """P bicubic B-spline patches, C2 inside, that share E edges and V vertices.

    Knots are uniform and clamped (spline_knots). A patch covers a grid of control quads, as large as
    creases, borders and extraordinary vertices allow; a control triangle is three, around its
    centroid. Lengths are in mesh units, angles in radians.

    vertices: (V, 3) float64.
    patch_spans: (P, 2) int32, along u and v. Patch p has (spans + 3) control points each way.
    patch_points: (C, 3) float64, the control points of all patches; net(p) has those of one.
    patch_offsets: (P + 1,) int64: patch p has the rows patch_offsets[p] ... [p + 1] - 1.
    patch_faces: (F,) or more int32; patch_face_offsets: (P + 1,) int64: the control faces of each
    patch, row by row; all triangles come first, then all quads.
    patch_polygon: (P,) int32, the first input face that each covers; polygons(p) has all.
    patch_plane: (P,) int32, the (first) input face where it is flat between creases or borders, and is
    written as one plane; patches of a polygon that was split may fold within it; otherwise -1.
    patch_shell: (P,) int32, the shell that each belongs to.
    shell_closed: (S,) bool, whether a shell has no free edge.
    edge_spans: (E,) int32; edge_points: (D, 3) float64; edge_offsets: (E + 1,) int64; as of patches.
    edge_vertices: (E, 2) int32, where an edge starts and ends.
    edge_kind: (E,) uint8, 0 smooth, 1 crease, 2 boundary.
    loop_edges: (L,) int32; loop_forward: (L,) bool; loop_offsets: (P + 1,) int64: the edges around
    each patch, counter-clockwise, from u = v = 0 along u; four, or more where others end at a side.
    residual: (P,) float64, the farthest that a point of the refined surface is from its patch, or
    the patch from that surface between its points.
    turned: (P,) float64, the sharpest angle between the normals of patch and refined surface.
    edge_error: (E,) float64, how far the curve is from the refined surface at most: across the
    surface; along it too where the edge is a crease or a border.
    edge_angles: (E, 17) float64, between the normals on both sides: the largest near each of so many
    places evenly along each edge; NaN
    along creases and boundaries, and at the tips of sharp kinks, where borders or creases meet at a
    corner and the surface does not lie in their plane. At slight ones it is the angle of the kink.
    edge_jumps: (E, 17) float64, 1 over mesh units: how much the curvature across each edge differs
    between both sides, in the same way.
    face_off: (F,) float64, how far the patch of a control face, or a curve beside it, is off there;
    face_angle: (F,) float64, the sharpest angle at its sides, without those of slight kinks.
    refinement_error: (P,) float64, how far the refined surface itself is about from the limit of finer
    ones, by what has changed in the patch's control face from the level below.
    unresolved: (u,) int64, input faces where the refined surface folds, or turns too sharply.
    size: float, the largest extent along an axis.
    tolerance, normal_tolerance: float, those asked for; tolerance is a share of the size.
    levels: int, of the refined surface; result: Result, that surface; with a scan a Fitted.
    scan_distances: (S,) float64, of each point of a scan from its patch, along the patch's normal,
    positive outside; NaN where the surface has no place for it; None without a scan.
    """

    def __init__(self, arrays: dict[str, Any], result: Result, levels: int):
        self.result = result
        self.levels = levels
        self.vertices: np.ndarray = arrays["vertices"]
        self.patch_spans: np.ndarray = arrays["patch_spans"]
        self.patch_points: np.ndarray = arrays["patch_points"]
        self.patch_offsets = _offsets((self.patch_spans.astype(np.int64) + 3).prod(axis=1))
        self.patch_faces: np.ndarray = arrays["patch_faces"]
        self.patch_face_offsets: np.ndarray = arrays["patch_face_offsets"]
        self._control_polygons = control_polygons(result, levels)
        self.patch_polygon = self._control_polygons[self.patch_faces[self.patch_face_offsets[:-1]]]
        self.patch_plane: np.ndarray = arrays["patch_plane"]
        self.edge_spans: np.ndarray = arrays["edge_spans"]
        self.edge_points: np.ndarray = arrays["edge_points"]
        self.edge_offsets = _offsets(self.edge_spans.astype(np.int64) + 3)
        self.edge_vertices: np.ndarray = arrays["edge_vertices"]
        self.edge_kind: np.ndarray = arrays["edge_kind"]
        self.loop_edges: np.ndarray = arrays["loop_edges"]
        self.loop_forward = arrays["loop_forward"].astype(bool)
        self.loop_offsets: np.ndarray = arrays["loop_offsets"]
        self.residual: np.ndarray = arrays["residual"]
        self.turned: np.ndarray = arrays["turned"]
        self.edge_error: np.ndarray = arrays["edge_error"]
        self.edge_angles: np.ndarray = arrays["angles"]
        self.edge_jumps: np.ndarray = arrays["jumps"]
        self.face_off: np.ndarray = arrays["face_off"]
        self.face_angle: np.ndarray = arrays["face_angle"]
        self.size: float = arrays["size"]
        self.tolerance: float = arrays["tolerance"]
        self.normal_tolerance: float = arrays["normal_tolerance"]
        self._lattice_error: np.ndarray = arrays["lattice_error"]
        self.refinement_error = np.zeros(len(self))
        np.maximum.at(
            self.refinement_error, self._patch_of_faces, self._lattice_error[self.patch_faces]
        )
        self.unresolved: np.ndarray = arrays["unresolved"]
        self.patch_shell, self.shell_closed = self._shells()
        self.scan_distances: np.ndarray | None = None

    def __len__(self) -> int:
        return len(self.patch_spans)

    def net(self, p: int) -> np.ndarray:
        """(spans_u + 3, spans_v + 3, 3) float64: the control points of patch p, a view."""
        rows, columns = self.patch_spans[p] + 3
        first = self.patch_offsets[p]
        return self.patch_points[first : first + rows * columns].reshape(rows, columns, 3)

    def polygons(self, p: int) -> np.ndarray:
        """(k,) int32: the input faces of patch p."""
        part = slice(self.patch_face_offsets[p], self.patch_face_offsets[p + 1])
        return np.unique(self._control_polygons[self.patch_faces[part]])

    def covering(self, polygons: ArrayLike) -> np.ndarray:
        """(P,) bool: whether a patch covers one of these input faces."""
        found = np.zeros(len(self), bool)
        own = np.isin(self._control_polygons[self.patch_faces], polygons)
        found[self._patch_of_faces[own]] = True
        return found

    def worst(self, polygons: ArrayLike) -> tuple[float, float]:
        """The largest distance from the fair surface, mesh units, and the largest angle at sides, radians,
        in these input faces; (0, 0) for none.
        """
        own = np.isin(self._control_polygons, polygons)
        off = (self.face_off + self._lattice_error)[own].max(initial=0)
        return float(off), float(np.fmax.reduce(self.face_angle[own], initial=0))

    def edge(self, e: int) -> np.ndarray:
        """(spans + 3, 3) float64: the control points of edge e, a view."""
        return self.edge_points[self.edge_offsets[e] : self.edge_offsets[e + 1]]

    def loop(self, p: int) -> list[tuple[int, bool]]:
        """The edges around patch p, counter-clockwise, and whether each runs forward."""
        part = slice(self.loop_offsets[p], self.loop_offsets[p + 1])
        return list(zip(self.loop_edges[part].tolist(), self.loop_forward[part].tolist()))

    def transformed(self, matrix: ArrayLike) -> SplinePatches:
        """A copy of the patches at matrix @ (x, y, z, 1). A mirror image is reversed, so that normals
        still point outwards. Errors stay in the old mesh units; `result` is not transformed. Raises
        FairingError BAD_SHAPE for anything but a matrix of finite numbers.
        """
        given = numbers(matrix, "matrix", "iuf").astype(float)
        if given.shape not in ((3, 4), (4, 4)) or not np.isfinite(given).all():
            raise fairing_error(
                "BAD_SHAPE",
                f"matrix has shape {given.shape}; it must be (4, 4) or (3, 4), of finite numbers.",
            )
        linear, shift = given[:3, :3], given[:3, 3]
        moved = copy(self)
        for name in ("vertices", "patch_points", "edge_points"):
            setattr(moved, name, getattr(self, name) @ linear.T + shift)
        if np.linalg.slogdet(linear)[0] < 0:
            moved._turn()
        return moved

    def _turn(self) -> None:
        """Exchanges u and v."""
        nets = [self.net(p).transpose(1, 0, 2).reshape(-1, 3) for p in range(len(self))]
        loops = [self.loop(p)[::-1] for p in range(len(self))]
        self.patch_points = np.concatenate([np.empty((0, 3)), *nets])
        self.patch_spans = self.patch_spans[:, ::-1].copy()
        steps = [step for loop in loops for step in loop]
        self.loop_edges = np.array([edge for edge, _ in steps], np.int32)
        self.loop_forward = np.array([not forward for _, forward in steps], bool)

    @property
    def written(self) -> np.ndarray:
        """(k,) int64: the patches that are faces of a CAD file; of those in one plane the first."""
        first = np.unique(self.patch_plane, return_index=True)[1]
        return np.union1d(np.flatnonzero(self.patch_plane < 0), first)

    @property
    def off(self) -> np.ndarray:
        """(P,) float64, mesh units: the largest distance of each patch from the fair surface."""
        return self._fit + self.refinement_error

    @cached_property
    def unmet(self) -> np.ndarray:
        """(k,) int64: input faces where a patch or an edge misses a tolerance."""
        return self._missing(self.face_off + self._lattice_error)

    @property
    def largest_miss(self) -> float:
        """The largest distance or angle of a face in units of its tolerance; 1 or less if all are met."""
        return float(self._misses(self.face_off + self._lattice_error).max(initial=0))

    @property
    def all_meet(self) -> bool:
        """Whether no angle at a side misses the tolerance."""
        return not (self.face_angle > self.normal_tolerance).any()

    @property
    def unmet_by_fit(self) -> np.ndarray:
        """(k,) int64: faces of `unmet` whose patches miss the tolerance from the refined surface too."""
        return self._missing(self.face_off)

    @property
    def unmet_by_surface(self) -> np.ndarray:
        """(k,) int64: the other faces of `unmet`, whose patches meet the tolerance, but whose refined
        surface still changes from level to level. Finer patches do not cure this.
        """
        return np.setdiff1d(self.unmet, self.unmet_by_fit)

    def _missing(self, off: np.ndarray) -> np.ndarray:
        return np.unique(self._control_polygons[self._misses(off) > 1]).astype(np.int64)

    def _misses(self, off: np.ndarray) -> np.ndarray:
        distance, angle = self.tolerance * self.size, self.face_angle / self.normal_tolerance
        return np.fmax(off / distance, angle) if distance else angle

    @cached_property
    def _fit(self) -> np.ndarray:
        """(P,) the largest distance of each patch and its edges from the refined surface."""
        fit = self.residual.copy()
        patch_of_steps = np.repeat(np.arange(len(self)), np.diff(self.loop_offsets))
        np.maximum.at(fit, patch_of_steps, self.edge_error[self.loop_edges])
        return fit

    @property
    def largest_off(self) -> float:
        """The largest distance of a patch from the fair surface, mesh units; `tolerance` bounds it."""
        return float(self.off.max(initial=0))

    @property
    def scan_within(self) -> tuple[float, float]:
        """Of absolute scan_distances the 95th percentile and the largest but outliers; (0, 0) without."""
        if self.scan_distances is None:
            return 0.0, 0.0
        far = np.abs(self.scan_distances)
        far[getattr(self.result, "outliers", [])] = np.nan
        far = np.sort(far[np.isfinite(far)])
        return (float(far[int(0.95 * (len(far) - 1))]), float(far[-1])) if len(far) else (0.0, 0.0)

    @property
    def _patch_of_faces(self) -> np.ndarray:
        return np.repeat(np.arange(len(self)), np.diff(self.patch_face_offsets))

    @property
    def largest_residual(self) -> float:
        """The largest distance of a point of the refined surface from its patch or edge, mesh units."""
        return float(max(self.residual.max(initial=0), self.edge_error.max(initial=0)))

    @property
    def largest_angle(self) -> float:
        """The sharpest angle between normals at a smooth edge, radians."""
        return float(np.nan_to_num(self.edge_angles).max(initial=0))

    def _shells(self) -> tuple[np.ndarray, np.ndarray]:
        count = np.bincount(self.loop_edges, minlength=len(self.edge_spans))
        patch = np.repeat(np.arange(len(self)), np.diff(self.loop_offsets))
        order = np.argsort(self.loop_edges, kind="stable")
        shared = order[count[self.loop_edges[order]] == 2].reshape(-1, 2)
        # the faces at an edge agree in orientation if they run along it in opposite directions
        agree = self.loop_forward[shared[:, 0]] != self.loop_forward[shared[:, 1]]
        shell = connected_parts(len(self), patch[shared[agree]])
        closed = np.ones(shell.max(initial=-1) + 1, bool)
        free = np.ones(len(self.edge_spans), bool)
        free[self.loop_edges[shared[agree, 0]]] = False
        closed[shell[patch[free[self.loop_edges]]]] = False
        return shell, closed

    def __repr__(self) -> str:
        return (
            f"SplinePatches({len(self)} patches, {len(self.shell_closed)} shells, "
            f"{self.largest_off / self.size if self.size else 0:.1e} of the size off, "
            f"{np.degrees(self.largest_angle):.3f} degrees at edges)"
        )


def control_polygons(result: Result, levels: int) -> np.ndarray:
    """(F,) int32: the input face of each control face, triangles first."""
    cells = 4**levels
    return np.concatenate([result.triangle_polygon[::cells], result.quad_polygon[::cells]])


def _offsets(sizes: np.ndarray) -> np.ndarray:
    return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
