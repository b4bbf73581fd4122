# SPDX-License-Identifier: GPL-3.0-or-later
"""What users read: in their words, with units, and refusals that begin with what to do."""

import ast
import re
from pathlib import Path

import bpy
import pytest
from test_tooltips import ours, tooltips

import addon
from addon import errors

ADDON = Path(addon.__file__).parent
# Words of those who make it.
OURS = re.compile(
    r"\b(pads?|needles?|crumpl\w+|energ(?:y|ies)|control vert(?:ex|ices)|point forces?|decrements?|"
    r"residuals?|converge\w*|thin plates?|total curvature energy|minimum variation|multigrid|"
    r"preconditioner|Newton|metric exponent|strain energy)\b",
    re.IGNORECASE,
)
# Where names of Python and of the command line stand.
NOT_SHOWN = {"core.py", "records.py", "measured.py", "report.py"}
OPTIONS = re.compile(r"--[\w-]+|\[[^]]*\]|`[^`]*`")
# What no mesh from Blender brings about: only arrays that a script makes.
OF_SCRIPTS = {"BAD_SHAPE", "INDEX_OUT_OF_RANGE", "BAD_FEATURE_EDGE", "FORKED", "CANCELLED"}
OWN_CURE = {"BAD_OPTION"}  # what to do depends on what it is, and the core says it
ORDERS = {
    *("Add", "Allow", "Change", "Choose", "Close", "Cut", "Delete", "Draw", "Ease", "Even", "Fair"),
    *("Fill", "Fix", "Give", "Go", "Leave", "Link", "Lower", "Make", "Merge", "Move", "Nothing"),
    *("Point", "Press", "Raise", "Recalculate", "Reinstall", "Run", "Select", "Separate", "Set"),
    *("Show", "Smooth", "Switch", "Triangulate", "Turn", "Undo", "Use", "Wait", "Write", "Open"),
}


def shown_strings(tree):
    """(line, text) of the constants in a file that may be read by users: no docstrings, no identifiers."""
    docs = {
        id(node.body[0].value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef)
        and node.body
        and isinstance(node.body[0], ast.Expr)
    }
    for node in ast.walk(tree):
        text = node.value if isinstance(node, ast.Constant) and id(node) not in docs else None
        if isinstance(text, str) and not re.fullmatch(r"[a-z_0-9.]*|[A-Z_0-9.]*", text):
            yield node.lineno, text


def words_of_ours(text):
    return OURS.findall(OPTIONS.sub("", text))


def sources():
    return sorted(path for path in ADDON.rglob("*.py") if path.name not in NOT_SHOWN)


def test_no_text_has_words_of_ours():
    found = {
        f"{path.relative_to(ADDON)}:{line}": text
        for path in sources()
        for line, text in shown_strings(ast.parse(path.read_text("utf-8")))
        if words_of_ours(text)
    }
    assert found == {}


def test_no_tooltip_has_words_of_ours():
    assert {where: text for where, text in tooltips() if words_of_ours(text)} == {}


@pytest.mark.parametrize("text", ["Draws needles", "Compare Energies", "The loads on pads"])
def test_a_word_of_ours_is_seen(text):
    assert words_of_ours(text)


def test_what_python_calls_it_is_let_through():
    assert not words_of_ours("--energy is for fairing") and not words_of_ours("Hold Softly")


def numbers():
    """(where, keywords) of every number in the interface."""
    for owner in {*ours(bpy.types.Operator), *ours(bpy.types.PropertyGroup)}:
        for base in owner.__mro__:
            for name, declared in vars(base).get("__annotations__", {}).items():
                keywords = getattr(declared, "keywords", {})
                kind = getattr(getattr(declared, "function", None), "__name__", "")
                if kind == "FloatProperty" and "HIDDEN" not in keywords.get("options", ()):
                    yield f"{owner.__name__}.{name}", keywords


def is_a_length(keywords):
    words = f"{keywords['name']} {keywords.get('description', '')}".lower()
    return bool(re.search(r"\bin scene units\b|\bdistances?\b|\bhow far\b|\blengths?\b", words))


def test_every_length_and_share_has_its_unit():
    """A length in scene units, a share as a slider, an angle in degrees; or the name says in what."""
    without = {
        where: keywords["name"]
        for where, keywords in numbers()
        if not keywords.get("subtype") and not keywords.get("unit") and is_a_length(keywords)
        if "(" not in keywords["name"]
    }
    assert without == {}


def codes():
    """Those of the core's errors, as its source spells them."""
    text = (ADDON.parent / "native" / "base" / "error.cpp").read_text("utf-8")
    return re.findall(r'case ErrorCode::\w+: return "(\w+)";', text)


def begins_with_an_order(text):
    """After the name of an object."""
    return re.sub(r"^(\{[^}]*\}|--\w+): ", "", text).split(" ")[0].strip(":,") in ORDERS


def test_every_refusal_of_the_core_begins_with_what_to_do():
    assert len(codes()) > 20
    for code in {*codes(), *errors.REMEDIES} - OF_SCRIPTS - OWN_CURE:
        for remedies in (errors.REMEDIES, errors.WITHOUT_MENDING, errors.OF_HOLES):
            assert begins_with_an_order(remedies[code]), (code, remedies[code])


def test_every_cause_of_an_unfinished_surface_has_words():
    """In Blender and in the reference, by its code."""
    source = (ADDON.parent / "native" / "fairing" / "warnings.cpp").read_text("utf-8")
    page = (ADDON.parent / "docs" / "reference" / "errors.md").read_text("utf-8")
    causes = set(re.findall(r'"(NOT_CONVERGED\w*)"', source))
    assert len(causes) == 6
    told = {}
    for code in causes:
        warning = {"code": code, "message": "What the core says."}
        assert errors.is_unfinished(warning) and f"| `{code}` | none |" in page
        told[code] = errors.warning_text("Box", warning)
        assert begins_with_an_order(told[code].removeprefix("Box: ")), told[code]
    assert len(set(told.values())) == 6
    other = {"code": "ISOLATED_VERTICES", "message": "1 vertex (3) belongs to no face."}
    assert not errors.is_unfinished(other)
    assert errors.warning_text("Box", other) == "Box: 1 vertex (3) belongs to no face."


def test_what_to_do_stands_before_what_is_wrong():
    class Refusal(Exception):
        code = "UNDERDETERMINED"

    text = errors.error_text("Box", Refusal("Nothing holds vertex 3. Give it a weight."))
    assert text == "Box: Set Vertices to Through, or a smaller tolerance. Nothing holds vertex 3."
    Refusal.code = "BAD_OPTION"
    text = errors.error_text("Box", Refusal("1 vertex (3) is to look away. Free its normal."))
    assert text == "Box: Free its normal. 1 vertex (3) is to look away."


def first_words(node):
    """The text with which an expression of Python's begins; of a value, its source in braces."""
    if isinstance(node, ast.Constant):
        return str(node.value)
    if isinstance(node, ast.JoinedStr):
        return "".join(
            part.value if isinstance(part, ast.Constant) else f"{{{ast.unparse(part.value)}}}"
            for part in node.values
        )
    return ""


def refusals(tree):
    """(line, text) of what operators refuse with, and of why buttons are grey."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            if name.endswith("JobError") and node.args:
                yield node.lineno, first_words(node.args[0])
            elif name == "self.report" and "ERROR" in ast.unparse(node.args[0]):
                yield node.lineno, first_words(node.args[1])
        elif isinstance(node, ast.FunctionDef) and re.search(
            "poll_reason|_reason$|why_outdated|_none_text|why_too", node.name
        ):
            for inner in ast.walk(node):
                if isinstance(inner, ast.Return) and inner.value is not None:
                    yield inner.lineno, first_words(inner.value)


def test_every_refusal_begins_with_what_to_do():
    found = {
        f"{path.relative_to(ADDON)}:{line}": text
        for path in sources()
        for line, text in refusals(ast.parse(path.read_text("utf-8")))
        if re.search("[a-z]{3}", re.sub(r"\{[^}]*\}", "", text)) and not begins_with_an_order(text)
    }
    assert found == {}


def test_a_refusal_that_begins_with_the_cause_is_seen():
    assert not begins_with_an_order("{self.name}: a part is selected whole")
    assert begins_with_an_order("{self.name}: Leave out some faces")
