// SPDX-License-Identifier: GPL-3.0-or-later
#include "transfer/point_normal.h"

#include <algorithm>

#include "base/points.h"
#include "grid/runs.h"

namespace fairing {
namespace {

using Point = Eigen::Map<const Vec3>;

Vec3 midpoint(const double* p, const double* p_normal, const double* q, const double* q_normal) {
  const Point a(p), b(q), m(p_normal), n(q_normal);
  const Vec3 along = b - a;
  return 0.5 * (a + b) - 0.125 * (along.dot(m) * m - along.dot(n) * n);
}

}  // namespace

void prolong_with_normals(const GridLevel& coarse, const GridLevel& fine, Workers& workers,
                          const double* x, const double* normal, double* y) {
  const ControlMesh& mesh = coarse.mesh();
  const int n = coarse.n();
  std::copy_n(x, 3 * std::size_t(mesh.vertex_count()), y);
  for_edge_parts(coarse, workers, [&](Index begin, Index end) {
    std::vector<double> run(lane_stride(n)), normals(lane_stride(n));
    for (Index e = begin; e < end; ++e) {
      gather_edge(coarse, x, e, run.data());
      gather_edge(coarse, normal, e, normals.data());
      double* to = y + 3 * std::size_t(fine.edge_base(e));
      for (int k = 1; k < 2 * n; ++k, to += 3) {
        const std::size_t at = 3 * std::size_t(k / 2);
        if (k % 2 == 0)
          copy_point(to, run.data() + at);
        else
          put_point(midpoint(&run[at], &normals[at], &run[at + 3], &normals[at + 3]), to);
      }
    }
  });
  for_face_parts(coarse, workers, [&](Index begin, Index end) {
    std::vector<double> points(3 * closed_size(true, std::size_t(n))), normals(points.size());
    for (Index f = begin; f < end; ++f) {
      const bool quad = mesh.faces[f].quad();
      gather_face(coarse, x, f, points.data());
      gather_face(coarse, normal, f, normals.data());
      const auto between = [&](int i, int j, int k, int l) {
        const auto at = [&](int a, int b) {
          return 3 * (closed_row(quad, std::size_t(n), std::size_t(b)) + std::size_t(a));
        };
        return midpoint(&points[at(i, j)], &normals[at(i, j)], &points[at(k, l)],
                        &normals[at(k, l)]);
      };
      double* to = y + 3 * std::size_t(fine.face_base(f));
      for (int j = 1; j < 2 * n; ++j)
        for (int i = 1; i < (quad ? 2 * n : 2 * n - j); ++i, to += 3) {
          const int a = i / 2, b = j / 2, odd_i = i % 2, odd_j = j % 2;
          if (!odd_i || !odd_j)
            put_point(between(a, b, a + odd_i, b + odd_j),
                      to);  // of a point with itself: the point
          else if (quad)
            put_point(0.5 * (between(a, b, a + 1, b + 1) + between(a + 1, b, a, b + 1)), to);
          else
            put_point(between(a + 1, b, a, b + 1), to);
        }
    }
  });
}

}  // namespace fairing
