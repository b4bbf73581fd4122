// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/chains.h"

#include <algorithm>
#include <utility>

#include "parallel/cancel.h"

namespace fairing {

ChainFinder::ChainFinder(ControlMesh& control)
    : on(control.edges.size(), 0),
      corner(std::size_t(control.vertex_count()), 0),
      joined(control),
      control_(control) {}

const std::vector<Index>& ChainFinder::at(Index v) {
  found_.clear();
  joined.for_each(v, [&](Index w) {
    for (const Spoke& spoke : control_.ring(w)) {
      const Index e = control_.original_edge(spoke.edge);
      const bool again =
          control_.shared_edge(e) && std::find(found_.begin(), found_.end(), e) != found_.end();
      if (on[e] && !again) found_.push_back(e);
    }
  });
  return found_;
}

Index ChainFinder::across(Index e, Index v) const {
  const auto& ends = control_.edges[e].vertex;
  const Index first = joined.first(ends[0]);
  return first == v ? joined.first(ends[1]) : first;
}

void ChainFinder::collect() {
  for (const Index v : Cancellable(control_.vertex_count()))
    if (corner[v])
      for (const Index e : std::vector<Index>(at(v)))
        if (on[e]) collect_from(v, e);
  for (Index e = 0; e < control_.first_copied_edge(); ++e)  // the remaining chains are closed
    if (on[e]) collect_from(joined.first(control_.edges[e].vertex[0]), e);
}

void ChainFinder::collect_from(Index start, Index e) {
  Chain chain;
  chain.vertices.push_back(control_.original_vertex(start));
  for (Index v = start;; e = at(v).front()) {
    on[e] = 0;
    chain.edges.push_back(e);
    v = across(e, v);
    chain.closed = v == start && !corner[v];
    if (!chain.closed) chain.vertices.push_back(control_.original_vertex(v));
    if (chain.closed || corner[v]) break;
  }
  control_.chains.push_back(std::move(chain));
}

}  // namespace fairing
