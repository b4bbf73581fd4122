// SPDX-License-Identifier: GPL-3.0-or-later
// The same control mesh again and again while its vertices move.
#pragma once

#include <span>

#include "fair/kept_run.h"
#include "fair/recent_surfaces.h"

namespace fairing {

// Keeps what fair() builds, and the last surface, from which the next one starts. All calls, the destructor's too, have to
// come from one thread, and one after the other. Throws FairingError and nothing else.
class FairSolver {
 public:
  // Checks and builds; solves nothing. `options` without shapes.
  // `monitor` watches all calls.
  FairSolver(const PolygonMesh& input, const FairOptions& options, Monitor& monitor);

  // The surface of these positions of the input's vertices (empty: as last), with charts, stencils and parameters of curves as
  // built: 3 numbers a point of the result. The first is that of fair(). After an error the next one starts from nothing.
  std::size_t points() { return run_.finest().size(); }
  Report solve(std::span<const double> coordinates, double* out);

  // Builds anew about these positions. `input` has the same faces as ever.
  void rebase(const PolygonMesh& input);

  OutputFaces faces() { return make_faces(run_.finest(), run_.workers()); }
  Array<std::int32_t> creases() const { return crease_edges(run_.mesh()); }
  // Of the long arrays and factors that are kept.
  std::size_t bytes() const { return ledger_.current(); }

 private:
  void take_place(std::span<const double> coordinates);
  void solve_afresh(Stopwatch& watch, Report& report);
  bool solve_on(Stopwatch& watch, Report& report);
  void write(Stopwatch& watch, Report& report, double* out);
  void start_anew();
  template <class Call>
  auto guarded(Call&& call);

  MemoryLedger ledger_;
  Monitor& monitor_;
  Report built_;  // what is to be said with every surface
  Stopwatch build_watch_;
  KeptRun run_;
  Placement place_;  // of the last call; its arrays stay where they are
  RecentSurfaces recent_;
  Array<double> released_;  // the surface with control vertices let go by epsilon
};

}  // namespace fairing
