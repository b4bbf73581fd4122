// SPDX-License-Identifier: GPL-3.0-or-later
// Taking folds out that steps have left. They lie along the surface, so that no displacement along
// its normals undoes them: places with folds are filled anew in the start, and the steps taken
// again.
#pragma once

#include "curvature/folds.h"
#include "curvature/steps.h"

namespace fairing {

// Gives the marked points (above zero), where they are unknowns, the positions on the surface x
// that are harmonic by the mean value weights [Floater 2003] of `shape`; all others stay. Weights
// are positive and reproduce linear maps of a flat `shape`, so that where the surface around is not
// folded, neither is the filling. 3 numbers a point. If the weights' matrix is singular, x stays.
void fill_harmonically(const GridLevel& grid, const Unknowns& unknowns, const Array<float>& marks,
                       const double* shape, double* x);

class Unfolding {
 public:
  // `folded_faces`: control faces whose folds are excused (folded_control_faces). All must outlive
  // it.
  Unfolding(SurfaceIterate& iterate, const ControlConstraints& constraints,
            const std::vector<std::uint8_t>& folded_faces, CurvatureSteps& steps)
      : it_(iterate), constraints_(constraints), folded_faces_(folded_faces), steps_(steps) {}

  // Folds of the surface as it is.
  Folds find() const;

  // Replaces iterate.current, at which the damped steps from `start` ended, by a surface with fewer
  // folds if one is found that has hardly more energy, or by one with much less energy; sets
  // folds_before and folds of `report`, or replaces it.
  void run(const StepStart& start, CurvatureLevelReport& report);

 private:
  void refill(const Array<float>& marks, Array<double>& x);
  void dilate_marks(int rings, Array<float>& marks);
  void solve_again(const StepStart& start, const Array<float>& marks, CurvatureLevelReport& report);
  bool mark_bursts(const Linearization& before, double energy, Array<float>& marks);

  SurfaceIterate& it_;
  const ControlConstraints& constraints_;
  const std::vector<std::uint8_t>& folded_faces_;
  CurvatureSteps& steps_;
};

}  // namespace fairing
