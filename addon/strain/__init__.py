# SPDX-License-Identifier: GPL-3.0-or-later
"""Which control vertices spoil the surface: measured, shown over the viewport, listed, put right."""
