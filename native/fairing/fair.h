// SPDX-License-Identifier: GPL-3.0-or-later
// The driver: plain arrays in, fair surface and report out. All coordinates are world coordinates.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fairing/joined_sheets.h"
#include "fairing/mending.h"
#include "fairing/output.h"
#include "fairing/systems.h"

namespace fairing {

struct FairResult {
  Array<double> vertices;             // 3 a point; the input's vertices first
  std::vector<Array<double>> shapes;  // the same of every shape
  OutputFaces faces;
  Array<std::int32_t> crease_edges;  // 2 an edge, as by crease_edges() in fairing/output.h
  Report report;
  std::optional<MendedMesh> mended{};  // what was faired, where it is not the input itself
};

// What a run says that has found no memory.
FairingError out_of_memory();

// The fair surface of a mesh, and of all shapes of `options`. Only reads the arrays of `mesh`. May
// run on any thread; `monitor` is watched from others. Throws FairingError and nothing else:
// cancelled and out_of_memory among its codes.
FairResult fair(const PolygonMesh& mesh, const FairOptions& options, Monitor& monitor);

// The same control mesh again and again while its vertices move. Keeps what fair() builds, and the
// last surface, from which the next one starts. All calls, the destructor's too, come from one
// thread, one after the other. Throws FairingError and nothing else.
class FairSolver {
 public:
  // Checks and builds; solves nothing. `options` without shapes; back_leg is refused (bad_option).
  // `monitor` watches all calls.
  FairSolver(const PolygonMesh& input, const FairOptions& options, Monitor& monitor);

  // Of a surface, its sheets joined.
  std::size_t points() { return JoinedSheets(systems_->finest()).size(); }

  // out <- the surface of these positions, 3 numbers an input vertex (empty: as last), with charts,
  // stencils and parameters of curves as built: 3 numbers a point. The first is that of fair().
  // After an error the next one starts from nothing.
  Report solve(std::span<const double> coordinates, double* out);

  // Builds anew about these positions. `input` has the same faces as ever; what was mended stays so.
  // After an error it is about the positions before, and the next surface starts from nothing.
  void rebase(const PolygonMesh& input);

  OutputFaces faces();
  // What is faired, where it is not the input itself, else null.
  const MendedMesh* mended() const { return mending_.mended(); }
  Array<std::int32_t> creases() const;
  // Of the long arrays and factors that are kept.
  std::size_t bytes() const { return ledger_.current(); }

 private:
  Report solve_mended(std::span<const double> coordinates, double* out);
  void rebase_mended(const PolygonMesh& input);
  void set_control(std::span<const double> coordinates);
  void solve_basis_first(Stopwatch& watch);
  void solve_from_nothing(Stopwatch& watch, Report& report);
  bool solve_from_last(Stopwatch& watch, Report& report);
  void write(Stopwatch& watch, Report& report, double* out);
  void forget_surfaces();
  template <class Call>
  auto guarded(Call&& call);

  MemoryLedger ledger_;
  Monitor& monitor_;
  Report built_;  // what building reports goes into every surface's report
  Stopwatch build_watch_;
  Mending mending_;
  std::unique_ptr<const FairingProblem> problem_;
  std::unique_ptr<FairingSystems> systems_;
  ControlPositions control_;  // of the last call; solvers hold on to its arrays
  RecentSurfaces recent_;
  bool was_far_out_ = false;  // the last surface is no start for another (fairing/extremes.h)
  Array<double> apart_;       // the last surface in world coordinates, where it has several sheets
};

}  // namespace fairing
