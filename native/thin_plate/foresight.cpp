// SPDX-License-Identifier: GPL-3.0-or-later
#include "thin_plate/foresight.h"

#include <cmath>

#include "hold/pads.h"
#include "parallel/reductions.h"

namespace fairing {

double Foresight::spring(std::size_t v) const {
  const VertexWeights& weights = levels_.weights(level_);
  return levels_.shared().unknowns.vertex[v] && !weights.empty() ? weights[v] : 0.0;
}

Foresight::Seen Foresight::look(const double* r, bool direct, const Loads& forces) const {
  const ThinPlateShared& shared = levels_.shared();
  Seen out{Loads(std::size_t(shared.mesh.vertex_count()), Vec3::Zero()), forces, 0};
  if (direct || !is_believed_) return out;
  if (!is_judged_) out.residual = norm(levels_.workers(), 3 * levels_.grid(level_).size(), r);
  levels_.restrict_to_vertices(level_, r, out.rest);
  for (std::size_t v = 0; v < stiffness_.size(); ++v)
    if (shared.unknowns.vertex[v])
      out.rest[v] *= spring(v) > 0 ? spring(v) / (spring(v) + stiffness_[v]) : 0.0;
  return out;
}

void Foresight::foresee(const Seen& before, const double* x, const double* r, bool direct,
                        const Hats* hats, Loads& forces) {
  Seen after = look(r, direct, forces);
  if (!is_judged_ && !direct) judge(before, after);
  if (!is_believed_) after.rest.assign(after.rest.size(), Vec3::Zero());
  vertices_.assign(x, x + 3 * after.rest.size());
  for (std::size_t v = 0; v < after.rest.size(); ++v) {
    if (hats && hats->under(v)) forces[v] -= after.rest[v];
    if (spring(v) > 0) Eigen::Map<Vec3>(vertices_.data() + 3 * v) += after.rest[v] / spring(v);
  }
}

// Which forces loads leave does not depend on how far a solve goes, so what is foreseen of them
// should not change. It does as the residual, where the prolongation is far from H: at borders with
// stiff stencils. It is believed where it is now known better than by the vertices' own rows.
void Foresight::judge(const Seen& before, const Seen& after) {
  is_judged_ = true;
  double own = 0, all = 0;
  for (std::size_t v = 0; v < after.forces.size(); ++v) {
    const Vec3 change = after.forces[v] - before.forces[v];
    own += change.squaredNorm();
    all += (change - after.rest[v] + before.rest[v]).squaredNorm();
  }
  is_believed_ = after.residual * std::sqrt(all) <= before.residual * std::sqrt(own);
}

}  // namespace fairing
