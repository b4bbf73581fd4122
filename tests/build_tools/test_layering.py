# SPDX-License-Identifier: GPL-3.0-or-later
"""The rooms of the core stand in one order: a file includes its own room and those before it.

Reads the text of native/ only, so nothing has to be built.
"""

import re
from pathlib import Path

import pytest

NATIVE = Path(__file__).resolve().parents[2] / "native"

# From the ground up. Rooms on one line do not know each other.
ROOMS = (
    ("base",),
    ("parallel",),
    ("mesh",),
    ("grid",),
    ("stencil", "splines"),
    ("curves", "hold"),
    ("sparse",),
    ("transfer",),
    ("multigrid",),
    ("thin_plate", "curvature"),
    ("strain", "paper"),
    ("fairing",),
    ("binding",),
)
FLOOR = {room: floor for floor, rooms in enumerate(ROOMS) for room in rooms}
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def sources(*rooms):
    return sorted(
        path
        for room in rooms
        for path in (NATIVE / room).rglob("*")
        if path.suffix in {".h", ".cpp"}
    )


def includes(path):
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def may_include(room, other):
    return room == other or FLOOR[other] < FLOOR[room]


def test_every_folder_is_a_room():
    assert {path.relative_to(NATIVE).parts[0] for path in NATIVE.glob("*/**/*.cpp")} == set(FLOOR)


@pytest.mark.parametrize("room", FLOOR)
def test_room_includes_only_rooms_before_it(room):
    assert sources(room), f"native/{room} has no sources"
    wrong = []
    for path in sources(room):
        for name in includes(path):
            other = name.split("/")[0]
            assert (NATIVE / name).is_file(), f"{path.name} includes {name}: no file in native/"
            if not may_include(room, other):
                wrong.append(f"native/{path.relative_to(NATIVE)} includes {name}")
    assert not wrong, (
        f"{room}/ may include only {', '.join(r for r in FLOOR if may_include(room, r))}:\n"
        + "\n".join(wrong)
    )


def test_mesh_does_not_need_its_checks():
    """validate/ is the gate to mesh/, and not a part that its tables are made with."""
    wrong = [
        path.name
        for path in (NATIVE / "mesh").glob("*.*")
        for name in includes(path)
        if name.startswith("mesh/validate/")
    ]
    assert not wrong, f"mesh/ includes mesh/validate/ in {', '.join(wrong)}"


def test_headers_form_no_circle():
    headers = {str(p.relative_to(NATIVE)): includes(p) for p in sources(*FLOOR) if p.suffix == ".h"}
    done = set()

    def visit(name, path):
        assert name not in path, "headers include each other: " + " -> ".join((*path, name))
        if name not in done:
            for other in headers[name]:
                visit(other, (*path, name))
            done.add(name)

    for name in headers:
        visit(name, ())


def uses():
    """The rooms that each room includes."""
    found = {room: set() for room in FLOOR}
    for room in FLOOR:
        for path in sources(room):
            found[room] |= {name.split("/")[0] for name in includes(path)} - {room}
    return found


def without_shortcuts(graph):
    """The arrows (used, user) that no longer way stands for."""

    def below(room):
        return set().union(graph[room], *map(below, graph[room]))

    return {
        (other, room)
        for room in graph
        for other in graph[room]
        if not any(other in below(third) for third in graph[room])
    }


def drawn(text):
    """The arrows of the first picture in a document."""
    picture = re.search(r"```mermaid\n(.*?)```", text, re.DOTALL).group(1)
    chains = [
        re.split(r"\s*-->\s*", line.strip()) for line in picture.splitlines() if "-->" in line
    ]
    return {arrow for chain in chains for arrow in zip(chain, chain[1:])}


def test_the_picture_of_the_architecture_is_true():
    assert drawn(page()) == without_shortcuts(uses())


def page():
    return (NATIVE.parent / "docs" / "architecture.md").read_text("utf-8")


def test_files_that_the_architecture_names_are_there():
    root = NATIVE.parent
    folders = ("native", "addon", "tests", "build_tools", "examples", "benchmarks", "cmake")
    paths = [f"/{path.relative_to(root)}" for top in folders for path in (root / top).rglob("*.*")]
    named = set(re.findall(r"`([\w./]+\.(?:h|cpp|py|cmake))`", page()))
    assert len(named) > 50
    assert sorted(n for n in named if not any(p.endswith(f"/{n}") for p in paths)) == []


@pytest.mark.parametrize(
    ("heading", "folder"),
    [
        ("### The steps of total curvature", "native/curvature"),
        ("A live surface, in the order of an edit's way", "addon/live"),
    ],
)
def test_a_walk_passes_every_file_of_its_room(heading, folder):
    table = page().split(heading)[1].split("\n\n|")[1].split("\n\n")[0]
    cells = [row.split("|")[0] for row in table.replace("\n|", "\n").splitlines()[2:]]
    walked = [name.split(".")[0] for cell in cells for name in re.findall(r"`([\w.]+)`", cell)]
    files = {
        p.stem for p in (NATIVE.parent / folder).iterdir() if p.suffix in {".h", ".cpp", ".py"}
    }
    assert sorted(walked) == sorted(files - {"options", "__init__"})
