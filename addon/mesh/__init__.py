# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender meshes and objects, read as arrays and written from them."""
