# SPDX-License-Identifier: GPL-3.0-or-later
"""Holes: each is filled, and faired in `rounds` near it (`near_hole`), so that nothing crosses the rest
(`crossings`); `filling` has the calls, `filled` their results. Sides of faces are cut at vertices on
them first (`edge_cuts`).
"""
