// SPDX-License-Identifier: GPL-3.0-or-later
// Easing: control positions whose loads are small, near where they were. With the loads g of the
// surface through them and G as in own_loads.h, the moves d minimize s^2 |g + G d|^2 + |d|^2. G is
// nearly symmetric, so
//
//   d(s) = -s^2 G (I + s^2 G^2)^-1 g,                                                        (*)
//
// a Butterworth filter of the control positions: shapes pass, noise does not. A space that holds
// (*) for all s serves for choosing s too: all vectors where there are few vertices, else Krylov's,
// which Arnoldi's steps find, one solve a step for all three coordinates.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace fairing {

using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;
// G times three columns, one row a vertex that may move.
using LoadsOfMoves = std::function<Columns(const Columns&)>;

struct Eased {
  Columns moves;
  double amount = 0;  // s times the mean of G's eigenvalues: no unit
  double noise = 0;   // root mean square length of the scatter that was taken out
  int solves = 0;
};

// The amount by generalized cross-validation (Golub, Heath and Wahba 1979); its trace exactly where
// all vectors are kept, otherwise by three random vectors of signs, always the same ones (Hutchinson
// 1990). With bounds, one a row: the largest amount that keeps every move within its bound.
Eased ease(const LoadsOfMoves& loads_of, const Columns& loads, const Eigen::VectorXd& bounds);

// At most so many rows move, and let go of their loads together: each time the one that strains
// most, |g_j| / own_j.
Eased ease_worst(const LoadsOfMoves& loads_of, const Columns& loads, const Eigen::VectorXd& own,
                 int most);

}  // namespace fairing
