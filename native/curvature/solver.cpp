// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature/solver.h"

#include <cmath>
#include <limits>
#include <utility>

#include "curvature/start.h"
#include "curvature/total_curvature.h"
#include "hold/pad_widths.h"
#include "parallel/reductions.h"

namespace fairing {
namespace {

// Plain steps until plain_decrement, where nothing is known of how they go.
constexpr int long_patience = 14;

// Plain steps below the finest level end here on pads: what is left is less than what the next level
// changes.
constexpr double start_decrement = 1e-2;

// After control vertices have moved: a change of the energy, relative, at which what only
// preconditions may stay as it is.
constexpr double nearby = 0.02;

// A star that has folded on pads counts as one of so many times the energy.
constexpr double price_of_folds = 8;
// Rounds in which pads beside folds are taken away on the finest level: those in the folds' stars,
// and one ring more each time.
constexpr int most_rounds = 3;

// Of each control vertex: the folds in its star.
std::vector<std::size_t> folds_of_stars(const ControlMesh& mesh, const Folds& folds) {
  std::vector<std::size_t> stars(std::size_t(mesh.vertex_count()), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    for (const Spoke& spoke : mesh.ring(v)) {
      stars[std::size_t(v)] += folds.on_edge[std::size_t(spoke.edge)];
      if (spoke.face >= 0) stars[std::size_t(v)] += folds.in_face[std::size_t(spoke.face)];
    }
  return stars;
}

// Marks the neighbours of marked control vertices.
void dilate_vertices(const ControlMesh& mesh, std::vector<std::uint8_t>& marks) {
  const std::vector<std::uint8_t> before = marks;
  for (const Edge& edge : mesh.edges) {
    const auto a = std::size_t(edge.vertex[0]), b = std::size_t(edge.vertex[1]);
    marks[a] |= before[b];
    marks[b] |= before[a];
  }
}

// On pads the least total curvature is another's least: it may be a little above the plate's.
constexpr double most_over_plate = 1.2;
// So many times as far from the mesh's centre as the plate: a surface that has folded there is a
// spike. One that has not may be the large sphere through a flat cap.
constexpr double farthest_over_plate = 2;

}  // namespace

GaussNewtonSolver::GaussNewtonSolver(const ControlMesh& mesh,
                                     const std::vector<CurvatureGrid>& levels, int base,
                                     const Stencils& stencils, const Unknowns& unknowns,
                                     const GaussNewtonOptions& options, HoldAlongNormals hold,
                                     const Pads* pads, Mirrors mirrors, Workers& workers,
                                     Monitor& monitor)
    : options_(options),
      hold_(std::move(hold)),
      pads_(pads),
      system_(mesh, levels, base, stencils, unknowns, options, std::move(mirrors), workers,
              monitor),
      iterate_{system_},
      folded_faces_(folded_control_faces(mesh, hold_.targets(), workers)),
      steps_(iterate_, options_),
      unfolding_(iterate_, hold_, folded_faces_, steps_),
      variation_(iterate_, options_) {
  system_.hold_by(&hold_);
}

CurvatureLevelReport GaussNewtonSolver::solve_level(int level, const Array<double>& plate) {
  CurvatureLevelReport report;
  report.level = level;
  if (level < system_.base()) return report;
  const StepWork before = system_.work(level);
  if (system_.stand_on(pads_)) iterate_.current.held.loads.clear();
  system_.allow_blocks(stepping_ != Stepping::damped);
  choose_start(iterate_, level, plate, plate_below_, report);
  const StepStart start{iterate_.current.points, iterate_.current.held, report};
  plate_below_.assign(plate.begin(), plate.begin() + std::ptrdiff_t(start.points.size()));
  solve_total_curvature(start, plate, report);
  if (is_finest()) remember(report);
  leave_out_tension(start, plate, report);
  report.work = system_.work(level) - before;
  return report;
}

void GaussNewtonSolver::solve_total_curvature(const StepStart& start, const Array<double>& plate,
                                              CurvatureLevelReport& report) {
  if (system_.pads() &&
      iterate_.level == std::clamp(widths_level, system_.base(), system_.finest()))
    choose_widths(start, report);
  else
    minimize(start, effort_of_level(), report);
  if (is_finest()) return finish(start, plate, report);
  keep_start_if_worse(start, plate, report);
}

StepEnd GaussNewtonSolver::end_of(Effort effort) {
  if (effort == Effort::accurate) return steps_.accurate_end();
  if (effort == Effort::judging) return {damped_decrement, 0};
  return {system_.pads() ? start_decrement : plain_decrement, 0};
}

StepStart GaussNewtonSolver::start_again(const StepStart& start, Array<double> points,
                                         double plate_energy, CurvatureLevelReport& report) {
  surface() = std::move(points);
  iterate_.is_linearized = false;
  report = start.report;
  report.plate_energy = plate_energy;
  return {surface(), iterate_.current.held, report};
}

// Plain steps first, on every level: where they fail on a coarse one, they may do on a finer one.
// They stand if they come near a solution and have never failed so far, be it not as near as was
// promised; else damped steps from the same start show whether they have found a worse surface.
// Widths of pads are judged without another try.
void GaussNewtonSolver::minimize(const StepStart& start, Effort effort,
                                 CurvatureLevelReport& report) {
  const bool is_accurate = effort == Effort::accurate, doubtful = stepping_ == Stepping::damped;
  if (!doubtful || effort != Effort::judging) {
    steps_.run_plain(end_of(effort), doubtful && is_accurate ? short_patience : long_patience,
                     report);
    if (is_settled(report) && stepping_ == Stepping::plain) return;
  }
  LinearizedSurface plain = iterate_.current;
  const CurvatureLevelReport plain_report = std::exchange(report, start.report);
  iterate_.current.points = start.points;
  iterate_.current.held = start.held;
  // A crumpled surface is hard for blocks too, and what they leave of a solve upsets the loads.
  system_.allow_blocks(false);
  LocalDamping damping(iterate_.grid(), system_.shared().unknowns, iterate_.workers());
  steps_.run_damped(damping, report);
  if (is_accurate) steps_.finish_damped(damping, report);
  const bool plain_is_as_good =
      is_settled(plain_report) && plain_report.energy <= equal_energy * report.energy;
  stepping_ = plain_is_as_good ? Stepping::plain : Stepping::damped;
  report.damped = !plain_is_as_good;
  if (!plain_is_as_good) return;
  iterate_.current = std::move(plain);
  report = plain_report;
}

// The surface on point forces says what each star costs at the least, and is where those on pads
// start: they have its shape, but for the marks.
void GaussNewtonSolver::choose_widths(const StepStart& start, CurvatureLevelReport& report) {
  const auto stars = [&] {
    return total_curvature_of_stars(iterate_.grid(), iterate_.workers(), surface().data());
  };
  {
    const GaussNewtonSystem::OffPads off_pads(system_);
    iterate_.is_linearized = false;
    minimize(start, Effort::judging, report);
  }
  const std::vector<double> of_needles = stars();
  const std::vector<std::size_t> folds_of_needles =
      folds_of_stars(system_.mesh(), unfolding_.find());
  double mean = 0;
  for (const double energy : of_needles) mean += energy / double(of_needles.size());
  const Array<double> needles = surface();
  const double energy_of_needles = report.energy;
  const double bound = std::max(start.report.plate_energy, energy_of_needles);
  int round = 0;
  for (;; ++round) {
    minimize(start_again(start, needles, bound, report), Effort::judging, report);
    std::vector<double> energy = stars();
    const std::vector<std::size_t> folds = folds_of_stars(system_.mesh(), unfolding_.find());
    for (std::size_t v = 0; v < energy.size(); ++v)
      if (folds[v] > folds_of_needles[v])
        energy[v] = std::max(energy[v], price_of_folds * (of_needles[v] + mean));
    const std::vector<int> halvings =
        halvings_of_pads(system_.grid(0), *system_.pads(), energy, of_needles, round);
    if (halvings.empty()) break;
    narrow_pads<1>(halvings, *system_.pads(), iterate_.current.held.loads);
  }
  const bool is_crumpled = !(report.energy <= crumpled * energy_of_needles);
  if (is_crumpled) {  // no widths will do
    const std::vector<int> all(of_needles.size(), to_nothing);
    narrow_pads<1>(all, *system_.pads(), iterate_.current.held.loads);
  }
  // Widths that have not changed go on from the surface that they were judged by.
  const bool stands = round == 0 && !is_crumpled;
  minimize(start_again(start, stands ? surface() : needles,
                       is_crumpled ? start.report.plate_energy : bound, report),
           effort_of_level(), report);
}

void GaussNewtonSolver::leave_folds(const StepStart& start, CurvatureLevelReport& report) {
  for (int round = 0; round < most_rounds; ++round) {
    const std::vector<std::size_t> folds = folds_of_stars(system_.mesh(), unfolding_.find());
    std::vector<std::uint8_t> near(folds.size());
    for (std::size_t v = 0; v < near.size(); ++v) near[v] = folds[v] > 0;
    for (int ring = 0; ring < round; ++ring) dilate_vertices(system_.mesh(), near);
    std::vector<int> halvings(folds.size(), 0);
    bool any = false;
    for (std::size_t v = 0; v < near.size(); ++v)
      if (near[v] && system_.pads()->under(v)) {
        halvings[v] = to_nothing;
        any = true;
      }
    if (!any) return;
    narrow_pads<1>(halvings, *system_.pads(), iterate_.current.held.loads);
    minimize(start_again(start, surface(), start.report.plate_energy, report), Effort::accurate,
             report);
  }
}

// What the finest level's surface has beyond those of coarser ones.
void GaussNewtonSolver::finish(const StepStart& start, const Array<double>& plate,
                               CurvatureLevelReport& report) {
  if (system_.pads()) leave_folds(start, report);
  unfolding_.run(start, report);
  if (hold_.any()) fix_held(report);
  keep_start_if_worse(start, plate, report);
  if (varies()) variation_.run(steps_.accurate_end(), report);
}

void GaussNewtonSolver::remember(CurvatureLevelReport& report) {
  solved_folds_ = report.folds = unfolding_.find().count();
  solved_energy_ = report.energy;
  is_sound_ = report.converged;
}

void GaussNewtonSolver::fix_held(CurvatureLevelReport& report) {
  system_.shared().unknowns = hold_.without_held();
  system_.hold_by(nullptr);
  iterate_.current.held.bounds.clear();
  if (!hold_.active()) return;
  hold_.enforce(surface().data());
  iterate_.linearize();
  steps_.polish(short_patience, equal_energy * iterate_.current.energy, report);
}

double GaussNewtonSolver::tension_of(const Array<double>& x) {
  if (!(options_.tension > 0)) return 0;
  return options_.tension * surface_area(iterate_.grid(), iterate_.workers(), x.data());
}

// Of what is reported.
void GaussNewtonSolver::leave_out_tension(const StepStart& start, const Array<double>& plate,
                                          CurvatureLevelReport& report) {
  report.plate_energy -= tension_of(plate);
  report.start_energy -= tension_of(start.points);
  report.energy -= tension_of(surface());
}

// Steps may end in a fold; then the surface that they began at is the better one. Where control
// vertices are held it may have left the bounds that the thin plate's keeps.
void GaussNewtonSolver::keep_start_if_worse(const StepStart& start, const Array<double>& plate,
                                            CurvatureLevelReport& report) {
  const double bound = report.converged ? energy_bound(report) : equal_energy * report.start_energy;
  const bool is_spike = report.folds > 0 && is_thrown(surface(), plate);
  if (report.energy <= bound && !is_spike) return;
  const bool keeps_plate =
      (is_finest() && hold_.any()) || (is_spike && is_thrown(start.points, plate));
  surface() = keeps_plate ? plate : start.points;
  surface().resize(start.points.size());
  system_.symmetrizer().points(iterate_.grid(), surface());
  iterate_.current.held = start.held;
  iterate_.linearize();
  report.energy = iterate_.op().fairness();
  report.left = std::numeric_limits<double>::infinity();
  report.converged = false;
  report.kept_start = true;
}

// However long a spike of folds is, it costs the same energy.
bool GaussNewtonSolver::is_thrown(const Array<double>& x, const Array<double>& plate) {
  const auto extent = [&](const Array<double>& y) {
    return largest(iterate_.workers(), 3 * iterate_.grid().size(),
                   [&](std::size_t i) { return y[i]; });
  };
  return !(extent(x) <= farthest_over_plate * extent(plate));
}

double GaussNewtonSolver::energy_bound(const CurvatureLevelReport& report) {
  return (system_.pads() ? most_over_plate : 1.0) * report.plate_energy;
}

bool GaussNewtonSolver::is_settled(const CurvatureLevelReport& report) {
  const bool gap_closed = report.constraint_gap <= system_.wanted_gap(iterate_.level);
  return gap_closed && is_near(report, plain_decrement) && report.energy <= energy_bound(report);
}

// Where steps had to be damped, or control vertices take part in them, all levels are needed.
bool GaussNewtonSolver::can_move() const {
  return is_sound_ && stepping_ == Stepping::plain && !hold_.any();
}

void GaussNewtonSolver::leave_plate(const Array<double>& plate) {
  for_each_index(iterate_.workers(), surface().size(),
                 [&](std::size_t i) { surface()[i] -= plate[i]; });
}

bool GaussNewtonSolver::solve_moved(const Array<double>& plate, Mirrors mirrors,
                                    CurvatureLevelReport& report) {
  system_.symmetrizer().set_mirrors(std::move(mirrors));
  folded_faces_ = folded_control_faces(system_.mesh(), hold_.targets(), iterate_.workers());
  for_each_index(iterate_.workers(), surface().size(),
                 [&](std::size_t i) { surface()[i] += plate[i]; });
  system_.symmetrizer().points(iterate_.grid(), surface());
  iterate_.linearize();
  iterate_.is_linearized = true;
  report.level = iterate_.level;
  report.plate_energy = NAN;  // unknown: the thin plate's surface has not been linearized
  report.start_energy = report.energy = iterate_.op().fairness();
  if (!(report.start_energy <= unlike_energy * solved_energy_ + flat_energy)) return false;
  iterate_.is_near_earlier =
      std::abs(report.start_energy - solved_energy_) <= nearby * solved_energy_;
  report.converged = true;
  const double start_tension = tension_of(surface());
  if (varies())
    variation_.run(steps_.accurate_end(), report);
  else
    steps_.run_plain(steps_.accurate_end(), short_patience, report);
  report.folds_before = report.folds = unfolding_.find().count();
  is_sound_ = report.converged && report.folds <= solved_folds_ &&
              (varies() || report.energy <= equal_energy * report.start_energy + flat_energy);
  solved_energy_ = report.energy;
  report.start_energy -= start_tension;
  report.energy -= tension_of(surface());
  return is_sound_;
}

}  // namespace fairing
