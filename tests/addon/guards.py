# SPDX-License-Identifier: GPL-3.0-or-later
"""What a source file may not do, found in its syntax tree: what the extension can reach."""

import ast
import sys
from pathlib import Path

ADDON = Path(__file__).resolve().parents[2] / "addon"

# Run code from text, load code from data, start programs, reach the network, go around Python.
FORBIDDEN_MODULES = frozenset(
    [
        "asyncio",
        "ctypes",
        "cffi",
        "code",
        "codeop",
        "dill",
        "ftplib",
        "http",
        "imaplib",
        "importlib",
        "joblib",
        "marshal",
        "multiprocessing",
        "pickle",
        "poplib",
        "pty",
        "requests",
        "runpy",
        "shelve",
        "smtplib",
        "socket",
        "socketserver",
        "ssl",
        "subprocess",
        "telnetlib",
        "urllib",
        "webbrowser",
        "xmlrpc",
    ]
)
PROCESS_MODULES = frozenset(["multiprocessing", "subprocess"])
FORBIDDEN_CALLS = frozenset(["eval", "exec", "compile", "__import__", "breakpoint", "input"])
FORBIDDEN_OF_OS = frozenset(
    ["system", "popen", "fork", "forkpty", "kill", "startfile", "putenv"]
)  # and exec…, spawn…

# Ask for or change files.
FILE_MODULES = frozenset(
    ["glob", "io", "pathlib", "shutil", "tempfile", "zipfile", "tarfile", "sqlite3", "os"]
)
FILE_METHODS = frozenset(
    [
        "open",
        "read_text",
        "write_text",
        "read_bytes",
        "write_bytes",
        "unlink",
        "rmdir",
        "rename",
        "mkdir",
        "makedirs",
        "touch",
        "symlink_to",
        "hardlink_to",
        "rmtree",
        "tofile",
        "fromfile",
        "savetxt",
        "loadtxt",
        "genfromtxt",
        "memmap",
        "save",
        "load",
        "savez",
    ]
)

BLENDER = frozenset(
    [
        "bpy",
        "bpy_extras",
        "bmesh",
        "mathutils",
        "gpu",
        "gpu_extras",
        "bl_ui",
        "bl_operators",
        "bl_math",
        "blf",
    ]
)


def faults(source, allow_files=False, allow_processes=False):
    """What is wrong with a file's text, a sentence each."""
    found = []
    forbidden = FORBIDDEN_MODULES - (PROCESS_MODULES if allow_processes else set())
    for node in ast.walk(ast.parse(source)):
        for name in _modules(node):
            if name in forbidden:
                found.append(f"line {node.lineno}: imports {name}")
            elif name in FILE_MODULES and not allow_files:
                found.append(f"line {node.lineno}: imports {name}, which reaches files")
        if isinstance(node, ast.Name | ast.Attribute):
            found += _faults_of_name(node)
        if isinstance(node, ast.Call) and not allow_files and _touches_files(node.func):
            found.append(f"line {node.lineno}: calls {ast.unparse(node.func)}, which reaches files")
    return found


def outside_imports(source):
    """Top names of all absolute imports, also of those within functions."""
    return {name for node in ast.walk(ast.parse(source)) for name in _modules(node)}


def own_imports(source, module):
    """Modules of the add-on that the file of `module`, itself as the parts of its name, imports; as
    parts too.

    `from . import x` names a module x. `from .x import y` names x, but a module y where x is a
    folder. What is imported for annotations alone, below `if TYPE_CHECKING`, does not count.
    """
    tree = ast.parse(source)
    unseen = {id(node) for block in _for_types(tree) for node in ast.walk(block)}
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level and id(node) not in unseen:
            above = module[: len(module) - node.level]
            target = (*above, *(node.module or "").split(".")) if node.module else above
            is_folder = not node.module or ADDON.joinpath(*target).is_dir()
            found |= {(*target, alias.name) for alias in node.names} if is_folder else {target}
    return found


def _for_types(tree):
    """What is read by type checkers only."""
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            yield from node.body


def is_allowed_outside(name):
    """Python's own, NumPy and Blender's; the core and the add-on itself are not."""
    return name in sys.stdlib_module_names or name in BLENDER or name == "numpy"


def _modules(node):
    if isinstance(node, ast.Import):
        return [alias.name.partition(".")[0] for alias in node.names]
    if isinstance(node, ast.ImportFrom) and node.level == 0:
        return [node.module.partition(".")[0]]
    return []


def _faults_of_name(node):
    """Names count wherever they stand: `run = eval` is as good as a call."""
    if isinstance(node, ast.Name):
        bad = node.id in FORBIDDEN_CALLS or node.id == "__builtins__"
    else:
        owner = node.value.id if isinstance(node.value, ast.Name) else ""
        of_os = owner == "os" and (
            node.attr in FORBIDDEN_OF_OS or node.attr.startswith(("exec", "spawn", "posix_spawn"))
        )
        bad = of_os or (owner == "builtins" and node.attr in FORBIDDEN_CALLS)
    return [f"line {node.lineno}: uses {ast.unparse(node)}"] if bad else []


def _touches_files(function):
    if isinstance(function, ast.Name):
        return function.id == "open"
    return isinstance(function, ast.Attribute) and function.attr in FILE_METHODS
