# SPDX-License-Identifier: GPL-3.0-or-later
"""The version of a wheel, for scikit-build-core: the manifest's, and a local part for development builds.

Blender keeps the old native code when a wheel of the same version is installed again, so a build
between releases has to have a version of its own: the same with `+g1a2b3c4` behind.
"""

import os
import tomllib
from pathlib import Path

MANIFEST = Path(__file__).resolve().parent.parent / "blender_manifest.toml"
LOCAL_PART = "DF_LOCAL_VERSION"


def manifest_version() -> str:
    """The project's version, which the manifest defines."""
    return tomllib.loads(MANIFEST.read_text(encoding="utf-8"))["version"]


def dynamic_metadata(field, settings=None, project=None) -> str:
    """Called by scikit-build-core for the field `version`."""
    if field != "version":
        raise ValueError(f"wheel_version provides no {field}")
    return version(os.environ.get(LOCAL_PART))


def version(local: str | None) -> str:
    """The manifest's version, with the local part of a development build."""
    return f"{manifest_version()}+{local}" if local else manifest_version()
