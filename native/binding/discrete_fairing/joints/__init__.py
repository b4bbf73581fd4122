# SPDX-License-Identifier: GPL-3.0-or-later
"""Borders of surfaces: their curves, tangent planes and curvatures (`borders`), how two join (`joint`),
and a border that meets a neighbour's (`matching`, by the rotations of `turning`), or both their mean
(`Halfway`).
"""
