// SPDX-License-Identifier: GPL-3.0-or-later
#include "strain/ease.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "base/roundoff.h"
#include "fairing/fair.h"
#include "fairing/mending.h"
#include "fairing/systems.h"
#include "parallel/cancel.h"
#include "strain/ease_system.h"
#include "strain/scatter.h"
#include "strain/strain.h"

namespace fairing {
namespace {

// The rows with the largest of these lengths, `count` of them: one of each that are images of each
// other. Rows whose length is not positive are left out. `images`: of each row, itself and its
// mirror images.
std::vector<Index> worst_rows(const std::vector<double>& lengths, std::size_t count,
                              const std::vector<std::vector<Index>>& images) {
  std::vector<Index> rows, out;
  for (std::size_t i = 0; i < lengths.size(); ++i)
    if (lengths[i] > 0) rows.push_back(Index(i));
  std::ranges::stable_sort(rows, std::greater(), [&](Index i) { return lengths[i]; });
  std::vector<std::uint8_t> taken(lengths.size());
  for (const Index row : rows) {
    if (out.size() == count) break;
    if (taken[row]) continue;
    out.push_back(row);
    for (const Index image : images[row]) taken[image] = 1;
  }
  return out;
}

// The moves of these rows after which none of them carries a load, a row each. g is square.
Columns moves_without_loads(const LoadMatrix& g, const Columns& loads,
                            std::span<const Index> rows) {
  const auto k = Eigen::Index(rows.size());
  Columns own(k, 3);
  if (rows.empty()) return own;
  Eigen::MatrixXd part(k, k);
  for (Eigen::Index i = 0; i < k; ++i) {
    stop_if_cancelled();
    own.row(i) = -loads.row(rows[i]);
    for (Eigen::Index j = 0; j < k; ++j) part(i, j) = g.coeff(rows[i], rows[j]);
  }
  return part.colPivHouseholderQr().solve(own);  // without pivots that are rounding
}

// Number of input vertices above which the loads are those of level 1, at a quarter of the cost.
constexpr std::int64_t on_second_level = 2000;
// Distance of two vertices in one solve: 81 sets, and so 27 solves, on quads.
constexpr int rings_between_probes = 9;

// Some rows and columns of a matrix with weights: rows are multiplied by them, columns divided.
LoadMatrix part_of(const LoadMatrix& all, const std::vector<Index>& row_of,
                   const std::vector<Index>& column_of, const std::vector<double>& row_weight,
                   const std::vector<double>& column_weight) {
  LoadMatrix out(Eigen::Index(row_weight.size()), Eigen::Index(column_weight.size()));
  std::vector<Eigen::Triplet<double, Index>> entries;
  for (Eigen::Index i = 0; i < all.rows(); ++i) {
    const Index row = row_of[i];
    if (row < 0) continue;
    for (LoadMatrix::InnerIterator entry(all, i); entry; ++entry)
      if (const Index column = column_of[entry.col()]; column >= 0)
        entries.emplace_back(row, column, entry.value() * row_weight[row] / column_weight[column]);
  }
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

// Square roots of shares whose mean is one.
std::vector<double> roots(std::vector<double> shares) {
  double sum = 0;
  for (const double share : shares) sum += share;
  for (double& share : shares) share = std::sqrt(share * double(shares.size()) / sum);
  return shares;
}

// Movable vertices of one kind, with their constraints in units of their roots.
struct Movable {
  std::vector<Index> vertices;
  std::vector<double> root;  // roots of the vertices' shares of area or length
  LoadMatrix g;              // scaled by the roots
};

// The requested amount, or that from the estimated scatter; 0: none. Curves and inner vertices may
// scatter differently, so each kind has its own.
struct Reading {
  EaseSystem system;
  double s = 0;
};

class Easing {
 public:
  // All references must outlive it.
  Easing(const Mending& mending, const EaseOptions& wanted, Monitor& monitor)
      : mending_(mending),
        wanted_(wanted),
        monitor_(monitor),
        watch_(report_, monitor),
        problem_(make_problem(mending.mesh(), mending.options(), watch_, report_)),
        mesh_(problem_->mesh),
        systems_(*problem_, monitor),
        at_(mending.mesh().coordinates.begin(), mending.mesh().coordinates.end()) {}

  EaseResult run() {
    monitor_.enter_part(0, 0.25);
    StrainGauge::require_room(*problem_, rings_between_probes, report_.predicted_bytes);
    ControlPositions control = problem_->basis;
    PlateLoads plate = loads_of(control);
    measure_matrix();
    out_.before = gauge_->excess(plate.turned, control);
    out_.moves.assign(std::size_t(mesh_.input_vertices), Vec3::Zero());
    if (wanted_.most > 0) {
      move_worst(std::move(plate.turned), control);
    } else {
      find_movable();
      // Scatter also causes moments on borders, which cannot be distinguished from those of the
      // shape: with them, results for few vertices with faint scatter are up to a tenth worse.
      // A curve has too few vertices to estimate scatter: that of inner vertices is a bound, and if
      // they have an estimate, a curve without one stays.
      Reading inner = read_inner(plate.free, control);
      const Reading curve = read_curve(control);
      double s = inner.s > 0 ? curve.s : amount(curve_, curve);
      if (wanted_.amount < 0 && inner.system.unknowns() > 0)
        s = with_noise_up_to(curve.system, s, inner.system.noise(amount(inner_, inner)));
      if (apply(curve_, curve.system, s)) {
        control = problem_->control_positions(at_);
        inner = read_inner(loads_of(control).free, control);
      }
      apply(inner_, inner.system, amount(inner_, inner));
    }
    const ControlPositions after = problem_->control_positions(at_);
    out_.after = gauge_->excess(loads_of(after).turned, after);
    restore();
    return std::move(out_);
  }

 private:
  PlateLoads loads_of(const ControlPositions& control) {
    ++out_.iterations;
    return solve_loads(*problem_, systems_, control, watch_);
  }

  bool stays(std::size_t v) const { return !wanted_.fixed.empty() && wanted_.fixed[v]; }

  void measure_matrix() {
    gauge_.emplace(*problem_, systems_, rings_between_probes, [&](double begin, double end) {
      monitor_.enter_part(0.25 + 0.625 * begin, 0.25 + 0.625 * end);
    });
    monitor_.enter_part(0.875, 1);
    out_.iterations += gauge_->solves();
  }

  void find_movable() {
    std::vector<Index> rows(gauge_->vertices().size(), -1);
    std::vector<double> shares;
    for (std::size_t i = 0; i < gauge_->on_pads(); ++i) {
      const auto v = std::size_t(gauge_->vertices()[i]);
      if (stays(v)) continue;
      rows[i] = Index(inner_.vertices.size());
      inner_rows_.push_back(Eigen::Index(i));
      inner_.vertices.push_back(Index(v));
      shares.push_back(systems_.plate().hats()->total(v));
    }
    inner_.root = roots(std::move(shares));
    inner_.g = part_of(gauge_->matrix(), rows, rows, inner_.root, inner_.root);

    const CurveLoads& curves = gauge_->curves();
    for (std::size_t i = 0; i < curves.vertices().size(); ++i) {
      const Index v = curves.vertices()[i];
      if (stays(std::size_t(v)) || mesh_.vertex_part(v) != RegionPart::inside) continue;
      curve_.vertices.push_back(v);
      curve_.root.push_back(curves.roots()[i]);
    }
    const LoadMatrix& differences = curves.differences();
    const std::vector<Index> columns = numbered(std::size_t(mesh_.vertex_count()), curve_.vertices);
    std::vector<Index> all_rows(std::size_t(differences.rows()));
    std::iota(all_rows.begin(), all_rows.end(), Index(0));
    curve_.g = part_of(differences, all_rows, columns, std::vector<double>(all_rows.size(), 1.0),
                       curve_.root);
  }

  Reading read_inner(const Loads& loads, const ControlPositions& control) const {
    const Columns all = gauge_->loads(loads, control);
    Columns own(Eigen::Index(inner_rows_.size()), 3);
    for (std::size_t i = 0; i < inner_rows_.size(); ++i)
      own.row(Eigen::Index(i)) = inner_.root[i] * all.row(inner_rows_[i]);
    Reading out = read({inner_.g, std::move(own)});
    if (wanted_.amount >= 0 || !(out.s > 0)) return out;
    const Scatter scatter =
        scatter_of(mesh_, control.working, inner_.vertices, inner_.root, out.system);
    const bool any = least_score(out.system.with_loads(scatter.loads)) > 0;
    out.s = any ? with_noise_up_to(out.system, out.s, scatter.most) : 0;
    return out;
  }

  Reading read_curve(const ControlPositions& control) const {
    return read({curve_.g, gauge_->curves().differences() * columns_of(control.working)});
  }

  Reading read(EaseSystem system) const {
    double s = 0;
    if (system.mean() > 0)
      s = wanted_.amount >= 0 ? wanted_.amount / system.mean() : cross_validated(system);
    return {std::move(system), s};
  }

  Eigen::VectorXd bounds_of(const Movable& movable) const {
    Eigen::VectorXd bounds(Eigen::Index(movable.vertices.size()));
    for (std::size_t i = 0; i < movable.vertices.size(); ++i)
      // the margin keeps rounded coordinates within the bound
      bounds[i] = (1 - roundoff) * movable.root[i] * wanted_.tolerance[movable.vertices[i]] /
                  problem_->frame.scale;
    return bounds;
  }

  // Without an estimate the largest amount within the bounds.
  double amount(const Movable& movable, const Reading& reading) const {
    if (reading.s > 0 || wanted_.tolerance.empty()) return reading.s;
    return with_moves_within(reading.system, bounds_of(movable));
  }

  // Moves them. Returns whether any moves.
  bool apply(const Movable& movable, const EaseSystem& system, double s) {
    if (!(s > 0)) return false;
    const Columns moves =
        wanted_.tolerance.empty() ? system.moves(s) : system.moves_within(s, bounds_of(movable));
    double squared = 0;
    for (std::size_t i = 0; i < movable.vertices.size(); ++i) {
      const Vec3 way =
          problem_->frame.scale / movable.root[i] * moves.row(Eigen::Index(i)).transpose();
      squared += way.squaredNorm();
      move(movable.vertices[i], way);
    }
    out_.amount = s * system.mean();
    const double trace = system.trace(s);
    out_.noise = trace > 0 ? std::sqrt(squared / trace) : 0;
    return squared > 0;
  }

  void move(Index v, const Vec3& way) {
    out_.moves[v] += way;
    for (int a = 0; a < 3; ++a) at_[3 * std::size_t(v) + std::size_t(a)] += way[a];
  }

  // Releases the vertices of the largest excess. If some of them are on curves, the inner ones are
  // chosen again with the new curves.
  void move_worst(Loads loads, ControlPositions control) {
    const auto inner = Index(gauge_->on_pads());
    std::vector<Index> worst = worst_of(out_.before, std::size_t(wanted_.most), true);
    const auto others =
        std::partition(worst.begin(), worst.end(), [&](Index r) { return r >= inner; });
    if (others != worst.begin()) {
      const auto left = std::size_t(worst.end() - others);
      worst.erase(others, worst.end());
      release(worst, gauge_->loads(loads, control));
      control = problem_->control_positions(at_);
      loads = loads_of(control).turned;
      worst = worst_of(gauge_->excess(loads, control), left, false);
    }
    release(worst, gauge_->loads(loads, control));
  }

  std::vector<Index> worst_of(const Excess& excess, std::size_t count, bool with_curves) const {
    std::vector<double> lengths(gauge_->vertices().size());
    for (std::size_t row = 0; row < (with_curves ? lengths.size() : gauge_->on_pads()); ++row)
      if (const auto v = std::size_t(gauge_->vertices()[row]); !stays(v))
        lengths[row] = std::abs(excess.own.lengths[v]);
    return worst_rows(lengths, count, gauge_->images());
  }

  // Moves the vertices of these rows, and their images, to where none of them carries a load.
  void release(const std::vector<Index>& worst, const Columns& loads) {
    std::vector<Index> rows;
    for (const Index row : worst)
      for (const Index image : gauge_->images()[row])
        if (!stays(std::size_t(gauge_->vertices()[image]))) rows.push_back(image);
    const Columns moves = moves_without_loads(gauge_->matrix(), loads, rows);
    for (std::size_t i = 0; i < rows.size(); ++i)
      move(gauge_->vertices()[rows[i]],
           problem_->frame.scale * moves.row(Eigen::Index(i)).transpose());
  }

  // Merged vertices take the position of the one that remains.
  void restore() {
    if (!mending_.mended()) return;
    const std::vector<Index>& origin = mending_.mended()->vertex_origin;
    give_to_merged(origin, out_.moves);
    fairing::restore(out_.before, origin);
    fairing::restore(out_.after, origin);
  }

  const Mending& mending_;
  const EaseOptions& wanted_;
  Monitor& monitor_;
  Report report_;
  Stopwatch watch_;
  std::unique_ptr<const FairingProblem> problem_;
  const ControlMesh& mesh_;
  FairingSystems systems_;
  std::vector<double> at_;  // positions of input vertices in world coordinates
  std::optional<StrainGauge> gauge_;
  Movable inner_, curve_;
  std::vector<Eigen::Index> inner_rows_;  // numbers of the gauge's rows
  EaseResult out_;
};

// Values of vertices, mapped to the remaining ones after merges.
struct Mapped {
  std::vector<double> tolerance;
  std::vector<std::uint8_t> fixed;
  EaseOptions options;

  Mapped(const EaseOptions& wanted, const MendedMesh* mended)
      : tolerance(wanted.tolerance.begin(), wanted.tolerance.end()),
        fixed(wanted.fixed.begin(), wanted.fixed.end()),
        options(wanted) {
    if (!mended) return;
    const std::vector<Index>& origin = mended->vertex_origin;
    for (std::size_t v = 0; v < origin.size(); ++v) {
      const auto lead = std::size_t(origin[v]);
      if (!tolerance.empty()) tolerance[lead] = std::min(tolerance[lead], tolerance[v]);
      if (!fixed.empty()) fixed[lead] |= fixed[v];
    }
    options.tolerance = tolerance;
    options.fixed = fixed;
  }
};

}  // namespace

EaseResult ease_control_mesh(const PolygonMesh& input, const FairOptions& options,
                             const EaseOptions& wanted, Monitor& monitor) {
  const CancelScope scope(&monitor);
  return with_named_errors([&] {
    FairOptions own = options_of_strain(options);
    if (input.vertex_count() > on_second_level) own.levels = 1;
    const MemoryLedger ledger(own.bytes_allowed());
    const Mending mending(input, own);
    const Mapped mapped(wanted, mending.mended());
    EaseResult out =
        mending.in_input_ids([&] { return Easing(mending, mapped.options, monitor).run(); });
    monitor.enter_part(0, 1);
    monitor.report(Phase::done, 1);
    return out;
  });
}

}  // namespace fairing
