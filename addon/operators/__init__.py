# SPDX-License-Identifier: GPL-3.0-or-later
"""All operators, for users and scripts."""
