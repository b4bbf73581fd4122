# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds defects of meshes and faults of surfaces, and mends them."""
