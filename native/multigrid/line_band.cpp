// SPDX-License-Identifier: GPL-3.0-or-later
#include "multigrid/line_band.h"

#include <algorithm>

#include "parallel/cancel.h"

namespace fairing {
namespace {

// Number of points. In fourth order the longest wave of a line is n^4 times as soft as the shortest
// one, and the 24 bits of single precision allow 64^4. Longer lines are cut.
constexpr std::size_t longest_line = 64;

}  // namespace

void LineBand::link() {
  const auto linked = [&](std::size_t p, std::size_t k) {
    const Index q = strongest_[p].outstanding(k);
    return q != none && strongest_[q].has(Index(p)) ? q : none;
  };
  std::vector<std::uint8_t> taken(points_, 0);
  // A closed line begins and ends at its weakest link; of links that tie, at the first one.
  const auto open = [&](std::size_t first) {
    const auto link = [&](std::size_t i) {
      const Strongest& own = strongest_[point_[i]];
      const Index next = i + 1 < point_.size() ? point_[i + 1] : point_[first];
      return own.coupling[own.point[0] == next ? 0 : 1];
    };
    std::size_t weakest = first;
    for (std::size_t i = first + 1; i < point_.size(); ++i)
      if (least_lead * link(i) < link(weakest)) weakest = i;
    std::rotate(point_.begin() + std::ptrdiff_t(first),
                point_.begin() + std::ptrdiff_t(weakest + 1), point_.end());
  };
  // From one end, in pieces of about equal length.
  const auto follow = [&](std::size_t p, bool closed) {
    const std::size_t first = point_.size();
    Index last = none;
    for (Index at = Index(p); at != none;) {
      const auto a = std::size_t(at);
      taken[a] = 1;
      point_.push_back(at);
      Index next = none;
      for (std::size_t k = 0; k < 2; ++k)
        if (const Index q = linked(a, k); q != none && q != last && !taken[q]) next = q;
      last = at;
      at = next;
    }
    if (closed) open(first);
    const std::size_t length = point_.size() - first;
    const std::size_t pieces = (length + longest_line - 1) / longest_line;
    for (std::size_t k = 1; k <= pieces; ++k) begin_.push_back(first + length * k / pieces);
  };
  // Open lines from their ends, then closed ones.
  for (const bool closed : {false, true})
    for (const std::size_t p : Cancellable(points_)) {
      const int links = (linked(p, 0) != none) + (linked(p, 1) != none);
      if (!taken[p] && links == (closed ? 2 : 1)) follow(p, closed);
    }
  Array<Strongest>().swap(strongest_);
  std::size_t longest = 0;
  for (std::size_t l = 0; l < lines(); ++l) longest = std::max(longest, length(l));
  span_ = double(longest) + 2;
  place_.assign(lines() > 0 ? points_ : 0, -1.0);
  for (std::size_t l = 0; l < lines(); ++l)
    for (std::size_t i = 0; i < length(l); ++i)
      place_[points_of(l)[i]] = span_ * double(l) + double(i);
}

}  // namespace fairing
