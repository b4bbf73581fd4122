// SPDX-License-Identifier: GPL-3.0-or-later
// The augmented-Lagrangian iteration that holds control vertices while a linear system is solved,
// for both energies: in space (N = 3, the thin plate) and along normals (N = 1, a Gauss-Newton
// step). With the springs W of control vertices, their targets c, loads f on pads and moments m of
// couples,
//
//   (K + W) x = b + W c + Omega (sum_c f_c phi_c + sum_c n_c psi_c . m_c)
//
// is solved for x with the current multipliers. Then x corrects these:
//
//   f   by M^-1 r, with r the forces left at vertices on pads (multipliers.h). A vertex on a spring
//       of weight w gives way: with s the stiffness of the surface there, and T the total of each
//       hat, by (M + (s / w) T)^-1 (1 + s / w) r.
//   c   within tolerances: ball_constraints.h, interval_constraints.h.
//   m   by the slopes that violate fixed normals (couples.h).
//
// The corrections affect each other; Anderson's acceleration treats all of them as one vector.
//
// Solves between corrections are short. The residual r of such a solve would still move control
// vertices and change their forces by H^T r, with H the cardinal surfaces of K, approximated by the
// prolongation from the control vertices. Forces and positions are corrected by that before they
// are read. (Without it a cube at level 7 ended 4e-4 off its sphere; a torus took 14 iterations in
// place of 11.)
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "constraints/anderson.h"
#include "constraints/ball_constraints.h"
#include "constraints/held_report.h"
#include "constraints/interval_constraints.h"
#include "constraints/multipliers.h"
#include "multigrid/hierarchy.h"

namespace fairing {

// Share of the error that remains after each short solve. On 151 runs on pads finest levels took
// 1,018 iterations; 988 with 0.35 and 975 with 0.5.
constexpr double solve_gain = 0.25;

// Most corrections of one held solve.
constexpr int most_corrections = 32;

// When a held solve ends. Shares of the first correction are those of its norm.
struct HeldLimits {
  // Of the last solve; if it is `from_start`, of every one.
  PcgLimits solve{};
  // Whether the last solve is a whole one. If not, the rest is less than the next step's change.
  bool ends_whole = false;
  // Of the loads' correction: relative to the loads, or to the first correction.
  double force = 0, of_first_force = 0;
  double angle = std::numeric_limits<double>::infinity();  // to a fixed tangent plane, radians
  double gap = 0, of_first_gap = 0;    // relative to the energy, or to the first gap
  int corrections = most_corrections;  // with the same springs
};

// The linear system, N numbers a point. Control vertices come first.
template <int N>
struct HeldSystem {
  using Vector = Eigen::Matrix<double, N, 1>;

  Workers& workers;
  std::size_t size;  // of x
  const Unknowns& unknowns;
  const VertexWeights& weights;       // of the current springs; empty: none
  std::span<const double> stiffness;  // at each control vertex that moves; empty: none moves
  const Hats* hats;                   // null: point forces hold control vertices
  const LevelCouples* couples;        // null: no fixed normals
  // The point to which a control vertex's spring pulls.
  std::function<Vector(std::size_t v)> target;
  // r <- b - K x without springs, on the unknowns and on vertices on pads.
  std::function<void(const double* x, double* r)> residual;
  std::function<LevelSolve(const PcgLimits&, const LinearSystem&)> solve;
  // sums <- H^T r for control vertices; empty: the prolongation does not approximate H, and the
  // vertices' own rows are used.
  std::function<void(std::span<const double> r, std::span<Vector> sums)> restrict_to_vertices;
  std::function<void(const VertexWeights&)> set_weights{};     // of the constraints, to which
  std::function<double(const double* x)> energy{};             // gaps are relative to it
  std::function<const Compliance&()> compliance_of_couples{};  // with fixed normals
};

template <int N>
class HeldSolve {
 public:
  using Constraints = std::conditional_t<N == 3, BallConstraints, IntervalConstraints>;
  using Vector = typename HeldSystem<N>::Vector;

  // `constraints`: null if no control vertex has a tolerance. All must outlive it.
  HeldSolve(const HeldSystem<N>& system, const HeldLimits& limits, Constraints* constraints,
            Multipliers<N>& multipliers, HeldReport& report);
  HeldSolve(const HeldSolve&) = delete;  // its steps use its own product

  // Improves x in place, together with its multipliers. r: room for a residual. `residual` of the
  // result is relative to the limits' scale, whatever each solve's own tolerance was.
  LevelSolve run(double* x, double* r);

  // Whether loads and couples had settled at the end.
  bool loads_settled() const { return loads_settled_; }
  // The product of all solves' gains, as a logarithm of residuals.
  double gain() const { return gain_; }

 private:
  // The quantity that corrections reduce, and the share that one correction leaves: that of a
  // solve, until two corrections have measured it.
  struct Convergence {
    double now = 0, first = 0, share = solve_gain;

    void set(double next);
  };
  // Squared norms of the multipliers and of their correction, by M.
  struct Sizes {
    double left = 0, all = 0;
  };

  double spring(std::size_t v) const {
    return system_.unknowns.vertex[v] && !system_.weights.empty() ? system_.weights[v] : 0.0;
  }
  bool on_pad(std::size_t v) const { return system_.hats && system_.hats->under(v); }

  void compute_residual(const double* x, double* r);
  template <class Away>
  void add_springs(Away&& away, const LoadsOf<N>& loads, LoadsOf<N>& forces, double* r) const;
  void solve(bool whole);
  void correct_by_residual(bool direct);
  Sizes correct_loads();
  Sizes correct_couples();
  bool check_loads();
  bool check_bounds();
  bool nearly_settled() const;
  void correct();
  Array<double> product(const Array<double>& numbers) const;

  const HeldSystem<N>& system_;
  const HeldLimits limits_;
  Constraints* constraints_;
  Multipliers<N>& multipliers_;
  HeldReport& report_;
  Multipliers<N> correction_{};
  std::vector<double> bound_weights_;  // which make shifts of targets comparable with loads
  Anderson steps_;                     // accelerates corrections, in the norm of M
  LoadsOf<N> own_forces_, forces_;     // left at vertices on pads: by their own rows, and corrected
  LoadsOf<N> vertices_;                // their positions after a whole solve
  double *x_ = nullptr, *r_ = nullptr;
  Convergence force_{}, gap_{};  // forces and slopes together
  double tilt_ = 0;  // of a tangent plane from a fixed one; a normal may point to the wrong side
  int corrections_ = 0;  // with these springs
  int iterations_ = 0;   // of this run
  bool loads_settled_ = true;
  LevelSolve solved_{};
  double gain_ = 0;
};

}  // namespace fairing
