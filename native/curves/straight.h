// SPDX-License-Identifier: GPL-3.0-or-later
// Feature curves that the faces beside them are too narrow for.
#pragma once

#include "curves/feature_curves.h"

namespace fairing {

// Control edges, ascending, whose curve leaves them by more than a face beside them is wide: the face
// would be wider than twice, or turn over. Both sides of a quad may be curves: then it is their bulges
// against one another that count, for narrow faces may follow a bend. A triangle's corner that no
// curve holds may follow a curve that goes away from it.
std::vector<Index> edges_to_straighten(const ControlMesh& mesh, std::span<const Vec3> positions,
                                       const FeatureCurves& curves);

}  // namespace fairing
