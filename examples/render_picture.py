# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's one picture: for each shape the control mesh beside the result, clay above zebra."""

from pathlib import Path

import bpy
import numpy as np
from render_clay import dress_in_clay
from render_studio import build_studio, render, stand
from render_zebra import dress_in_zebra

TILE = (960, 480)  # pixels of one pair
COLUMNS = 2
CLAY_SAMPLES, ZEBRA_SAMPLES = 20, 10  # denoised; stripes light themselves and are clean early
FADE = 0.05  # of a tile's width
PAPER = (0.815, 0.812, 0.805)  # behind everything, as displayed; darker than the light stripes


def render_pair(control, result, folder, turn=0.0, tip=0.0, stripes=8):
    """Clay and zebra of the two objects, in the current scene; returns the paths of both pictures."""
    paths = [Path(folder) / f"{result.name} {look}.png" for look in ("clay", "zebra")]
    build_studio(*TILE)
    pair = stand([control, result], turn, tip)
    wires = dress_in_clay(*pair)
    render(paths[0], CLAY_SAMPLES)
    for wire in wires:
        wire.hide_render = True
    dress_in_zebra(*pair, stripes=stripes)
    render(paths[1], ZEBRA_SAMPLES)
    return paths


def compose(pairs, path):
    """All tiles on one sheet of paper: shapes in reading order, zebra under clay."""
    width, height = TILE
    rows = -(-len(pairs) // COLUMNS)
    sheet = np.empty((2 * rows * height, COLUMNS * width, 4), np.float32)
    sheet[:] = (*PAPER, 1.0)
    for i, pair in enumerate(pairs):
        row, column = divmod(i, COLUMNS)
        for below, tile in enumerate(pair):
            top = (2 * row + below) * height
            _lay(
                sheet[top : top + height, column * width : (column + 1) * width], load_pixels(tile)
            )
    save(sheet, path)


def _lay(paper, tile):
    """`tile` on `paper`; long shadows fade out at its sides."""
    across = np.linspace(0.0, 1.0, tile.shape[1], dtype=np.float32)
    fade = np.clip(np.minimum(across, 1 - across) / FADE, 0, 1)
    alpha = tile[..., 3:] * fade[:, None]
    paper[..., :3] = alpha * tile[..., :3] + (1 - alpha) * paper[..., :3]


def load_pixels(path):
    """(height, width, 4) float32 as displayed, top row first."""
    image = bpy.data.images.load(str(path))
    width, height = image.size
    values = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    return values.reshape(height, width, 4)[::-1]


def save(sheet, path, alpha=False):
    """Writes (height, width, 4) as displayed, top row first, as a PNG."""
    height, width, _ = sheet.shape
    image = bpy.data.images.new("Picture", width, height, alpha=alpha)
    image.pixels.foreach_set(np.ascontiguousarray(sheet[::-1]).ravel())
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)
