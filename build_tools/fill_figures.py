# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures of filled holes, by the names under which documents have them."""

from collections.abc import Callable

from results import result, short, table


def lengths_table() -> str:
    """Seconds of the processor against the length of a ragged loop."""
    heads = ["edges", "triangles between them alone", "all of it", "new faces", "folds"]
    rows = [
        [
            f"{int(edges):,}",
            f"{short(entry['triangulated'])} s",
            f"{short(entry['filled'])} s",
            f"{entry['faces']:,}",
            str(entry["folds"]),
        ]
        for edges, entry in result("fill_lengths").items()
    ]
    return table(heads, rows)


# as the documents call the shapes and tools of `fills`
SHAPES = {
    "half sphere": "half sphere",
    "60° cap": "cap of 60°",
    "cylinder side": "side of a cylinder",
    "torus, bite": "torus, a bite",
    "saddle": "saddle",
    "paraboloid": "paraboloid",
    "cylinder, 220°": "cylinder, 220° around",
}
TOOLS = {
    "total curvature": "total curvature",
    "thin plate": "thin plate",
    "minimum variation": "minimum variation",
    "CGAL, C1": "CGAL, C1",
    "CGAL, C2": "CGAL, C2",
    "MeshLib": "MeshLib",
    "PyMeshLab": "PyMeshLab",
    "Blender, Fill": "Blender, Fill",
    "Blender, Grid Fill": "Grid Fill",
}


def least_marked(values: list[str]) -> list[str]:
    """Numbers of one row, the least of them in bold."""
    least = min(map(float, values))
    return [f"**{value}**" if float(value) == least else value for value in values]


def distances_table() -> str:
    """How far fillings are from the surface that was cut, in thousandths of the hole's diameter."""
    rows = []
    for shape, name in SHAPES.items():
        found = result("fills")["shapes"][shape]
        off = [short(1000 * found[tool]["off"]) for tool in TOOLS]
        before = short(1000 * found["as it was"]["off"])
        rows.append([name, str(found["edges"]), before, *least_marked(off)])
    return table(["hole", "edges", "as it was", *TOOLS.values()], rows)


def rims_table() -> str:
    """The largest angle across the rim, in those of the mesh."""
    shapes = result("fills")["shapes"]
    rows = [
        [name, *least_marked([short(shapes[shape][tool]["rim"], 3) for tool in TOOLS])]
        for shape, name in SHAPES.items()
    ]
    return table(["hole", *TOOLS.values()], rows)


def seconds_table() -> str:
    """Seconds of the processor against the length of a round rim."""
    found = result("fills")["seconds"]
    tools = [TOOLS[tool] for tool in next(iter(found.values()))]
    rows = [
        [edges, *(short(each["seconds"]) for each in entry.values())]
        for edges, entry in found.items()
    ]
    return table(["edges", *tools], rows)


FILL: dict[str, Callable[[], str]] = {
    "fill.lengths.table": lengths_table,
    "fills.distances.table": distances_table,
    "fills.rims.table": rims_table,
    "fills.seconds.table": seconds_table,
}
