// SPDX-License-Identifier: GPL-3.0-or-later
#include "control_mesh_invariants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace fairing::test {
namespace {

void expect_sides(const ControlMesh& mesh) {
  Index first_side = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Face& face = mesh.faces[f];
    ASSERT_TRUE(face.size == 3 || face.size == 4);
    EXPECT_EQ(face.vertex[3] < 0, face.size == 3);
    EXPECT_EQ(face.first_side, first_side);
    EXPECT_TRUE(face.polygon >= 0 && face.polygon < mesh.input_faces);
    for (int s = 0; s < face.size; ++s) {
      const Index id = face.first_side + s;
      const Side& side = mesh.sides.at(std::size_t(id));
      const Edge& edge = mesh.edges.at(std::size_t(side.edge));
      EXPECT_EQ(side.face, Index(f));
      EXPECT_EQ(side.local, s);
      EXPECT_EQ(edge.side[side.reversed], id);
      EXPECT_EQ(edge.vertex[side.reversed], face.vertex[std::size_t(s)]);
      EXPECT_EQ(edge.vertex[!side.reversed], face.vertex[std::size_t((s + 1) % face.size)]);
    }
    first_side += face.size;
  }
  EXPECT_EQ(first_side, Index(mesh.sides.size()));
}

void expect_edges(const ControlMesh& mesh) {
  std::set<std::array<Index, 2>> pairs;
  std::size_t sides = 0;
  for (const Edge& edge : mesh.edges) {
    EXPECT_NE(edge.vertex[0], edge.vertex[1]);
    EXPECT_TRUE(pairs
                    .insert({std::min(edge.vertex[0], edge.vertex[1]),
                             std::max(edge.vertex[0], edge.vertex[1])})
                    .second);
    sides += std::size_t(edge.side[0] >= 0) + std::size_t(edge.side[1] >= 0);
    EXPECT_TRUE(edge.side[0] >= 0 || edge.side[1] >= 0);
  }
  EXPECT_EQ(sides, mesh.sides.size());
}

// Counter-clockwise: the next spoke is the side that ends in the centre.
void expect_ring(const ControlMesh& mesh, Index v) {
  const auto ring = mesh.ring(v);
  std::set<Index> edges;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Spoke& spoke = ring[i];
    EXPECT_TRUE(edges.insert(spoke.edge).second);
    EXPECT_EQ(mesh.edges.at(std::size_t(spoke.edge)).vertex[!spoke.outward], v);
    EXPECT_EQ(mesh.edges.at(std::size_t(spoke.edge)).side[!spoke.outward] < 0, spoke.face < 0);
    if (spoke.face < 0) {
      EXPECT_EQ(i, ring.size() - 1);
      EXPECT_TRUE(mesh.edges.at(std::size_t(ring[0].edge)).boundary());
      continue;
    }
    const Face& face = mesh.faces.at(std::size_t(spoke.face));
    EXPECT_EQ(face.vertex[std::size_t(spoke.corner)], v);
    EXPECT_EQ(mesh.sides.at(std::size_t(face.first_side + spoke.corner)).edge, spoke.edge);
    const int before = (spoke.corner + face.size - 1) % face.size;
    EXPECT_EQ(mesh.sides.at(std::size_t(face.first_side + before)).edge,
              ring[(i + 1) % ring.size()].edge);
  }
  EXPECT_TRUE(!mesh.interior(v) || ring.size() >= 3);
}

void expect_rings(const ControlMesh& mesh) {
  ASSERT_EQ(Index(mesh.ring_offset.size()), mesh.vertex_count() + 1);
  EXPECT_EQ(mesh.ring_offset.back(), Index(mesh.spokes.size()));
  EXPECT_EQ(mesh.spokes.size(), 2 * mesh.edges.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) expect_ring(mesh, v);
}

void expect_chains(const ControlMesh& mesh) {
  ASSERT_EQ(mesh.feature_edge.size(), mesh.edges.size());
  ASSERT_EQ(Index(mesh.feature_vertex.size()), mesh.vertex_count());
  std::set<Index> in_chains;
  for (const Chain& chain : mesh.chains) {
    EXPECT_EQ(chain.vertices.size(), chain.edges.size() + (chain.closed ? 0u : 1u));
    EXPECT_GE(chain.edges.size(), chain.closed ? 3u : 1u);
    for (std::size_t k = 0; k < chain.edges.size(); ++k) {
      const std::set<Index> ends{chain.vertices[k],
                                 chain.vertices[(k + 1) % chain.vertices.size()]};
      const Edge& edge = mesh.edges.at(std::size_t(chain.edges[k]));
      EXPECT_EQ(ends, (std::set<Index>{mesh.original_vertex(edge.vertex[0]),
                                       mesh.original_vertex(edge.vertex[1])}));
      EXPECT_TRUE(in_chains.insert(chain.edges[k]).second);
      EXPECT_TRUE(mesh.feature_edge[std::size_t(chain.edges[k])]);
      for (Index v : edge.vertex) EXPECT_TRUE(mesh.feature_vertex[std::size_t(v)]);
    }
    const std::set<Index> distinct(chain.vertices.begin(), chain.vertices.end());
    const bool meets_itself = !chain.closed && chain.vertices.front() == chain.vertices.back();
    if (mesh.copies.vertex.empty()) {  // else it may touch itself
      EXPECT_EQ(distinct.size() + meets_itself, chain.vertices.size());
    }
  }
  std::size_t features = 0;
  for (Index e = 0; e < mesh.first_copied_edge(); ++e)
    features += mesh.feature_edge[std::size_t(e)];
  EXPECT_EQ(in_chains.size(), features);
}

void expect_copies(const ControlMesh& mesh) {
  EXPECT_TRUE(std::is_sorted(mesh.copies.vertex.begin(), mesh.copies.vertex.end()));
  EXPECT_TRUE(std::is_sorted(mesh.copies.edge.begin(), mesh.copies.edge.end()));
  for (Index v = mesh.input_vertices; v < mesh.first_centre(); ++v) {
    EXPECT_LT(mesh.original_vertex(v), mesh.input_vertices);
    EXPECT_EQ(mesh.positions[std::size_t(v)], mesh.positions[std::size_t(mesh.original_vertex(v))]);
    EXPECT_FALSE(mesh.ring(v).empty());
  }
  std::map<std::set<Index>, Index> first_between;
  for (Index e = 0; e < Index(mesh.edges.size()); ++e) {
    const Edge& edge = mesh.edges[std::size_t(e)];
    const Edge& original = mesh.edges[std::size_t(mesh.original_edge(e))];
    EXPECT_LT(mesh.original_edge(e), mesh.first_copied_edge());
    for (std::size_t h = 0; h < 2; ++h)
      EXPECT_EQ(mesh.original_vertex(edge.vertex[h]), mesh.original_vertex(original.vertex[h]));
    EXPECT_TRUE(!mesh.nonmanifold(e) || mesh.feature_edge[std::size_t(e)]);
    EXPECT_FALSE(mesh.nonmanifold(e) && mesh.second_edge(e));
    const auto [between, is_first] = first_between.insert(
        {{mesh.original_vertex(edge.vertex[0]), mesh.original_vertex(edge.vertex[1])}, e});
    EXPECT_EQ(mesh.original_edge(e), between->second);
  }
  for (Index f = mesh.first_copied_face(); f < Index(mesh.faces.size()); ++f) {
    const Face& face = mesh.faces[std::size_t(f)];
    const Face& original =
        mesh.faces[std::size_t(mesh.copies.face[std::size_t(f - mesh.first_copied_face())])];
    ASSERT_EQ(face.size, original.size);
    EXPECT_EQ(face.polygon, original.polygon);
    for (int i = 0; i < face.size; ++i) {  // at the same place, reversed, a half each
      const Index v = face.vertex[std::size_t(i)],
                  w = original.vertex[std::size_t((original.size - i) % original.size)];
      EXPECT_EQ(mesh.original_vertex(v), mesh.original_vertex(w));
      EXPECT_NE(mesh.second_vertex(v), mesh.second_vertex(w));
    }
  }
}

}  // namespace

void expect_consistent(const ControlMesh& mesh) {
  EXPECT_GE(mesh.vertex_count(), mesh.input_vertices);
  expect_sides(mesh);
  expect_edges(mesh);
  expect_rings(mesh);
  expect_chains(mesh);
  expect_copies(mesh);
}

}  // namespace fairing::test
