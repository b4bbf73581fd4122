# SPDX-License-Identifier: GPL-3.0-or-later
"""One run: read, fair on a thread or blocking, write; queue, progress, cancel."""
