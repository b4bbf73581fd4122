# SPDX-License-Identifier: GPL-3.0-or-later
"""How many random calls a run of the tests makes: the same ones each time."""

from hypothesis import HealthCheck, settings

COMMON = {
    "deadline": None,
    "derandomize": True,
    "database": None,
    "suppress_health_check": [*HealthCheck],
}
settings.register_profile("usual", max_examples=400, **COMMON)
settings.load_profile("usual")
