# SPDX-License-Identifier: GPL-3.0-or-later
"""What the control mesh carries (UV maps, weights, colours …), carried over to the refined lattice: NumPy, no Blender."""
