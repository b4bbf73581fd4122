# SPDX-License-Identifier: GPL-3.0-or-later
"""The fair surface of a cage near scans, an ordinary surface of its cage that remembers its scans."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, cast

import numpy as np

from .. import core, memory
from ..blender import Context, Mesh, Object
from ..check.defects import entry, recall_defects, store_defects
from ..errors import OF_FITS, JobError
from ..mesh import scans
from ..mesh.layers import fill_layer, make_layer
from ..mesh.object import Reference
from ..mesh.scans import Scan, read_scans
from ..mesh.write import NO_POINTS
from ..settings import Settings
from ..surfaces import freshness
from ..triangles import fans
from ..units import Units
from ..words import counted
from .fair import Job

TOO_COARSE, UNCOVERED, OUTLIERS = "FIT_TOO_COARSE", "FIT_NO_POINTS", "FIT_OUTLIERS"


@dataclass(frozen=True)
class Fit:
    """What a surface is fitted to, and how closely."""

    scan: Scan  # in the world
    tolerance: float | None = None  # scene units; None: as closely as the noise allows
    weight: float | None = None  # of the core, where it is known already
    objects: Sequence[Object] = ()  # that the scan was read from

    @classmethod
    def of(cls, context: Context, target: Object, again: bool = True) -> "Fit | None":
        """What `target` was fitted to, or None; `again`: the weight is chosen anew. Raises JobError if
        the scans are gone.
        """
        kept = target.discrete_fairing_fit
        if not len(kept.scans):
            return None
        near = memory.scans_of(target)
        if not near:
            raise JobError(
                f"{target.name}: Select a scan and the cage, and run Fair Surface on Scan. Its scan was deleted."
            )
        scan = read_scans(context, near)
        if not again:
            return cls(scan, weight=kept.weight, objects=near)
        return cls(scan, kept.tolerance if kept.amount == "TOLERANCE" else None, objects=near)

    def arguments(self, cage: Object) -> dict[str, Any]:
        """The arguments of the scan for `discrete_fairing.fit`."""
        scan = self.scan.in_shape_of(cage)
        return scan.arguments | {"tolerance": self.tolerance, "weight": self.weight}


def settings_of_fit(settings: Settings, scan: Scan) -> Settings:
    """Without what a fit does not know. Points without faces have no border, and nothing along a surface
    holds a border curve near them: there borders keep to the points as all else does.
    """
    return replace(
        settings,
        boundary=settings.boundary if len(scan.triangles) else "FREE",
        energy="THIN_PLATE",
        interpolation="EXACT",
        use_selection=False,
        use_shape_keys=False,
    )


class FitJob(Job):
    """One cage and its scans."""

    made_name = "Fit"
    remedies = OF_FITS

    def __init__(
        self,
        context: Context,
        cage: Object,
        fit: Fit,
        settings: Settings,
        target: Object | None = None,
    ) -> None:
        _require(cage, fit)
        super().__init__(context, cage, settings_of_fit(settings, fit.scan), target)
        self.kind = "FIT"
        if self.settings.boundary != settings.boundary and self._is_open():
            self.notes.append(
                "Its border stays as far as the cage: points without faces have none."
            )
        self._units = Units.of(context.scene)
        self._scans = [Reference(scan) for scan in fit.objects]
        self._amount = fit.tolerance
        self._near = fit.arguments(cage)
        if fit.objects:
            self._made["scans"] = scans.made_of(context, fit.objects, cage)
        self._points = len(fit.scan.points)

    @property
    def made_from(self) -> list[Object]:
        """The cage and the scans, those that still exist."""
        found = (reference.find() for reference in (self.reference, *self._scans))
        return [target for target in found if target is not None]

    def _is_open(self) -> bool:
        return bool((np.bincount(self.arrays.corner_edges) == 1).any())

    def surface(self, **watchers: Any) -> Any:
        module = core.module()
        try:
            found = module.fit(**core.of_fits(self.arguments), **self._near, **watchers)
        except module.FairingError as error:
            raise module.errors.error_with_lengths(error, self._length) from None
        report = found.report
        report["warnings"] = [
            module.errors.with_lengths(warning, self._length) for warning in report["warnings"]
        ]
        return found

    def _length(self, length: float) -> str:
        return self._units.lengths(length)(length)

    def _is_inside_out(self) -> bool:
        corners, offsets = self.arrays.corners, self.arrays.offsets
        triangles = corners[fans(offsets[:-1], np.diff(offsets))[0]]
        return not self._is_open() and Scan(self.arrays.positions, triangles).volume < 0

    def warnings(self) -> list[str]:
        told = super().warnings()
        if self._is_inside_out():
            told.append(
                f"{self.name}: Flip the normals of scan and cage (Alt N in Edit Mode) if the surface should not be"
                " inside out. They point inwards."
            )
        return told

    def _compute(self, watchers: dict[str, Any]) -> None:
        super()._compute(watchers)
        self.notes.insert(0, self.said())

    def control(self) -> core.ControlArrays:
        """The cage as it was moved: what the surface is compared with."""
        world = super().control()
        moved = np.array(self.result.vertices[: len(world.positions)])
        return replace(world, positions=moved)

    def _work(self, levels: int | None = None) -> int:
        return super()._work(levels) + self._points

    def write(self, context: Context, own: Any = None) -> Object:
        target = super().write(context, own)
        near = [scan for reference in self._scans if (scan := reference.find()) is not None]
        if near:
            memory.remember_fit(target, near, self._amount, self.result.weight, self.said())
            freshness.know(target)  # its scans, too
            self._note_places(context, near)
        return target

    @property
    def _bare(self) -> np.ndarray:
        """(m,) bool: faces of the cage without points."""
        return np.asarray(self.result.coverage == 0)

    def mark(self, mesh: Mesh) -> None:
        super().mark(mesh)
        if self._bare.any():
            fine = self.transfer.face(self._bare)
            fill_layer(make_layer(mesh, NO_POINTS, "BOOLEAN", "FACE"), fine)

    def said(self) -> str:
        found = self.result
        length = self._units.lengths(found.within[0])
        text = f"Within {length(found.within[0])} of 95 % of the scan; its noise is about {length(found.noise)}."
        coarse, strays = len(found.too_coarse), len(found.outliers)
        bare = int(np.count_nonzero(self._bare))
        if coarse:
            text += f" {counted(coarse, '{face is|faces are}')} too coarse."
        if bare:
            text += f" {counted(bare, '{face has|faces have}')} no points."
        if strays:
            text += f" {counted(strays, '{point is a stray|points are strays}')}."
        return text

    def _note_places(self, context: Context, near: Sequence[Object]) -> None:
        """Lists faces of the cage, and points of a scan of one plain mesh, in the panel Check."""
        found, cage = self.result, cast(Object, self.source)
        bare = np.flatnonzero(self._bare)
        _note(context, cage, {TOO_COARSE: found.too_coarse, UNCOVERED: bare}, "face")
        plain = [one for one in near if one.type == "MESH" and one.mode == "OBJECT"]
        if plain == near[:1] and len(plain[0].data.vertices) == self._points:
            _note(context, plain[0], {OUTLIERS: found.outliers}, "vertex")


def _require(cage: Object, fit: Fit) -> None:
    """Raises JobError where no surface can be near the scan."""
    points = fit.scan.points
    if not len(points):
        raise JobError(
            f"{cage.name}: Select the scan, too. What is selected beside the cage has no points."
        )
    scans.require_finite(points, ", ".join(scan.name for scan in fit.objects) or cage.name)


def _note(context: Context, target: Object, places: dict[str, np.ndarray], kind: str) -> None:
    known = recall_defects(target)
    kept = [] if known is None or known[1] else known[0]
    new = [entry(code, kind, ids.tolist()) for code, ids in places.items() if len(ids)]
    others = [defect for defect in kept if defect["code"] not in places]
    if new or len(others) < len(kept):
        store_defects(context, target, others + new)


def job_of(
    context: Context,
    source: Object,
    settings: Settings,
    target: Object,
    region: np.ndarray | None = None,
    again: bool = True,
) -> Job:
    """What makes the surface `target` from its `source` as it is now. `again`: as `Fit.of` takes it."""
    fit = Fit.of(context, target, again)
    if fit is None:
        return Job(context, source, settings, target, region)
    return FitJob(context, source, fit, settings, target)


def live_scan(context: Context, source: Object, target: Object) -> dict[str, Any] | None:
    """The arguments of the fit that an edit waits for; None for other surfaces."""
    fit = Fit.of(context, target, again=False)
    if fit is None:
        return None
    scan = fit.scan.in_shape_of(source).thinned()
    return scan.arguments | {"weight": fit.weight}
