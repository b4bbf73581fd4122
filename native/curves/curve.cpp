// SPDX-License-Identifier: GPL-3.0-or-later
// The minimizer in closed form. Between two control vertices the second divided differences M of a
// minimizer vary linearly, so its points are cubic in the index i = 0 … N:
//
//   f_i = (1 − i/N) a + (i/N) b + h² [M_a φ(N − i) + M_b φ(i)],
//   φ(i) = (i³ − N² i) / 6N,   h = H / N,
//
// where H is the segment's length in the parameter, |b − a|^exponent. The unknowns are the M at the
// control vertices; the definition of the second divided difference there gives one tridiagonal
// equation a vertex:
//
//   (2N² + 1)(h₋ + h₊) M_j + (N² − 1)(h₊ M_{j+1} + h₋ M_{j−1})
//       = 6N [(c_{j+1} − c_j)/H₊ − (c_j − c_{j−1})/H₋].
//
// At the ends of an open chain M is zero or that of the next vertex. N → ∞ gives the cubic spline.
// A line that is tangent to its neighbours stays straight. The curve between two lines is an open
// chain with the lines' tangents: 2 M_0 + M_1 = 6 / H [(c_1 − c_0)/H − f'_0]. Its speed f' there is
// that of the circle with this tangent through its first two vertices.
#include "curves/curve.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/angle.h"
#include "curves/lines.h"
#include "parallel/cancel.h"

namespace fairing {
namespace {

template <class Value>
void solve_open(std::vector<double> diagonal, const std::vector<double>& right,
                std::vector<Value>& value) {
  const std::size_t n = value.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = right[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * right[i - 1];
    value[i] -= factor * value[i - 1];
  }
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n) value[i] -= right[i] * value[i + 1];
    value[i] /= diagonal[i];
  }
}

// Returns the x of
//
//   right[i - 1] x[i - 1] + diagonal[i] x[i] + right[i] x[i + 1] = value[i].
//
// With `cyclic` (at least three unknowns), right.back() couples the last unknown to the first;
// without, it is not used. Dominance makes pivoting needless. Linear time.
std::vector<Vec3> solve_tridiagonal(const std::vector<double>& diagonal,
                                    const std::vector<double>& right, std::vector<Vec3> value,
                                    bool cyclic) {
  if (!cyclic) {
    solve_open(diagonal, right, value);
    return value;
  }
  // Sherman–Morrison: the matrix is an open one, T, plus c w wᵀ with w = e_first + e_last.
  const double c = right.back();
  std::vector<double> open = diagonal;
  open.front() -= c;
  open.back() -= c;
  std::vector<double> w(value.size(), 0.0);
  w.front() = w.back() = 1;
  solve_open(open, right, value);
  solve_open(open, right, w);
  const Vec3 factor = (c / (1 + c * (w.front() + w.back()))) * (value.front() + value.back());
  for (std::size_t i = 0; i < value.size(); ++i) value[i] -= w[i] * factor;
  return value;
}

// Rounding depends on the order of operations, so every chain is first put into a canonical order
// that depends only on its coordinates: its vertex i is vertex start ± i of the given one.
struct Order {
  std::size_t start = 0;
  bool backwards = false;

  std::size_t operator()(std::size_t i, std::size_t count) const {
    return (backwards ? start + count - i : start + i) % count;
  }
};

bool less(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

bool precedes(std::span<const Vec3> vertices, const Order& a, const Order& b) {
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3 &p = vertices[a(i, vertices.size())], &q = vertices[b(i, vertices.size())];
    if (less(p, q)) return true;
    if (less(q, p)) return false;
  }
  return false;
}

// The least order, or all least ones if the chain is the same from several vertices or ends, as a
// boundary that follows a slit and returns.
std::vector<Order> canonical_orders(std::span<const Vec3> vertices, bool closed) {
  std::vector<Order> orders;
  const auto consider = [&](const Order& order) {
    if (!orders.empty() && precedes(vertices, orders[0], order)) return;
    if (!orders.empty() && precedes(vertices, order, orders[0])) orders.clear();
    orders.push_back(order);
  };
  if (!closed) {
    consider({0, false});
    consider({vertices.size() - 1, true});
    return orders;
  }
  const Vec3 least = *std::min_element(vertices.begin(), vertices.end(), less);
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    if (vertices[v] != least) continue;
    consider({v, false});
    consider({v, true});
  }
  return orders;
}

// Derivatives at the ends of an open chain, where a line goes on.
struct Slopes {
  std::optional<Vec3> first, last;
};

// The second divided differences M at the control vertices; lengths[s] is the length of the segment
// from vertex s to s + 1.
std::vector<Vec3> joint_moments(const std::vector<Vec3>& c, const std::vector<double>& lengths,
                                bool closed, const CurveScheme& scheme, const Slopes& slopes = {}) {
  const double n = scheme.subdivisions;
  const bool parabolic = !closed && scheme.ends == ChainEnds::parabolic;
  const std::size_t count = c.size(), segments = lengths.size();
  const std::size_t first = closed || slopes.first ? 0 : 1,
                    end = closed || slopes.last ? count : count - 1;
  std::vector<Vec3> moments(count, Vec3::Zero());
  if (end <= first) return moments;

  const std::size_t joints = end - first;
  std::vector<double> diagonal(joints), right(joints);
  std::vector<Vec3> value(joints);
  for (std::size_t k = 0; k < joints; ++k) {
    const std::size_t j = first + k, before = (j + segments - 1) % segments, after = j % segments;
    const Vec3 in = (c[j] - c[(j + count - 1) % count]) / lengths[before],
               out = (c[(j + 1) % count] - c[j]) / lengths[after];
    right[k] = (n * n - 1) * lengths[after] / n;
    if (!closed && (j == 0 || j == count - 1)) {
      const double length = lengths[j == 0 ? after : before];
      diagonal[k] = 2 * (n * n - 1) * length / n;
      value[k] = 6 * (n * n - 1) / n * (j == 0 ? out - *slopes.first : *slopes.last - in);
    } else {
      diagonal[k] = (2 * n * n + 1) * (lengths[before] + lengths[after]) / n;
      value[k] = 6 * n * (out - in);
    }
  }
  if (parabolic && !slopes.first) diagonal.front() += (n * n - 1) * lengths.front() / n;
  if (parabolic && !slopes.last) diagonal.back() += (n * n - 1) * lengths.back() / n;
  const std::vector<Vec3> solution = solve_tridiagonal(diagonal, right, std::move(value), closed);
  std::copy(solution.begin(), solution.end(), moments.begin() + std::ptrdiff_t(first));
  if (parabolic && !slopes.first) moments.front() = moments[1];
  if (parabolic && !slopes.last) moments.back() = moments[count - 2];
  return moments;
}

// A chain in canonical order, and the second divided differences at both ends of each segment. They
// are zero on lines, so a joint between line and curve has two.
class CanonicalChain {
 public:
  CanonicalChain(const std::vector<Vec3>& parameters, const std::vector<Vec3>& vertices,
                 bool closed, const CurveScheme& scheme, const Beyond& beyond)
      : p_(parameters),
        c_(vertices),
        closed_(closed),
        scheme_(scheme),
        straight_(tangent_lines(parameters, closed, beyond)),
        bends_(straight_.size(), {Vec3::Zero(), Vec3::Zero()}) {
    for (std::size_t s = 0; s < segments(); ++s)
      lengths_.push_back(std::pow((p_[next(s)] - p_[s]).norm(), scheme.exponent));
    bend();
  }

  // Interior points, segment by segment.
  std::vector<Vec3> points() const {
    const double n = scheme_.subdivisions;
    const auto phi = [n](double i) { return (i * i * i - n * n * i) / (6 * n); };
    std::vector<Vec3> points;
    for (const std::size_t s : Cancellable(segments())) {
      const Vec3 &a = c_[s], &b = c_[next(s)];
      const double h = lengths_[s] / n;
      for (int i = 1; i < scheme_.subdivisions; ++i)
        points.push_back(a + (i / n) * (b - a) +
                         h * h * (phi(n - i) * bends_[s].first + phi(i) * bends_[s].last));
    }
    return points;
  }

 private:
  struct Bend {
    Vec3 first, last;
  };

  std::size_t segments() const { return straight_.size(); }
  std::size_t next(std::size_t vertex) const { return (vertex + 1) % p_.size(); }

  void bend() {
    const auto line = std::find(straight_.begin(), straight_.end(), 1);
    if (line == straight_.end()) {
      const std::vector<Vec3> moments = joint_moments(c_, lengths_, closed_, scheme_);
      for (std::size_t s = 0; s < segments(); ++s) bends_[s] = {moments[s], moments[next(s)]};
      return;
    }
    const std::size_t start = closed_ ? std::size_t(line - straight_.begin()) : 0;
    for (std::size_t begin = 0; begin < segments();) {
      std::size_t end = begin;
      while (end < segments() && !straight_[(start + end) % segments()]) ++end;
      if (end > begin) bend_curve(start + begin, end - begin);
      begin = end + 1;
    }
  }

  // The open chain of `count` segments that begins at vertex `first`, between two lines or a line and
  // an end.
  void bend_curve(std::size_t first, std::size_t count) {
    std::vector<Vec3> vertices = {c_[first % c_.size()]};
    std::vector<double> lengths;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t s = (first + i) % segments();
      vertices.push_back(c_[next(s)]);
      lengths.push_back(lengths_[s]);
    }
    const std::size_t last = first + count;
    Slopes slopes;
    if (closed_ || first > 0)
      slopes.first = slope((first + segments() - 1) % segments(), first % segments());
    if (closed_ || last < segments())
      slopes.last = slope(last % segments(), (last - 1) % segments());
    const std::vector<Vec3> moments = joint_moments(vertices, lengths, false, scheme_, slopes);
    for (std::size_t i = 0; i < count; ++i)
      bends_[(first + i) % segments()] = {moments[i], moments[i + 1]};
  }

  // The derivative where a line meets the arc that it is tangent to: the arc is longer than its chord.
  Vec3 slope(std::size_t line, std::size_t arc) const {
    const Vec3 along = p_[next(line)] - p_[line], chord = p_[next(arc)] - p_[arc];
    const double angle = angle_between(along, chord);
    const double stretch = angle > 0 ? angle / std::sin(angle) : 1;
    return stretch * chord.norm() / lengths_[arc] / along.norm() * (c_[next(line)] - c_[line]);
  }

  const std::vector<Vec3>&p_, &c_;
  bool closed_;
  const CurveScheme& scheme_;
  std::vector<std::uint8_t> straight_;  // by segment
  std::vector<double> lengths_;
  std::vector<Bend> bends_;
};

}  // namespace

std::vector<Vec3> refine_chain(std::span<const Vec3> parameters, std::span<const Vec3> vertices,
                               bool closed, const CurveScheme& scheme, Beyond beyond) {
  if (vertices.size() < 2 || scheme.subdivisions < 2) return {};
  const std::size_t count = vertices.size(), segments = closed ? count : count - 1;
  const auto inner = std::size_t(scheme.subdivisions - 1);

  std::vector<Order> orders = canonical_orders(parameters, closed);
  // The orders are equal for the parameters, but may differ for other vertices.
  if (parameters.data() != vertices.data()) orders.resize(1);
  std::vector<Vec3> canonical_parameters, canonical;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = orders[0](i, count);
    canonical_parameters.push_back(parameters[from] + Vec3::Zero());  // −0 becomes 0
    canonical.push_back(vertices[from] + Vec3::Zero());
  }
  if (orders[0].backwards) std::swap(beyond.first, beyond.last);
  const std::vector<Vec3> refined =
      CanonicalChain(canonical_parameters, canonical, closed, scheme, beyond).points();

  // If there are several orders, segments at the same place take the points of the first of them.
  std::vector<Vec3> points(segments * inner);
  std::vector<std::uint8_t> filled(segments, 0);
  for (std::size_t s = 0; s < segments; ++s) {
    for (const Order& order : orders) {
      // Canonical segment s joins order(s) and order(s + 1); given ones have their first vertex'
      // number.
      const std::size_t given = order.backwards ? order(s + 1, count) : order(s, count);
      if (std::exchange(filled[given], std::uint8_t(1))) continue;
      for (std::size_t i = 0; i < inner; ++i)
        points[given * inner + (order.backwards ? inner - 1 - i : i)] = refined[s * inner + i];
    }
  }
  return points;
}

}  // namespace fairing
