# SPDX-License-Identifier: GPL-3.0-or-later
"""Other programs that close a hole, each with untuned settings and in a process of its own: two of these
libraries may not bear each other.

    python fill_rivals.py MAKER IN.npz OUT.npz

IN has `vertices` (n, 3), `faces` (m, 3) and `hole` (k,), ids around it; OUT has `vertices` and `faces`
of the whole mesh, the old vertices first, and the CPU seconds that the call alone took.
"""

import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import process_time
from typing import Any, TypeAlias

import numpy as np

CGAL = Path(__file__).resolve().parent.parent / "build/bench/benchmarks" / "fairing_bench_fill_cgal"

Arrays: TypeAlias = tuple[np.ndarray, np.ndarray, np.ndarray]
Made: TypeAlias = tuple[np.ndarray, np.ndarray, float]


def ours(energy: str) -> Callable[[Arrays], Made]:
    """Fills by df.fill_holes with its defaults."""

    def make(given: Arrays) -> Made:
        import discrete_fairing as df

        vertices, faces, hole = given
        begun = process_time()
        filled = df.fill_holes(vertices, faces, holes=[hole], energy=energy)
        return filled.vertices, np.asarray(filled.faces), process_time() - begun

    return make


def meshlib(given: Arrays) -> Made:
    """fillHoleNicely: triangulated, subdivided to the mean edge of the mesh, smoothed."""
    import meshlib.mrmeshnumpy as arrays
    import meshlib.mrmeshpy as mm

    vertices, faces, hole = given
    mesh = arrays.meshFromFacesVerts(faces.astype(np.int32), vertices)
    edge = next(
        e
        for e in mesh.topology.findHoleRepresentiveEdges()
        if mesh.topology.org(e).get() in set(hole.tolist())
    )
    settings = mm.FillHoleNicelySettings()
    settings.triangulateParams.metric = mm.getUniversalMetric(mesh)
    settings.subdivideSettings.maxEdgeLen = mean_edge(vertices, hole)
    settings.subdivideSettings.maxEdgeSplits = 10**6
    settings.smoothCurvature = True
    begun = process_time()
    mm.fillHoleNicely(mesh, edge, settings)
    taken = process_time() - begun
    return arrays.getNumpyVerts(mesh), arrays.getNumpyFaces(mesh.topology), taken


def pymeshlab(given: Arrays) -> Made:
    """meshing_close_holes, refined to the mean edge of the rim; all holes up to this one's size."""
    import pymeshlab as ml

    vertices, faces, hole = given
    work = ml.MeshSet(verbose=False)
    work.add_mesh(ml.Mesh(vertices, faces.astype(np.int32)))
    begun = process_time()
    work.meshing_close_holes(
        maxholesize=len(hole) + 1,
        refinehole=True,
        refineholeedgelen=ml.PureValue(mean_edge(vertices, hole)),
    )
    taken = process_time() - begun
    mesh = work.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix(), taken


def blender(operator: str) -> Callable[[Arrays], Made]:
    """An operator of Edit Mode on the selected rim; its faces cut into triangles."""

    def make(given: Arrays) -> Made:
        import bpy  # isort: skip
        import bmesh  # which comes with it

        vertices, faces, hole = given
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        mesh: Any = bpy.data.meshes.new("Hole")
        mesh.from_pydata(vertices.tolist(), [], faces.tolist())
        target = bpy.data.objects.new("Hole", mesh)
        bpy.context.scene.collection.objects.link(target)
        bpy.context.view_layer.objects.active = target
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_mode(type="EDGE")
        bpy.ops.mesh.select_all(action="DESELECT")
        edited = bmesh.from_edit_mesh(mesh)
        edited.verts.ensure_lookup_table()
        for a, b in zip(hole.tolist(), np.roll(hole, -1).tolist(), strict=True):
            edge = edited.edges.get((edited.verts[a], edited.verts[b]))
            if edge is not None:
                edge.select_set(True)
        bmesh.update_edit_mesh(mesh)
        begun = process_time()
        getattr(bpy.ops.mesh, operator)()
        taken = process_time() - begun
        bpy.ops.object.mode_set(mode="OBJECT")
        mesh.calc_loop_triangles()
        points = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", points)
        triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
        mesh.loop_triangles.foreach_get("vertices", triangles)
        return points.reshape(-1, 3).astype(float), triangles.reshape(-1, 3), taken

    return make


def cgal(continuity: int) -> Callable[[Arrays], Made]:
    """triangulate_refine_and_fair_hole; continuity 1 is its default, 2 goes on with curvature."""

    def make(given: Arrays) -> Made:
        import cholesky

        vertices, faces, hole = given
        with tempfile.TemporaryDirectory() as folder:
            source, target = Path(folder, "in"), Path(folder, "out")
            cholesky.write_mesh((vertices, faces), source)
            words = [CGAL, source, hole[0], hole[1], continuity, target]
            done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=True)
            lines = target.read_text().split("\n", 1)
            count = int(lines[0].split()[0])
            numbers = np.array(lines[1].split(), float)
        points, rest = numbers[: 3 * count], numbers[3 * count :]
        return points.reshape(-1, 3), rest.reshape(-1, 4)[:, 1:].astype(int), float(done.stdout)

    return make


def mean_edge(vertices: np.ndarray, hole: np.ndarray) -> float:
    return float(np.linalg.norm(vertices[hole] - vertices[np.roll(hole, -1)], axis=1).mean())


MAKERS: dict[str, Callable[[Arrays], Made]] = {
    "total curvature": ours("total_curvature"),
    "thin plate": ours("thin_plate"),
    "minimum variation": ours("minimum_variation"),
    "CGAL, C1": cgal(1),
    "CGAL, C2": cgal(2),
    "MeshLib": meshlib,
    "PyMeshLab": pymeshlab,
    "Blender, Fill": blender("fill"),
    "Blender, Grid Fill": blender("fill_grid"),
}


def made(name: str, given: Arrays, limit: float) -> Made | str:
    """The result of a fresh process; a message where it fails, or takes longer than `limit` seconds."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = Path(folder, "in.npz"), Path(folder, "out.npz")
        np.savez(source, vertices=given[0], faces=given[1], hole=given[2])
        words = [sys.executable, __file__, name, str(source), str(target)]
        try:
            done = subprocess.run(words, capture_output=True, text=True, timeout=limit)
        except subprocess.TimeoutExpired:
            return "too slow"
        if not target.exists():
            said = done.stderr.strip().splitlines()
            return said[-1][:60] if said else f"exit code {done.returncode}"
        found = np.load(target)
        return found["vertices"], found["faces"], float(found["seconds"])


def main(name: str, source: str, target: str) -> None:
    given = np.load(source)
    vertices, faces, seconds = MAKERS[name]((given["vertices"], given["faces"], given["hole"]))
    np.savez(target, vertices=vertices, faces=faces, seconds=seconds)


if __name__ == "__main__":
    main(*sys.argv[1:])
