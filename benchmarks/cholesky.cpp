// SPDX-License-Identifier: GPL-3.0-or-later
// Our solver beside sparse Cholesky factorizations of the very same system, in one process, in
// turns.
//
// fairing_bench_cholesky MESH LEVELS THREADS REPEATS [ldlt]
//
// MESH is a text file: vertices and faces counted, three coordinates a vertex, then a face a line,
// corners counted first. Prints one JSON object. Seconds are of the wall clock and of the
// processor, lists in the order of the runs.
//
// What is timed on either side starts from the stencils and ends with all three coordinates:
//   ours      levels, diagonals, full multigrid from the control polyhedron to a relative residual
//   of 1e-8 cholesky  ordering, factorization, three right-hand sides; the assembly of the matrix
//   apart, and CHOLMOD's
//             ordering and symbolic analysis once more by itself
//   kept      the three right-hand sides alone, with the factorization kept
#include <Eigen/CholmodSupport>
#include <Eigen/SparseCholesky>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <memory>
#include <string>

#include "constraints/control_constraints.h"
#include "curves/feature_curves.h"
#include "fairing/control_positions.h"
#include "fairing/options.h"
#include "grid/linear.h"
#include "mesh/validate/check.h"
#include "thin_plate/solver.h"

namespace {

using namespace fairing;
constexpr int kKept = 10;  // solves with the kept factorization for each whole run
using Three = Eigen::Matrix<double, Eigen::Dynamic, 3>;

OwnedPolygonMesh read_mesh(const char* path) {
  std::ifstream in(path);
  std::size_t vertices = 0, faces = 0;
  in >> vertices >> faces;
  OwnedPolygonMesh mesh;
  mesh.coordinates.resize(3 * vertices);
  for (double& c : mesh.coordinates) in >> c;
  for (std::size_t f = 0; f < faces; ++f) {
    int size = 0;
    in >> size;
    for (std::int64_t corner = 0; size > 0 && in >> corner; --size) mesh.corners.push_back(corner);
    mesh.offsets.push_back(std::int64_t(mesh.corners.size()));
  }
  if (!in) throw std::runtime_error(std::string("cannot read ") + path);
  return mesh;
}

// Wall and processor seconds of one competitor, run by run.
struct Times {
  std::vector<double> wall, processor;

  template <class Body>
  void run(Body&& body) {
    const auto start = std::chrono::steady_clock::now();
    const double before = processor_now();
    body();
    processor.push_back(processor_now() - before);
    wall.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }

 private:
  static double processor_now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  }
};

void print(const char* key, const std::vector<double>& values) {
  std::printf("\"%s\": [", key);
  for (std::size_t i = 0; i < values.size(); ++i) std::printf("%s%.6g", i ? ", " : "", values[i]);
  std::printf("]");
}

void print(const char* key, const Times& times) {
  std::printf(", \"%s\": {", key);
  print("wall", times.wall);
  std::printf(", ");
  print("processor", times.processor);
  std::printf("}");
}

// The race on one mesh: what both sides share.
class Race {
 public:
  Race(const OwnedPolygonMesh& input, int levels, int threads) : workers_(threads) {
    options_.levels = levels;
    mesh_ = make_control_mesh(input.view(), options_.features, {});
    const Frame frame = working_frame(mesh_, mesh_.positions);
    for (Vec3& p : mesh_.positions) p = frame.to_working(p);
    curves_ =
        refine_feature_edges(mesh_, mesh_.positions, mesh_.positions, options_.curve_scheme());
    stencils_ = make_stencils(mesh_, ChartMaker(mesh_), workers_);
    unknowns_.vertex.assign(std::size_t(mesh_.vertex_count()), 0);
    for (const auto feature : mesh_.feature_edge) unknowns_.edge.push_back(!feature);
    grid_ = std::make_unique<GridLevel>(mesh_, levels);
  }

  const GridLevel& grid() const { return *grid_; }

  // Ours; returns the iterations on the finest level.
  int multigrid(Array<double>& x) {
    ThinPlateOptions options;
    options.levels = options_.levels;
    ThinPlateSolver system(mesh_, ChartMaker(mesh_), stencils_, unknowns_, {}, options, workers_,
                           monitor_);
    const PlateData data{mesh_.positions, curves_};
    BallConstraints constraints = system.begin({mesh_, mesh_.positions, unknowns_});
    std::vector<LevelReport> reports;
    PlateSurface surface;
    for (int level = system.levels().base(); level <= system.levels().top(); ++level)
      surface = system.solve_level(level, data, constraints, surface, reports, {});
    x = std::move(surface.x);
    return reports.back().iterations;
  }

  AssembledSystem assemble() {
    return assemble_thin_plate(*grid_, stencils_, unknowns_, {}, workers_);
  }

  // The right-hand side of a correction to the control polyhedron, which goes into x.
  Three right_hand_side(const AssembledSystem& system, Array<double>& x) {
    x.resize(3 * grid_->size());
    Array<double> image(x.size());
    refine_linearly(*grid_, mesh_.positions, workers_, x.data());
    const ThinPlateRows<double> rows(mesh_, stencils_);
    ElementSlots<double> slots;
    apply_thin_plate(*grid_, rows, unknowns_, {}, workers_, slots, x.data(), image.data());
    Three b(Eigen::Index(system.unknown_points.size()), 3);
    for (std::size_t i = 0; i < system.unknown_points.size(); ++i)
      for (std::size_t a = 0; a < 3; ++a)
        b(Eigen::Index(i), Eigen::Index(a)) = -image[3 * std::size_t(system.unknown_points[i]) + a];
    return b;
  }

 private:
  FairOptions options_;
  Workers workers_;
  Monitor monitor_;
  ControlMesh mesh_;
  FeatureCurves curves_;
  Stencils stencils_;
  Unknowns unknowns_;
  std::unique_ptr<GridLevel> grid_;
};

using Supernodal = Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower>;

template <class Solver>
void factor(Solver& solver, const SparseMatrix& matrix) {
  solver.compute(matrix);
  if (solver.info() != Eigen::Success) throw std::runtime_error("the factorization failed");
}

template <class Solver>
Three factor_and_solve(const SparseMatrix& matrix, const Three& b) {
  Solver solver;
  factor(solver, matrix);
  return solver.solve(b);
}

// The largest distance between two solutions: ours, and a start with its correction.
double distance(const Array<double>& ours, const Array<double>& start,
                const AssembledSystem& system, const Three& correction) {
  double largest = 0;
  for (std::size_t i = 0; i < system.unknown_points.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t at = 3 * std::size_t(system.unknown_points[i]) + a;
      largest = std::max(
          largest, std::abs(ours[at] - start[at] - correction(Eigen::Index(i), Eigen::Index(a))));
    }
  return largest;
}

void race(const char* path, int levels, int threads, int repeats, bool with_ldlt) {
  const OwnedPolygonMesh input = read_mesh(path);
  Race race(input, levels, threads);
  Times multigrid, assembly, analysis, cholmod, kept, ldlt;
  AssembledSystem system;
  assembly.run([&] { system = race.assemble(); });
  Array<double> start, ours;
  const Three b = race.right_hand_side(system, start);
  Three correction;
  int iterations = 0;
  for (int r = 0; r < repeats; ++r) {
    analysis.run([&] {
      Supernodal solver;
      solver.analyzePattern(system.matrix);
    });
    // a factorization warms or cools everything for the next run: ours goes before and after it
    multigrid.run([&] { iterations = race.multigrid(ours); });
    cholmod.run([&] { correction = factor_and_solve<Supernodal>(system.matrix, b); });
  }
  Supernodal factored;
  factor(factored, system.matrix);
  for (int r = 0; r < kKept * repeats; ++r) kept.run([&] { correction = factored.solve(b); });
  const double cholmod_distance = distance(ours, start, system, correction);
  const double residual = (system.matrix * correction - b).norm() / b.norm();
  double ldlt_distance = -1;
  if (with_ldlt) {
    ldlt.run([&] {
      correction =
          factor_and_solve<Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower>>(system.matrix, b);
    });
    ldlt_distance = distance(ours, start, system, correction);
  }
  std::printf(
      "{\"points\": %zu, \"unknowns\": %zu, \"nonzeros\": %lld, \"iterations\": %d, \"threads\": "
      "%d",
      race.grid().size(), system.unknown_points.size(), (long long)system.matrix.nonZeros(),
      iterations, threads);
  std::printf(", \"cholmod_distance\": %.3g, \"cholmod_residual\": %.3g, \"ldlt_distance\": %.3g",
              cholmod_distance, residual, ldlt_distance);
  print("ours", multigrid);
  print("assembly", assembly);
  print("analysis", analysis);
  print("cholmod", cholmod);
  print("kept", kept);
  print("ldlt", ldlt);
  std::printf("}\n");
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 5) {
    std::fprintf(stderr, "usage: %s MESH LEVELS THREADS REPEATS [ldlt]\n", arguments[0]);
    return 2;
  }
  try {
    race(arguments[1], std::stoi(arguments[2]), std::stoi(arguments[3]), std::stoi(arguments[4]),
         count > 5 && !std::strcmp(arguments[5], "ldlt"));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
