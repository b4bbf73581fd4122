# SPDX-License-Identifier: GPL-3.0-or-later
"""The attributes of a Blender mesh, other than its topology and positions, as NumPy arrays."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Storage:
    """How Blender hands out one element of a data type."""

    field: str  # its name in foreach_get and foreach_set
    dtype: type
    width: int
    mixable: bool  # numbers that a mean makes sense of


STORAGE = {
    "FLOAT": Storage("value", np.float32, 1, True),
    "FLOAT2": Storage("vector", np.float32, 2, True),
    "FLOAT_VECTOR": Storage("vector", np.float32, 3, True),
    "FLOAT_COLOR": Storage("color", np.float32, 4, True),
    "BYTE_COLOR": Storage("color", np.float32, 4, True),  # linear colours, which mix as light does
    "INT": Storage("value", np.int32, 1, False),
    "INT8": Storage("value", np.int32, 1, False),
    "INT16_2D": Storage("value", np.int32, 2, False),
    "INT32_2D": Storage("value", np.int32, 2, False),
    "BOOLEAN": Storage("value", bool, 1, False),
    "QUATERNION": Storage("value", np.float32, 4, False),
    "FLOAT4X4": Storage("value", np.float32, 16, False),
    "STRING": Storage("value", object, 1, False),
}

# positions and topology, which the refined mesh has of its own; seams have another name in each Blender version
_NOT_CARRIED = {"position", "custom_normal", "uv_seam"}
# all other names that begin with a dot are Blender's own: topology, selection, what is hidden, pins
_INTERNAL_CARRIED = {".sculpt_mask", ".sculpt_face_set"}


@dataclass(frozen=True)
class Attribute:
    """One attribute: `values` (size,) or (size, width), of the elements of `domain`."""

    name: str
    data_type: str
    domain: str
    values: np.ndarray


def read_attributes(mesh):
    """The attributes of `mesh` that are carried: (list of Attribute, list of names of unknown data types)."""
    chosen = [attribute for attribute in mesh.attributes if _is_carried(attribute.name)]
    known = [attribute for attribute in chosen if attribute.data_type in STORAGE]
    return [_read(attribute) for attribute in known], [a.name for a in chosen if a.data_type not in STORAGE]


def _is_carried(name):
    return name not in _NOT_CARRIED and (not name.startswith(".") or name in _INTERNAL_CARRIED)


def _read(attribute):
    storage = STORAGE[attribute.data_type]
    size = len(attribute.data)
    if storage.dtype is object:  # texts have no bulk access
        values = np.array([item.value for item in attribute.data], object)
    else:
        values = np.empty(size * storage.width, storage.dtype)
        attribute.data.foreach_get(storage.field, values)
    if storage.width > 1:
        values = values.reshape(size, storage.width)
    return Attribute(attribute.name, attribute.data_type, attribute.domain, values)
