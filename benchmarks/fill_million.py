# SPDX-License-Identifier: GPL-3.0-or-later
"""Fill Hole Fair on a mesh of a million triangles: the add-on in Blender as a Python module, part by
part. What Blender does for undo and to draw the mesh comes on top.
"""

import sys
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np
import table

ROOT = Path(__file__).resolve().parent.parent
SIDE = 720  # vertices along a side of a curved sheet
EDGES = (30, 100, 300)  # around a round hole in its middle, about
REPEATS = 3
PARTS = ("read", "compute", "compare", "apply")


def run() -> dict[str, Any]:
    """Seconds of the processor, all threads together, the least of some runs; and of the clock."""
    sys.path.insert(0, str(ROOT))
    try:
        import bpy
    except ImportError:
        print("fill_million: Blender as a Python module is not there")
        return {}
    import addon

    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon.register()
    try:
        result = {}
        for edges in EDGES:
            runs = [_measured(edges) for _ in range(REPEATS)]
            result[str(edges)] = min(runs, key=lambda r: r["whole"])
            result[str(edges)]["wall"] = min(r["wall"] for r in runs)
    finally:
        addon.unregister()
    heads = ["triangles", "edges around", "new faces", *PARTS, "whole", "wall"]
    rows = [[r[head] for head in heads] for r in result.values()]
    table.show("A hole in a million triangles: seconds", heads, rows)
    return result


def sheet(radius: float) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and triangles of a curved square with a hole of this radius, in edges."""
    line = np.linspace(-1, 1, SIDE)
    x, y = np.meshgrid(line, line, indexing="ij")
    vertices = np.stack([x, y, 0.3 * np.sin(2 * x) * np.cos(2 * y)], -1).reshape(-1, 3)
    at = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    quads = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], -1).reshape(-1, 4)
    faces = np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]])
    away = np.linalg.norm(vertices[faces].mean(1)[:, :2], axis=1)
    used, faces = np.unique(faces[away > radius * 2 / (SIDE - 1)], return_inverse=True)
    return vertices[used], faces.reshape(-1, 3)


def _measured(edges: int) -> dict[str, Any]:
    import bpy

    from addon.holes import HoleJob, Wish

    # a circle is eight radii around, as edges of the lattice go
    target = _object(*sheet(edges / 8))
    wall, begun = perf_counter(), process_time()
    times: list[float] = []
    job = HoleJob(bpy.context, target, Wish("CURVATURE", "TOTAL_CURVATURE", 1.0, 2 * edges, False))
    times.append(process_time())
    job.compute()
    times.append(process_time())
    if job.why_outdated(bpy.context):
        raise RuntimeError("the mesh changed meanwhile")
    times.append(process_time())
    triangles = len(target.data.polygons)
    done = job.apply()
    times.append(process_time())
    wall = perf_counter() - wall
    around = sum(len(loop) for hole in job.result.holes for loop in hole.loops)
    bpy.data.meshes.remove(target.data)
    return {
        "triangles": triangles,
        "edges around": around,
        "new faces": done.faces,
        **dict(zip(PARTS, np.diff([begun, *times]).tolist(), strict=True)),
        "whole": times[-1] - begun,
        "wall": wall,
    }


def _object(vertices: np.ndarray, faces: np.ndarray) -> Any:
    """With a UV map."""
    import bpy

    mesh: Any = bpy.data.meshes.new("Sheet")
    mesh.vertices.add(len(vertices))
    mesh.loops.add(faces.size)
    mesh.polygons.add(len(faces))
    mesh.attributes["position"].data.foreach_set("vector", vertices.astype(np.float32).ravel())
    mesh.attributes[".corner_vert"].data.foreach_set("value", faces.astype(np.int32).ravel())
    mesh.polygons.foreach_set("loop_start", 3 * np.arange(len(faces), dtype=np.int32))
    mesh.update(calc_edges=True)
    mesh.uv_layers.new(name="UV")
    target = bpy.data.objects.new("Sheet", mesh)
    bpy.context.collection.objects.link(target)
    bpy.context.view_layer.objects.active = target
    target.select_set(True)
    return target
