# SPDX-License-Identifier: GPL-3.0-or-later
"""Shape keys of the refined mesh."""

import numpy as np

from .drivers import copy_drivers


def write_shape_keys(target, keys, shapes, source=None):
    """Gives the object `target` the `keys` (ShapeKeys): the first has its mesh's own positions, the others `shapes`.

    `shapes`: k - 1 arrays (N, 3), or one array (k - 1, N, 3). Vertex groups have to be there already. `source`: the
    object whose keys they are, for their drivers.
    """
    blocks = [target.shape_key_add(name=key.name, from_mix=False) for key in keys.keys]
    for block, positions in zip(blocks[1:], shapes, strict=True):
        block.data.foreach_set("co", np.ascontiguousarray(positions, np.float32).ravel())
    for block, key in zip(blocks, keys.keys):
        block.name = key.name
        block.relative_key = blocks[key.relative_key]
        for name, value in key.settings.items():
            setattr(block, name, value)
    owner = target.data.shape_keys
    owner.use_relative = keys.use_relative
    owner.eval_time = keys.eval_time
    target.active_shape_key_index = keys.active
    target.show_only_shape_key = keys.show_only
    if source is not None and source.data.shape_keys is not None:
        copy_drivers(source.data.shape_keys, owner)
