# SPDX-License-Identifier: GPL-3.0-or-later
"""Transfers the data of the control mesh to the refined lattice. NumPy, no Blender."""
