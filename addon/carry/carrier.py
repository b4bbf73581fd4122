# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of the control mesh, carried over to all elements of the refined one: plain arrays, no Blender.

Numbers are mixed: linearly in triangles, bilinearly in quads. The weights are whole numbers over a power of two, so in
double precision sums of single-precision values are exact: equal values stay as they are, to the last bit, and a point
that two faces share gets the same value from both.
"""

import numpy as np

from .cells import make_cells
from .centres import Centres
from .control_faces import find_control_faces
from .edges import edge_origin
from .patch import Patch


class Carrier:
    """Carries values from the n vertices, c corners, m faces and e edges of a control mesh to a refined one.

    The refined corners are those of the result's triangles, then of its quads, as in a mesh that is made of them.
    """

    def __init__(self, result, arrays, levels):
        """`result`: the core's, refined `levels` times; `arrays`: the control mesh (positions, edges, corners, offsets)."""
        self.control_count = len(arrays.positions)
        self.vertex_count = len(result.vertices)
        self._arrays = arrays
        self.patches = []
        self._centres = None
        start = 0
        for fine, polygon in zip(result.faces, (result.triangle_polygon, result.quad_polygon), strict=True):
            cells = make_cells(fine.shape[1], levels)
            faces = find_control_faces(fine, polygon, cells, arrays)
            self._centres = self._centres or Centres(faces, arrays)  # triangles come first
            if len(fine):
                self.patches.append(Patch(cells, faces, fine, start))
            start += fine.size
        self.corner_count = start
        self._polygon = np.concatenate([result.triangle_polygon, result.quad_polygon])

    def used_vertices(self):
        """(n,) bool: which control vertices belong to a face."""
        used = np.zeros(self.vertex_count, bool)
        for patch in self.patches:
            used[patch.faces.vertices] = True
        return used[: self.control_count]

    def corner(self, values):
        """(c,) or (c, w) numbers on corners → (refined corners, w) float32. A face's come from its own corners only."""
        values = _table(values)
        known = np.concatenate([values, self._centres.corner(values)])
        out = np.empty((self.corner_count, values.shape[1]), np.float32)
        for patch in self.patches:
            patch.mix_corners(known, out)
        return out

    def point(self, values):
        """(n,) or (n, w) numbers on vertices → (refined vertices, w) float32; the first n are the given ones."""
        values = _table(values)
        known = np.concatenate([values, self._centres.point(values)])
        out = np.zeros((self.vertex_count, values.shape[1]), np.float32)
        for patch in self.patches:
            patch.mix_points(known, out)
        out[: len(known)] = known
        return out

    def own_point(self, values):
        """(n, …) → (refined vertices, …): as given on the control vertices, 0 or False on all others."""
        out = np.zeros((self.vertex_count, *values.shape[1:]), values.dtype)
        out[: len(values)] = values
        return out

    def face(self, values):
        """(m, …) of any type on faces → (refined faces, …)."""
        return values[self._polygon]

    def edge_origin(self, corner_edge, edge_count):
        """(refined edges,) int32: the control edge that each is a piece of, -1 for edges inside of faces.

        `corner_edge` (refined corners,): the edge that leaves each corner; `edge_count`: how many there are.
        """
        origin = np.full(edge_count, -1, np.int32)
        for patch in self.patches:
            edge_origin(patch, self._arrays.edges, corner_edge, origin)
        return origin

    def pick_corner(self, values):
        """(c, …) of any type on corners → (refined corners, …): the value of the nearest corner of the same polygon.

        Of several that are equally near, that of the vertex with the lowest id.
        """
        out = np.empty((self.corner_count, *values.shape[1:]), values.dtype)
        _, lowest = self._centres.lowest()
        for patch in self.patches:
            patch.pick_corners(
                values, self._replace(patch.faces.corners, lowest, len(values)), self._fans(patch), out
            )
        return out

    def pick_point(self, values):
        """(n, …) of any type on vertices → (refined vertices, …): the value of the nearest vertex of the control face.

        Of several that are equally near, the one with the lowest id.
        """
        out = np.zeros((self.vertex_count, *values.shape[1:]), values.dtype)
        lowest, _ = self._centres.lowest()
        for patch in self.patches:
            patch.pick_points(
                values, self._replace(patch.faces.vertices, lowest, len(values)), self._fans(patch), out
            )
        out[: len(values)] = values
        return out

    def _fans(self, patch):
        fans = np.zeros(len(patch.faces.polygon), bool)
        if patch.faces.size == 3:
            fans[self._centres.members] = True
        return fans

    @staticmethod
    def _replace(ids, lowest, count):
        """`ids` with the centres, which have no values to pick, replaced by what is picked for them."""
        replaced = ids.copy()
        centre = replaced >= count
        replaced[centre] = lowest[replaced[centre] - count]
        return replaced


def _table(values):
    values = np.asarray(values)
    return values.reshape(len(values), -1)
