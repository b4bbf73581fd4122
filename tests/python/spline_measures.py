# SPDX-License-Identifier: GPL-3.0-or-later
"""Spline patches evaluated by SciPy, from nets and knots alone."""

import numpy as np
from discrete_fairing import spline_knots
from scipy.interpolate import BSpline


def basis(spans: int, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Values and derivatives (len(at), spans + 3) of the basis functions."""
    spline = BSpline(spline_knots(spans), np.eye(spans + 3), 3)
    return spline(at), spline.derivative()(at)


def evaluate(patches, p: int, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and normals with their lengths, (len(u), len(v), 3), of patch p."""
    (au, du), (av, dv) = (basis(s, at) for s, at in zip(patches.patch_spans[p], (u, v)))
    net = patches.net(p)
    at, along_u, along_v = (
        np.einsum("ai,bj,ijk->abk", a, b, net) for a, b in ((au, av), (du, av), (au, dv))
    )
    return at, np.cross(along_u, along_v)


def gauss(spans: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on [0, 1] that are exact for products of the patches' derivatives."""
    x, w = np.polynomial.legendre.leggauss(6)
    nodes = (np.arange(spans)[:, None] + (1 + x) / 2) / spans
    return nodes.ravel(), np.tile(w / 2 / spans, spans)


def volume(patches) -> float:
    """Inside all patches, by the divergence theorem."""
    total = 0.0
    for p, (spans_u, spans_v) in enumerate(patches.patch_spans.tolist()):
        (u, wu), (v, wv) = gauss(spans_u), gauss(spans_v)
        at, normal = evaluate(patches, p, u, v)
        total += np.einsum("a,b,abk,abk->", wu, wv, at, normal)
    return total / 3


def radii(patches, samples: int = 33) -> np.ndarray:
    """Distances of points of all patches from the origin."""
    t = np.linspace(0, 1, samples)
    found = [evaluate(patches, p, t, t)[0] for p in range(len(patches))]
    return np.linalg.norm(found, axis=3)
