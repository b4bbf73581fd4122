# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line closes holes, and makes closed surfaces of scans."""

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from cli_files import read_obj
from cli_runs import entries, run

from addon.cli.files import read_file


def write_ball(name, open_above=0.7, sides=24, rings=12):
    """A sphere of quads around its waist and triangles at its poles, open above."""
    lines, at = ["o Ball"], {}
    for r in range(1, rings):
        height, radius = np.cos(np.pi * r / rings), np.sin(np.pi * r / rings)
        for s in range(sides):
            at[r, s] = len(at) + 1
            angle = 2 * np.pi * s / sides
            lines.append(
                f"v {radius * np.cos(angle):.6f} {radius * np.sin(angle):.6f} {height:.6f}"
            )
    lines.append("v 0 0 -1")
    for r in range(1, rings - 1):
        for s in range(sides):
            if np.cos(np.pi * r / rings) < open_above:
                t = (s + 1) % sides
                lines.append(f"f {at[r, s]} {at[r + 1, s]} {at[r + 1, t]} {at[r, t]}")
    last = rings - 1
    lines += [f"f {at[last, s]} {len(at) + 1} {at[last, (s + 1) % sides]}" for s in range(sides)]
    Path(name).write_text("\n".join(lines) + "\n")


def open_edges(path):
    uses = Counter(
        tuple(sorted(edge))
        for item in read_file(Path(path))
        for face in item.data.polygons
        for edge in face.edge_keys
    )
    return sum(count == 1 for count in uses.values())


def test_a_hole_is_closed_and_the_rest_stays():
    write_ball("in.obj")
    code, (entry,) = entries("in.obj", "out.obj", "--fill")
    assert (code, entry["status"], entry["warnings"]) == (0, "done", [])
    (item,) = entry["objects"]
    (hole,) = item["report"]["holes"]
    assert hole["edges"] == [24] and hole["converged"] and not hole["folds"] + hole["crossings"]
    assert hole["faces"] == item["result"]["faces"] - item["control"]["faces"]
    before, after = read_obj("in.obj"), read_obj("out.obj")
    used = before[np.isin(np.round(before, 5), np.round(after, 5)).all(axis=1)]
    assert len(used) and np.abs(np.linalg.norm(after, axis=1) - 1).max() < 2e-3
    assert open_edges("out.obj") == 0


def test_larger_holes_stay_open_and_that_is_no_failure():
    write_ball("in.obj")
    code, (entry,) = entries("in.obj", "out.ply", "--fill", "--largest-hole", 0.5)
    assert (code, entry["objects"][0]["report"]) == (0, {"holes": []})
    assert open_edges("out.ply") == 24


def test_quads_are_heard_and_their_lack_is_warned_of():
    """Open above, and without one quad and one triangle."""
    write_ball("in.obj")
    lines = Path("in.obj").read_text().splitlines()
    quads = [k for k, line in enumerate(lines) if line.startswith("f ") and line.count(" ") == 4]
    del lines[-1], lines[quads[50]]
    Path("in.obj").write_text("\n".join(lines) + "\n")
    _, (entry,) = entries("in.obj", "out.obj", "--fill", "--fill-quads")
    assert entry["settings"]["fill_quads"] is True
    holes = entry["objects"][0]["report"]["holes"]
    assert sorted((h["edges"], h["faces"]) for h in holes) == [([3], 1), ([4], 1), ([24], 36)]
    assert [bool(h["why_triangles"]) for h in holes] == [h["edges"] == [3] for h in holes]
    (warning,) = entry["warnings"]
    assert warning.endswith("1 hole filled with triangles: its rim has 3 edges, which is odd.")


def write_scan(name):
    """A ball with a hole, and a speck far away."""
    write_ball(name, open_above=0.9)
    lines = Path(name).read_text().splitlines()
    count = sum(line.startswith("v ") for line in lines)
    speck = ["v 3 3 0", "v 3.1 3 0", "v 3 3.1 0", f"f {count + 1} {count + 2} {count + 3}"]
    Path(name).write_text("\n".join(lines + speck) + "\n")


def test_a_scan_is_closed():
    write_scan("in.obj")
    code, (entry,) = entries("in.obj", "out.obj", "--clean")
    (item,) = entry["objects"]
    told = item["report"]
    assert code == 0 and entry["warnings"] == []
    assert open_edges("out.obj") == 0
    assert np.abs(np.linalg.norm(read_obj("out.obj"), axis=1) - 1).max() < 0.06
    assert {act["step"] for act in told["done"]} >= {"islands", "fill"}
    assert (told["watertight"], told["left"]) == (True, [])
    assert told["volume"] == pytest.approx(4.05, abs=0.1)
    # plain numbers: nobody knows what the file means by 1
    assert told["said"][-1] == f"Watertight: yes; volume {told['volume']:.3g}; left: nothing"


def test_what_is_left_is_warned_of_and_is_no_failure(capsys):
    write_scan("in.obj")
    words = ("--clean-without", "fill", "--clean-islands", 0)
    code, (entry,) = entries("in.obj", "out.obj", "--clean", *words)
    told = entry["objects"][0]["report"]
    assert code == 0 and entry["status"] == "done"
    assert (told["watertight"], told["volume"]) == (False, None)
    assert told["left"] == [{"code": "OPEN_HOLE", "count": 27}]
    (warning,) = entry["warnings"]
    assert warning == "Ball: Watertight: no; left: 27 edges are at holes."
    assert open_edges("out.obj") == 27
    assert run("in.obj", "again.obj", "--clean", "--largest-hole", 0.5) == 0
    assert "left: 24 edges are at holes" in capsys.readouterr().err
    assert open_edges("again.obj") == 24
