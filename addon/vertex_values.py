# SPDX-License-Identifier: GPL-3.0-or-later
"""One number a vertex by name: a vertex group, or else a float attribute on points."""

from collections.abc import Iterator

import numpy as np

from .blender import Mesh, Object, column
from .errors import JobError

# The weight for a strength of one half, with which vertices move by about a twentieth of an edge.
_PULL_OF_HALF = 100.0


def names(source: Object) -> Iterator[tuple[str, str]]:
    """(name, kind) of all values of `source`; where two share a name, the last one is read."""
    for attribute in source.data.attributes:
        if _is_float(attribute) and not attribute.name.startswith("."):
            yield attribute.name, "Attribute"
    for group in source.vertex_groups:
        yield group.name, "Vertex Group"


def exists(source: Object, mesh: Mesh, name: str) -> bool:
    """Whether `source` has values by this `name`."""
    return name in source.vertex_groups or _is_float(mesh.attributes.get(name))


def factors(source: Object, mesh: Mesh, name: str) -> np.ndarray:
    """(n,) float64 from 0 to 1: the values `name` on `mesh`, which is the mesh of the object `source`
    or the result of its modifiers. 0 outside of a group.

    Raises JobError if there are none by this name.
    """
    return np.clip(_read(source, mesh, name, "Tolerance Group"), 0.0, 1.0)


def pulls(source: Object, mesh: Mesh, name: str) -> np.ndarray:
    """(n,) float64 from 0, infinity included: weights of the core. An attribute has weights; a group
    has strengths from 0, no weight, to 1, which fixes the vertex.

    Raises JobError if there are none by this name, or invalid weights.
    """
    values = _read(source, mesh, name, "Pull Group")
    if name in source.vertex_groups:
        with np.errstate(divide="ignore"):
            return _PULL_OF_HALF * (values / (1 - np.minimum(values, 1))) ** 2
    wrong = np.flatnonzero(~(values >= 0))
    if len(wrong):
        raise JobError(
            f"{source.name}: Change the attribute '{name}' at vertex {wrong[0]}, or choose another Pull Group. "
            f"It is {values[wrong[0]]:g} there, and pulls are 0 or more."
        )
    return values


def _read(source: Object, mesh: Mesh, name: str, field: str) -> np.ndarray:
    if not exists(source, mesh, name):
        raise JobError(
            f"{source.name}: Choose another {field}, or clear the field. "
            f"There is no vertex group and no float attribute on points named '{name}'."
        )
    if name in source.vertex_groups:
        return _group(mesh, source.vertex_groups[name].index)
    return column(mesh.attributes[name].data, "value").astype(np.float64)


def _is_float(attribute: object) -> bool:
    return (getattr(attribute, "data_type", ""), getattr(attribute, "domain", "")) == (
        "FLOAT",
        "POINT",
    )


def _group(mesh: Mesh, index: int) -> np.ndarray:
    weights = np.zeros(len(mesh.vertices))
    for vertex in mesh.vertices:
        for member in vertex.groups:
            if member.group == index:
                weights[vertex.index] = member.weight
    return weights
