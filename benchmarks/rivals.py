# SPDX-License-Identifier: GPL-3.0-or-later
"""Other programs that make a smooth surface of a control mesh, each called as its own documents advise.

Every maker takes (vertices, polygons, levels) and gives (points (n, 3), triangles (m, 3)); it
raises Missing where its package is not installed and Refused where it cannot take the mesh.
"""

import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module, metadata
from pathlib import Path
from types import ModuleType
from typing import Any

import discrete_fairing as df
import numpy as np

sys.path.append(str(Path(__file__).resolve().parent.parent / "tests" / "python"))

Surface = tuple[np.ndarray, np.ndarray]
PUSHED, ROUNDS = 1e-5, 100  # of pushing a cage out: what may remain, as a share; the most rounds


class Missing(Exception):
    """The package is not installed."""


class Refused(Exception):
    """The tool does not take this mesh."""


@dataclass(frozen=True)
class Rival:
    name: str
    make: Callable[[np.ndarray, list[list[int]], int], Surface]
    interpolates: bool
    note: str


def installed(name: str, package: str) -> ModuleType:
    """The module, or Missing with the command that installs it."""
    try:
        return import_module(name)
    except ImportError as error:
        # without dependencies: NumPy has to stay as the module bpy wants it
        raise Missing(
            f"{package} is not installed: .venv/bin/pip install --no-deps {package}"
        ) from error


def load_early() -> None:
    """Before the module bpy: libigl can crash where that has been loaded first."""
    with suppress(Missing):
        installed("igl", "libigl")


def versions() -> dict[str, str]:
    """The versions of all tools that take part."""
    found = {}
    for package in ("discrete-fairing", "manifold3d", "libigl", "bpy", "numpy"):
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            found[package] = "not installed"
    return found


def triangulate(points: np.ndarray, polygons: list[list[int]]) -> np.ndarray:
    """(m, 3): quads are cut along their shorter diagonal, larger polygons become fans."""
    triangles = []
    for p in polygons:
        p = list(p)
        if len(p) == 4 and np.linalg.norm(points[p[1]] - points[p[3]]) < np.linalg.norm(
            points[p[0]] - points[p[2]]
        ):
            p = p[1:] + p[:1]
        triangles += [[p[0], p[k], p[k + 1]] for k in range(1, len(p) - 1)]
    return np.array(triangles, np.int64)


def is_closed(triangles: np.ndarray) -> bool:
    """Whether every edge has its other side."""
    halves = {(t[k], t[(k + 1) % 3]) for t in triangles.tolist() for k in range(3)}
    return all((b, a) in halves for a, b in halves)


def fairing(energy: str) -> Callable[..., Surface]:
    """A maker that calls discrete_fairing."""

    def make(points: np.ndarray, polygons: list[list[int]], levels: int) -> Surface:
        try:
            result = df.fair(points, polygons, levels=levels, energy=energy, measure=False)
        except df.FairingError as error:
            if error.code == "BAD_OPTION":
                raise Missing(f"this build has no energy {energy}") from error
            raise Refused(f"{error.code}") from error
        except ValueError as error:
            raise Missing(f"this build has no energy {energy}") from error
        return result.vertices, result.triangles.astype(np.int64)

    return make


def manifold(points: np.ndarray, polygons: list[list[int]], levels: int) -> Surface:
    """Smooth tangents at every edge, then Bézier patches cut into 2**levels pieces a side."""
    module = installed("manifold3d", "manifold3d")
    triangles = triangulate(points, polygons)
    mesh = module.Mesh64(vert_properties=points, tri_verts=triangles.astype(np.uint64))
    if not is_closed(triangles) or module.Manifold(mesh).status() != module.Error.NoError:
        raise Refused("takes closed meshes only")
    out = module.Manifold.smooth(mesh).refine(2**levels).to_mesh64()
    return np.array(out.vert_properties)[:, :3], np.array(out.tri_verts).astype(np.int64)


def biharmonic(points: np.ndarray, polygons: list[list[int]], levels: int) -> Surface:
    """The flat faces refined, then libigl's biharmonic positions with the control vertices
    fixed."""
    igl = installed("igl", "libigl")
    vertices, triangles = igl.upsample(points, triangulate(points, polygons), levels)
    fixed = np.arange(len(points))
    return igl.harmonic(vertices, triangles, fixed, points, 2), triangles


def loop(points: np.ndarray, polygons: list[list[int]], levels: int) -> Surface:
    """Subdivides by libigl's Loop scheme."""
    igl = installed("igl", "libigl")
    return igl.loop(points, triangulate(points, polygons), levels)


def modified_butterfly(points: np.ndarray, polygons: list[list[int]], levels: int) -> Surface:
    """Subdivides by modified butterfly, in NumPy."""
    import butterfly

    triangles = triangulate(points, polygons)
    if not is_closed(triangles):
        raise Refused("our version takes closed meshes only")
    for _ in range(levels):
        points, triangles = butterfly.refine(points, triangles)
    return points, triangles


def catmull_clark(
    points: np.ndarray,
    polygons: list[list[int]],
    levels: int,
    creases: Sequence[tuple[int, int]] = (),
) -> Surface:
    """Blender's Subdivision Surface with its own settings; `creases`: edges that are sharp."""
    bpy = installed("bpy", "bpy")
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    mesh = bpy.data.meshes.new("Control")
    mesh.from_pydata(points.tolist(), [], [list(map(int, p)) for p in polygons])
    if creases:
        sharp = {frozenset(edge) for edge in creases}
        values = [float(frozenset(edge.vertices) in sharp) for edge in mesh.edges]
        mesh.attributes.new("crease_edge", "FLOAT", "EDGE").data.foreach_set("value", values)
    target = bpy.data.objects.new("Control", mesh)
    bpy.context.scene.collection.objects.link(target)
    modifier = target.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = levels
    result = target.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    return mesh_arrays(result)


def catmull_clark_through(
    points: np.ndarray,
    polygons: list[list[int]],
    levels: int,
    creases: Sequence[tuple[int, int]] = (),
) -> Surface:
    """Subdivision Surface of a cage that is pushed out until the surface meets the given points."""
    from scipy.sparse.linalg import LinearOperator, gmres

    def met(cage: np.ndarray) -> np.ndarray:
        surface, _ = catmull_clark(cage.reshape(-1, 3), polygons, 1, creases)
        return surface[: len(points)].ravel()

    wanted = points.astype(float).ravel()
    map_of_cages = LinearOperator((len(wanted), len(wanted)), met)
    cage, _ = gmres(map_of_cages, wanted, wanted, rtol=PUSHED, restart=ROUNDS, maxiter=1)
    return catmull_clark(cage.reshape(-1, 3), polygons, levels, creases)


def mesh_arrays(mesh: Any) -> Surface:
    """Points and triangles of a mesh of Blender's; quads cut along their shorter diagonal."""
    points = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3).astype(float)
    corners, counts = np.empty(len(mesh.loops), np.int32), np.empty(len(mesh.polygons), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    mesh.polygons.foreach_get("loop_total", counts)
    if not (counts == 4).all():
        return points, triangulate(points, np.split(corners, np.cumsum(counts)[:-1]))
    quads = corners.reshape(-1, 4).astype(np.int64)
    corner = points[quads]
    other = np.linalg.norm(corner[:, 1] - corner[:, 3], axis=1) < np.linalg.norm(
        corner[:, 0] - corner[:, 2], axis=1
    )
    cut = np.where(other[:, None], quads[:, [1, 2, 3, 1, 3, 0]], quads[:, [0, 1, 2, 0, 2, 3]])
    return points, cut.reshape(-1, 3)


ALL = (
    Rival(
        "thin plate",
        fairing("thin_plate"),
        True,
        'Discrete Fairing, `energy="thin_plate"`: the paper\'s',
    ),
    Rival(
        "total curvature", fairing("total_curvature"), True, "Discrete Fairing, ∫ κ₁² + κ₂² itself"
    ),
    Rival(
        "minimum variation",
        fairing("minimum_variation"),
        True,
        "Discrete Fairing, change of curvature",
    ),
    Rival(
        "Manifold",
        manifold,
        True,
        "manifold3d, `smooth` then `refine`: one patch for each triangle",
    ),
    Rival(
        "biharmonic", biharmonic, True, "libigl, `harmonic` with k = 2 on the refined flat faces"
    ),
    Rival(
        "butterfly",
        modified_butterfly,
        True,
        "modified butterfly subdivision, a NumPy version of ours",
    ),
    Rival("Catmull-Clark", catmull_clark, False, "Blender's Subdivision Surface, default settings"),
    Rival("Loop", loop, False, "libigl, `loop`"),
)
