// SPDX-License-Identifier: GPL-3.0-or-later
// What a run reports, as dicts and lists.
#pragma once

#include <pybind11/pybind11.h>

#include "fair/report.h"

namespace fairing {

pybind11::dict to_python(const Report& report);

}  // namespace fairing
