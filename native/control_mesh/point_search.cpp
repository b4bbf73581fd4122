// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_mesh/point_search.h"

#include <algorithm>

#include "execution/cancel.h"

namespace fairing {
namespace {

double key_of(const Vec3& p) { return p.dot(Vec3(0.5347, 0.6241, 0.5698)); }  // of length one, nearly

}  // namespace

PointSearch::PointSearch(const ControlMesh& mesh) : positions_(mesh.positions) {
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    if (!mesh.ring(v).empty()) entries_.push_back({key_of(positions_[std::size_t(v)]), v});
  std::sort(entries_.begin(), entries_.end(),
            [comparisons = std::size_t(0)](const Entry& a, const Entry& b) mutable {
              stop_if_cancelled(++comparisons);
              return a.key < b.key;
            });
}

Index PointSearch::at(const Vec3& p, double tolerance) const {
  const double key = key_of(p), reach = 2 * tolerance;
  auto entry = std::lower_bound(entries_.begin(), entries_.end(), key - reach,
                                [](const Entry& e, double k) { return e.key < k; });
  Index found = none;
  for (; entry != entries_.end() && entry->key <= key + reach; ++entry) {
    if ((positions_[std::size_t(entry->vertex)] - p).norm() > tolerance) continue;
    if (found >= 0) return several;
    found = entry->vertex;
  }
  return found;
}

}  // namespace fairing
