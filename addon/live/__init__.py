# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfaces that follow while their sources are edited: `watch` hears of edits, a `session` follows them."""
