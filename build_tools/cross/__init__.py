# SPDX-License-Identifier: GPL-3.0-or-later
"""Wheels for other platforms: compiled here, inspected, and tested in emulators."""
