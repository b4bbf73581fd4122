# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings and arrays as a call of the core."""
