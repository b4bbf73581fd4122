# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the sources: format by clang-format and ruff, types by mypy, imports by import-linter."""

from pathlib import Path

from layout import CACHE, ROOT
from shell import run
from stamp import files_under

CPP_FOLDERS = ["native", "tests/native", "benchmarks"]
PYTHON_FOLDERS = ["addon", "benchmarks", "build_tools", "examples", "native", "tests"]


def cpp_files() -> list[Path]:
    """All C++ sources, as paths from the project's root."""
    files = files_under(*(ROOT / folder for folder in CPP_FOLDERS))
    return [path.relative_to(ROOT) for path in files if path.suffix in (".h", ".cpp")]


def checks() -> dict[str, list]:
    """The command of each check, by the check's name."""
    return {
        "clang-format": ["clang-format", "--dry-run", "--Werror", *cpp_files()],
        "ruff check": ["ruff", "check", *PYTHON_FOLDERS],
        "ruff format": ["ruff", "format", "--check", *PYTHON_FOLDERS],
        "mypy": ["mypy"],
        "imports": [
            *("env", f"PYTHONPATH={ROOT / 'native' / 'binding'}"),
            *("lint-imports", "--cache-dir", CACHE / "import-linter"),
        ],
    }


def rewrite() -> int:
    """Formats all sources; ruff names what it cannot correct."""
    run("clang-format", "-i", *cpp_files())
    run("ruff", "format", *PYTHON_FOLDERS)
    return run("ruff", "check", "--fix", *PYTHON_FOLDERS, check=False)
