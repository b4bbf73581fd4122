# SPDX-License-Identifier: GPL-3.0-or-later
"""Control vertices that spoil the surface: measured, shown over the viewport, listed, and moved."""
