// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/cells.h"

#include <algorithm>
#include <cmath>

#include "grid/runs.h"

namespace fairing {
namespace {

// Number of cells of a face before row j. In a triangle each row has one cell less that points up,
// and one less that points down, than the row before.
constexpr int cells_below(bool quad, int n, int j) { return quad ? j * n : j * (2 * n - j); }

}  // namespace

// In a triangle's row, each cell that points up precedes the adjacent one that points down.
Cells::Cells(const GridLevel& grid, Workers& workers) : grid_(grid) {
  const ControlMesh& mesh = grid.mesh();
  const int n = grid.n();
  const auto faces = Index(mesh.faces.size());
  for (Index f = 0; f <= faces; ++f) first_.push_back(f * n * n);
  corner_.resize(std::size_t(faces) * std::size_t(n) * std::size_t(n));
  face_.resize(corner_.size());
  for_face_parts(grid, workers, [&](Index begin, Index end) {
    for (Index f = begin; f < end; ++f) {
      auto to = std::size_t(first_cell(f));
      const bool quad = mesh.faces[f].quad();
      const auto point = [&](int i, int j) { return grid.face_point(f, i, j); };
      std::fill_n(face_.begin() + to, n * n, f);
      for (int j = 0; j < n; ++j) {
        stop_in_large_face(j);
        for (int i = 0; i < (quad ? n : n - j); ++i) {
          if (quad) {
            corner_[to++] = {point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)};
            continue;
          }
          corner_[to++] = {point(i, j), point(i + 1, j), point(i, j + 1), -1};
          if (i + j + 1 < n)
            corner_[to++] = {point(i + 1, j), point(i + 1, j + 1), point(i, j + 1), -1};
        }
      }
    }
  });
  begin_.assign(grid.size() + 1, 0);
  for (const auto& corners : corner_)
    for (const Index p : corners)
      if (p >= 0) ++begin_[std::size_t(p) + 1];
  for (std::size_t p = 0; p < grid.size(); ++p) begin_[p + 1] += begin_[p];
  at_.resize(begin_.back());
  Array<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (const std::size_t c : Cancellable(corner_.size())) {
    for (std::size_t k = 0; k < 4; ++k)
      if (const Index p = corner_[c][k]; p >= 0) at_[next[p]++] = {Index(c), std::uint8_t(k)};
  }
}

FacePlace Cells::place(Index cell, const CornerShares& shares) const {
  const Index f = face(cell);
  const int n = grid_.n(), rank = cell - first_cell(f);
  if (quad(cell)) {
    const double u = double(shares[1]) + double(shares[2]),
                 v = double(shares[2]) + double(shares[3]);
    return {f, rank % n + u, rank / n + v};
  }
  int j = int(n - std::sqrt(double(n) * n - rank));  // up to rounding
  while (j > 0 && cells_below(false, n, j) > rank) --j;
  while (cells_below(false, n, j + 1) <= rank) ++j;
  const int in_row = rank - cells_below(false, n, j), i = in_row / 2;
  if (in_row % 2 == 0) return {f, i + double(shares[1]), j + double(shares[2])};
  return {f, i + double(shares[0]) + double(shares[1]), j + double(shares[1]) + double(shares[2])};
}

Cells::AtPoint Cells::cell_at(const FacePlace& place, int of) const {
  const double scale = std::ldexp(1.0, grid_.level() - of);
  const int n = grid_.n();
  const bool quad = grid_.mesh().faces[place.face].quad();
  const double x = std::clamp(place.i * scale, 0.0, double(n)),
               y = std::clamp(place.j * scale, 0.0, double(n));
  const int j = std::min(int(y), n - 1), i = std::min(int(x), (quad ? n : n - j) - 1);
  const double u = x - i, v = y - j;
  const Index row = first_cell(place.face) + cells_below(quad, n, j);
  if (quad) return {row + i, std::uint8_t(v < 0.5 ? (u < 0.5 ? 0 : 1) : (u < 0.5 ? 3 : 2))};
  const bool down = u + v > 1 && i + j + 1 < n;
  const double share[3] = {down ? 1 - v : 1 - u - v, down ? u + v - 1 : u, down ? 1 - u : v};
  return {row + 2 * i + down, std::uint8_t(std::max_element(share, share + 3) - share)};
}

}  // namespace fairing
