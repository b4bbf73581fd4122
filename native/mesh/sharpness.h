// SPDX-License-Identifier: GPL-3.0-or-later
// Semi-sharp edges and vertices under Catmull-Clark subdivision [DeRose, Kass, Truong 1998, §3]:
// the rule of each vertex, and its number of steps.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "mesh/control_mesh.h"
#include "mesh/vertex_pair.h"

namespace fairing {

// How many subdivision steps a rule stays sharp; from `always_sharp` on for ever, as in OpenSubdiv.
constexpr double always_sharp = 10;

struct Sharpness {
  EdgeValues edges;              // of edges, creases or not
  std::vector<double> vertices;  // one a vertex, or empty; 0: none is given
};

// Throws FairingError(bad_option) for values that are not from 0 to `most`, or not one an edge;
// index_out_of_range for edges of vertices that are not in the mesh. `name` is the setting's.
void check_edge_values(const std::string& name, std::int64_t vertices, const EdgeValues& given,
                       double most);

// "from 0 to 1", or "zero or positive" without a limit.
const char* up_to(double most);

constexpr double sharp_for_ever = std::numeric_limits<double>::infinity();

// The sharpness after some steps.
inline double after(double sharpness, int steps) { return std::max(0.0, sharpness - steps); }

// The sharpness of a vertex and of its spokes.
struct AroundVertex {
  double vertex = 0;
  std::vector<double> spokes;
};

enum class VertexRule { smooth, crease, corner };
VertexRule rule_of(const AroundVertex& sharp, int steps);

// During the change from one rule to the next, sharpness is between 0 and 1: the share of the
// sharper rule [DeRose, Kass, Truong 1998, §3], the mean over all elements that become smooth.
double share_of_sharper(const AroundVertex& sharp, int steps);

// The sharpness of all elements of a polygon mesh: the given values; infinite on feature edges
// without one, at corners, at sharp turns of curves, and on straight borders.
class SharpRules {
 public:
  // `control` is made from the mesh.
  SharpRules(const ControlMesh& control, std::span<const std::int64_t> corners,
             const Sharpness& given);

  double vertex(std::size_t v) const { return vertex_[v]; }
  double edge(std::int64_t a, std::int64_t b) const;

 private:
  std::vector<std::pair<VertexPair, double>> edges_;  // ascending; of equal pairs the first counts
  std::vector<double> vertex_;
};

}  // namespace fairing
