# SPDX-License-Identifier: GPL-3.0-or-later
"""What the control mesh carries, transferred to the refined lattice: NumPy, no Blender."""
