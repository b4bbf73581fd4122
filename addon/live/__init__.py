# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that follow their sources during edits."""
