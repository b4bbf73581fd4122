# SPDX-License-Identifier: GPL-3.0-or-later
"""Allocations of the native module fail one after another: each call gives an error in words, and the process goes
on. It is a process of its own, with an operator new of this test."""

import shutil
import subprocess
import sys
from pathlib import Path

import discrete_fairing
import pytest

OPERATOR_NEW = """
#include <atomic>
#include <cstdlib>
#include <new>

static std::atomic<long> counted{0}, failing{0};

extern "C" void fail_at(long number) { counted = 0, failing = number; }
extern "C" long count_taken() { return counted; }

void* operator new(std::size_t size) {
  if (failing > 0 && ++counted == failing) throw std::bad_alloc();
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
"""
EVERY_ALLOCATION = """
import ctypes
import os

import control_meshes as meshes
import discrete_fairing as df
from discrete_fairing import _native

memory = ctypes.CDLL(None)
memory.fail_at.argtypes, memory.count_taken.restype = [ctypes.c_long], ctypes.c_long
vertices, faces = meshes.tetrahedron()


def ends(call, number):
    memory.fail_at(number)
    try:
        call()
        return 0
    except MemoryError:
        return 0
    except df.FairingError as error:
        return int(error.code != "OUT_OF_MEMORY")
    except BaseException:
        return 2
    finally:
        memory.fail_at(0)


for call in (df.Monitor, _native.Options, lambda: df.Solver(vertices, faces, 0, threads=1)):
    call()  # what is made once is there
    memory.fail_at(2**62)
    call()
    count = memory.count_taken()
    memory.fail_at(0)
    assert count > 0
    codes = set()
    for number in range(1, count + 1):
        child = os.fork()
        if child == 0:
            os._exit(ends(call, number))
        codes.add(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    print(sorted(codes))
"""


@pytest.mark.skipif(sys.platform != "linux", reason="operator new is replaced as Linux does")
@pytest.mark.skipif(shutil.which("c++") is None, reason="there is no compiler")
def test_a_constructor_without_memory_raises(tmp_path):
    source, library = tmp_path / "operator_new.cpp", tmp_path / "operator_new.so"
    source.write_text(OPERATOR_NEW)
    subprocess.run(["c++", "-shared", "-fPIC", "-o", library, source], check=True)
    paths = [str(Path(__file__).parent), str(Path(discrete_fairing.__file__).parents[1])]
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path[:0] = {paths!r}\n" + EVERY_ALLOCATION],
        capture_output=True,
        text=True,
        timeout=300,
        env={"LD_PRELOAD": str(library)},
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.split("\n")[:-1] == ["[0]"] * 3
