// SPDX-License-Identifier: GPL-3.0-or-later
#include "butterfly.h"

#include <cmath>
#include <numbers>

#include "reference_rings.h"

namespace fairing::test {
namespace {

class Step {
 public:
  Step(const GridLevel& coarse, const std::vector<double>& x) : walker_(cells(coarse)), x_(x) {}

  // The new point on the edge between two old ones.
  Vec3 middle(Index a, Index b) const {
    const std::vector<RingNeighbour> from_a = walker_.ring(a, b), from_b = walker_.ring(b, a);
    const bool regular_a = from_a.size() == 6, regular_b = from_b.size() == 6;
    if (regular_a && regular_b)
      return 0.5 * (at(a) + at(b)) + 0.125 * (at(from_a[1].point) + at(from_a[5].point)) -
             0.0625 * (at(from_a[2].point) + at(from_a[4].point) + at(from_b[2].point) +
                       at(from_b[4].point));
    if (regular_a) return irregular(b, from_b);
    if (regular_b) return irregular(a, from_a);
    return 0.5 * (irregular(a, from_a) + irregular(b, from_b));
  }

 private:
  Vec3 at(Index p) const { return Eigen::Map<const Vec3>(x_.data() + 3 * std::size_t(p)); }

  // From the ring of the end that is irregular, beginning with the other end.
  Vec3 irregular(Index centre, const std::vector<RingNeighbour>& ring) const {
    const std::size_t k = ring.size();
    Vec3 sum = 0.75 * at(centre);
    for (std::size_t j = 0; j < k; ++j) {
      const double angle = 2 * std::numbers::pi * double(j) / double(k);
      double weight = (0.25 + std::cos(angle) + 0.5 * std::cos(2 * angle)) / double(k);
      if (k == 3) weight = j == 0 ? 5.0 / 12 : -1.0 / 12;
      if (k == 4) weight = j == 0 ? 3.0 / 8 : j == 2 ? -1.0 / 8 : 0;
      sum += weight * at(ring[j].point);
    }
    return sum;
  }

  RingWalker walker_;
  const std::vector<double>& x_;
};

std::vector<double> refined(const GridLevel& coarse, const GridLevel& fine,
                            const std::vector<double>& x) {
  const Step step(coarse, x);
  std::vector<double> y(3 * fine.size(), 0.0);
  const auto put = [&](Index p, const Vec3& value) {
    Eigen::Map<Vec3>(y.data() + 3 * std::size_t(p)) = value;
  };
  for (Index f = 0; f < Index(coarse.mesh().faces.size()); ++f) {
    const int n = coarse.n();
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n - j; ++i) {
        const Index here = coarse.face_point(f, i, j);
        put(fine.face_point(f, 2 * i, 2 * j),
            Eigen::Map<const Vec3>(x.data() + 3 * std::size_t(here)));
        const auto between = [&](int di, int dj) {
          if (i + di < 0 || i + di + j + dj > n) return;
          const Index there = coarse.face_point(f, i + di, j + dj);
          put(fine.face_point(f, 2 * i + di, 2 * j + dj),
              step.middle(std::min(here, there), std::max(here, there)));
        };
        between(1, 0);
        between(0, 1);
        between(-1, 1);
      }
  }
  return y;
}

}  // namespace

std::vector<double> butterfly(const ControlMesh& mesh, int levels) {
  std::vector<double> x;
  for (const Vec3& p : mesh.positions) x.insert(x.end(), {p.x(), p.y(), p.z()});
  for (int level = 0; level < levels; ++level)
    x = refined(GridLevel(mesh, level), GridLevel(mesh, level + 1), x);
  return x;
}

}  // namespace fairing::test
