# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line on file names that are not plain English, and on consoles with ASCII alone."""

import os
from pathlib import Path

import pytest
from cli_files import materials_of, read_obj, write_obj
from cli_runs import contains, process, run

NAMES = ["two words", "Körper", "Ko\u0308rper", "部品", "☃ 🙂", "in.dots.name", "100%"]
NOT_UTF_8 = os.fsdecode(b"not \xff utf-8")  # as old archives bring them along


@pytest.mark.parametrize("name", [*NAMES, NOT_UTF_8], ids=ascii)
def test_a_name_goes_in_and_out(name):
    points = write_obj(f"{name}.obj", materials=("red",))
    made = Path("new folder", "ü", f"{name}.obj")
    assert run(f"{name}.obj", made, "--levels", 1) == 0
    assert contains(read_obj(made), points, 1e-6)
    assert materials_of(made).is_file()


def test_a_console_that_knows_ascii_only_gets_signs_in_their_place():
    write_obj("Körper.obj")
    code, _, error = process("Körper.obj", "out.obj", PYTHONIOENCODING="ascii")
    assert (code, Path("out.obj").exists()) == (0, True), error
    assert "K\\xf6rper.obj" in error
