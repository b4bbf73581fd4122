# SPDX-License-Identifier: GPL-3.0-or-later
"""The platforms and Pythons that wheels are cross-compiled for."""

from dataclasses import dataclass

# of Blender 4.3 to 5.0, and of 5.1 and newer
PYTHONS = ("cp311", "cp313")


@dataclass(frozen=True)
class Target:
    """One platform, with its name in each tool."""

    name: str  # Blender's name
    zig: str  # includes the oldest system
    wheel_tag: str
    module_suffix: str  # of an extension module; {tag} and {digits} belong to the Python

    @property
    def is_windows(self) -> bool:
        return self.name.startswith("windows")

    @property
    def is_macos(self) -> bool:
        return self.name.startswith("macos")

    def suffix(self, python: str) -> str:
        """The suffix of a module for a Python such as "cp311"."""
        return self.module_suffix.format(tag=python, digits=python.removeprefix("cp"))


TARGETS = (
    Target("windows-x64", "x86_64-windows-gnu", "win_amd64", ".{tag}-win_amd64.pyd"),
    Target(
        "linux-x64",
        "x86_64-linux-gnu.2.28",
        "manylinux_2_28_x86_64",
        ".cpython-{digits}-x86_64-linux-gnu.so",
    ),
    Target(
        "linux-arm64",
        "aarch64-linux-gnu.2.28",
        "manylinux_2_28_aarch64",
        ".cpython-{digits}-aarch64-linux-gnu.so",
    ),
    Target("macos-arm64", "aarch64-macos.11.0", "macosx_11_0_arm64", ".cpython-{digits}-darwin.so"),
    Target("macos-x64", "x86_64-macos.10.15", "macosx_10_15_x86_64", ".cpython-{digits}-darwin.so"),
)


def target_named(name: str) -> Target:
    """A target by Blender's name of the platform."""
    return {target.name: target for target in TARGETS}[name]
