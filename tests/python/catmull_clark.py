# SPDX-License-Identifier: GPL-3.0-or-later
"""One step of Catmull-Clark subdivision with semi-sharp creases, written down as the papers have it [Catmull, Clark
1978; DeRose, Kass, Truong 1998], vertex by vertex: what limit positions are judged by."""

from collections import defaultdict

import numpy as np


def subdivide(vertices, faces, sharp_edges=(), sharp_vertices=()):
    """(vertices, faces, sharp_edges, sharp_vertices) after one step; the old vertices come first.

    `sharp_edges`: {(a, b): sharpness} with a < b, infinity for ever; `sharp_vertices`: {v: sharpness}."""
    vertices = np.asarray(vertices, float)
    sharp, corner = dict(sharp_edges), dict(sharp_vertices)
    beside = defaultdict(list)  # edge: faces
    for f, face in enumerate(faces):
        for a, b in zip(face, [*face[1:], face[0]]):
            beside[min(a, b), max(a, b)].append(f)
    for edge, both in beside.items():
        if len(both) != 2:
            sharp[edge] = np.inf
    middle = np.array([vertices[list(face)].mean(axis=0) for face in faces])
    edges = {edge: len(vertices) + k for k, edge in enumerate(beside)}
    edge_points = []
    for edge, both in beside.items():
        straight = vertices[list(edge)].mean(axis=0)
        share = min(1.0, sharp.get(edge, 0.0))
        smooth = straight if len(both) != 2 else (straight + middle[both].mean(axis=0)) / 2
        edge_points.append(share * straight + (1 - share) * smooth)
    around = defaultdict(list)
    for edge in beside:
        for v in edge:
            around[v].append(edge)
    faces_at = defaultdict(list)
    for f, face in enumerate(faces):
        for v in face:
            faces_at[v].append(f)

    def rule(v, later):
        left = {e: max(0.0, sharp.get(e, 0.0) - later) for e in around[v]}
        ends = [sum(e) - v for e, s in left.items() if s > 0]
        if max(0.0, corner.get(v, 0.0) - later) > 0 or len(ends) > 2:
            return "corner", vertices[v]
        if len(ends) == 2:
            return "crease", 0.75 * vertices[v] + 0.125 * vertices[ends].sum(axis=0)
        n = len(around[v])
        middles = np.mean([vertices[list(e)].mean(axis=0) for e in around[v]], axis=0)
        q = middle[faces_at[v]].mean(axis=0)
        return "smooth", (q + 2 * middles + (n - 3) * vertices[v]) / n

    moved = vertices.copy()
    for v in around:
        (now, here), (then, there) = rule(v, 0), rule(v, 1)
        fading = [
            s for s in [corner.get(v, 0.0), *(sharp.get(e, 0.0) for e in around[v])] if 0 < s <= 1
        ]
        share = 1.0 if now == then or not fading else float(np.mean(fading))
        moved[v] = share * here + (1 - share) * there
    first = len(vertices) + len(edges)
    quads = []
    for f, face in enumerate(faces):
        for k, v in enumerate(face):
            before, after = face[k - 1], face[(k + 1) % len(face)]
            quads.append(
                [
                    v,
                    edges[min(v, after), max(v, after)],
                    first + f,
                    edges[min(v, before), max(v, before)],
                ]
            )
    halves = {}
    for edge, sharpness in sharp.items():
        if sharpness > 1 and edge in edges:
            for v in edge:
                halves[v, edges[edge]] = sharpness - 1
    points = np.concatenate([moved, edge_points, middle])
    return points, quads, halves, {v: s - 1 for v, s in corner.items() if s > 1}
