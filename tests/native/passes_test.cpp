// SPDX-License-Identifier: GPL-3.0-or-later
// The matrix-free passes against written-out matrices, and these against charts and fits found another way.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "energy/assemble.h"
#include "energy/plate_matrix.h"
#include "energy/thin_plate.h"
#include "energy/thin_plate_level.h"
#include "lattice/linear.h"
#include "lattice/ring.h"
#include "meshes.h"
#include "transfer/transfer.h"
#include "transfer/written_transfer.h"
#include "written_rings.h"

namespace fairing::test {
namespace {

using Dense = Eigen::MatrixXd;
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;  // a lattice vector

constexpr double pi = std::numbers::pi;

ControlMesh control(const OwnedPolygonMesh& mesh, const FeatureOptions& features = {}) {
  return make_control_mesh(mesh.view(), features);
}

// Moves every vertex a little, so that no symmetry hides an error.
OwnedPolygonMesh shaken(OwnedPolygonMesh mesh, double by = 0.15) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> move(-by, by);
  for (double& x : mesh.coordinates) x += move(random);
  return mesh;
}

// Two apexes of valence k over a ring of vertices of valence 4.
OwnedPolygonMesh bipyramid(int k) {
  std::vector<Point> points{{0, 0, 1}, {0, 0, -1}};
  std::vector<Polygon> faces;
  for (int i = 0; i < k; ++i) {
    points.push_back({std::cos(2 * pi * i / k), std::sin(2 * pi * i / k), 0});
    faces.push_back({0, 2 + i, 2 + (i + 1) % k});
    faces.push_back({1, 2 + (i + 1) % k, 2 + i});
  }
  return make_mesh(points, faces);
}

// Quads and triangles side by side: every second quad of a grid cut.
OwnedPolygonMesh mixed_grid(int columns, int rows) {
  const OwnedPolygonMesh quads = grid(columns, rows);
  OwnedPolygonMesh mesh{quads.coordinates, {}, {0}};
  const auto add = [&](std::initializer_list<std::int64_t> face) {
    mesh.corners.insert(mesh.corners.end(), face);
    mesh.offsets.push_back(std::int64_t(mesh.corners.size()));
  };
  for (std::int64_t f = 0; f < quads.view().face_count(); ++f) {
    const auto q = quads.view().face(f);
    if (f % 2 == 0) {
      add({q[0], q[1], q[2], q[3]});
    } else if (f % 3 == 0) {
      add({q[0], q[1], q[2]});
      add({q[0], q[2], q[3]});
    } else {
      add({q[1], q[2], q[3]});
      add({q[1], q[3], q[0]});
    }
  }
  return mesh;
}

std::map<std::string, ControlMesh> all_meshes() {
  std::map<std::string, ControlMesh> all;
  const FeatureOptions free{.boundary = BoundaryMode::free}, linear{.boundary = BoundaryMode::linear};
  all["tetrahedron"] = control(shaken(tetrahedron()));
  all["cube"] = control(shaken(cube()));
  all["cube of triangles"] = control(shaken(cube_triangles()));
  all["octahedron"] = control(shaken(octahedron()));
  all["icosahedron"] = control(shaken(icosahedron()));
  all["pyramid"] = control(shaken(square_pyramid()));
  all["two components"] = control(two_tetrahedra());
  all["dodecahedron"] = control(shaken(dodecahedron(), 0.05));
  for (int k = 3; k <= 12; ++k) all["bipyramid " + std::to_string(k)] = control(shaken(bipyramid(k), 0.05));
  all["torus"] = control(shaken(torus(5, 4)));
  all["grid"] = control(shaken(grid(3, 2)));
  all["grid, free"] = control(shaken(grid(3, 2)), free);
  all["mixed grid"] = control(shaken(mixed_grid(4, 3)));
  all["mixed grid, free"] = control(shaken(mixed_grid(4, 3)), free);
  all["mixed grid, linear"] = control(shaken(mixed_grid(4, 3)), linear);
  all["mixed grid, dart"] =
      control(shaken(mixed_grid(3, 3)), {.crease_edges = {{5, 6}}, .corner_vertices = {9}});
  all["cylinder, free"] = control(shaken(open_cylinder(5)), free);
  all["cylinder"] = control(shaken(open_cylinder(5)));
  all["fan"] = control(shaken(fan(7)));
  all["fan, free"] = control(shaken(fan(7)), free);
  all["half fan, free"] = control(shaken(half_fan(5)), free);
  all["roof"] = control(roof(), {.crease_edges = {{0, 1}}});
  all["roof, free"] = control(shaken(roof()), free);
  all["crease"] = control(shaken(icosahedron()), {.crease_edges = {{0, 11}, {11, 2}}});
  all["triangle, free"] = control(single_triangle(), free);
  all["quad, free"] = control(single_quad(), free);
  all["triangle"] = control(single_triangle());
  OwnedPolygonMesh isolated = shaken(octahedron());
  isolated.coordinates.insert(isolated.coordinates.end(), {9, 9, 9});
  all["isolated vertex"] = control(isolated);
  return all;
}

const std::map<std::string, ControlMesh>& meshes() {
  static const auto all = all_meshes();
  return all;
}

Unknowns all_points(const ControlMesh& mesh) {
  return {std::vector<std::uint8_t>(std::size_t(mesh.vertex_count()), 1),
          std::vector<std::uint8_t>(mesh.edges.size(), 1), true};
}

// No vertex (0), every second vertex without a feature (1), all of these (2).
Unknowns some_points(const ControlMesh& mesh, int choice) {
  Unknowns u = all_points(mesh);
  u.any_vertex = false;
  for (std::size_t v = 0; v < u.vertex.size(); ++v) {
    u.vertex[v] = !mesh.feature_vertex[v] && (choice == 2 || (choice == 1 && v % 2 == 0));
    u.any_vertex |= u.vertex[v] != 0;
  }
  for (std::size_t e = 0; e < u.edge.size(); ++e) u.edge[e] = !mesh.feature_edge[e];
  return u;
}

Points random_points(std::size_t size, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1, 1);
  Points x(Eigen::Index(size), 3);
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = number(random);
  return x;
}

// Zero where the point is known.
Points masked(const Lattice& lattice, const Unknowns& unknowns, Points x) {
  const auto number = number_unknowns(lattice, unknowns);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] < 0) x.row(Eigen::Index(p)).setZero();
  return x;
}

// Slots that hold rubbish: nothing may be read that this pass has not written.
template <class T>
Exchange<T> poisoned(const Lattice& lattice) {
  Exchange<T> exchange;
  exchange.fit(lattice);
  for (Array<T>* slots : {&exchange.row, &exchange.side, &exchange.end, &exchange.spoke})
    std::fill(slots->begin(), slots->end(), std::numeric_limits<T>::quiet_NaN());
  return exchange;
}

struct Setting {
  const ControlMesh& mesh;
  Lattice lattice;
  ChartMaker charts;
  Stencils stencils;
};

// Calls body(setting, workers) for every mesh at every level up to `most_levels`.
void on_all(int most_levels, const std::function<void(const Setting&, Workers&)>& body,
            const ChartOptions& options = {}) {
  Workers workers(1);
  for (const auto& [name, mesh] : meshes())
    for (int level = 0; level <= most_levels; ++level) {
      SCOPED_TRACE(name + ", level " + std::to_string(level));
      body({mesh, Lattice(mesh, level), ChartMaker(mesh, options), make_stencils(mesh, options, workers)},
           workers);
    }
}

// K over all points from charts and fits, with rings found by walking around cells.
Dense written_stiffness(const Setting& s) {
  const double scale = double(s.lattice.n()) * s.lattice.n();
  Dense k = Dense::Zero(Eigen::Index(s.lattice.size()), Eigen::Index(s.lattice.size()));
  const RingWalker walker(cells(s.lattice));
  visit_fits(s.lattice, walker, s.charts, [&](const WrittenFit& fit) {
    if (fit.chart.ring.empty()) return;
    ASSERT_EQ(fit.ring.size(), fit.chart.ring.size());
    Dense g = Dense::Zero(3, k.cols());
    for (std::size_t j = 0; j < fit.ring.size(); ++j) {
      const Eigen::Vector3d column = fit.rows.col(Eigen::Index(j)).tail<3>();
      g.col(fit.ring[j].point) += column;
      g.col(fit.centre) -= column;
    }
    // Only the columns of the ring are set; the product below is still fine on these small levels.
    std::vector<Index> points{fit.centre};
    for (const auto& r : fit.ring) points.push_back(r.point);
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    for (const Index a : points)
      for (const Index b : points) k(a, b) += scale * fit.chart.area * g.col(a).dot(g.col(b));
  });
  return k;
}

Dense assembled(const Setting& s, const Unknowns& unknowns, const VertexWeights& weights = {}) {
  return Dense(assemble_thin_plate(s.lattice, s.stencils, unknowns, weights).matrix);
}

TEST(Lattice, NumbersEveryPointOnce) {
  on_all(3, [](const Setting& s, Workers&) {
    std::vector<int> seen(s.lattice.size(), 0);
    for (const Cell& cell : cells(s.lattice))
      for (const Index p : cell)
        if (p >= 0) ++seen.at(std::size_t(p));
    for (std::size_t p = 0; p < seen.size(); ++p)
      EXPECT_EQ(seen[p] > 0, p >= std::size_t(s.mesh.vertex_count()) || !s.mesh.ring(Index(p)).empty()) << p;
  });
}

TEST(Lattice, LiesOnTheControlPolyhedron) {
  on_all(3, [](const Setting& s, Workers&) {
    Points x(Eigen::Index(s.lattice.size()), 3);
    refine_linearly(s.lattice, s.mesh.positions, x.data());
    const int n = s.lattice.n();
    for (Index f = 0; f < Index(s.mesh.faces.size()); ++f) {
      const Face& face = s.mesh.faces[std::size_t(f)];
      const auto corner = [&](std::size_t c) { return s.mesh.positions[std::size_t(face.vertex[c])]; };
      for (int side = 0; side < face.size; ++side)
        for (int k = 0; k <= n; ++k) {
          const double t = double(k) / n;
          const auto from = std::size_t(side), to = std::size_t((side + 1) % face.size);
          const Index p = s.lattice.face_point(f, closed_point(face.quad(), n, side, k, 0));
          EXPECT_LT((x.row(p).transpose() - (1 - t) * corner(from) - t * corner(to)).norm(), 1e-14);
          EXPECT_EQ(p, s.lattice.side_point(s.mesh.sides[std::size_t(face.first_side + side)], k));
        }
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= (face.quad() ? n : n - j); ++i) {
          const double u = double(i) / n, v = double(j) / n;
          const Vec3 expected = face.quad() ? Vec3((1 - u) * (1 - v) * corner(0) + u * (1 - v) * corner(1) +
                                                   u * v * corner(2) + (1 - u) * v * corner(3))
                                            : Vec3((1 - u - v) * corner(0) + u * corner(1) + v * corner(2));
          EXPECT_LT((x.row(s.lattice.face_point(f, i, j)).transpose() - expected).norm(), 1e-14);
        }
    }
  });
}

TEST(Assembly, IsTheMatrixOfChartsAndFits) {
  for (const ChartOptions& options :
       {ChartOptions{}, ChartOptions{.exponent = 1}, ChartOptions{.exponent = 0}, ChartOptions{.blend = 0.4},
        ChartOptions{.kind = ChartKind::tangent, .exponent = 1}})
    on_all(
        2,
        [](const Setting& s, Workers&) {
          const Dense expected = written_stiffness(s), actual = assembled(s, all_points(s.mesh));
          EXPECT_LT((actual - expected).norm(), 1e-11 * expected.norm() + 1e-300);
        },
        options);
}

TEST(Assembly, KnowsConstants) {
  on_all(2, [](const Setting& s, Workers&) {
    const Dense k = assembled(s, all_points(s.mesh));
    EXPECT_LT((k * Dense::Ones(k.cols(), 1)).norm(), 1e-12 * k.norm() + 1e-300);
  });
}

TEST(ThinPlate, AppliesTheAssembledMatrix) {
  on_all(3, [](const Setting& s, Workers& workers) {
    const Dense all = assembled(s, all_points(s.mesh));
    const ThinPlateRows<double> rows(s.mesh, s.stencils);
    const ThinPlateRows<float> narrow(s.mesh, s.stencils);
    Exchange<double> exchange = poisoned<double>(s.lattice);
    Exchange<float> narrow_exchange = poisoned<float>(s.lattice);
    const Points x = random_points(s.lattice.size());
    for (int choice = 0; choice < 3; ++choice) {
      const Unknowns unknowns = some_points(s.mesh, choice);
      Points y = random_points(s.lattice.size(), 2);  // what it holds before must not matter
      apply_thin_plate(s.lattice, rows, unknowns, {}, workers, exchange, x.data(), y.data());
      const Points expected = masked(s.lattice, unknowns, all * x);
      EXPECT_LT((y - expected).norm(), 1e-12 * all.norm() * x.norm() + 1e-300) << choice;

      const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> xf = x.cast<float>();
      Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> yf = xf;
      apply_thin_plate(s.lattice, narrow, unknowns, {}, workers, narrow_exchange, xf.data(), yf.data());
      EXPECT_LT((yf.cast<double>() - expected).norm(), 1e-5 * all.norm() * x.norm() + 1e-300) << choice;
    }
  });
}

TEST(ThinPlate, IsTheAssembledSystemOnItsUnknowns) {
  on_all(2, [](const Setting& s, Workers& workers) {
    for (int choice = 0; choice < 3; ++choice) {
      const Unknowns unknowns = some_points(s.mesh, choice);
      VertexWeights weights(std::size_t(s.mesh.vertex_count()), 0.0);
      for (std::size_t v = 0; v < weights.size(); v += 3) weights[v] = 0.5 + double(v);
      const AssembledSystem system = assemble_thin_plate(s.lattice, s.stencils, unknowns, weights);
      const Dense k(system.matrix);
      EXPECT_EQ((k - k.transpose()).norm(), 0);
      const ThinPlateRows<double> rows(s.mesh, s.stencils);
      Exchange<double> exchange = poisoned<double>(s.lattice);
      const Points x = masked(s.lattice, unknowns, random_points(s.lattice.size()));
      Points y(x.rows(), 3);
      apply_thin_plate(s.lattice, rows, unknowns, weights, workers, exchange, x.data(), y.data());
      Points small(k.cols(), 3);
      for (std::size_t r = 0; r < system.unknown_points.size(); ++r)
        small.row(Eigen::Index(r)) = x.row(system.unknown_points[r]);
      const Points expected = k * small;
      const Array<float> diagonal =
          thin_plate_diagonal(s.lattice, rows, unknowns, weights, workers, exchange);
      ASSERT_EQ(diagonal.size(), s.lattice.size());
      std::vector<std::uint8_t> known(s.lattice.size(), 1);
      for (std::size_t r = 0; r < system.unknown_points.size(); ++r) {
        const Index p = system.unknown_points[r];
        known[std::size_t(p)] = 0;
        EXPECT_LT((y.row(p) - expected.row(Eigen::Index(r))).norm(), 1e-12 * k.norm() * x.norm());
        const double entry = k(Eigen::Index(r), Eigen::Index(r));
        EXPECT_NEAR(diagonal[std::size_t(p)], entry > 0 ? entry : 1.0, 1e-6 * std::max(entry, 1e-6)) << p;
      }
      for (std::size_t p = 0; p < known.size(); ++p)
        if (known[p]) {
          EXPECT_EQ(y.row(Eigen::Index(p)).norm(), 0);
          EXPECT_EQ(diagonal[p], 1.0f);
        }
    }
  });
}

TEST(ThinPlate, EnergyIsTheQuadraticForm) {
  on_all(3, [](const Setting& s, Workers& workers) {
    const Dense k = assembled(s, all_points(s.mesh));
    const Points x = random_points(s.lattice.size());
    const ThinPlateRows<double> rows(s.mesh, s.stencils);
    const double expected = (x.transpose() * k * x).trace();
    EXPECT_NEAR(thin_plate_energy(s.lattice, rows, workers, x.data()), expected, 1e-12 * expected + 1e-300);
  });
}

// P over all points, from the text in transfer.h.
Dense written_prolongation(const Setting& coarse, const Lattice& fine) {
  const Lattice& lattice = coarse.lattice;
  const auto size = Eigen::Index(lattice.size());
  Dense p = Dense::Zero(Eigen::Index(fine.size()), size);
  const RingWalker walker(cells(lattice));
  // Where the fine points are: over coarse points, half-way along coarse edges, and in the middle of quad
  // cells.
  std::vector<Index> over(lattice.size(), -1);
  std::map<std::pair<Index, Index>, Index> along;
  std::vector<Index> middle;
  const int n = lattice.n();
  for (Index v = 0; v < lattice.mesh().vertex_count(); ++v) over[std::size_t(v)] = v;
  for (Index f = 0; f < Index(lattice.mesh().faces.size()); ++f) {
    const bool quad = lattice.mesh().faces[std::size_t(f)].quad();
    const auto note = [&](int i, int j, int di, int dj) {
      const int i2 = i + di, j2 = j + dj;
      if (i2 < 0 || j2 < 0 || i2 > n || j2 > n || (!quad && i2 + j2 > n)) return;
      const Index a = lattice.face_point(f, i, j), b = lattice.face_point(f, i2, j2);
      along[{std::min(a, b), std::max(a, b)}] = fine.face_point(f, i + i2, j + j2);
    };
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= (quad ? n : n - j); ++i) {
        over[std::size_t(lattice.face_point(f, i, j))] = fine.face_point(f, 2 * i, 2 * j);
        note(i, j, 1, 0);
        note(i, j, 0, 1);
        if (!quad) note(i, j, -1, 1);
      }
  }
  for (Index f = 0; f < Index(lattice.mesh().faces.size()); ++f) {
    const bool quad = lattice.mesh().faces[std::size_t(f)].quad();
    if (quad) {
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) middle.push_back(fine.face_point(f, 2 * i + 1, 2 * j + 1));
    } else {
      middle.insert(middle.end(), std::size_t(n) * std::size_t(n), -1);  // as cells() lists them
    }
  }
  for (std::size_t c = 0; c < over.size(); ++c)
    if (over[c] >= 0) p(over[c], Eigen::Index(c)) = 1;

  visit_fits(lattice, walker, coarse.charts, [&](const WrittenFit& fit) {
    const auto opposite = [&](std::size_t j) {
      return fit.ring[(j + fit.ring.size() / 2) % fit.ring.size()].point;
    };
    for (std::size_t j = 0; j < fit.ring.size(); ++j) {
      const RingNeighbour& r = fit.ring[j];
      const Index to = r.cell >= 0 ? middle.at(std::size_t(r.cell))
                                   : along.at({std::min(fit.centre, r.point), std::max(fit.centre, r.point)});
      const double weight = r.cell >= 0 ? 0.25 : 0.5;
      const auto add = [&](Index from, double w) { p(to, from) += weight * w; };
      if (fit.chart.ring.empty()) {
        if (r.cell >= 0) {
          for (const Index corner : walker.all()[std::size_t(r.cell)]) add(corner, 0.25);
        } else {
          add(fit.centre, 0.5);
          add(r.point, 0.5);
        }
      } else if (fit.in_face) {
        add(r.point, 0.375);
        add(fit.centre, 0.75);
        add(opposite(j), -0.125);
      } else {
        const Coefficients at = basis(0.5 * fit.chart.ring[j]);
        add(fit.centre, 1);
        for (std::size_t m = 0; m < fit.ring.size(); ++m) {
          const double w = at.dot(fit.rows.col(Eigen::Index(m)));
          add(fit.ring[m].point, w);
          add(fit.centre, -w);
        }
      }
    }
  });
  return p;
}

TEST(Transfer, ProlongsByTheFitsOfCharts) {
  for (const ChartOptions& options : {ChartOptions{}, ChartOptions{.exponent = 1}})
    on_all(
        2,
        [](const Setting& s, Workers& workers) {
          const Lattice fine(s.mesh, s.lattice.level() + 1);
          const Dense p = written_prolongation(s, fine);
          Exchange<double> exchange = poisoned<double>(fine);
          const Points x = random_points(s.lattice.size());
          Points y = random_points(fine.size(), 2);
          prolong<double>(s.lattice, fine, s.stencils, nullptr, workers, exchange, x.data(), y.data());
          EXPECT_LT((y - p * x).norm(),
                    2e-7 * p.norm() * x.norm());  // the rows are stored in single precision
        },
        options);
}

TEST(Transfer, RestrictionIsTheTranspose) {
  on_all(2, [](const Setting& s, Workers& workers) {
    const Lattice fine(s.mesh, s.lattice.level() + 1);
    for (int choice = 0; choice < 3; ++choice) {
      const Unknowns unknowns = some_points(s.mesh, choice);
      Exchange<double> exchange = poisoned<double>(fine);
      const Points x = masked(s.lattice, unknowns, random_points(s.lattice.size()));
      const Points y = masked(fine, unknowns, random_points(fine.size(), 2));
      Points px = random_points(fine.size(), 3), py = random_points(s.lattice.size(), 4);
      prolong(s.lattice, fine, s.stencils, &unknowns, workers, exchange, x.data(), px.data());
      restrict_to(s.lattice, fine, s.stencils, unknowns, workers, exchange, y.data(), py.data());
      EXPECT_EQ((px - masked(fine, unknowns, px)).norm(), 0);
      EXPECT_EQ((py - masked(s.lattice, unknowns, py)).norm(), 0);
      for (int a = 0; a < 3; ++a)  // each coordinate is a vector of its own
        EXPECT_NEAR(px.col(a).dot(y.col(a)), x.col(a).dot(py.col(a)), 1e-13 * (1 + px.norm() * y.norm()))
            << choice;
    }
  });
}

TEST(Transfer, KeepsConstants) {
  on_all(3, [](const Setting& s, Workers& workers) {
    const Lattice fine(s.mesh, s.lattice.level() + 1);
    Exchange<double> exchange;
    Points x(Eigen::Index(s.lattice.size()), 3), y(Eigen::Index(fine.size()), 3);
    x.rowwise() = Eigen::RowVector3d(1, -0.3, 1e6);
    prolong<double>(s.lattice, fine, s.stencils, nullptr, workers, exchange, x.data(), y.data());
    const auto vertices = s.mesh.vertex_count();
    for (Eigen::Index p = 0; p < y.rows(); ++p) {
      if (p < vertices && s.mesh.ring(Index(p)).empty()) continue;
      EXPECT_EQ(y(p, 0), 1.0) << p;
      EXPECT_NEAR(y(p, 1), -0.3, 2e-16) << p;
      EXPECT_NEAR(y(p, 2), 1e6, 4e-10) << p;
    }
  });
}

double quadratic(double u, double v) { return 0.3 + u - 2 * v + 0.7 * u * u - 1.3 * u * v + 0.4 * v * v; }

TEST(Transfer, KeepsQuadraticsInThePlane) {
  // Sheared squares (quads), and the same cut along their diagonals: charts of exponent 1 are the plane
  // itself.
  Workers workers(1);
  for (const bool cut : {false, true}) {
    OwnedPolygonMesh mesh = grid(4, 4);
    for (std::size_t i = 0; i < mesh.coordinates.size(); i += 3)
      mesh.coordinates[i] += 0.4 * mesh.coordinates[i + 1];
    if (cut) mesh = triangulated(mesh);
    const ControlMesh plane = control(mesh);
    const Stencils stencils = make_stencils(plane, {.exponent = 1}, workers);
    const auto values = [&](const Lattice& lattice) {
      Points x(Eigen::Index(lattice.size()), 3);
      refine_linearly(lattice, plane.positions, x.data());
      for (Eigen::Index p = 0; p < x.rows(); ++p) x(p, 2) = quadratic(x(p, 0), x(p, 1));
      return x;
    };
    for (int level = 0; level < 4; ++level) {
      const Lattice coarse(plane, level), fine(plane, level + 1);
      const Points x = values(coarse), expected = values(fine);
      Points y(expected.rows(), 3);
      Exchange<double> exchange;
      prolong<double>(coarse, fine, stencils, nullptr, workers, exchange, x.data(), y.data());
      int checked = 0;
      for (Eigen::Index p = 0; p < y.rows(); ++p) {
        // Only points whose parents carry fits: a cell away from the boundary.
        const double v = expected(p, 1), u = expected(p, 0) - 0.4 * v, cell = 1.0 / coarse.n() - 1e-9;
        if (std::min(u, v) < cell || std::max(u, v) > 4 - cell) continue;
        EXPECT_NEAR(y(p, 2), expected(p, 2), 3e-6) << "level " << level << " point " << p;
        ++checked;
      }
      EXPECT_GT(checked, 8);
      const ThinPlateRows<double> rows(plane, stencils);
      Points residual(x.rows(), 3);
      const Unknowns unknowns = some_points(plane, 2);
      Exchange<double> passes;
      apply_thin_plate(coarse, rows, unknowns, {}, workers, passes, x.data(), residual.data());
      for (Eigen::Index p = 0; p < x.rows(); ++p) {
        // K annihilates polynomials of degree two (their Hessian is constant) two rings inside.
        const double v = x(p, 1), u = x(p, 0) - 0.4 * v, cell = 2.0 / coarse.n() - 1e-9;
        if (std::min(u, v) < cell || std::max(u, v) > 4 - cell) continue;
        EXPECT_NEAR(residual(p, 2), 0, 1e-9) << "level " << level << " point " << p;
      }
    }
  }
}

using FloatPoints = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

// With the room that rows may read in packs.
FloatPoints with_room(const Points& x) {
  FloatPoints out = FloatPoints::Constant(x.rows() + Eigen::Index(vector_room), 3, 1e30f);
  out.topRows(x.rows()) = x.cast<float>();
  return out;
}

Points of_room(const FloatPoints& x, std::size_t size) {
  return x.topRows(Eigen::Index(size)).cast<double>();
}

Unknowns inside_region(const ControlMesh& mesh, Unknowns u) {
  for (std::size_t v = 0; v < u.vertex.size(); ++v)
    if (mesh.vertex_place(Index(v)) != Place::inside) u.vertex[v] = 0;
  for (std::size_t e = 0; e < u.edge.size(); ++e)
    if (mesh.edge_place(Index(e)) != Place::inside) u.edge[e] = 0;
  for (const Place place : mesh.region.face) u.face.push_back(place == Place::inside);
  return u;
}

// K in rows, weights of control vertices and the diagonal included, against the assembled system.
void expect_rows_of(const Setting& s, const Unknowns& unknowns, Workers& workers) {
  const std::unique_ptr<PlateMatrix> rows = PlateMatrix::make(s.lattice, s.stencils, unknowns, workers);
  ASSERT_EQ(rows != nullptr, s.lattice.n() > 1);
  if (!rows) return;
  VertexWeights weights(std::size_t(s.mesh.vertex_count()), 0.0);
  for (const bool weighted : {true, false}) {
    for (std::size_t v = 0; v < weights.size(); v += 2) weights[v] = weighted ? 0.5 + double(v) : 0.0;
    rows->set_weights(weights);
    const AssembledSystem system = assemble_thin_plate(s.lattice, s.stencils, unknowns, weights);
    const Dense k(system.matrix);
    const Points x = masked(s.lattice, unknowns, random_points(s.lattice.size()));
    Points small(k.cols(), 3), expected = Points::Zero(x.rows(), 3);
    for (Eigen::Index r = 0; r < k.cols(); ++r) small.row(r) = x.row(system.unknown_points[std::size_t(r)]);
    small = k * small;
    Array<float> diagonal(s.lattice.size(), 1.0f);
    for (Eigen::Index r = 0; r < k.cols(); ++r) {
      const Index p = system.unknown_points[std::size_t(r)];
      expected.row(p) = small.row(r);
      if (k(r, r) > 0) diagonal[std::size_t(p)] = float(1 / k(r, r));
    }
    const FloatPoints xf = with_room(x);
    FloatPoints image = FloatPoints::Constant(x.rows(), 3, 1e30f);
    rows->visit_images(xf.data(), workers, [&](std::size_t first, std::size_t count, const float* part) {
      std::copy_n(part, 3 * count, image.data() + 3 * first);
    });
    EXPECT_LT((image.cast<double>() - expected).norm(), 1e-6 * k.norm() * x.norm() + 1e-300);
    const Array<float> inverse = rows->inverse_diagonal(workers);
    for (std::size_t p = 0; p < diagonal.size(); ++p)
      EXPECT_NEAR(inverse[p], diagonal[p], 1e-5 * diagonal[p]);
  }
}

TEST(Rows, AreTheAssembledSystem) {
  on_all(3, [](const Setting& s, Workers& workers) {
    for (int choice = 0; choice < 3; ++choice) expect_rows_of(s, some_points(s.mesh, choice), workers);
  });
}

TEST(Rows, AreTheAssembledSystemBesideJoints) {
  Workers workers(1);
  for (const Joint joint : {Joint::position, Joint::tangent, Joint::curvature})
    for (const OwnedPolygonMesh& owned :
         {shaken(grid(4, 3)), shaken(mixed_grid(4, 3)), shaken(torus(6, 5))}) {
      FeatureOptions features;
      features.region = {true, {0, 1, 2, 5}, joint};
      const ControlMesh mesh = control(owned, features);
      for (int level = 1; level <= 3; ++level) {
        SCOPED_TRACE(int(joint) * 10 + level);
        const ChartOptions options;
        const Setting s{mesh, Lattice(mesh, level), ChartMaker(mesh, options),
                        make_stencils(mesh, options, workers)};
        expect_rows_of(s, inside_region(mesh, some_points(mesh, 1)), workers);
      }
    }
}

TEST(Rows, TransferAsPassesDo) {
  on_all(2, [](const Setting& s, Workers& workers) {
    const Lattice fine(s.mesh, s.lattice.level() + 1);
    const double rounding = 2e-7 * (1 + written_prolongation(s, fine).norm());
    for (int choice = 0; choice < 3; ++choice) {
      const Unknowns unknowns = some_points(s.mesh, choice);
      const std::unique_ptr<WrittenTransfer> rows =
          WrittenTransfer::make(s.lattice, fine, s.stencils, unknowns, workers);
      ASSERT_NE(rows, nullptr);
      Exchange<double> exchange = poisoned<double>(fine);
      const Points x = masked(s.lattice, unknowns, random_points(s.lattice.size()));
      const Points y = masked(fine, unknowns, random_points(fine.size(), 2));
      Points px(y.rows(), 3), ry(x.rows(), 3);
      prolong(s.lattice, fine, s.stencils, &unknowns, workers, exchange, x.data(), px.data());
      restrict_to(s.lattice, fine, s.stencils, unknowns, workers, exchange, y.data(), ry.data());
      FloatPoints up = with_room(Points::Zero(y.rows(), 3)), down = with_room(Points::Zero(x.rows(), 3));
      rows->prolong<3>(with_room(x).data(), workers, up.data());
      rows->restrict_to<3>(with_room(y).data(), workers, down.data());
      EXPECT_LT((of_room(up, fine.size()) - px).norm(), rounding * (1 + x.norm())) << choice;
      EXPECT_LT((of_room(down, s.lattice.size()) - ry).norm(), rounding * (1 + y.norm())) << choice;

      // The same rows for one number a point.
      Eigen::VectorXf one = with_room(x).col(1), result = Eigen::VectorXf::Zero(y.rows());
      rows->prolong<1>(one.data(), workers, result.data());
      EXPECT_LT((result.cast<double>() - px.col(1)).norm(), rounding * (1 + x.norm()));
      one = with_room(y).col(2);
      result = Eigen::VectorXf::Zero(x.rows());
      rows->restrict_to<1>(one.data(), workers, result.data());
      EXPECT_LT((result.cast<double>() - ry.col(2)).norm(), rounding * (1 + y.norm()));
    }
  });
}

// Rows finished where they are computed, against one application and then the vectors.
TEST(Rows, RelaxAsApplicationsDo) {
  on_all(3, [](const Setting& s, Workers& workers) {
    const Unknowns unknowns = some_points(s.mesh, 1);
    ThinPlateShared shared(s.mesh, s.stencils, unknowns, {}, workers);
    ThinPlateLevel level(shared, s.lattice);
    const auto start = [&](unsigned seed) {
      return with_room(masked(s.lattice, unknowns, random_points(s.lattice.size(), seed)));
    };
    for (const bool adds : {false, true}) {
      FloatPoints d = start(1), x[2] = {start(2), start(2)}, r[2] = {start(3), start(3)},
                  next[2] = {start(4), start(4)};
      level.relax({d.data(), next[0].data(), x[0].data(), r[0].data(), 0.3f, 0.7f, adds}, workers);
      level.LevelOperator::relax({d.data(), next[1].data(), x[1].data(), r[1].data(), 0.3f, 0.7f, adds},
                                 workers);
      EXPECT_EQ((x[0] - x[1]).topRows(Eigen::Index(s.lattice.size())).norm(), 0);
      EXPECT_EQ((r[0] - r[1]).topRows(Eigen::Index(s.lattice.size())).norm(), 0);
      EXPECT_EQ((next[0] - next[1]).topRows(Eigen::Index(s.lattice.size())).norm(), 0);
      level.subtract_image(d.data(), next[0].data(), x[0].data(), workers);
      level.LevelOperator::subtract_image(d.data(), next[1].data(), x[1].data(), workers);
      EXPECT_EQ((x[0] - x[1]).topRows(Eigen::Index(s.lattice.size())).norm(), 0);
    }
  });
}

// A block whose rows name more columns than short places can tell apart is refused.
TEST(Rows, RefuseTooManyColumnsInOnePlace) {
  Workers workers(1);
  for (const Index columns : {65000, 66000}) {
    WrittenMatrix matrix(2, std::size_t(columns));
    const auto writer = [&] {
      return [columns](Index row, RowBuilder& builder) {
        for (Index c = row; c < columns; c += 2) builder.add(c, 1.0);
      };
    };
    EXPECT_EQ(matrix.build(workers, writer), columns == 65000);
  }
}

TEST(Passes, AnyNumberOfThreadsGivesTheSameBits) {
  OwnedPolygonMesh mesh = shaken(mixed_grid(30, 24));
  const ControlMesh big = control(mesh, {.crease_edges = {{40, 41}, {41, 42}}});
  const Unknowns unknowns = some_points(big, 1);
  const Lattice coarse(big, 1), fine(big, 2);
  std::vector<std::vector<char>> results;
  for (const int threads : {1, 2, 4, 8}) {
    Workers workers(threads);
    const Stencils stencils = make_stencils(big, {}, workers);
    const ThinPlateRows<double> rows(big, stencils);
    const ThinPlateRows<float> narrow(big, stencils);
    Exchange<double> exchange;
    Exchange<float> narrow_exchange;
    const Points x = random_points(coarse.size()), z = random_points(fine.size());
    const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> zf = z.cast<float>();
    std::vector<char> bytes;
    const auto keep = [&](const void* data, std::size_t size) {
      const char* c = static_cast<const char*>(data);
      bytes.insert(bytes.end(), c, c + size);
    };
    Points kz = z, px = z, rz = x;
    auto kzf = zf;
    apply_thin_plate(fine, rows, unknowns, {}, workers, exchange, z.data(), kz.data());
    keep(kz.data(), sizeof(double) * std::size_t(kz.size()));
    apply_thin_plate(fine, narrow, unknowns, {}, workers, narrow_exchange, zf.data(), kzf.data());
    keep(kzf.data(), sizeof(float) * std::size_t(kzf.size()));
    prolong(coarse, fine, stencils, &unknowns, workers, exchange, x.data(), px.data());
    keep(px.data(), sizeof(double) * std::size_t(px.size()));
    restrict_to(coarse, fine, stencils, unknowns, workers, exchange, z.data(), rz.data());
    keep(rz.data(), sizeof(double) * std::size_t(rz.size()));
    const double energy = thin_plate_energy(fine, rows, workers, z.data());
    keep(&energy, sizeof energy);
    const Array<float> diagonal = thin_plate_diagonal(fine, rows, unknowns, {}, workers, exchange);
    keep(diagonal.data(), sizeof(float) * diagonal.size());
    results.push_back(bytes);
  }
  for (std::size_t k = 1; k < results.size(); ++k) EXPECT_TRUE(results[k] == results[0]) << k;
}

Chart random_ring(int valence, std::mt19937& random, double skew = 1) {
  std::uniform_real_distribution<double> vary(-0.3, 0.3);
  Chart chart;
  for (int j = 0; j < valence; ++j) {
    const double angle = 2 * pi * (j + vary(random)) / valence, radius = 1 + vary(random);
    chart.ring.push_back(Vec2(skew * radius * std::cos(angle), radius * std::sin(angle)));
  }
  return chart;
}

// The fit of a quadratic with these coefficients, as an error relative to them.
double fit_error(const Chart& chart, const Coefficients& c) {
  const FitRows rows = fit(chart);
  Coefficients found = Coefficients::Zero();
  for (std::size_t j = 0; j < chart.ring.size(); ++j)
    found += rows.col(Eigen::Index(j)) * basis(chart.ring[j]).dot(c);
  return (found - c).norm() / c.norm();
}

TEST(Fit, BasisIsOrthonormalOnHessians) {
  // f = 1/2 p^T H p: the last three coefficients' squares add up to |H|^2.
  const double uu = 0.7, uv = -0.4, vv = 1.9, u = 0.3, v = -1.1;
  Coefficients c;
  c << 0, 0, (uu + vv) / std::sqrt(2), (uu - vv) / std::sqrt(2), std::sqrt(2) * uv;
  EXPECT_NEAR(basis({u, v}).dot(c), 0.5 * uu * u * u + uv * u * v + 0.5 * vv * v * v, 1e-15);
  EXPECT_NEAR(c.squaredNorm(), uu * uu + 2 * uv * uv + vv * vv, 1e-14);
}

TEST(Fit, IsExactOnQuadratics) {
  std::mt19937 random(3);
  for (int valence = 5; valence <= 40; ++valence)
    for (int trial = 0; trial < 20; ++trial)
      EXPECT_LT(fit_error(random_ring(valence, random), Coefficients::Random()), 1e-9) << valence;
}

TEST(Fit, IsExactOnQuadraticsOverSkewedRings) {
  std::mt19937 random(4);
  for (const double skew : {1e-4, 0.01, 0.1, 10.0, 1e3})
    for (const int valence : {6, 8, 12}) {
      // In round coordinates the ring is as good as any; scale the coefficients so that all of them count.
      Coefficients c;
      c << 1 / skew, 1, (1 / skew / skew + 1) / std::sqrt(2), (1 / skew / skew - 1) / std::sqrt(2),
          std::sqrt(2) / skew;
      EXPECT_LT(fit_error(random_ring(valence, random, skew), c), 1e-8) << skew << " " << valence;
    }
}

TEST(Fit, FewNeighboursMeasureTheLaplacian) {
  std::mt19937 random(5);
  Coefficients round;
  round << 0.3, -0.8, 1, 0, 0;
  for (const int valence : {3, 4})
    for (int trial = 0; trial < 50; ++trial) EXPECT_LT(fit_error(random_ring(valence, random), round), 1e-11);
  // Valence 3 knows no trace-free part; at valence 4 it has one row, and agrees with the data.
  EXPECT_LT(fit(random_ring(3, random)).bottomRows(2).norm(), 1e-11);
  for (int trial = 0; trial < 50; ++trial) {
    const Chart chart = random_ring(4, random);
    const FitRows rows = fit(chart);
    const Eigen::JacobiSVD<Dense> svd(rows.bottomRows(2));
    EXPECT_LT(svd.singularValues()(1), 1e-10 * svd.singularValues()(0));
    Eigen::Matrix<double, 4, 5> a;
    for (int j = 0; j < 4; ++j) a.row(j) = basis(chart.ring[std::size_t(j)]).transpose();
    EXPECT_LT((a * rows - Dense::Identity(4, 4)).norm(), 1e-9);  // it interpolates
  }
}

TEST(Fit, OpenRingsFitTheirGradient) {
  std::mt19937 random(6);
  Coefficients linear;
  linear << 0.3, -0.8, 0, 0, 0;
  for (int valence = 2; valence <= 9; ++valence) {
    Chart chart = random_ring(2 * valence, random);
    chart.ring.resize(std::size_t(valence));
    chart.closed = false;
    EXPECT_LT(fit_error(chart, linear), 1e-9) << valence;
    EXPECT_TRUE(fit(chart).allFinite());
  }
}

double turning(const Chart& chart) {
  double sum = 0;
  for (std::size_t j = 0; j < chart.ring.size(); ++j) {
    const Vec2 &a = chart.ring[j], &b = chart.ring[(j + 1) % chart.ring.size()];
    sum += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return sum;
}

TEST(Charts, GoRoundOnce) {
  for (const double exponent : {0.0, 0.5, 1.0})
    for (const auto& [name, mesh] : meshes()) {
      SCOPED_TRACE(name);
      const ChartMaker charts(mesh, {.exponent = exponent});
      for (Index v = 0; v < mesh.vertex_count(); ++v)
        EXPECT_NEAR(mesh.interior(v) ? turning(charts.vertex(v)) : 2 * pi, 2 * pi, 1e-12);
      for (Index e = 0; e < Index(mesh.edges.size()); ++e)
        EXPECT_NEAR(mesh.edges[std::size_t(e)].boundary() ? 2 * pi : turning(charts.edge(e)), 2 * pi, 1e-12);
      for (Index f = 0; f < Index(mesh.faces.size()); ++f)
        EXPECT_NEAR(turning(charts.face(f)), 2 * pi, 1e-12);
    }
}

TEST(Charts, SharesAddUpToTheArea) {
  // A control vertex, the points of an edge and those of a face share the metric's area between them.
  for (const auto& [name, mesh] : meshes()) {
    SCOPED_TRACE(name);
    const ChartMaker charts(mesh, {.exponent = 1});
    for (const int n : {1, 2, 4, 8}) {
      double area = 0, expected = 0;
      for (Index v = 0; v < mesh.vertex_count(); ++v)
        if (!mesh.ring(v).empty()) area += charts.vertex(v).area;
      for (Index e = 0; e < Index(mesh.edges.size()); ++e) area += (n - 1) * charts.edge(e).area;
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        area += double(interior_size(mesh.faces[f].quad(), n)) * charts.face(Index(f)).area;
        expected += charts.flat()[f].area;
      }
      EXPECT_NEAR(area / n / n, expected, 1e-12 * expected) << n;
    }
  }
}

TEST(Charts, SpaceTheRowsOfAnEdgeAlike) {
  // Else a function with a slope along the edge has a twist that grows with the level.
  for (const ChartKind kind : {ChartKind::exponential, ChartKind::tangent})
    for (const double blend : {1.0, 0.3})
      for (const auto& [name, mesh] : meshes()) {
        SCOPED_TRACE(name);
        const ChartMaker charts(mesh, {.kind = kind, .exponent = 0.5, .blend = blend});
        for (Index e = 0; e < Index(mesh.edges.size()); ++e) {
          const Chart chart = charts.edge(e);
          const EdgeRingLanes ring(mesh, e);
          for (int lane = 0; lane < 3; ++lane)
            for (int j = 0; j < ring.size; ++j)
              for (int k = 0; k < ring.size; ++k) {
                if (ring.lane[j] != lane || ring.lane[k] != lane) continue;
                const int steps = ring.at[j] - ring.at[k];  // forward along the edge
                const Vec2 moved = chart.ring[std::size_t(j)] - chart.ring[std::size_t(k)];
                EXPECT_LT((moved - steps * chart.ring[0]).norm(), 1e-13) << e << " lane " << lane;
              }
        }
      }
}

TEST(Charts, UniformChartIsRegular) {
  const ControlMesh mesh = control(shaken(bipyramid(7)));
  const Chart chart = ChartMaker(mesh, {.exponent = 0}).vertex(0);
  ASSERT_EQ(chart.ring.size(), 7u);
  for (std::size_t j = 0; j < 7; ++j) {
    EXPECT_NEAR(chart.ring[j].norm(), chart.ring[0].norm(), 1e-14);
    EXPECT_NEAR(chart.ring[j].dot(chart.ring[(j + 1) % 7]) / chart.ring[j].squaredNorm(),
                std::cos(2 * pi / 7), 1e-13);
  }
  const ControlMesh quads = control(shaken(torus(5, 4)));
  const Chart cross = ChartMaker(quads, {.exponent = 0}).vertex(3);
  ASSERT_EQ(cross.ring.size(), 8u);
  for (std::size_t j = 0; j < 8; ++j) EXPECT_NEAR(cross.ring[j].norm(), j % 2 ? std::sqrt(2) : 1, 1e-13);
}

TEST(Charts, BlendEndsAtItsTwoCharts) {
  for (const auto& [name, mesh] : meshes()) {
    SCOPED_TRACE(name);
    const ChartMaker plain(mesh, {.exponent = 0.7}), one(mesh, {.exponent = 0.7, .blend = 1}),
        zero(mesh, {.exponent = 0.7, .blend = 0}), uniform(mesh, {.exponent = 0});
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.ring(v).empty()) continue;
      const Chart a = plain.vertex(v), b = one.vertex(v), c = zero.vertex(v), d = uniform.vertex(v);
      double mean_a = 0, mean_c = 0;
      for (std::size_t j = 0; j < a.ring.size(); ++j) {
        EXPECT_EQ(a.ring[j], b.ring[j]);
        mean_a += a.ring[j].norm();
        mean_c += c.ring[j].norm();
      }
      EXPECT_NEAR(mean_a, mean_c, 1e-12 * mean_a);  // the uniform chart at the chart's mean radius
      const double scale = c.ring[0].norm() / d.ring[0].norm();
      for (std::size_t j = 0; j < a.ring.size(); ++j)
        for (std::size_t k = 0; k < j; ++k)
          EXPECT_NEAR((c.ring[j] - c.ring[k]).norm(), scale * (d.ring[j] - d.ring[k]).norm(), 1e-12);
    }
  }
}

TEST(Charts, TangentPlaneSeesAFlatMeshAsItIs) {
  const ControlMesh mesh = control(mixed_grid(4, 4));
  const ChartMaker tangent(mesh, {.kind = ChartKind::tangent}), plane(mesh, {.exponent = 1});
  const auto expect_congruent = [](const Chart& a, const Chart& b) {
    ASSERT_EQ(a.ring.size(), b.ring.size());
    for (std::size_t j = 0; j < a.ring.size(); ++j) {
      EXPECT_NEAR(a.ring[j].norm(), b.ring[j].norm(), 1e-13);
      EXPECT_NEAR((a.ring[j] - a.ring[0]).norm(), (b.ring[j] - b.ring[0]).norm(), 1e-13);
    }
    EXPECT_NEAR(a.area, b.area, 1e-13);
  };
  for (Index v = 0; v < mesh.vertex_count(); ++v) expect_congruent(tangent.vertex(v), plane.vertex(v));
  for (Index e = 0; e < Index(mesh.edges.size()); ++e) expect_congruent(tangent.edge(e), plane.edge(e));
}

}  // namespace
}  // namespace fairing::test
