# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings and arrays as the arguments of `discrete_fairing.fair`: the one place that knows both spellings."""

from .features import corner_vertices, crease_edges


def fair_arguments(arrays, settings, preferences, region=None, shapes=None):
    """Keyword arguments for `discrete_fairing.fair`, `vertices` and `faces` included.

    `region`: (r,) ids of the faces to fair, None for all. `shapes`: (k, n, 3) further positions, such as shape keys.
    """
    threshold = settings.crease_threshold if settings.use_crease_attribute else None
    approximate = settings.interpolation == "APPROXIMATE"
    arguments = {
        "vertices": arrays.positions,
        "faces": (arrays.corners, arrays.offsets),
        "levels": settings.levels,
        "energy": settings.energy.lower(),
        "metric_exponent": settings.metric_exponent,
        "interpolation": settings.interpolation.lower(),
        "tolerance": settings.tolerance if approximate else 0.0,
        "crease_edges": crease_edges(arrays, threshold, settings.use_sharp_edges),
        "corner_vertices": corner_vertices(arrays, threshold),
        "crease_angle": settings.crease_angle if settings.use_crease_angle else None,
        "corner_angle": settings.corner_angle if settings.use_corner_angle else None,
        "boundary": settings.boundary.lower(),
        "epsilon": settings.epsilon,
        "repair_orientation": settings.repair_orientation,
        "memory_limit": (settings.memory_limit or preferences.memory_limit) * 2**20,
        "threads": preferences.threads,
    }
    if region is not None:
        arguments |= {"region": region, "joint": settings.joint.lower()}
    if shapes is not None and len(shapes):
        arguments["shapes"] = shapes
    return arguments
