# SPDX-License-Identifier: GPL-3.0-or-later
"""Spline patches of a surface, and their STEP file: `fitting` has the call, which tries `levels` (near
scans `finer_fits`) and keeps the `fits` that hold; `patches` are its result, `distances` those to
points, `flat_polygons` the faces that are planes; `step` writes `files`.
"""
