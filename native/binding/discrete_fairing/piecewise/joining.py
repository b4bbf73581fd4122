# SPDX-License-Identifier: GPL-3.0-or-later
"""join(): the whole surface from its parts, and how well neighbours agree."""

from __future__ import annotations

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


def jumps(seams: list[tuple[int, np.ndarray, np.ndarray]], owner: Any, size: float) -> dict:
    """The distances for seams (part, ids, points), with owner(ids) -> points."""
    gaps = [np.linalg.norm(points - owner(ids), axis=1) for _, ids, points in seams]
    largest = [float(gap.max(initial=0.0)) for gap in gaps]
    every = np.concatenate(gaps) if gaps else np.empty(0)
    at = int(np.argmax(largest)) if largest else 0
    return {
        "largest": largest[at] if largest else 0.0,
        "median": float(np.median(every)) if len(every) else 0.0,
        "points": len(every),
        "part": seams[at][0] if seams else 0,
        "share": (largest[at] if largest else 0.0) / size,
    }


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
        for shape, vertices in enumerate(self.shapes):
            part.of_shape(shape).write_into(vertices)
        cells = 1 << (2 * self.numbering.levels)
        for kind, faces in enumerate(part.faces):
            which = part.is_quad == bool(kind)
            quads = part.quads_before[which]
            rank = quads if kind else part.face_id[which] - quads
            self.faces[kind][rank] = faces.reshape(-1, cells, 3 + kind)
            self.polygon[kind][rank] = part.polygon[which]
        own = part.vertex_id < len(self.widths)
        if len(part.report["pad_widths"]):
            self.widths[part.vertex_id[own]] = part.report["pad_widths"]
            self.has_pads = True
        self.seams.append((part.index, part.seam_ids(), part.seam_points()))
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
        levels = max((len(report["iterations"]) for report in reports), default=0)

        def most(name: str) -> Any:
            return max(report[name] for report in reports)

        def by_level(name: str) -> list[Any]:
            return [
                max(report[name][level] for report in reports if level < len(report[name]))
                for level in range(levels)
            ]

        def of_shape(shape: int) -> dict[str, Any]:
            told = [report["shapes"][shape] for report in reports if report["shapes"]]
            return {
                name: all(entry[name] for entry in told)
                if name == "converged"
                else max(entry[name] for entry in told)
                for name in (told[0] if told else ())
            }

        phases = dict.fromkeys(phase for report in reports for phase in report["seconds"])
        pads = [report["pads"] for report in reports if "pads" in report]
        return {
            "iterations": by_level("iterations"),
            "residuals": by_level("residuals"),
            "converged": all(report["converged"] for report in reports),
            "warm": False,
            "shapes": [of_shape(shape) for shape in range(len(self.shapes))],
            "seconds": {
                phase: sum(report["seconds"].get(phase, 0.0) for report in reports)
                for phase in phases
            },
            "predicted_bytes": most("predicted_bytes"),
            "peak_bytes": most("peak_bytes"),
            "largest_deviation": most("largest_deviation"),
            "constraint_rounds": most("constraint_rounds"),
            "constraint_gap": most("constraint_gap"),
            "pads": {
                "gone": sum(pad["gone"] for pad in pads),
                "widths": self.widths.tolist() if self.has_pads else [],
            },
            "normals": {
                "fixed": sum(report["normals"]["fixed"] for report in reports),
                "largest_angle": max(report["normals"]["largest_angle"] for report in reports),
            },
            "threads": most("threads"),
            **self.first["report"],
            "warnings": self.first["report"]["warnings"]
            + [warning for report in reports for warning in report["warnings"]],
            "pieces": {
                "count": self.surface["count"],
                "rings": self.surface["rings"],
                "jump": jumps(self.seams, lambda ids: self.vertices[ids], self.surface["size"]),
                "parts": [
                    {key: value for key, value in report.items() if key != "pad_widths"}
                    for report in reports
                ],
            },
        }
