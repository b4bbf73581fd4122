# SPDX-License-Identifier: GPL-3.0-or-later
"""join(): the whole surface from its parts, and how well neighbours agree."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import Any

import numpy as np

from ..errors import fairing_error
from ..result import Result
from .part import Part


def join(parts: Iterable[Part]) -> Result:
    """The whole surface as one Result, in memory.

    `parts`: the parts of all pieces, in any order. Points on a seam are those of their owner, to the last
    bit. report["pieces"] says how well neighbours agree.
    Raises FairingError BAD_OPTION for parts that do not belong together or are missing, TOO_LARGE
    for more than 2**31 points.
    """
    whole: Whole | None = None
    for part in parts:
        whole = whole or Whole(part)
        whole.take(part)
    if whole is None:
        raise fairing_error("BAD_OPTION", "There are no parts to join.")
    return whole.result()


def worst(values: list[Any]) -> Any:
    """Of the same entry of several reports: whether all are true, or the largest number; of lists and
    dicts, element by element.
    """
    if isinstance(values[0], dict):
        names = dict.fromkeys(name for value in values for name in value)
        return {name: worst([v[name] for v in values if name in v]) for name in names}
    if isinstance(values[0], list):
        longest = max(map(len, values))
        return [worst([v[k] for v in values if k < len(v)]) for k in range(longest)]
    return all(values) if isinstance(values[0], bool) else max(values)


class Whole:
    """The whole surface while parts are added to it."""

    def __init__(self, first: Part):
        numbering = first.numbering
        if numbering.size >= 2**31:
            raise fairing_error(
                "TOO_LARGE",
                f"The surface has {numbering.size} points; a mesh in memory holds fewer than "
                "2**31.",
                cure="Keep it in parts.",
            )
        self.surface, self.numbering = first.surface, numbering
        cells = 1 << (2 * numbering.levels)
        self.vertices = np.empty((numbering.size, 3))
        self.shapes = [np.empty((numbering.size, 3)) for _ in range(first.surface["shapes"])]
        self.faces = [
            np.empty((count, cells, size), np.int32)
            for count, size in ((numbering.triangles, 3), (numbering.quads, 4))
        ]
        self.polygon = [
            np.empty(count, np.int32) for count in (numbering.triangles, numbering.quads)
        ]
        self.has_pads = False
        self.widths = np.zeros(first.surface["input_vertices"])
        self.first: dict[str, Any] = {}
        self.seams: list[tuple[int, np.ndarray, np.ndarray]] = []
        self.reports: dict[int, dict[str, Any]] = {}

    def take(self, part: Part) -> None:
        if part.surface["fingerprint"] != self.surface["fingerprint"] or (
            part.surface["count"] != self.surface["count"]
        ):
            raise fairing_error("BAD_OPTION", "The parts are of different surfaces.")
        if part.index in self.reports:
            raise fairing_error("BAD_OPTION", f"Part {part.index} is given twice.")
        part.write_into(self.vertices)
        for vertices, shape in zip(self.shapes, part.shapes):
            vertices[part.ids] = shape
        cells = 1 << (2 * self.numbering.levels)
        for kind, faces in enumerate(part.faces):
            its = part.control.take(np.flatnonzero(part.control.quad == bool(kind)))
            rank = its.quads_before if kind else its.number - its.quads_before
            self.faces[kind][rank] = faces.reshape(-1, cells, 3 + kind)
            self.polygon[kind][rank] = its.polygon
        if len(part.report["pad_widths"]):
            self.widths[part.vertex_ids] = part.report["pad_widths"]
            self.has_pads = True
        self.seams.append((part.index, part.seam_ids, part.seam_points))
        self.reports[part.index] = part.report
        if part.index == 0:
            self.first = part.surface

    def result(self) -> Result:
        missing = sorted(set(range(self.surface["count"])) - set(self.reports))
        if missing:
            raise fairing_error(
                "BAD_OPTION",
                f"Parts are missing: {', '.join(map(str, missing[:20]))}.",
                cure="Fair these pieces too.",
            )
        self.vertices[self.first["alone"]] = self.first["alone_points"]
        for vertices, alone in zip(self.shapes, self.first["alone_shapes"]):
            vertices[self.first["alone"]] = alone
        cells = 1 << (2 * self.numbering.levels)
        arrays: dict[str, Any] = {
            "vertices": self.vertices,
            "triangles": self.faces[0].reshape(-1, 3),
            "quads": self.faces[1].reshape(-1, 4),
            "triangle_polygon": np.repeat(self.polygon[0], cells),
            "quad_polygon": np.repeat(self.polygon[1], cells),
            "crease_edges": self.first["crease_edges"],
            "shapes": self.shapes,
            "mended": self.first.get("mended"),
        }
        if arrays["mended"]:
            self._restore(arrays)
        arrays["report"] = self._report()
        return Result(arrays)

    def _restore(self, arrays: dict[str, Any]) -> None:
        """Converts ids back from the mended mesh, like native/fairing/mending.cpp."""
        origin, count = arrays["mended"]["vertex_origin"], self.surface["input_vertices"]
        for vertices in (self.vertices, *self.shapes):
            vertices[:count] = vertices[origin]
        self.widths = self.widths[origin]
        for kind in ("triangle", "quad"):
            mended = arrays[f"{kind}_polygon"]
            arrays[f"{kind}_mended"] = mended
            arrays[f"{kind}_polygon"] = arrays["mended"]["face_origin"][mended]

    def _report(self) -> dict[str, Any]:
        reports = [self.reports[index] for index in sorted(self.reports)]
        told = [r for r in reports if "seconds" in r]
        apart = ("pad_widths", "pads", "warnings")
        merged = worst([{key: r[key] for key in r if key not in apart} for r in reports])
        seconds = sum((Counter(r["seconds"]) for r in told), Counter[str]())
        return {
            **merged,
            "warm": False,
            "seconds": dict(seconds),
            "pads": {
                "gone": sum(r["pads"]["gone"] for r in told),
                "widths": self.widths.tolist() if self.has_pads else [],
            },
            "normals": {**merged["normals"], "fixed": sum(r["normals"]["fixed"] for r in told)},
            **self.first["report"],
            "warnings": self.first["report"]["warnings"]
            + [warning for report in reports for warning in report["warnings"]],
            "pieces": {
                "count": self.surface["count"],
                "rings": self.surface["rings"],
                "jump": self._jump(),
                "parts": [{k: v for k, v in r.items() if k != "pad_widths"} for r in reports],
            },
        }

    def _jump(self) -> dict[str, Any]:
        """How far parts are from the owners of their seams."""
        gaps = [np.linalg.norm(p - self.vertices[ids], axis=1) for _, ids, p in self.seams]
        largest, every = [float(gap.max(initial=0.0)) for gap in gaps], np.concatenate(gaps)
        at = int(np.argmax(largest))
        return {
            "largest": largest[at],
            "median": float(np.median(every)) if len(every) else 0.0,
            "points": len(every),
            "part": self.seams[at][0],
            "share": largest[at] / self.surface["size"],
        }
