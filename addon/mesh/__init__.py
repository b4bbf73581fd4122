# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's meshes and objects as arrays and writes them."""
