# SPDX-License-Identifier: GPL-3.0-or-later
"""What is asked of a run: one value, made once from Blender's properties, a surface's memory or the
command line, and handed down. No Blender.

What each setting means stands in properties.py.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

if TYPE_CHECKING:
    from .blender import Object
    from .properties import FairingSettings


_Values = TypeVar("_Values")


def values_of(kind: type[_Values], properties: Any, **others: Any) -> _Values:
    """The dataclass `kind`, each field from the property by its name, but for the `others`."""
    names = [field.name for field in fields(kind) if field.name not in others]  # type: ignore[arg-type]
    return kind(**{name: getattr(properties, name) for name in names}, **others)


@dataclass(frozen=True)
class Settings:
    """Lengths are in scene units, angles in radians; choices by the identifiers of choices.py."""

    levels: int
    energy: str
    interpolation: str
    limit: float
    tolerance: float  # in its unit
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
    keep_symmetry: bool
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
    memory_limit: int  # megabytes

    @classmethod
    def of(cls, properties: FairingSettings) -> Settings:
        """Those of an operator or a property group, as they are now."""
        return values_of(cls, properties)

    def for_source(self, source: Object) -> Settings:
        """The same with what AUTO comes to for `source`; a Subdivision Surface modifier that is in the
        faired mesh already is not followed a second time.
        """
        subdivided = subdivision(source) is not None
        if subdivided and is_evaluated(self) and self.interpolation in ("AUTO", "LIMIT"):
            return replace(self, interpolation="EXACT")
        if self.interpolation == "AUTO":
            return replace(self, interpolation="LIMIT" if subdivided else "EXACT")
        return self


@dataclass(frozen=True)
class PatchOptions:
    """Of spline patches, and of a file of them."""

    fit_tolerance: float  # share of the surface's size
    fit_angle: float
    fit_levels: int  # 0: as many as the tolerance needs
    # whether faces that fold or turn too sharply get patches: what is shown and not written is never refused
    force: bool = True
    unit: str = "MM"  # of the file


NAMES = tuple(field.name for field in fields(Settings))
# which say that vertices may be missed, where nobody says what they are
OF_NEAR = ("tolerance", "tolerance_group", "pull_group")
if TYPE_CHECKING:
    # questions that panels ask of Blender's properties too
    AnySettings: TypeAlias = Settings | FairingSettings
else:
    AnySettings = Settings


def is_near(settings: AnySettings) -> bool:
    """Whether the surface may miss vertices: only then does a tolerance mean anything."""
    return settings.interpolation == "APPROXIMATE"


def is_limit(settings: AnySettings) -> bool:
    """Whether the surface passes through limit positions."""
    return settings.interpolation == "LIMIT"


def subdivision(source: Object) -> Any:
    """The modifier by which `source` is looked at as a Catmull-Clark surface; None if there is none."""
    modifiers: Any = source.modifiers
    shown = (m for m in modifiers if m.type == "SUBSURF" and m.show_viewport)
    return next((m for m in shown if m.subdivision_type == "CATMULL_CLARK"), None)


def is_evaluated(settings: AnySettings) -> bool:
    """Whether the source is faired with its modifiers; never where faces are selected, on the mesh
    as modelled.
    """
    return settings.mesh_source == "EVALUATED" and not settings.use_selection


def halves(settings: AnySettings) -> int:
    """How many times as large as the mesh what is computed is: with its mirror image, twice."""
    return 1 if settings.symmetry_plane == "NONE" else 2


def wants_modifiers(settings: Settings) -> bool:
    """Whether a new surface gets the modifiers of its source: not what is in the faired mesh
    already.
    """
    return settings.copy_modifiers and settings.mesh_source == "ORIGINAL"
