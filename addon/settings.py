# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings of a run: one value, made once from Blender's properties, a stored surface or the
command line. No Blender.

properties.py explains each setting.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .blender import Object
    from .properties import FairingSettings


_Values = TypeVar("_Values")


def values_of(kind: type[_Values], properties: Any, **others: Any) -> _Values:
    """A dataclass `kind` with the properties of the same names, except for the `others`."""
    names = [field.name for field in fields(kind) if field.name not in others]  # type: ignore[arg-type]
    return kind(**{name: getattr(properties, name) for name in names}, **others)


@dataclass(frozen=True)
class Settings:
    """Lengths are in scene units, angles in radians, choices are identifiers of choices.py."""

    levels: int
    energy: str
    interpolation: str
    limit: float
    tolerance: float  # in its own unit
    tolerance_unit: str
    tolerance_group: str
    pull_group: str
    pad_size: float
    tension: float
    boundary: str
    symmetry_plane: str
    mesh_source: str
    use_selection: bool
    joint: str
    use_crease_attribute: bool
    crease_threshold: float
    use_sharp_edges: bool
    use_crease_angle: bool
    crease_angle: float
    use_corner_angle: bool
    corner_angle: float
    metric_exponent: float
    repair: str
    weld: float
    use_shape_keys: bool
    copy_modifiers: bool
    hide_source: bool
    shade_smooth: bool

    @classmethod
    def of(cls, properties: FairingSettings) -> Settings:
        """The present settings of an operator or a property group."""
        return values_of(cls, properties)

    def for_source(self, source: Object, by_shape: str = "EXACT") -> Settings:
        """The same with AUTO resolved for `source`, where no modifier decides `by_shape` (check/cages.py); a
        modifier is not followed a second time.
        """
        subdivided = subdivision(source) is not None
        if subdivided and is_evaluated(self) and self.interpolation in ("AUTO", "LIMIT"):
            return replace(self, interpolation="EXACT")
        if self.interpolation == "AUTO":
            return replace(self, interpolation="LIMIT" if subdivided else by_shape)
        return self


@dataclass(frozen=True)
class PatchOptions:
    fit_tolerance: float  # relative to the surface's size; 0: the usual one, more near a scan
    fit_angle: float  # radians; 0: the usual one, more near a scan
    fit_levels: int  # 0: as many as the tolerance needs
    # whether faces that fold or turn too sharply get patches; a display without a file always has them
    force: bool = True
    unit: str = "MM"  # unit of the file


NAMES = tuple(field.name for field in fields(Settings))
# choices by which vertices may be missed, unless they are given otherwise
OF_NEAR = ("tolerance", "tolerance_group", "pull_group")
if TYPE_CHECKING:
    # functions that panels call with Blender's properties too
    AnySettings: TypeAlias = Settings | FairingSettings
else:
    AnySettings = Settings


def is_near(settings: AnySettings) -> bool:
    """Whether the surface may miss vertices, so that a tolerance applies."""
    return settings.interpolation == "APPROXIMATE"


def is_limit(settings: AnySettings) -> bool:
    """Whether the surface passes through limit positions."""
    return settings.interpolation == "LIMIT"


def subdivision(source: Object) -> Any:
    """The modifier by which `source` is shown as a Catmull-Clark surface; None if there is none."""
    modifiers: Any = source.modifiers
    shown = (m for m in modifiers if m.type == "SUBSURF" and m.show_viewport)
    return next((m for m in shown if m.subdivision_type == "CATMULL_CLARK"), None)


def are_mirrored(sources: Iterable[Object]) -> bool:
    """Whether the modifiers that these objects show are Mirror alone."""
    modifiers = (modifier for source in sources for modifier in source.modifiers)
    return {modifier.type for modifier in modifiers if modifier.show_viewport} == {"MIRROR"}


def mirror_axis(sources: Iterable[Object]) -> str:
    """The axis of the halves that Mirror completes, alone or under Subdivision Surface, as `X`; empty for other
    objects.
    """
    axes = {_mirrored_axes(source) for source in sources}
    axis = axes.pop() if len(axes) == 1 else ""
    return axis if len(axis) == 1 else ""


def _mirrored_axes(source: Object) -> str:
    shown: list[Any] = [m for m in source.modifiers if m.show_viewport]
    kinds = [m.type for m in shown]
    if kinds not in (["MIRROR"], ["MIRROR", "SUBSURF"]) or shown[0].mirror_object is not None:
        return ""
    return "".join(axis for axis, is_used in zip("XYZ", shown[0].use_axis) if is_used)


def is_evaluated(settings: AnySettings) -> bool:
    """Whether the source is faired with its modifiers; never if faces are selected."""
    return settings.mesh_source == "EVALUATED" and not settings.use_selection


def halves(settings: AnySettings) -> int:
    """How many times larger than the mesh the computed one is: twice with its mirror image."""
    return 1 if settings.symmetry_plane == "NONE" else 2


def wants_modifiers(settings: Settings) -> bool:
    """Whether a new surface gets the source's modifiers: not if they are in the faired mesh."""
    return settings.copy_modifiers and settings.mesh_source == "ORIGINAL"
