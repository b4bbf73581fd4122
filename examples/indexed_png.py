# SPDX-License-Identifier: GPL-3.0-or-later
"""Small PNG files: each picture has its own palette, in plain NumPy."""

import struct
import zlib
from pathlib import Path

import numpy as np


def write_indexed_png(path, pixels, colours=96):
    """`pixels`: (height, width, 3) from 0 to 1 as displayed, top row first; `colours`: 256 at most."""
    values = np.rint(np.clip(pixels, 0, 1) * 255).astype(np.uint8)
    height, width, _ = values.shape
    palette, ids = _quantize(values.reshape(-1, 3), colours)
    rows = np.zeros((height, width + 1), np.uint8)  # each row begins with its filter, which is none
    rows[:, 1:] = ids.reshape(height, width)
    header = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)
    parts = (
        (b"IHDR", header),
        (b"PLTE", palette.tobytes()),
        (b"IDAT", zlib.compress(rows.tobytes(), 9)),
        (b"IEND", b""),
    )
    Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*part) for part in parts))


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def _quantize(values, colours):
    """(k, 3) uint8 palette by median cut and a few rounds of k-means, and the (n,) ids of the nearest colours."""
    unique, inverse, counts = np.unique(values, axis=0, return_inverse=True, return_counts=True)
    points = unique.astype(np.float32)
    palette = _median_cut(points, counts, colours)
    for _ in range(4):
        nearest = _nearest(points, palette)
        weight = np.bincount(nearest, counts, len(palette))
        used = weight > 0
        for axis in range(3):
            total = np.bincount(nearest, counts * points[:, axis], len(palette))
            palette[used, axis] = total[used] / weight[used]
    palette = np.rint(palette).astype(np.uint8)
    return palette, _nearest(points, palette.astype(np.float32))[inverse.ravel()].astype(np.uint8)


def _median_cut(points, counts, colours):
    boxes = [np.arange(len(points))]
    while len(boxes) < colours:
        spread = [np.ptp(points[box], axis=0).max() * np.sqrt(counts[box].sum()) for box in boxes]
        widest = int(np.argmax(spread))
        if spread[widest] == 0:
            break
        box = boxes.pop(widest)
        box = box[np.argsort(points[box][:, np.argmax(np.ptp(points[box], axis=0))], kind="stable")]
        share = np.cumsum(counts[box])
        cut = int(np.clip(np.searchsorted(share, share[-1] / 2), 1, len(box) - 1))
        boxes += [box[:cut], box[cut:]]
    return np.array(
        [np.average(points[box], axis=0, weights=counts[box]) for box in boxes], np.float32
    )


def _nearest(points, palette):
    distances = (palette**2).sum(1) - 2 * points @ palette.T
    return distances.argmin(1)
