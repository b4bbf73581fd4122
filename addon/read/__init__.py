# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh in: what the core and the data transfer need of a Blender object, as NumPy arrays."""
