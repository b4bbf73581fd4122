# SPDX-License-Identifier: GPL-3.0-or-later
"""Patches fitted to the surface of one level: what they may miss, and surfaces that are refused."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _native
from ..arrays import following, numbers
from ..converters import positive
from ..errors import fairing_error
from ..result import Result
from ..scan_fitting import Fitted
from .flat_polygons import is_flat, mark_flat
from .patches import SplinePatches, control_polygons

USUAL_TOLERANCE, USUAL_ANGLE = 1e-4, 8e-4  # share of the size; radians
# The allowed distance of patches from a surface, as a share of the distance of 95 % of the scan from it.
# Independent errors add by squares, so patches at this distance put points 12 % farther away.
SHARE_OF_SCAN = 0.5
TURN_LIMIT = np.radians(20.0)  # between neighbouring cells of the refined surface
# the same on level 3 and finer ones, above which a fold remains; on level 2 some folds do not
HOPELESS_TURN = np.radians(150.0)
FOLD_LIMIT = np.radians(45.0)  # between a patch and the refined surface

# vertices, triangles, quads and crease edges of a refined surface
Arrays = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


class PatchFits:
    """The settings of fit_patches(), and its fits on a level."""

    def __init__(self, tolerance: object, normal_tolerance: object, force: bool):
        self._has_tolerance = tolerance is not None
        self._has_angle = normal_tolerance is not None
        self.tolerance, self.normal_tolerance = USUAL_TOLERANCE, USUAL_ANGLE
        if self._has_tolerance:
            self.tolerance = positive("tolerance", tolerance)
        if self._has_angle:
            self.normal_tolerance = positive("normal_tolerance", normal_tolerance)
        self.force = force
        self._groups = np.empty(0, np.int32)  # of the input's faces

    def keep_apart(self, groups: ArrayLike, faces: int) -> None:
        """Faces of different numbers are in different patches. Raises FairingError BAD_SHAPE."""
        self._groups = numbers(groups, "groups", "iu").astype(np.int32)
        if self._groups.shape != (faces,):
            raise fairing_error(
                "BAD_SHAPE", f"groups has shape {self._groups.shape}; it must be ({faces},)."
            )

    def allow_for(self, found: Fitted, polygons: tuple[np.ndarray, np.ndarray]) -> None:
        """Allows more near a scan without a tolerance; the angle is that of a patch so far off."""
        size = float(np.ptp(found.vertices, axis=0).max(initial=0))
        corners, offsets = polygons
        ends = found.vertices[corners] - found.vertices[corners[following(offsets)]]
        edge = float(np.linalg.norm(ends, axis=1).mean())
        if size and not self._has_tolerance:
            self.tolerance = max(USUAL_TOLERANCE, SHARE_OF_SCAN * found.within[0] / size)
        if edge and not self._has_angle:
            self.normal_tolerance = max(USUAL_ANGLE, self.tolerance * size / edge)

    def fitted(
        self, result: Result, level: int, lattice_error: np.ndarray, watched: dict[str, Any]
    ) -> SplinePatches:
        # reported even if the fit is quick
        if watched["progress"](0.0, "patches") is False:
            watched["monitor"].cancel()
        size = float(np.ptp(result.vertices, axis=0).max(initial=0))
        used = lattice_error.max(initial=0) / (self.tolerance * size) if size else 0.0
        left = max(2.0 * (1.0 - used), 0.5) if used < 1.0 else 1.0
        fit = partial(self._patches, result, level, lattice_error, watched)
        found = fit(min(left, 1.0))
        # a closer fit costs less than a finer surface
        if left > 0.5 and 1.0 < found.largest_miss <= 2.0 and found.all_meet:
            found = min(found, fit(0.5), key=lambda patches: patches.largest_miss)
        return found

    def _patches(
        self,
        result: Result,
        level: int,
        lattice_error: np.ndarray,
        watched: dict[str, Any],
        share: float,
    ) -> SplinePatches:
        polygons = control_polygons(result, level)
        arrays, bad = self._fit(_arrays(result), polygons, level, watched, share)
        arrays.update(
            tolerance=self.tolerance,
            normal_tolerance=self.normal_tolerance,
            lattice_error=lattice_error,
            unresolved=np.unique(polygons[bad]).astype(np.int64),
        )
        return SplinePatches(arrays, result, level)

    def _fit(
        self,
        arrays: Arrays,
        polygons: np.ndarray,
        level: int,
        watched: dict[str, Any],
        share: float = 1.0,
    ) -> tuple[dict[str, Any], np.ndarray]:
        """The core's arrays, and (F,) bool: control faces whose patches or surface fold. `share`: of the tolerance;
        of that, patches have a half.
        """
        groups = self._groups[polygons] if len(self._groups) else self._groups
        allowed = share * self.tolerance, self.normal_tolerance
        found = _native.fit_splines(*arrays, groups, level, *allowed, **watched)
        points = partial(_points, arrays, polygons)
        mark_flat(found, polygons, points, self.normal_tolerance)
        bad = (found["lattice_turn"] > TURN_LIMIT) | (found["face_angle"] > TURN_LIMIT)
        folded = np.repeat(~(found["turned"] <= FOLD_LIMIT), np.diff(found["patch_face_offsets"]))
        bad[found["patch_faces"][folded]] = True
        return found, bad

    def still_folded(
        self, result: Result, level: int, faces: ArrayLike, watched: dict[str, Any]
    ) -> bool:
        """Whether patches of the input `faces`, fitted with their neighbours alone, still fold."""
        polygons = control_polygons(result, level)
        chosen = np.isin(polygons, faces)
        kept, arrays = _around(result, level, chosen)
        if kept.all():
            return False  # as far as is known; the whole fit decides
        _, bad = self._fit(arrays, polygons[kept], level, watched)
        return bool(bad[chosen[kept]].any())

    def turns(self, result: Result, level: int, watched: dict[str, Any]) -> np.ndarray:
        """(F,) the largest turn of each control face that exceeds the tolerance."""
        least = self.tolerance * float(np.ptp(result.vertices, axis=0).max(initial=0))
        return _native.lattice_turns(*_arrays(result), level, least, **watched)

    def stays_folded(
        self, result: Result, level: int, finer: float, watched: dict[str, Any]
    ) -> bool:
        """Whether folds will remain on the finest level, as turns halve; then it is refused."""
        limit = min(HOPELESS_TURN, 1.5 * TURN_LIMIT * 2**finer)
        turns = _native.lattice_turns(*_arrays(result), level, 0.0, **watched)
        return self._refuses(result, level, turns > limit)

    def stays_sharp(
        self, result: Result, level: int, before: np.ndarray, turns: np.ndarray, finer: int
    ) -> bool:
        """Whether turns above the limit decrease so slowly, from the previous level to this, that they
        stay above it on the finest. It is refused then, unless forced.
        """
        bad = np.minimum(before, turns) > TURN_LIMIT
        falling = np.minimum(turns[bad] / before[bad], 1.0)
        bad[bad] = turns[bad] * falling**finer > TURN_LIMIT
        return self._refuses(result, level, bad)

    @staticmethod
    def sharp_faces(result: Result, level: int, turns: np.ndarray) -> list[int]:
        """Faces whose refined surface folds or turns too sharply for any patch."""
        return _curved(result, level, turns > TURN_LIMIT)

    def checked(self, patches: SplinePatches) -> SplinePatches:
        self.refuse(patches.unresolved.tolist())
        return patches

    def refuse(self, faces: list[int]) -> None:
        if faces and not self.force:
            raise fairing_error(
                "UNRESOLVED",
                "{face} {has|have} a surface that folds or turns too sharply for patches.",
                faces,
                "face",
                "Move or add control vertices, crease the edges there, or give force=True.",
            )

    def _refuses(self, result: Result, level: int, bad: np.ndarray) -> bool:
        """Whether any control face is `bad`: refuses them."""
        faces = _curved(result, level, bad)
        self.refuse(faces)
        return bool(faces)


def _arrays(result: Result) -> Arrays:
    return (result.vertices, *result.faces, result.crease_edges)


def _curved(result: Result, level: int, bad: np.ndarray) -> list[int]:
    """The input faces of a mask of control faces, without flat ones: there the patches decide."""
    polygons = control_polygons(result, level)
    size = float(np.ptp(result.vertices, axis=0).max(initial=0))
    points = partial(_points, _arrays(result), polygons)
    return [p for p in np.unique(polygons[bad]).tolist() if not is_flat(points(p), size)]


def _points(arrays: Arrays, polygons: np.ndarray, polygon: int) -> np.ndarray:
    """(k, 3): the corners of the cells of an input face, of `polygons` (F,) by control faces."""
    cells = (len(arrays[1]) + len(arrays[2])) // len(polygons)
    masks = np.split(polygons == polygon, [len(arrays[1]) // cells])
    corners = [
        faces.reshape(len(mask), cells * faces.shape[1])[mask].ravel()
        for faces, mask in zip(arrays[1:3], masks)
    ]
    return arrays[0][np.concatenate(corners)]


def _around(result: Result, level: int, chosen: np.ndarray) -> tuple[np.ndarray, Arrays]:
    """The control faces `chosen` (F,) and those at their vertices: a mask, and as a surface."""
    cells = 4**level
    blocks = [faces.reshape(-1, cells * faces.shape[1]) for faces in result.faces]
    masks = np.split(chosen, [len(blocks[0])])
    touched = np.zeros(len(result.vertices), bool)
    for block, mask in zip(blocks, masks):
        touched[block[mask]] = True
    kept = [touched[block].any(axis=1) for block in blocks]
    used = np.zeros_like(touched)
    for block, keep in zip(blocks, kept):
        used[block[keep]] = True
    number = np.cumsum(used, dtype=np.int32) - 1
    triangles, quads = (
        number[block[keep]].reshape(-1, corners)
        for block, keep, corners in zip(blocks, kept, (3, 4))
    )
    creases = result.crease_edges
    creases = number[creases[used[creases].all(axis=1)]]
    return np.concatenate(kept), (result.vertices[used], triangles, quads, creases)
