# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of surfaces: how exact, how calm, by the names under which documents have them."""

from collections.abc import Callable, Sequence
from typing import Any

from results import result, short, table

# Of the tools in `side_by_side`, those whose surface misses the control vertices.
MISSES = ("Catmull-Clark", "Loop", "(exact sphere)")
MEASURES = ("least_radius", "largest_radius", "off", "dihedral", "energy", "triangles", "seconds")
HEADS = ("", "least radius", "largest radius", "off", "dihedral", "E / 8π", "triangles", "seconds")
FOUR = ("E / 8π", "99 %", "99.9 %", "largest")


def measured(figures: dict[str, Any]) -> list[str]:
    """The cells of one tool's surface, in the order of MEASURES."""
    forms = ("{:.5f}", "{:.5f}", "{:.3g}", "{:.2f}", "{:.4f}", "{:,}", "{:.3f}")
    values = [figures[key] for key in MEASURES]
    return ["" if v is None else form.format(v) for form, v in zip(forms, values, strict=True)]


def side_by_side_of(name: str) -> str:
    """The surfaces of all tools over one mesh; bold is the best of those through the vertices."""
    found = result("side_by_side")["meshes"][name]
    rows = {tool: measured(f) for tool, f in found.items() if "absent" not in f}
    ours = [cells for tool, cells in rows.items() if tool not in MISSES]
    best = {
        k: min((cells[k] for cells in ours), key=float)
        for k in (MEASURES.index("dihedral"), MEASURES.index("energy"))
    }
    shown = range(len(MEASURES)) if "(exact sphere)" in found else range(2, len(MEASURES))
    lines = []
    for tool, figures in found.items():
        if tool not in rows:
            lines.append([tool, f"*{figures['absent']}*", *[""] * (len(shown) - 1)])
            continue
        cells = list(rows[tool])
        cells[3] += "°"
        for k, value in best.items():
            if tool not in MISSES and rows[tool][k] == value:
                cells[k] = f"**{cells[k]}**"
        lines.append([tool, *(cells[k] for k in shown)])
    levels = result("side_by_side")["levels"][name]
    heading = f"\n\n### {name[0].upper()}{name[1:]}, {levels} levels"
    return heading + table([HEADS[0], *(HEADS[k + 1] for k in shown)], lines)


def side_by_side() -> str:
    """All meshes, each under a heading."""
    parts = [side_by_side_of(name).strip() for name in result("side_by_side")["meshes"]]
    return "\n\n" + "\n\n".join(parts) + "\n\n"


def four(figures: dict[str, float]) -> str:
    """Total curvature and angles, in one cell."""
    text = " · ".join(f"{figures[key]:.3g}" for key in FOUR)
    return text + (f" ({figures['crossing']:.0f} cross)" if figures.get("crossing") else "")


def beside_subdivision(name: str, ours: Sequence[tuple[str, str]]) -> str:
    """Each cage's four figures, Subdivision Surface's first; how many of ours are smaller."""
    heads = ["cage", "Subdivision Surface"]
    for _, label in ours:
        heads += [label, "smaller"]
    rows = []
    for cage, found in result(name).items():
        theirs = found["Subdivision Surface"]
        if not isinstance(theirs, dict):
            continue
        row = [f"`{cage}`", four(theirs)]
        for key, _ in ours:
            row += [four(found[key]), str(sum(found[key][k] < theirs[k] for k in FOUR))]
        rows.append(row)
    return table(heads, rows)


def jobs_table() -> str:
    """Known panels and hulls: angles to the true normals."""
    tools = {
        "Subdivision Surface": "Subdivision Surface",
        "thin plate, limit": "thin plate, *Limit*",
        "thin plate": "thin plate",
        "total curvature": "total curvature",
        "minimum variation": "minimum variation",
    }
    rows = [
        [job, model, *(f"{found[t]['rms']:.2g} · {found[t]['at corners']:.2g}" for t in tools)]
        for job, models in result("jobs").items()
        for model, found in models.items()
    ]
    return table(["job", "model", *tools.values()], rows)


DRAWN = {
    "minimum variation": "minimum variation",
    "minimum variation, near": "*Near*",
    "thin plate": "thin plate",
    "thin plate, limit": "thin plate, *Limit*",
    "total curvature, limit": "total curvature, *Limit*",
    "minimum variation, limit": "minimum variation, *Limit*",
}


def drawn_table(job: str) -> str:
    """Roughness in that of Subdivision Surface, and how much more than the cage surfaces turn."""
    rows = []
    for model, found in result("drawn")[job].items():
        theirs = found["Subdivision Surface"]
        row = [model, f"{100 * theirs['swing']:.0f} %"]
        for tool in DRAWN:
            ratio = found[tool]["roughness"] / theirs["roughness"]
            row.append(f"{ratio:.2g} · {100 * found[tool]['swing']:.0f} %")
        rows.append(row)
    return table(["model", "Subdivision Surface", *DRAWN.values()], rows)


def machine_parts_table() -> str:
    """Distances from parts that are known."""
    tools = ("Subdivision Surface", "thin_plate", "total_curvature", "minimum_variation")
    rows = [
        [
            part,
            *(
                " · ".join(f"{d:.2g}" if d > 1e-3 else "0" for d in found[tool].values())
                for tool in tools
            ),
        ]
        for part, found in result("machine_parts").items()
    ]
    return table(["part", *(tool.replace("_", " ") for tool in tools)], rows)


def measured_points_table() -> str:
    """How far surfaces are off a dome whose points were measured."""
    tools = ("through", "Subdivision Surface", "near", "eased")
    rows = [
        [*dome.split(" · "), *(f"{found[tool]:.2g}" for tool in tools)]
        for dome, found in result("measured_points").items()
    ]
    names = ("through", "Subdivision Surface", "*Near*, a tenth", "*Points*")
    return table(["height", "turn", "scatter", *names], rows)


PEAKS = {
    "creature": "creature, 3 levels",
    "bob": "Bob, 3 levels",
    "cat's head": "cat's head, 3 levels",
    "hand": "hand, 2 levels",
    "cow": "cow (Spot's dense mesh), 2 levels",
}


def peaks_cell(found: dict[str, Any]) -> str:
    """Median, 95 % and largest, then how many are peaks."""
    return f"{' / '.join(f'{v:.2f}' for v in found['over_mean'])}, {found['peaks'] or 'none'}"


def peaks_table() -> str:
    """Curvature at control vertices over the mean around them."""
    pads, peaks = result("pads"), result("peaks")
    rows = []
    for name, label in PEAKS.items():
        points = {
            "thin_plate": pads["real"][f"{name}, 0.0"],
            "total_curvature": pads["near along normals"][f"{name}, 0.0, 0.0"],
        }
        vertices = peaks[name]["thin_plate"]["vertices"]
        for energy in ("thin_plate", "total_curvature"):
            head = f"{label}, {vertices} vertices" if energy == "thin_plate" else ""
            cells = [peaks_cell(points[energy]), peaks_cell(peaks[name][energy])]
            rows.append([head, energy.replace("_", " "), *cells])
        # it has no loads: pads only make its start
        rows.append(["", "minimum variation", "", peaks_cell(peaks[name]["minimum_variation"])])
    return table(["", "energy", "on point forces", "on pads"], rows)


def fender_table() -> str:
    """Dirichlet energy of the mean curvature on the fender."""
    found = result("pads")
    rows = []
    for energy in ("thin_plate", "total_curvature", "minimum_variation"):
        cells = [found.get(f"fender, {energy}, {size}") for size in ("0.0", "0.5", "1.0")]
        rows.append(
            [energy.replace("_", " "), *(short(c["dirichlet"], 3) if c else "" for c in cells)]
        )
    return table(["", "point forces", "pads of ½", "pads of 1"], rows)


def exact_table() -> str:
    """Spheres and tori that are known, on point forces and on pads."""
    found = result("exact")
    rows = []
    spheres: dict[tuple[str, int], dict[float, list[Any]]] = {}
    for name, level, size, *rest in found["spheres"]:
        spheres.setdefault((name, level), {})[size] = rest
    for (name, level), sizes in spheres.items():
        cells = [f"{sizes[s][1]} of {sizes[s][0]}" for s in (0.0, 1.0)]
        rows.append([f"{name}, level {level}", "spheres met", *cells])
    tori: dict[str, dict[float, list[float]]] = {}
    for name, size, *by_level in found["clifford"]:
        tori.setdefault(name, {})[size] = by_level
    for name, sizes in tori.items():
        cells = [f"{sizes[s][2]:.2e}".replace("e-0", "e-") for s in (0.0, 1.0)]
        rows.append([f"Clifford torus, {name}, level 3", "distance", *cells])
    return table(["known surface", "measure", "point forces", "pads of 1"], rows)


def offsets_table() -> str:
    """Scattered control vertices, eased: errors in thousandths of an edge."""
    rows = []
    for name, found in result("offsets")["shapes"].items():
        errors = (
            found["before"],
            min(found["near"]),
            min(found["tolerance"]),
            min(found["amount"]),
            found["automatic"],
        )
        back = "–" if found["moved_back"] is None else f"{found['moved_back']:.2f}"
        cells = [f"{1e3 * e / found['edge']:.1f}" for e in errors]
        ratio, noise = f"{found['ratio']:.2f}", f"{found['noise']:.2f}"
        rows.append([name, *cells, ratio, noise, str(found["found"]), back])
    return table(
        ["shape, scatter", "as measured", "Near", "within a tolerance", "best amount", "automatic"]
        + ["over best", "scatter read", "found of 20", "back"],
        rows,
    )


def offsets_hulls_table() -> str:
    """Three wrong vertices of half a hull: how many are among the most strained."""
    rows = [
        [name, *(f"{each[k]:.2f}" for k in ("found", "of_six"))]
        + [f"{1e3 * each[k]:.1f}" for k in ("largest", "median")]
        for name, each in result("offsets")["hulls"].items()
    ]
    heads = [
        "stations × lines, scatter in m, border at the keel",
        "of the worst 3",
        "of the worst 6",
    ]
    return table([*heads, "largest strain without scatter, mm", "median, mm"], rows)


def caps_table() -> str:
    """Caps of a sphere on their boundary circle: how far surfaces are off, in shares of the radius."""
    rows = []
    for name, size, *errors in result("exact")["caps"]:
        if size == 0.0:
            continue  # point forces
        mesh, energy = name.split(", ")
        cells = [f"{100 * e:.2g} %" if e > 1e-4 else short(e) for e in errors]
        rows.append([mesh, energy.replace("_", " "), *cells])
    return table(["control mesh", "energy", "cap of 30°", "60°", "90°"], rows)


def near_on_pads_table() -> str:
    """Total curvature with a tolerance of 2 % of an edge, on points and on pads."""
    found = result("pads")["near along normals"]
    heads = ["", "points", "pads", "energy: Through, points, pads", "solves: Through, Near"]
    rows = []
    for name in dict.fromkeys(key.rsplit(", ", 2)[0] for key in found):
        through, points, near = (
            found[f"{name}, {k}"] for k in ("1.0, 0.0", "0.0, 0.02", "1.0, 0.02")
        )
        row = [" / ".join(f"{v:.2f}" for v in f["over_mean"][1:]) for f in (points, near)]
        row.append(", ".join(short(f["energy"], 3) for f in (through, points, near)))
        rows.append([name, *row, f"{through['solves'][-1]}, {near['solves'][-1]}"])
    return table(heads, rows)


def rims_table() -> str:
    """How far rims turn once around, degrees."""
    rows = [
        [name, *(f"{angle:.1f}" for angle in found.values())]
        for name, found in result("rims").items()
    ]
    return table(
        ["model", "Subdivision Surface", "thin plate", "*Character*", "*Follow* at 0"], rows
    )


def step_distances_table() -> str:
    """STEP files as another program evaluates them, from their surfaces."""
    rows = [
        [
            name,
            *(f"{case[k]:,}".replace(",", " ") for k in ("level", "patches", "points")),
            *(f"{case[k]:.1e}" for k in ("median", "99 %", "largest", "own")),
        ]
        for name, case in result("step_distances").items()
    ]
    heads = ["file", "level", "patches", "points", "median", "99 %", "largest"]
    return table([*heads, "the patches' own largest"], rows)


SHAPE: dict[str, Callable[[], str]] = {
    "comparison.tables": side_by_side,
    "subdivision.table": lambda: beside_subdivision(
        "subdivision",
        [("thin plate", "thin plate, near"), ("total curvature", "total curvature, near")],
    ),
    "limits.table": lambda: beside_subdivision(
        "limits",
        [
            ("limit", "thin plate"),
            ("Character", "*Character*"),
            ("limit, total curvature", "total curvature"),
        ],
    ),
    "rims.table": rims_table,
    "step_distances.table": step_distances_table,
    "jobs.table": jobs_table,
    "drawn.panels": lambda: drawn_table("panel"),
    "drawn.hulls": lambda: drawn_table("hull"),
    "machine_parts.table": machine_parts_table,
    "points.table": measured_points_table,
    "peaks.table": peaks_table,
    "pads.fender.table": fender_table,
    "pads.near.table": near_on_pads_table,
    "exact.table": exact_table,
    "exact.caps.table": caps_table,
    "offsets.table": offsets_table,
    "offsets.hulls.table": offsets_hulls_table,
}
