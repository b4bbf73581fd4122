# SPDX-License-Identifier: GPL-3.0-or-later
"""Wheels for the machines that this one is not: compiled here, inspected, and tried as far as emulators reach."""
