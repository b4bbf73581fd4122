// SPDX-License-Identifier: GPL-3.0-or-later
// Sixty surfaces, to be compared between machines, C libraries and processors:
//
//   fairing_surfaces write FILE     on one machine
//   fairing_surfaces compare FILE   on the other one; fails where two differ by more than `bound`
//
// docs/developers/packaging.md has what was measured.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "fairing/fair.h"
#include "meshes.h"
#include "random.h"

namespace fairing::test {
namespace {

struct Surface {
  std::string name;
  Energy energy;
  std::vector<double> coordinates;
};

struct NamedMesh {
  const char* name;
  OwnedPolygonMesh mesh;
};

struct NamedOptions {
  const char* name;
  FairOptions options;
};

constexpr const char* energy_names[] = {"thin_plate", "total_curvature", "minimum_variation"};

// The largest distance allowed between two machines' surfaces, over the size of the mesh: ten times
// what was measured, which rounding decides: the last iteration of a solve, the last step.
double bound(Energy energy) {
  switch (energy) {
    case Energy::thin_plate: return 5e-10;
    case Energy::total_curvature: return 1e-8;
    case Energy::minimum_variation: return 2e-4;
  }
  return 0;
}

// With every coordinate moved by up to `by`, which makes the solves long and their ends uncertain.
OwnedPolygonMesh rough(OwnedPolygonMesh mesh, double by) {
  std::mt19937 random(1);
  UniformReal<> offset(-by, by);
  for (double& x : mesh.coordinates) x += offset(random);
  return mesh;
}

std::vector<NamedMesh> meshes() {
  return {{"icosahedron", icosahedron()},
          {"torus", waved(torus(7, 5), 0.2)},
          {"rough", rough(torus(14, 9), 0.15)},
          {"patch", waved(triangulated(grid(5, 4)), 0.4)}};
}

std::vector<NamedOptions> variants() {
  FairOptions plain;
  plain.levels = 2;
  plain.threads = 1;
  std::vector<NamedOptions> all(5, {"default", plain});
  all[1].name = "points";
  all[1].options.pad_size = 0;
  all[2].name = "creases";
  all[2].options.features.crease_angle = 0.6;
  all[3].name = "near";
  all[3].options.interpolation = Interpolation::approximate;
  all[3].options.tolerance = {0.05};
  all[4].name = "free";
  all[4].options.features.boundary = BoundaryMode::free;
  all[4].options.metric_exponent = 1;
  return all;
}

// The surface, or nothing where the mesh is refused with these options.
std::vector<double> coordinates(const OwnedPolygonMesh& mesh, const FairOptions& options) {
  Monitor monitor;
  try {
    const FairResult result = fair(mesh.view(), options, monitor);
    return {result.vertices.begin(), result.vertices.end()};
  } catch (const FairingError&) {
    return {};
  }
}

std::vector<Surface> surfaces() {
  std::vector<Surface> all;
  for (const NamedMesh& mesh : meshes())
    for (const Energy energy :
         {Energy::thin_plate, Energy::total_curvature, Energy::minimum_variation})
      for (NamedOptions variant : variants()) {
        variant.options.energy = energy;
        const std::string name =
            std::string(mesh.name) + ' ' + energy_names[int(energy)] + ' ' + variant.name;
        all.push_back({name, energy, coordinates(mesh.mesh, variant.options)});
      }
  return all;
}

// The largest difference of two surfaces, over the extent of the first; infinite for other points.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return INFINITY;
  double largest = 0, extent = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
    extent = std::max(extent, std::abs(a[i]));
  }
  return largest == 0 ? 0 : largest / extent;
}

void write(const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  for (const Surface& surface : surfaces()) {
    const std::size_t size = surface.coordinates.size();
    file.write(reinterpret_cast<const char*>(&size), sizeof size);
    file.write(reinterpret_cast<const char*>(surface.coordinates.data()), size * sizeof(double));
  }
}

std::vector<double> read(std::ifstream& file) {
  std::size_t size = 0;
  file.read(reinterpret_cast<char*>(&size), sizeof size);
  std::vector<double> coordinates(file ? size : 0);
  file.read(reinterpret_cast<char*>(coordinates.data()), coordinates.size() * sizeof(double));
  return coordinates;
}

// The number of surfaces beyond their bound; prints them, and the largest difference by energy.
int compare(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  double largest[3] = {};
  int same = 0, beyond = 0, count = 0, empty = 0;
  for (const Surface& surface : surfaces()) {
    const double by = difference(read(file), surface.coordinates);
    largest[int(surface.energy)] = std::max(largest[int(surface.energy)], by);
    ++count;
    same += by == 0;
    empty += surface.coordinates.empty();
    if (by <= bound(surface.energy)) continue;
    ++beyond;
    std::printf("differs by %.1e: %s\n", by, surface.name.c_str());
  }
  for (int energy = 0; energy < 3; ++energy)
    std::printf("%s: at most %.1e\n", energy_names[energy], largest[energy]);
  std::printf("%d of %d have the same bits, %d were refused\n", same, count, empty);
  std::printf("%d passed, %d failed\n", count - beyond, beyond);
  return beyond;
}

}  // namespace
}  // namespace fairing::test

int main(int count, char** words) {
  const std::string what = count == 3 ? words[1] : "";
  if (what == "write") return fairing::test::write(words[2]), 0;
  if (what == "compare") return fairing::test::compare(words[2]) != 0;
  std::fprintf(stderr, "usage: fairing_surfaces write|compare FILE\n");
  return 2;
}
