// SPDX-License-Identifier: GPL-3.0-or-later
// Named tiny meshes for the tests. All are oriented outwards (or upwards) and clean unless their
// name says otherwise.
#pragma once

#include <array>
#include <initializer_list>
#include <vector>

#include "mesh/polygon_mesh.h"

namespace fairing::test {

using Point = std::array<double, 3>;
using Polygon = std::vector<std::int64_t>;

OwnedPolygonMesh make_mesh(const std::vector<Point>& points, const std::vector<Polygon>& faces);

// Closed.
OwnedPolygonMesh tetrahedron();
OwnedPolygonMesh cube();  // six quads, corners at (±1, ±1, ±1)
OwnedPolygonMesh cube_triangles();
OwnedPolygonMesh octahedron();
OwnedPolygonMesh icosahedron();   // on the unit sphere
OwnedPolygonMesh dodecahedron();  // twelve pentagons
OwnedPolygonMesh square_pyramid();
OwnedPolygonMesh torus(int around, int across);  // quads; radii 2 and 1
OwnedPolygonMesh two_tetrahedra();               // two components

// Every quad of a mesh of quads, cut from its first corner.
OwnedPolygonMesh triangulated(const OwnedPolygonMesh& quads);

// The mesh with z raised by `height` sin(2x + y).
OwnedPolygonMesh waved(OwnedPolygonMesh mesh, double height);

// With a boundary.
OwnedPolygonMesh single_triangle();
OwnedPolygonMesh single_quad();
OwnedPolygonMesh fan(int triangles);  // a closed flat fan: the hub is vertex 0, of that valence
OwnedPolygonMesh half_fan(int triangles);      // the hub, vertex 0, on the boundary
OwnedPolygonMesh grid(int columns, int rows);  // unit quads in z = 0
OwnedPolygonMesh open_cone(int triangles);     // apex 0 at height 1
OwnedPolygonMesh open_cylinder(int around);    // one ring of quads, two boundary loops
OwnedPolygonMesh roof();                       // two quads over the ridge 0-1, at a right angle

// Polygons for splitting, each one face in z = 0.
OwnedPolygonMesh l_shape();      // six corners, star-shaped
OwnedPolygonMesh u_shape();      // eight corners, mirror-symmetric, no point sees all of it
OwnedPolygonMesh arrow();        // a concave quad, reflex at corner 3
OwnedPolygonMesh flat_corner();  // a quad that looks like a triangle: 180 degrees at corner 1
OwnedPolygonMesh warped_quad(double height);  // a unit square with two opposite corners lifted
OwnedPolygonMesh quad_doublet();              // two quads around the interior vertex 1 of valence 2

}  // namespace fairing::test
