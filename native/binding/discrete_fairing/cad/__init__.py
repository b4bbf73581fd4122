# SPDX-License-Identifier: GPL-3.0-or-later
"""Spline patches of a surface, and their STEP file: `fitting` has the call, which tries `levels` and keeps the `fits` that
hold; `patches` are its result, `distances` from it to points, `flat_polygons` faces that are planes; `step` writes `files`.
"""
