# SPDX-License-Identifier: GPL-3.0-or-later
"""The job that fits spline patches to a surface."""

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np

from .. import core, errors
from ..blender import Context, Object
from ..check.defects import entry, store_defects
from ..errors import JobError
from ..jobs.fair import Job
from ..jobs.fit import Fit, settings_of_fit
from ..memory import source_of
from ..mesh.modifiers import left_out, own_left_out
from ..mesh.object import Reference, new_object
from ..mesh.read import control_mesh, read_mesh
from ..mesh.shape_keys import ShapeKeys, influences, mixed_positions, read_shape_keys
from ..mesh.world_shape import transformed, world_matrix
from ..settings import PatchOptions, Settings, is_evaluated
from ..surfaces import neighbours
from ..transfer.attributes import AttributeTransfer
from ..units import Units
from . import colours, words

Share = float | np.ndarray  # of a shape: one number, or one a control vertex


def shown_mesh(context: Context, shown: Object) -> core.ControlArrays:
    """The mesh of `shown` with its mix of shape keys, without modifiers, in its own coordinates."""
    with control_mesh(context, shown) as mesh:
        arrays = read_mesh(mesh)
        return replace(arrays, positions=mixed_positions(shown, mesh, arrays.positions))


def shares_of(
    shown: Object, keys: ShapeKeys, groups: Sequence[Any], vertex_count: int
) -> dict[int, Share]:
    """Shares of the source's `keys` in the mix, by the sliders of `shown` with the same names; the
    result of `influences`. `groups`: the vertex groups of the source. Raises JobError if keys of
    `shown` itself take part, which the fitted surface does not have.
    """
    its = read_shape_keys(shown, len(shown.data.vertices))
    if its is None:
        return {}
    dense = {group.name: group.dense for group in groups}
    found = influences(its, lambda name: dense.get(name, np.ones(vertex_count, np.float32)))
    places = {key.name: place for place, key in enumerate(keys.keys)}
    names = {place: its.keys[place].name for place in found}
    own = [name for name in names.values() if name not in places]
    if own:
        raise JobError(own_keys_text(shown.name, own))
    return {places[name]: found[place] for place, name in names.items() if places[name]}


def own_keys_text(name: str, own: Sequence[str]) -> str:
    keys = f"{'key' if len(own) == 1 else 'keys'} {', '.join(own)}"
    return (
        f"{name}: Set the {keys} to 0, or give the source such a key and make the surface again. Patches are fitted to "
        f"the fair surface, which does not have the {keys} of its mesh."
    )


class Blend:
    """The `blend` of `discrete_fairing.fit_patches`: mixes the surface and its shapes with one share
    `of_shapes` for each shape; `arrays`: the control mesh.
    """

    def __init__(self, arrays: core.ControlArrays, of_shapes: Sequence[Share]) -> None:
        self._arrays, self._influences = arrays, of_shapes

    def __call__(self, result: Any, levels: int) -> np.ndarray:
        found = result.vertices.copy()
        for share, shape in zip(self._influences, result.shapes, strict=True):
            if np.ndim(share):
                share = AttributeTransfer(result, self._arrays, levels).point(np.asarray(share))
            found += share * (shape - result.vertices)
        return found


def distance(
    result: Any, levels: int, vertices: np.ndarray, mesh: core.ControlArrays
) -> float | None:
    """The largest distance, along normals, between the surface `result` of `levels`, with its `vertices`
    (N, 3), and the `mesh` shown, in the same coordinates, at common points. None if the mesh has other
    faces than such a surface.
    """
    triangles = int((mesh.face_sizes == 3).sum())
    counts = [triangles, len(mesh.face_sizes) - triangles]
    at_0 = [len(faces) >> 2 * levels for faces in result.faces]
    own = next((k for k in range(levels + 9) if [n << 2 * k for n in at_0] == counts), None)
    if own is None or not any(at_0) or len(mesh.corners) != 3 * counts[0] + 4 * counts[1]:
        return None
    faces = np.split(mesh.corners, [3 * triangles])
    shown = SimpleNamespace(
        vertices=mesh.positions, faces=(faces[0].reshape(-1, 3), faces[1].reshape(-1, 4))
    )
    both = shown, SimpleNamespace(vertices=vertices, faces=result.faces)
    coarse, fine = both if own <= levels else both[::-1]
    change = core.module().level_change.change_between(
        coarse, fine, max(own, levels), abs(own - levels)
    )
    return float(change.max(initial=0.0))


_USUAL_LEVELS = 5  # levels of the lattice that patches are usually fitted to, for predictions
_KINDS = (
    ("UNRESOLVED", "unresolved"),
    ("PATCH_TOLERANCE", "unmet_by_fit"),
    ("SURFACE_TOLERANCE", "unmet_by_surface"),
)


class PatchJob(Job):
    """Fits patches to the fair surface of one object; the result is `patches`."""

    def __init__(
        self,
        context: Context,
        shown: Object,
        options: PatchOptions,
        settings: Settings | None = None,
        fit: Fit | None = None,
    ) -> None:
        """`shown`: a surface, which is recomputed from its source with its own settings, or a mesh to
        be faired with `settings`; None: those of the scene. `options`: of the patches. `fit`: the scan
        for a mesh; a surface knows its own.
        """
        source = source_of(shown)
        if source is not None:
            settings = Settings.of(shown.discrete_fairing)
            fit = Fit.of(context, shown, again=False)
        settings = settings or Settings.of(context.scene.discrete_fairing)
        settings = settings if fit is None else settings_of_fit(settings, fit.scan)
        # the lattice has its own number of levels
        super().__init__(
            context,
            source or shown,
            replace(settings, levels=1),
            neighbour=neighbours.neighbour_of(shown),
            halfway=neighbours.is_mutual(shown),
            surface=shown,
        )
        self.name = shown.name
        self._shown = Reference(shown)
        self._way_back = self.shape.way_back
        self.placement = np.array(world_matrix(shown), float) @ self._way_back
        if abs(np.linalg.det(self.placement[:3, :3])) < 1e-18:
            raise JobError(f"{self.name}: Give it a thickness. Its scale is 0 along an axis.")
        self._units = Units.of(context.scene)
        # other notes concern data that only meshes carry
        self.notes = own_left_out(shown) if source else self._left_out(shown)
        self.colours, self.slots = colours.of_faces(shown, source or shown, self.data)
        self.arguments = core.patch_arguments(self.arguments, options)
        if fit is not None:
            self.remedies = errors.OF_FITS
            scan = fit.arguments(source or shown) | {"levels": settings.levels}
            self.arguments = core.patches_on_scan(self.arguments, scan)
        if len(self.slots):  # a patch has one material
            self.arguments["groups"] = self.slots
        self._blend(shown)
        self._mesh = None if source is None else shown_mesh(context, shown)
        self._stands = np.array(world_matrix(shown), float)
        # if more levels show more: not of a control mesh, nor of a fit, whose points CAD has
        self.levels_shown = None if source is None or fit else int(shown.discrete_fairing.levels)
        self.apart: float | None = None  # as returned by `distance`, in Blender units of the world
        self.refused: list[int] = []  # faces that prevent the fit of patches

    def _left_out(self, mesh: Object) -> list[str]:
        cure = "set Control Mesh to With Modifiers"
        return [] if is_evaluated(self.settings) else left_out(mesh, cure)

    def _blend(self, shown: Object) -> None:
        """Fits patches to the mix of shape keys that the sliders of `shown` make."""
        keys = self.keys or ShapeKeys((), np.empty((0, 0, 3)), True, 0.0, 0, False)
        count = len(self.arrays.positions)
        used: dict[int, Any] = shares_of(shown, keys, self.data.groups, count)
        given = self.arguments.pop("shapes", ())
        if used:
            self.arguments["shapes"] = np.stack([given[place - 1] for place in used])
            self.arguments["blend"] = Blend(self.arrays, list(used.values()))

    def _compute(self, watchers: dict[str, Any]) -> None:
        with errors.explained(self.name):
            try:
                self.patches = core.module().fit_patches(
                    **core.with_partner(self.arguments), **watchers
                )
            except core.module().FairingError as error:
                if error.code != "UNRESOLVED":
                    raise
                self.refused = error.elements
                return
        self.result = self.patches.result
        mended = errors.repairs_text(self.result.report["repairs"])
        if mended:
            self.notes.append(mended)
        if self._mesh is not None:
            vertices = transformed(self.result.vertices, self.placement)
            shown = replace(self._mesh, positions=transformed(self._mesh.positions, self._stands))
            self.apart = distance(self.result, self.patches.levels, vertices, shown)

    def _work(self, levels: int | None = None) -> int:
        return super()._work(levels or self.arguments["levels"] or _USUAL_LEVELS)

    def is_writable(self) -> bool:
        return super().is_writable() and self._shown.find() is not None

    def write(self, context: Context, _own: Any = None) -> Object:
        """Makes a new object of the patches, beside the surface."""
        shown = cast(Object, self._shown.find())  # is_writable has checked it
        patches = self.patches.transformed(self._way_back)
        slots = self.slots[patches.patch_polygon] if len(self.slots) else None
        paints = colours.materials(shown, self.source or shown)
        surface = colours.surface_of(context, f"{self.name} Patches", patches, paints, slots)
        return new_object(context, shown, surface)

    def length(self, own: float) -> float:
        """A length of the patches in Blender units of the world."""
        return float(self._stretch.max() * own)

    @property
    def allowed(self) -> float:
        """How far patches may be from the fair surface, in Blender units of the world."""
        return self.length(self.patches.tolerance * self.patches.size)

    @property
    def angle(self) -> float:
        """The largest angle at smooth edges; an upper bound for unevenly scaled surfaces."""
        return float(self.patches.largest_angle * self._stretch.max() / self._stretch.min())

    @property
    def _stretch(self) -> np.ndarray:
        return np.linalg.svd(self.placement[:3, :3], compute_uv=False)

    @property
    def defects(self) -> list[dict[str, Any]]:
        """The faults of the patches, by faces of the source, like the defects of Check Mesh."""
        return [
            entry(code, "face", faces, "error" if code == "UNRESOLVED" else "warning")
            for code, name in _KINDS
            if (faces := self._faulty(name))
        ]

    def _faulty(self, name: str) -> list[int]:
        if self.refused:
            return self.refused if name == "unresolved" else []
        return cast(list[int], getattr(self.patches, name).tolist())

    def warnings(self) -> list[str]:
        """For each kind of fault, what to do, what is wrong, by how much, and the faces."""
        return [
            words.together(
                (
                    f"{self.name}: {errors.remedy(defect['code'], self.settings, self.remedies)}",
                    errors.what(defect),
                    self._miss_text(defect["elements"]) if defect["code"] != "UNRESOLVED" else "",
                    f"{words.faces_text(defect['elements'])}.",
                )
            )
            for defect in self.defects
        ]

    def _miss_text(self, faces: list[int]) -> str:
        off, angle = self.patches.worst(faces)
        most, told = self.patches.normal_tolerance, self._units.lengths(self.allowed, 2)
        size = self.length(self.patches.size)
        return words.miss_text(self.length(off), self.allowed, size, angle, most, told)

    def note_defects(self, context: Context) -> None:
        """Lists the faults in the panel Check of the source, whose buttons select them."""
        source = self.source
        if source is not None and self.defects and not is_evaluated(self.settings):
            store_defects(context, source, self.defects)


def refused(jobs: Sequence[PatchJob]) -> list[PatchJob]:
    """The jobs without patches, because their surface folds or is not resolved."""
    return [job for job in jobs if job.refused]
