// SPDX-License-Identifier: GPL-3.0-or-later
// Feature curves for which the adjacent faces are too narrow.
#pragma once

#include "curves/feature_curves.h"

namespace fairing {

// Control edges, ascending, whose curve leaves them by more than the width of an adjacent face: the
// face would be more than twice as wide, or turn over. If both sides of a quad are curves, only
// their bulges against each other count, because narrow faces may follow a bend. A triangle's
// corner that no curve holds may follow a curve that goes away from it.
std::vector<Index> edges_to_straighten(const ControlMesh& mesh, std::span<const Vec3> positions,
                                       const FeatureCurves& curves);

}  // namespace fairing
