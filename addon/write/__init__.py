# SPDX-License-Identifier: GPL-3.0-or-later
"""Mesh out: the refined mesh and its object, in bulk."""
