# SPDX-License-Identifier: GPL-3.0-or-later
"""The jobs: each reads Blender's data, computes on any thread, and writes.

`fair` makes a surface, `fit` one near scans, over a cage that `scan_cage` makes if there is none; `in_place` fairs
selected faces in their own mesh, or removes their `noise`; `fill` fills holes, and `clean` cleans scans.
"""
