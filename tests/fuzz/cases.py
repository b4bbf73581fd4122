# SPDX-License-Identifier: GPL-3.0-or-later
"""One call of fair() as a value: it can be drawn by chance, kept in a file, and run again."""

import json
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import control_meshes as meshes
import numpy as np
import sheet_meshes
from hypothesis import strategies as st

CORPUS = Path(__file__).resolve().parent / "corpus"
FAR = (1e3, 1e6, 1e6, 1e9, 1e60, 1e120, float("inf"))


@dataclass
class Case:
    """Arguments of fair(): numbers and lists alone."""

    vertices: list[list[float]]
    faces: list[list[int]]
    options: dict[str, Any] = field(default_factory=dict)

    @property
    def points(self) -> np.ndarray:
        """(n, 3) float64."""
        return np.array(self.vertices, float).reshape(-1, 3)

    def write(self, path: Path) -> None:
        """As JSON, not-a-number and infinity by their names."""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(vars(self)) + "\n")

    @classmethod
    def read(cls, path: Path) -> "Case":
        """What write() has written."""
        return cls(**json.loads(path.read_text()))


def case_of(points: np.ndarray, faces: np.ndarray, *_: object) -> Case:
    """Of a mesh that the other tests make."""
    return Case(points.tolist(), faces.tolist())


def prism(count: int) -> Case:
    """Two polygons and a band of quads between."""
    turn = 2 * np.pi * np.arange(count) / count
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1)
    after = [(k + 1) % count for k in range(count)]
    band = [[k, after[k], count + after[k], count + k] for k in range(count)]
    caps = [list(range(count))[::-1], list(range(count, 2 * count))]
    return Case([*ring.tolist(), *(ring + [0, 0, 1]).tolist()], band + caps)


SOUND = st.one_of(
    st.just(case_of(*meshes.tetrahedron())),
    st.builds(lambda c, r: case_of(*meshes.grid(c, r)), st.integers(1, 4), st.integers(1, 4)),
    st.builds(lambda u, v: case_of(*meshes.torus(u, v, 2)), st.integers(3, 6), st.integers(3, 5)),
    st.builds(lambda n: case_of(*meshes.fan(n)), st.integers(3, 40)),
    st.builds(prism, st.integers(3, 9)),
    st.builds(lambda n: case_of(*sheet_meshes.book(n, 2, 1)), st.integers(2, 4)),
)


@st.composite
def damaged(draw: st.DrawFn) -> Case:
    """A mesh of some shape, with up to four things done to it that real files have."""
    mesh = draw(SOUND)
    points, faces = mesh.points, [list(face) for face in mesh.faces]
    shake = draw(st.sampled_from((0.0, 0.1, 1.0)))
    seed = draw(st.integers(0, 2**16))
    points = points + shake * np.random.default_rng(seed).uniform(-1, 1, points.shape)
    points = points * draw(st.sampled_from((1.0, 1.0, 1e-9, 1e9, 1e-150, 1e90)))
    for _ in range(draw(st.sampled_from((0, 0, 1, 1, 2, 4)))):
        v = draw(st.integers(0, len(points) - 1))
        f = draw(st.integers(0, len(faces) - 1))
        other = draw(st.integers(0, len(points) - 1))
        match draw(st.sampled_from(DAMAGES)):
            case "far":
                with np.errstate(invalid="ignore"):  # 0 times infinity is a case, too
                    points[v] = (1 + points[v]) * draw(st.sampled_from(FAR))
            case "coincide":
                points[v] = points[other]
            case "flat":
                points[:, draw(st.integers(0, 2))] = 0
            case "stretch":
                points[:, draw(st.integers(0, 2))] *= draw(st.sampled_from((1e-6, 1e3)))
            case "turn":
                faces[f].reverse()
            case "twice":
                faces.append(list(faces[f]))
            case "lose" if len(faces) > 1:
                faces.pop(f)
            case "merge":
                faces = [[other if k == v else k for k in face] for face in faces]
            case "fin":
                a, b = faces[f][:2]
                faces.append([a, b, other])
            case "wild":
                faces[f][0] = draw(st.sampled_from((-1, len(points), 2**31, other)))
    return Case(points.tolist(), faces)


DAMAGES = (
    "far",
    "far",
    "far",
    "coincide",
    "flat",
    "stretch",
    "turn",
    "twice",
    "lose",
    "merge",
    "fin",
    "wild",
)


@st.composite
def options(draw: st.DrawFn, mesh: Case) -> dict[str, Any]:
    """Options of fair() that go together, mostly."""
    count = len(mesh.vertices)
    vertex = st.integers(0, count - 1)
    share = st.sampled_from((0.0, 0.25, 1.0))
    some: dict[str, st.SearchStrategy[Any]] = {
        "energy": st.sampled_from(("thin_plate", "total_curvature", "minimum_variation")),
        "pad_size": share,
        "tension": share,
        "metric_exponent": st.sampled_from((0.0, 0.5, 1.0)),
        "chart": st.sampled_from(("exponential", "tangent")),
        "boundary": st.sampled_from(("curve", "linear", "free")),
        "crease_edges": st.lists(st.tuples(vertex, vertex).map(list), max_size=2),
        "crease_angle": st.sampled_from((0.1, 1.0)),
        "corner_vertices": st.lists(vertex, max_size=3),
        "corner_angle": st.sampled_from((0.1, 1.0)),
        "region": st.lists(st.integers(0, len(mesh.faces) - 1), min_size=1, max_size=4),
        "joint": st.sampled_from(("position", "tangent", "curvature")),
        "epsilon": st.sampled_from((0.0, 1e-3)),
        "method": st.sampled_from(("multigrid", "back_leg")),
        "measure": st.booleans(),
        "repair": st.sampled_from(("mend", "refuse")),
        "weld": st.sampled_from((0.0, 0.1)),
        "threads": st.integers(0, 3),
        "step_tolerance": st.sampled_from((1e-11, 1e-8, 0.1)),
        "max_steps": st.sampled_from((1, 3, 40)),
        "interpolation": st.just("approximate"),
    }
    chosen = draw(st.sets(st.sampled_from(sorted(some)), max_size=4)) | {
        "energy",
        "pad_size",
        "repair",
    }
    found = {name: draw(some[name]) for name in sorted(chosen)}
    found["levels"] = draw(st.integers(0, 3 if count < 20 else 2))
    if "interpolation" in found:
        held = st.sampled_from((0.0, 1e-3, 0.1, float("inf")))
        found |= draw(
            st.one_of(
                st.builds(lambda t: {"tolerance": t}, st.sampled_from((0.0, 1e-3, 0.3))),
                st.builds(
                    lambda t: {"tolerance": t}, st.lists(held, min_size=count, max_size=count)
                ),
                st.builds(lambda w: {"weights": w}, st.lists(held, min_size=count, max_size=count)),
            )
        )
    return found


@st.composite
def cases(draw: st.DrawFn) -> Case:
    """Any mesh with any options."""
    mesh = draw(damaged())
    return Case(mesh.vertices, mesh.faces, draw(options(mesh)))


def border_of(faces: list[list[int]]) -> list[int]:
    """The vertices of edges with one face, of sound faces."""
    sides = [frozenset(side) for face in faces for side in zip(face, [*face[1:], face[0]])]
    times = Counter(sides)
    return sorted({v for side in sides if times[side] == 1 for v in side})


@st.composite
def halves(draw: st.DrawFn) -> Case:
    """A mesh whose border lies in a plane of symmetry, most of it or all; a closed one is opened."""
    mesh = draw(damaged())
    faces = mesh.faces if border_of(mesh.faces) else mesh.faces[1:]
    points, plane = mesh.points, draw(st.sampled_from("xyz"))
    border = [v for v in border_of(faces) if 0 <= v < len(points)]
    out = draw(st.sets(st.sampled_from(border), max_size=2)) if border else set()
    with np.errstate(invalid="ignore"):
        near = draw(st.sampled_from((0.0, 0.0, 1e-7))) * np.nanmax(np.abs(points), initial=0)
    points[[v for v in border if v not in out], "xyz".index(plane)] = near
    half = Case(points.tolist(), faces)
    return Case(half.vertices, faces, draw(options(half)) | {"symmetry_plane": plane})
