// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's charts: tangent planes, and the linear blend with the uniform chart.
#pragma once

#include <memory>

#include "paper/options.h"
#include "stencil/stencils.h"

namespace fairing {

// Projection of the linearly refined control mesh along its normal. Inside a face the grid is flat;
// where there is no tangent plane, charts are exponential.
class TangentCharts : public ChartMaker {
 public:
  explicit TangentCharts(const ControlMesh& mesh) : ChartMaker(mesh, 1) {}
  Chart vertex(Index v) const override;
  Chart edge(Index e) const override;
};

// chart <- (1 - alpha) uniform + alpha chart [Kobbelt 1997b], after the uniform chart is scaled to
// the chart's mean radius and rotated by the best fit: no first neighbour matters.
void blend(const Chart& uniform, double alpha, Chart& chart);

// `Base`: the charts to blend; its constructor's arguments follow alpha.
template <class Base>
class BlendedCharts final : public Base {
 public:
  template <class... Arguments>
  BlendedCharts(double alpha, const ControlMesh& mesh, Arguments... arguments)
      : Base(mesh, arguments...), alpha_(alpha), uniform_(mesh, 0) {}
  Chart vertex(Index v) const override { return blended(uniform_.vertex(v), Base::vertex(v)); }
  Chart edge(Index e) const override { return blended(uniform_.edge(e), Base::edge(e)); }
  Chart face(Index f) const override { return blended(uniform_.face(f), Base::face(f)); }

 private:
  Chart blended(const Chart& uniform, Chart chart) const {
    blend(uniform, alpha_, chart);
    return chart;
  }

  double alpha_;
  ChartMaker uniform_;
};

// The charts for these options; without any of the paper's, those of stencil/chart.h.
std::unique_ptr<ChartMaker> make_charts(const ControlMesh& mesh, double exponent,
                                        const PaperOptions& options);

// The stencils of such charts. The membrane's weights are blended too.
// Throws if the run is cancelled.
Stencils make_stencils(const ControlMesh& mesh, const ChartMaker& charts,
                       const PaperOptions& options, Workers& workers,
                       const MembraneOptions& membrane);

}  // namespace fairing
