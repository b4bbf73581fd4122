# SPDX-License-Identifier: GPL-3.0-or-later
"""The core's tuning constants: how many there are, and that they are explained.

A tuning constant is a number that somebody chose: a threshold, a gain, a tolerance, a limit. Counted are
`constexpr` numbers, each name of a list by itself, and numbers that stand bare in the code where neither arithmetic
nor geometry gives them: fractions other than eighths, and whole numbers from ten on that something is compared
with. Settings have pages of their own, and are left out; so are FACTS and numbers of ten digits, which are
coefficients. Reads the text of native/ only, so nothing has to be built."""

import re
from collections import Counter
from functools import cache
from pathlib import Path
from typing import NamedTuple

NATIVE = Path(__file__).resolve().parents[2] / "native"

# What there is today. Lower these with every constant that goes or is explained.
MOST = 184

SETTINGS = {
    "fairing/options.h",
    "fairing/settings.h",
    "multigrid/solve_options.h",
    "paper/options.h",
}  # defaults, described in docs/reference

# Names of what is exact, or laid down: by mathematics, by a format, by what another number is.
FACTS = """
    ahead behind here midpoint_share centre_share half middle turn
    degree full_turn root_half half_root_half tangent_of_eighth ten_a_decade
    undetermined_square thinnest_ring_square
    too_long too_short deviation_over_median in_a_row always_sharp largest_mesh
    avx both_halves system_saves most one_call one_end one_first page megabyte
    vector_bytes float_vector_bytes index_bytes
    least_mass_eigenvalue largest_mass_eigenvalue change_left_by_level share_of_coarser
    boundary_modes angles_an_edge corner_of directions order triangle
    lane_block lane_count local_stride most_slots stride sums vector_room
    in_plane none several centripetal width bytes_a_point bytes_a_cell vectors
    higher_terms terms_beyond
"""

NUMBER_TYPE = r"(?:double|float|int|u?int(?:\d+|ptr)_t|size_t|Index|chrono::\w+)"
DECLARATION = re.compile(
    rf"\bconstexpr\s+(?:std::|Eigen::)?{NUMBER_TYPE}\s+(?P<list>[^;{{}}]*(?:\{{[^;]*\}}[^;{{}}]*)?);"
)
NAMED = re.compile(r"\s*(\w+)(?:\[[^\]]*\])*\s*(?:=|\()\s*(.*)", re.DOTALL)
NUMBER = re.compile(r"(?<![\w.])(?:\d[\d']*\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?:f|u|ull)?\b")
RANGE = re.compile(r"\b(?:in_range|refuse)\(")
COMPARED = re.compile(r"(?<![<>-])(?:[<>]=?|==)\s*(\d[\d']*)(?![\w.'])")


class Constant(NamedTuple):
    room: str
    place: str  # file:line
    name: str  # empty: a bare number
    value: str
    explained: bool  # a comment stands on its line or on the one before


def code_of(line: str) -> str:
    """Without strings, comments, what the preprocessor reads, and ranges of settings."""
    if line.lstrip().startswith("#") or RANGE.search(line):
        return ""
    return re.sub(r'"(?:\\.|[^"\\])*"', '""', line).split("//")[0]


def parts(text: str) -> list[str]:
    """What commas outside of brackets separate."""
    found, depth, begin = [], 0, 0
    for i, c in enumerate(text):
        depth += (c in "({[") - (c in ")}]")
        if c == "," and depth == 0:
            found.append(text[begin:i])
            begin = i + 1
    return [*found, text[begin:]]


def is_chosen(number: str) -> bool:
    """Whether a bare number is neither whole, nor an eighth, nor a coefficient."""
    number = number.rstrip("fu").replace("'", "")
    digits = re.sub(r"\D", "", re.split("[eE]", number)[0])
    return (
        re.search(r"[.eE]", number) is not None
        and len(digits) < 10
        and not (8 * float(number)).is_integer()
    )


def constants_of(file: str, source: str) -> list[Constant]:
    found = []
    lines = source.splitlines()
    text = "\n".join(map(code_of, lines))

    def add(match: re.Match[str], name: str, value: str) -> None:
        first, last = (text.count("\n", 0, at) for at in match.span())
        explained = any("//" in line for line in lines[max(first - 1, 0) : last + 1])
        found.append(Constant(file.split("/")[0], f"{file}:{first + 1}", name, value, explained))

    for match in DECLARATION.finditer(text):
        for named in filter(None, map(NAMED.match, parts(match["list"]))):
            if named[1] not in FACTS.split() and NUMBER.search(named[2]):
                add(match, named[1], " ".join(named[2].split()).rstrip(")"))
    rest = DECLARATION.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    for match in NUMBER.finditer(rest):
        if is_chosen(match[0]):
            add(match, "", match[0])
    for match in COMPARED.finditer(rest):
        if int(match[1].replace("'", "")) >= 10:
            add(match, "", match[1])
    return found


@cache
def constants() -> list[Constant]:
    paths = sorted(path for path in NATIVE.rglob("*") if path.suffix in {".h", ".cpp"})
    files = {path.relative_to(NATIVE).as_posix(): path for path in paths}
    return [
        constant
        for file, path in files.items()
        if file not in SETTINGS
        for constant in constants_of(file, path.read_text("utf-8"))
    ]


def test_there_are_no_more_than_there_were():
    rooms = Counter(constant.room for constant in constants())
    assert rooms.total() <= MOST, f"{rooms.total()} tuning constants, by rooms: {dict(rooms)}"


def test_they_are_explained():
    bare = [f"{c.place} {c.name}" for c in constants() if c.name and not c.explained]
    assert bare == []


def test_it_finds_what_it_should():
    found = constants_of(
        "room/some.cpp",
        "// Of the length.\n"
        "constexpr double least = 1e-9, full_turn = 6.28;\n"
        'const char* text = "0.37"; double x = 0.37 * 0.125 + 0.33333333333; // 0.99\n'
        "\n"
        "constexpr int table[2] = {4,\n"
        "                          5};\n"
        "if (x > 12 || i << 20 || y->z < 3) return;\n",
    )
    assert [(c.name, c.value, c.explained) for c in found] == [
        ("least", "1e-9", True),
        ("table", "{4, 5}", False),
        ("", "0.37", True),
        ("", "12", False),
    ]
