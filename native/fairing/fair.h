// SPDX-License-Identifier: GPL-3.0-or-later
// The driver: plain arrays in, fair surface and report out. All coordinates are world coordinates.
#pragma once

#include <new>
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
  std::vector<Array<double>> shapes;  // likewise, for each shape
  OutputFaces faces;
  Array<std::int32_t> crease_edges;  // 2 vertices per edge, from crease_edges() in fairing/output.h
  Report report;
  std::optional<MendedMesh> mended{};  // the mesh that was faired, if it is not the input
};

// The error of a run that could not allocate.
FairingError out_of_memory();

// Returns the result of a call; replaces std::bad_alloc by FairingError.
template <class Call>
auto with_named_errors(Call&& call) {
  try {
    return call();
  } catch (const std::bad_alloc&) {
    throw out_of_memory();
  }
}

// The end of a run whose points are computed: faces, crease edges, warnings of memory, progress.
void finish(const FairingProblem& problem, const MemoryLedger& ledger, Stopwatch& watch,
            Monitor& monitor, FairResult& result);
// Translates a result of the mended mesh back to the input.
void restore(const Mending& mending, FairResult& result);

// The fair surface of a mesh, and of all shapes of `options`. Only reads the arrays of `mesh`. May
// run on any thread; other threads may watch `monitor`. Throws FairingError only, with cancelled
// and out_of_memory among its codes.
FairResult fair(const PolygonMesh& mesh, const FairOptions& options, Monitor& monitor);

// Fairs one control mesh repeatedly while its vertices move. Keeps what fair() builds and the last
// surface, from which the next one starts. All calls, the destructor included, must come from one
// thread. Throws FairingError only.
class FairSolver {
 public:
  // Checks and builds; does not solve. `options` without shapes; back_leg is refused (bad_option).
  // `monitor` watches all calls.
  FairSolver(const PolygonMesh& input, const FairOptions& options, Monitor& monitor);

  // Points of a surface after its sheets are joined.
  std::size_t points() { return JoinedSheets(systems_->finest()).size(); }

  // out <- the surface of these positions, 3 numbers for each input vertex (empty: the last ones),
  // with the charts, stencils and curve parameters as built. The first surface is that of fair().
  // After an error the next solve does not use an earlier surface.
  Report solve(std::span<const double> coordinates, double* out);

  // Builds again with these positions. `input` must have the same faces; mending is not repeated.
  // After an error the old positions remain, and the next solve does not use an earlier surface.
  void rebase(const PolygonMesh& input);

  OutputFaces faces();
  // The mesh that is faired, if it is not the input; otherwise null.
  const MendedMesh* mended() const { return mending_.mended(); }
  Array<std::int32_t> creases() const;
  // Bytes of the long arrays and factors that are kept.
  std::size_t bytes() const { return ledger_.current(); }

 private:
  Report solve_mended(std::span<const double> coordinates, double* out);
  void rebase_mended(const PolygonMesh& input);
  void set_control(std::span<const double> coordinates);
  void solve_cold(Stopwatch& watch, Report& report);
  bool solve_warm(Stopwatch& watch, Report& report);
  void write(Stopwatch& watch, Report& report, double* out);
  void forget_surfaces();
  template <class Call>
  auto guarded(Call&& call);

  MemoryLedger ledger_;
  Monitor& monitor_;
  Report built_;  // the report of building, copied into every surface's report
  Stopwatch build_watch_;
  Mending mending_;
  std::unique_ptr<const FairingProblem> problem_;
  std::unique_ptr<FairingSystems> systems_;
  ControlPositions control_;  // of the last call; solvers refer to its arrays
  RecentSurfaces recent_;
  bool was_far_out_ = false;  // the last surface is no start for another (fairing/extremes.h)
  Array<double> apart_;       // the last surface in world coordinates, if it has several sheets
};

}  // namespace fairing
