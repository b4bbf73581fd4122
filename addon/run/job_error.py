# SPDX-License-Identifier: GPL-3.0-or-later
"""Why a job gave no surface."""


class JobError(Exception):
    """Why an object cannot be faired, as a sentence for its user.

    `code`, `kind`, `elements`: of the core's error, where it was the core that refused; else "", "mesh", ().
    """

    def __init__(self, sentence, code="", kind="mesh", elements=()):
        super().__init__(sentence)
        self.code = code
        self.kind = kind
        self.elements = list(elements)


class JobCancelled(JobError):
    """The user did not want it any more."""
