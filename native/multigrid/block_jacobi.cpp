// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/block_jacobi.h"

#include <Eigen/SparseCholesky>
#include <type_traits>
#include <utility>

#include "base/simd.h"
#include "parallel/memory_news.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

using Four = Packs<float, 16>;

// Points of a block: enough to reach along many thin faces. Those along one line take hardly more
// numbers than the matrix has, those of a round block some twenty each.
constexpr std::size_t most_points = 1024;
constexpr std::size_t grain = 4;  // blocks worth a thread

// Shares of the diagonal that are added to it until the block is definite in rounding.
constexpr double shifts[] = {0, 1e-7, 1e-5, 1e-3, 1};

// Numbers of a point in a block's own vectors: three in packs of four.
template <int C>
constexpr std::size_t stride = C == 3 ? 4 : 1;

template <int C>
using PackOfPoint = std::conditional_t<C == 3, Four::Pack, float>;

template <int C>
DF_INLINE void load_point(const float* from, PackOfPoint<C>& pack) {
  std::memcpy(&pack, from, sizeof pack);
}
template <int C>
DF_INLINE void store_point(const PackOfPoint<C>& pack, float* to) {
  std::memcpy(to, &pack, sizeof pack);
}

// Calls body(std::integral_constant<int, C>) for C numbers a point.
template <class Body>
void with_components(std::size_t components, const Body& body) {
  if (components == 3)
    body(std::integral_constant<int, 3>());
  else
    body(std::integral_constant<int, 1>());
}

}  // namespace

std::size_t BlockJacobi::Factor::bytes() const {
  return point.capacity() * sizeof(Index) + inverse.capacity() * sizeof(float) +
         end.capacity() * sizeof(std::uint32_t) + row.capacity() * sizeof(std::uint16_t) +
         number.capacity() * sizeof(float);
}

template <int C>
void BlockJacobi::Factor::forward(float* x) const {
  std::uint32_t k = 0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    PackOfPoint<C> own, other;
    load_point<C>(x + stride<C> * i, own);
    own *= inverse[i];
    store_point<C>(own, x + stride<C> * i);
    for (; k < end[i]; ++k) {
      float* const at = x + stride<C> * row[k];
      load_point<C>(at, other);
      other -= number[k] * own;
      store_point<C>(other, at);
    }
  }
}

template <int C>
void BlockJacobi::Factor::backward(float* x) const {
  for (std::size_t i = point.size(); i-- > 0;) {
    PackOfPoint<C> own, other;
    load_point<C>(x + stride<C> * i, own);
    for (std::uint32_t k = i > 0 ? end[i - 1] : 0; k < end[i]; ++k) {
      load_point<C>(x + stride<C> * row[k], other);
      own -= number[k] * other;
    }
    own *= inverse[i];
    store_point<C>(own, x + stride<C> * i);
  }
}

// Factors one block after another, on one thread.
class BlockJacobi::Factorizer {
 public:
  // Of each point: its block, and its place there.
  struct Place {
    Index block = -1;
    std::uint16_t place = 0;
  };
  Factorizer(const SymmetricRows& rows, const std::vector<Place>& places)
      : rows_(rows), places_(places) {}

  Factor factor(const Index* points, std::size_t size) {
    take_lower_half(points, size);
    llt_.analyzePattern(matrix_);
    const Eigen::VectorXd diagonal = matrix_.diagonal();
    for (const double shift : shifts) {
      for (Eigen::Index i = 0; i < Eigen::Index(size); ++i)
        matrix_.coeffRef(i, i) = (1 + shift) * diagonal(i);
      llt_.factorize(matrix_);
      if (llt_.info() == Eigen::Success) break;
    }
    return columns(points);
  }

 private:
  void take_lower_half(const Index* points, std::size_t size) {
    entries_.clear();
    const Index own = places_[std::size_t(points[0])].block;
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t k = rows_.first[std::size_t(points[i])];
           k < rows_.first[std::size_t(points[i]) + 1]; ++k) {
        const auto [block, place] = places_[std::size_t(rows_.entry[k].first)];
        if (block == own && place >= i)
          entries_.emplace_back(int(place), int(i), double(rows_.entry[k].second));
      }
    matrix_.resize(Eigen::Index(size), Eigen::Index(size));
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
  }

  Factor columns(const Index* points) const {
    const SparseMatrix& lower = llt_.matrixL().nestedExpression();
    const auto& order = llt_.permutationPinv().indices();
    const auto size = std::size_t(lower.cols());
    const auto below = std::size_t(lower.nonZeros()) - size;
    Factor out;
    out.point.reserve(size);
    out.inverse.reserve(size);
    out.end.reserve(size);
    out.row.reserve(below);
    out.number.reserve(below);
    for (Eigen::Index i = 0; i < lower.cols(); ++i) {
      out.point.push_back(points[order.size() > 0 ? order(i) : int(i)]);
      for (SparseMatrix::InnerIterator entry(lower, i); entry; ++entry) {
        if (entry.row() == i) {
          out.inverse.push_back(float(1 / entry.value()));
          continue;
        }
        out.row.push_back(std::uint16_t(entry.row()));
        out.number.push_back(float(entry.value()));
      }
      out.end.push_back(std::uint32_t(out.row.size()));
    }
    return out;
  }

  const SymmetricRows& rows_;
  const std::vector<Place>& places_;
  std::vector<Eigen::Triplet<double>> entries_;
  SparseMatrix matrix_;
  Eigen::SimplicialLLT<SparseMatrix> llt_;
};

std::unique_ptr<BlockJacobi> BlockJacobi::make(const LevelOperator& op, Workers& workers) {
  const SymmetricRows rows = op.rows();
  if (rows.first.empty()) return nullptr;
  const CountedBytes counted(rows.bytes());
  std::unique_ptr<BlockJacobi> out(new BlockJacobi(op, workers));
  out->blocks_ = strong_blocks(rows, most_points);
  out->factor(rows);
  return out;
}

bool BlockJacobi::refactor() {
  const SymmetricRows rows = op_.rows();
  if (rows.first.empty()) return false;
  const CountedBytes counted(rows.bytes());
  factor(rows);
  return true;
}

void BlockJacobi::factor(const SymmetricRows& rows) {
  MemoryLedger::remove(std::exchange(bytes_, 0));
  announce_memory(rows.bytes());  // about as much
  std::vector<Factorizer::Place> places(op_.points());
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    for (std::size_t i = blocks_.begin[b]; i < blocks_.begin[b + 1]; ++i)
      places[std::size_t(blocks_.point[i])] = {Index(b), std::uint16_t(i - blocks_.begin[b])};
  factors_.resize(blocks_.size());
  workers_.for_parts(blocks_.size(), grain, [&](std::size_t begin, std::size_t end) {
    Factorizer factorizer(rows, places);
    for (std::size_t b = begin; b < end; ++b)
      factors_[b] = factorizer.factor(blocks_.point.data() + blocks_.begin[b],
                                      blocks_.begin[b + 1] - blocks_.begin[b]);
  });
  for (const Factor& f : factors_) bytes_ += f.bytes();
  MemoryLedger::add(bytes_);
}

// Calls load(at, y) on all points of a block, solve(factor, vector of the block), and then store(at,
// y); `at`: where a point's numbers are in the operator's vectors.
template <int C, class Load, class Solve, class Store>
void BlockJacobi::visit(const Load& load, const Solve& solve, const Store& store) const {
  workers_.for_parts(factors_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Factor& f = factors_[b];
      float* const local = room_in(thread_scratch<float>().work, stride<C> * f.point.size());
      for (std::size_t i = 0; i < f.point.size(); ++i) {
        for (std::size_t a = C; a < stride<C>; ++a) local[stride<C> * i + a] = 0;
        load(C * std::size_t(f.point[i]), local + stride<C> * i);
      }
      solve(f, local);
      for (std::size_t i = 0; i < f.point.size(); ++i)
        store(C * std::size_t(f.point[i]), local + stride<C> * i);
    }
  });
}

// x <- solve(x), block by block.
template <class Solve>
void BlockJacobi::replace(float* x, const Solve& solve) const {
  with_components(op_.components(), [&](auto components) {
    constexpr int C = decltype(components)::value;
    visit<C>([=](std::size_t at, float* y) { std::copy_n(x + at, C, y); },
             [&](const Factor& f, float* y) { solve(f, y, components); },
             [=](std::size_t at, const float* y) { std::copy_n(y, C, x + at); });
  });
}

void BlockJacobi::forward(float* x) const {
  replace(x, [](const Factor& f, float* y, auto c) { f.forward<decltype(c)::value>(y); });
}

void BlockJacobi::backward(float* x) const {
  replace(x, [](const Factor& f, float* y, auto c) { f.backward<decltype(c)::value>(y); });
}

void BlockJacobi::start_from_zero(float step, const float* r, float* x, float* d) const {
  const std::size_t size = op_.size();
  for_each_index(workers_, size, [=](std::size_t i) { x[i] = d[i] = 0; });
  with_components(op_.components(), [&](auto components) {
    constexpr int C = decltype(components)::value;
    visit<C>([=](std::size_t at, float* y) { std::copy_n(r + at, C, y); },
             [](const Factor& f, float* y) {
               f.forward<C>(y);
               f.backward<C>(y);
             },
             [=](std::size_t at, const float* y) {
               for (std::size_t a = 0; a < C; ++a) x[at + a] = d[at + a] = step * y[a];
             });
  });
}

void BlockJacobi::finish_step(const SmoothingStep& s) const {
  with_components(op_.components(), [&](auto components) {
    constexpr int C = decltype(components)::value;
    visit<C>(
        [&](std::size_t at, float* y) {
          for (std::size_t a = 0; a < C; ++a) y[a] = s.r[at + a] -= s.next[at + a];
        },
        [](const Factor& f, float* y) {
          f.forward<C>(y);
          f.backward<C>(y);
        },
        [&](std::size_t at, const float* y) {
          for (std::size_t a = 0; a < C; ++a) {
            const float old = s.d[at + a], change = s.step * y[a] + s.momentum * old;
            if (s.adds_d) s.x[at + a] += old;
            s.x[at + a] += change;
            s.next[at + a] = change;
          }
        });
  });
}

}  // namespace fairing
