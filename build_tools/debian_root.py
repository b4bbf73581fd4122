# SPDX-License-Identifier: GPL-3.0-or-later
"""A Debian trixie in a folder, for its Blender 4.3 (Python 3.13) and its OpenMesh 11.

Everything mounted for it lives in a mount namespace of its own, so nothing is left to unmount, however
a command ends, and deleting the cache can never reach through a mount into the project.
"""

import shutil
from pathlib import Path

from layout import CACHE, ROOT
from native_wheel import PIP_WHEEL, inputs, local_version, only_wheel
from shell import DevError, as_root, run, say
from stamp import fingerprint, is_fresh, leave
from wheel_version import LOCAL_PART

SUITE = "trixie"
FOLDER = CACHE / f"debian-{SUITE}"
STAMP = CACHE / f"debian-{SUITE}.stamp"
PYTHON_TAG = "cp313"
PACKAGES = ["blender", "python3-numpy"]
PACKAGES += ["g++", "cmake", "ninja-build", "libopenmesh-dev", "libeigen3-dev"]
PACKAGES += ["python3-dev", "python3-pip", "python3-scikit-build-core", "pybind11-dev"]

# one folder that both sides may write
INSIDE = Path("/srv/discrete_fairing")
OUTSIDE = FOLDER / "srv" / "discrete_fairing"

ENTER = ROOT / "build_tools" / "enter_root.sh"


def command(*words: str | Path, **extra: str) -> list[str]:
    """The command line that runs `words` inside, as root, with the project read-only at /project."""
    variables = {"PATH": "/usr/bin:/bin:/usr/sbin:/sbin", "HOME": "/root", "LC_ALL": "C.UTF-8", **extra}
    inner = ["env", "-i", *(f"{name}={value}" for name, value in variables.items()), *map(str, words)]
    return as_root("unshare", "--mount", "sh", ENTER, FOLDER, ROOT, *inner)


def make() -> None:
    """Makes the folder, a minute's work; returns at once when it is there."""
    value = fingerprint([], SUITE, *PACKAGES, str(INSIDE))
    if is_fresh(STAMP, value) and FOLDER.is_dir():
        return
    if shutil.which("mmdebstrap") is None:
        raise DevError("the tests in a real Blender need mmdebstrap: run `dev.py setup` first.")
    say(f"Debian {SUITE} with Blender in {FOLDER.relative_to(ROOT)}")
    STAMP.unlink(missing_ok=True)
    run(*as_root("rm", "-rf", "--one-file-system", FOLDER))
    options = ["--variant=minbase", '--aptopt=APT::Install-Recommends "false"']
    if run(*as_root("mmdebstrap", *options, f"--include={','.join(PACKAGES)}", SUITE, FOLDER), check=False):
        raise DevError(
            f"no Debian {SUITE} could be made, so nothing can be tested in a real Blender: "
            "mmdebstrap needs root, the right to mount, and a reachable Debian archive."
        )
    run(*as_root("mkdir", "-p", FOLDER / "project", OUTSIDE))
    run(*as_root("chmod", "1777", OUTSIDE))
    run(*as_root("ln", "-sf", "/proc/self/mounts", FOLDER / "etc" / "mtab"))  # Blender looks for its disks
    leave(STAMP, value)


def wheel() -> Path:
    """The wheel for the Python inside, built there; returns at once when nothing changed."""
    make()
    folder = OUTSIDE / "wheels"
    stamp = CACHE / f"wheel-{SUITE}.stamp"
    value = fingerprint(inputs(), STAMP.read_text(), local_version())
    if not (is_fresh(stamp, value) and folder.is_dir()):
        say(f"native build for Debian {SUITE}")
        run(*as_root("rm", "-rf", folder))
        places = [f"--config-settings=build-dir={INSIDE}/build", "--wheel-dir", INSIDE / "wheels", "/project"]
        pip = ["python3", "-m", "pip", "--quiet", *PIP_WHEEL, *places]
        run(*command(*pip, **{LOCAL_PART: local_version(), "PYTHONDONTWRITEBYTECODE": "1"}))
        leave(stamp, value)
    return only_wheel(folder)
