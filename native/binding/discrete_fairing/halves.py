# SPDX-License-Identifier: GPL-3.0-or-later
"""Half of a symmetric mesh: the whole mesh is faired, and the half of the surface is returned.

So the surface is smooth across the plane of symmetry, like anywhere else inside the whole.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._native import FairingError
from .arrays import face_arrays, following, vertex_array
from .automatic import resolved
from .converters import edges_with_values
from .errors import about, fairing_error
from .options import EDGES_WITH_VALUES, FACE_IDS, ONE_A_VERTEX, VERTEX_IDS, native_options

PLANES = {"x": 0, "y": 1, "z": 2}
SNAP = 1e-6  # share of the mesh's size: border vertices nearer to the plane lie in it
FAR = 1e100  # the core refuses larger coordinates, and NaN


class Control:
    """The control mesh for the core: the caller's or, with a `symmetry_plane`, its double."""

    def __init__(
        self,
        vertices: ArrayLike,
        faces: ArrayLike | Sequence[Sequence[int]],
        settings: dict[str, Any],
        symmetry_plane: str | None,
    ):
        self.points, self.settings = vertex_array(vertices), settings
        self.corners, self.offsets = face_arrays(faces)
        self.count = len(self.points)  # number of the caller's vertices
        self.half: Half | None = None
        self.options = native_options(settings)  # refuses settings as the caller has given them
        if symmetry_plane is not None:
            half = self.half = Half(*self.arrays, symmetry_plane, self.options.repair)
            self.points, self.settings = half.points(self.points), half.settings(settings)
            self.corners, self.offsets = half.faces(self.corners, self.offsets)
        self.settings = resolved(self.settings, *self.arrays)
        if self.settings is not settings:
            self.options = native_options(self.settings)

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.points, self.corners, self.offsets

    def values(self, values: np.ndarray) -> np.ndarray:
        """Converts values (n,) of the caller's vertices, or empty, to those of the core's mesh."""
        return self.half.values(values) if self.half else values

    def named(self) -> AbstractContextManager[None]:
        """A context in which the core's errors name the caller's elements."""
        return self.half.named() if self.half else nullcontext()

    def cut(self, found: dict[str, Any]) -> dict[str, Any]:
        """Converts the core's result to one of the caller's mesh."""
        return self.half.cut(found) if self.half else found


class Half:
    """The given mesh, n vertices, m faces and c corners, and its double: the caller's come first, then
    their images; vertices of border edges in the plane are their own.
    """

    def __init__(
        self,
        points: np.ndarray,
        corners: np.ndarray,
        offsets: np.ndarray,
        plane: object,
        repair: _native.Repair,
    ):
        if not isinstance(plane, str) or plane not in PLANES:
            raise fairing_error(
                "BAD_OPTION", f'symmetry_plane is {plane!r}; it must be "x", "y", "z" or None.'
            )
        self.plane, self.axis = plane, PLANES[plane]
        self.vertex_count, self.face_count = len(points), len(offsets) - 1
        if repair == _native.Repair.refuse:
            _refuse_unknown("faces", "vertex", corners, self.vertex_count)
        _native.require_readable(points, corners, offsets, repair)
        self._known = (corners >= 0) & (corners < self.vertex_count)
        self._used = np.unique(corners[self._known])
        self._image = np.arange(len(points)) + len(points)
        shared = self._shared(points, corners, offsets)
        self._image[shared] = shared
        self._copied = np.flatnonzero(self._image != np.arange(len(points)))
        self._image[self._copied] = len(points) + np.arange(len(self._copied))
        self.in_plane = shared  # (k,) int64: vertices that are their own images

    def _shared(self, points: np.ndarray, corners: np.ndarray, offsets: np.ndarray) -> np.ndarray:
        """Ids of the ends of border edges in the plane, without faces that mending drops."""
        flat = np.abs(points[:, self.axis]) <= self._reach(points)
        sizes = np.diff(offsets)
        kept = _first_of_their_kind(corners, offsets)
        kept[np.repeat(np.arange(len(sizes)), sizes)[~self._known]] = False
        once = np.repeat(kept, sizes)
        pairs = np.sort(np.stack([corners, corners[following(offsets)]], axis=1)[once], axis=1)
        edges, uses = np.unique(pairs, axis=0, return_counts=True)
        edges = edges[uses == 1]
        found = np.unique(edges[flat[edges].all(axis=1)])
        if not len(found):
            raise fairing_error(
                "BAD_OPTION",
                f'symmetry_plane is "{self.plane}", but no border edge lies in the plane '
                f"{self.plane} = 0.",
                cure="Put the vertices of the border that meets its mirror image there.",
            )
        return found

    def _reach(self, points: np.ndarray) -> float:
        """The largest distance of vertices that count as in the plane, mesh units."""
        with np.errstate(invalid="ignore", over="ignore"):
            return SNAP * np.ptp(points[self._used], axis=0).max() if len(self._used) else 0.0

    def _refuse_gap(self, points: np.ndarray, where: str) -> None:
        """Raises an error for vertices that have left the plane, where the halves would separate."""
        height = np.abs(points[self.in_plane, self.axis])
        away = self.in_plane[(height > self._reach(points)) & (height <= FAR)].tolist()
        if away:
            raise fairing_error(
                "BAD_OPTION",
                f"{{vertex}} {{is|are}} not in the plane {self.plane} = 0{where}, where symmetry_plane "
                "has the mesh meet its mirror image.",
                away,
                "vertex",
                "Put the border back there.",
            )

    def shapes(self, shapes: np.ndarray) -> np.ndarray:
        """Converts shapes (k, n, 3) to the double's. Refuses vertices that have left the plane."""
        for k, shape in enumerate(shapes):
            self._refuse_gap(shape, f" in shape {k}")
        return self._doubled(shapes)

    def points(self, points: np.ndarray) -> np.ndarray:
        """Converts points (n, 3) to the double's. Refuses vertices that have left the plane."""
        self._refuse_gap(points, "")
        return self._doubled(points)

    def values(self, values: np.ndarray) -> np.ndarray:
        """Converts values (n,), or empty, to the double's."""
        return np.concatenate([values, values[self._copied]]) if len(values) else values

    def _doubled(self, points: np.ndarray) -> np.ndarray:
        """Points (…, n, 3) of the double; border vertices near the plane are moved into it."""
        own = points.copy()
        height = own[..., self.in_plane, self.axis]
        own[..., self.in_plane, self.axis] = np.where(np.abs(height) <= FAR, 0.0, height)
        return self._with_copies(own)

    def reflected(self, points: np.ndarray) -> np.ndarray:
        """The mirror images of points or vectors (…, 3)."""
        images = points.copy()
        images[..., self.axis] *= -1.0
        return images

    def _with_copies(self, own: np.ndarray) -> np.ndarray:
        """One point or vector a vertex (…, n, 3), and the images of those off the plane."""
        images = self.reflected(own[..., self._copied, :])
        return np.ascontiguousarray(np.concatenate([own, images], axis=-2))

    def beside(
        self, points: np.ndarray, corners: np.ndarray, offsets: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Another mesh, a neighbour or a scan, with its mirror image."""
        reverse, twice = _reversed(offsets)
        both = np.concatenate([points, self.reflected(points)])
        return both, np.concatenate([corners, corners[reverse] + len(points)]), twice

    def faces(self, corners: np.ndarray, offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Corners and offsets of the double, where images are reversed. An id that is not in the mesh
        becomes -1, since it could be an image's id.
        """
        reverse, twice = _reversed(offsets)
        images = np.where(self._known, self._image[np.where(self._known, corners, 0)], -1)
        own = np.where(self._known, corners, -1)
        return np.concatenate([own, images[reverse]]), twice

    def settings(self, settings: dict[str, Any]) -> dict[str, Any]:
        """Converts the settings that name vertices, edges or faces to the double's."""
        given = dict(settings)
        for name in ("tolerance", *ONE_A_VERTEX):
            values = given.get(name)
            if values is not None and np.ndim(values) == 1 and len(values) == self.vertex_count:
                given[name] = self.values(np.asarray(values))
        normals = given.get("normals")
        if normals is not None and np.shape(normals) == (self.vertex_count, 3):
            given["normals"] = self._normals(normals)
        for name in (*VERTEX_IDS, *FACE_IDS):
            if given.get(name) is not None:
                kind = "face" if name in FACE_IDS else "vertex"
                given[name] = self.with_images(name, kind, given[name])
        for name in EDGES_WITH_VALUES:
            if given.get(name) is not None:
                pairs, values = edges_with_values(name, given[name])
                given[name] = (self.with_images(name, "vertex", pairs), np.tile(values, 2))
        if given.get("boundary_edges") is not None:
            given["boundary_edges"] = {
                mode: self.with_images("boundary_edges", "vertex", pairs)
                for mode, pairs in given["boundary_edges"].items()
            }
        return given

    def _normals(self, normals: Any) -> np.ndarray:
        """Normals of the double; in the plane without the part that no symmetric surface has."""
        own = np.array(normals, float)
        own[self.in_plane, self.axis] *= 0.0  # NaN stays NaN
        return self._with_copies(own)

    def with_images(self, name: str, kind: str, ids: Any) -> np.ndarray:
        """Elements and their images. Refuses ids that only the other half has."""
        ids = np.asarray(ids)
        if not ids.size:
            return ids
        of_vertices = kind == "vertex"
        _refuse_unknown(name, kind, ids, self.vertex_count if of_vertices else self.face_count)
        return np.concatenate([ids, self._image[ids] if of_vertices else ids + self.face_count])

    @contextmanager
    def named(self) -> Iterator[None]:
        """A context in which the core's errors name elements of the half."""
        try:
            yield
        except FairingError as error:
            own = self._own(error.elements, error.kind)
            both = "Both halves together: " if error.code == "TOO_LARGE" else ""
            raise about(error, own, both) from None

    def _own(self, elements: Sequence[int], kind: str) -> list[int]:
        """The half's elements for elements of the double or their images; each once."""
        if kind == "face":
            return list(dict.fromkeys(face % self.face_count for face in elements))
        origin = np.concatenate([np.arange(self.vertex_count), self._copied])
        own = origin[np.asarray(elements, int)].tolist()
        if kind != "edge":
            return list(dict.fromkeys(own))
        pairs = {frozenset(pair): pair for pair in reversed(list(zip(own[::2], own[1::2])))}
        return [vertex for pair in reversed(pairs.values()) for vertex in pair]

    def cut(self, whole: dict[str, Any]) -> dict[str, Any]:
        """Converts the core's result for the double to one for the half."""
        given = dict(whole)
        kinds = ("triangle", "quad")
        kept = {kind: whole[f"{kind}_polygon"] < self.face_count for kind in kinds}
        used = np.zeros(len(whole["vertices"]), bool)
        used[: self.vertex_count] = True
        seam = np.zeros_like(used)
        for kind in kinds:
            faces = whole[f"{kind}s"]
            used[faces[kept[kind]].ravel()] = True
            seam[faces[~kept[kind]].ravel()] = True
        seam &= used
        seam[: self.vertex_count] = False
        seam[self.in_plane] = True
        new_id = np.cumsum(used, dtype=np.int32) - 1
        for kind in kinds:
            given[f"{kind}s"] = new_id[whole[f"{kind}s"][kept[kind]]].astype(np.int32)
            given[f"{kind}_polygon"] = whole[f"{kind}_polygon"][kept[kind]]
            if whole.get(f"{kind}_mended") is not None:
                given[f"{kind}_mended"] = whole[f"{kind}_mended"][kept[kind]]

        def half(surface: np.ndarray) -> np.ndarray:
            surface = surface[used]
            surface[new_id[np.flatnonzero(seam)], self.axis] = 0.0
            return surface

        given["vertices"] = half(whole["vertices"])
        given["shapes"] = [half(shape) for shape in whole["shapes"]]
        creases = whole["crease_edges"]
        given["crease_edges"] = creases[(creases < self.vertex_count).all(axis=1)]
        if whole["mended"]:
            given["mended"] = self._cut_mended(whole["mended"])
        given["report"] = self._cut_report(whole["report"])
        return given

    def _cut_mended(self, mended: dict[str, Any]) -> dict[str, Any]:
        faces = int(np.searchsorted(mended["face_origin"], self.face_count))
        corners = int(mended["offsets"][faces])
        return {
            **mended,
            "corners": mended["corners"][:corners],
            "offsets": mended["offsets"][: faces + 1],
            "vertex_origin": mended["vertex_origin"][: self.vertex_count],
            "face_origin": mended["face_origin"][:faces],
            "corner_origin": mended["corner_origin"][:corners],
            "corner_share": mended["corner_share"][:corners],
        }

    def _cut_report(self, report: dict[str, Any]) -> dict[str, Any]:
        """The half's report: element ids and values per vertex are converted, other numbers kept."""
        given = dict(report)
        for name in ("warnings", "repairs"):
            given[name] = [
                {**entry, "elements": self._own(entry["elements"], entry["kind"])}
                for entry in report[name]
            ]
        given["flipped_faces"] = self._own(report["flipped_faces"], "face")
        pads = report["pads"]
        given["pads"] = {**pads, "widths": pads["widths"][: self.vertex_count]}
        return given


def _refuse_unknown(name: str, kind: str, ids: np.ndarray, count: int) -> None:
    """Raises an error for ids that are not in the mesh; the core checks all else."""
    if ids.dtype.kind not in "iu" or not ids.size:
        return
    unknown = np.unique(ids[(ids < 0) | (ids >= count)]).tolist()
    if unknown:
        raise fairing_error(
            "INDEX_OUT_OF_RANGE",
            f"{{{kind}}} {{is|are}} named in {name} but not in the mesh: "
            f"ids run from 0 to {count - 1}.",
            unknown,
            kind,
        )


def _reversed(offsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places of the corners of faces in the opposite order; offsets of the faces and their images."""
    sizes = np.diff(offsets)
    place = np.arange(sizes.sum()) - np.repeat(offsets[:-1], sizes)
    turned = np.repeat(offsets[1:], sizes) - 1 - place
    return turned, np.concatenate([offsets, offsets[-1] + offsets[1:]])


def _first_of_their_kind(corners: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """(m,) bool: false for faces with the vertices of an earlier face, which mending drops."""
    sizes, first = np.diff(offsets), np.zeros(len(offsets) - 1, bool)
    for size in np.unique(sizes):
        faces = np.flatnonzero(sizes == size)
        rows = np.sort(corners[offsets[faces, None] + np.arange(size)], axis=1)
        first[faces[np.unique(rows, axis=0, return_index=True)[1]]] = True
    return first
