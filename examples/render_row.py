# SPDX-License-Identifier: GPL-3.0-or-later
"""Variants of one object side by side, each with a label below: a row of tiles as one small PNG."""

from dataclasses import dataclass
from math import cos, radians, sin
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import numpy as np
from indexed_png import write_indexed_png
from mathutils import Matrix, Vector
from render_clay import CREASE, WIRE, add_wire, clay, creased_edges
from render_picture import PAPER, load_pixels
from render_studio import DISTANCE, build_studio, dress, render
from render_zebra import dress_in_zebra

import addon

TILE = (260, 270)  # pixels in the picture; rendered twice as large
WIDTH = 2.4  # of a tile, in the studio's units
LABEL = 0.2  # that the label takes of its height
SAMPLES = {"clay": 12, "zebra": 8, "own": 12}  # own: with the materials that it has
INK = (0.012, 0.013, 0.016)
MARKED = (0.0, 0.30, 0.62)  # edges that are marked sharp


@dataclass(frozen=True)
class View:
    """The view of all tiles of a row: `span` units of the mesh fit into a tile's width."""

    span: float
    turn: float = 25.0  # degrees about the vertical
    elevation: float = 17.0  # degrees, of the camera
    height: float = 0.5  # of the middle of what is seen over the floor, in the mesh's units
    look: str = "clay"
    stripes: int = 10
    wires: bool = False  # on the surfaces; a control mesh has them anyway


def draw_rows(names, rows, folder, lengths=None):
    """PNGs in `folder` of those `rows` that `names` has, of all if it is empty. Each is a list of
    functions that render one tile to a path. `lengths`: tiles a line, of pictures with several lines.
    """
    unknown = {*names} - {*rows}
    if unknown:
        raise SystemExit(
            f"No such picture: {', '.join(sorted(unknown))}. There are {', '.join(rows)}."
        )
    folder.mkdir(parents=True, exist_ok=True)
    addon.register()
    try:
        for name in names or rows:
            _draw_row(rows[name], folder / f"{name}.png", (lengths or {}).get(name))
    finally:
        addon.unregister()  # the module bpy would hang at exit with classes of ours still registered


def _draw_row(row, path, length):
    with TemporaryDirectory() as folder:
        tiles = [Path(folder) / f"{i}.png" for i in range(len(row))]
        for tile, draw in zip(tiles, row, strict=True):
            bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
            draw(tile)
        compose_row(tiles, path, length)
    print(f"{path.name}: {path.stat().st_size // 1000} kB", flush=True)


def render_tile(path, label, view, control, surfaces, wired):
    """Renders the `surfaces` of the current scene, `wired` with their edges drawn; changes the scene."""
    width, height = (2 * pixels for pixels in TILE)
    place(view, surfaces)
    build_studio(width, height)
    aim(view)
    for surface in surfaces:
        if view.look == "clay":
            dress(surface, clay())
    if view.look == "zebra":
        dress_in_zebra(*surfaces, stripes=view.stripes)
    if wired:
        _draw_wires(surfaces[0])
    control.hide_render = control not in surfaces
    _write_label(label)
    render(path, SAMPLES[view.look])


def compose_row(tiles, path, length=None):
    """The tiles side by side on paper, at half their size; `length` in each line, all by default."""
    papers = [_on_paper(load_pixels(tile)) for tile in tiles]
    length = length or len(tiles)
    lines = [papers[k : k + length] for k in range(0, len(papers), length)]
    row = np.concatenate([np.concatenate(line, axis=1) for line in lines])
    height, width, _ = row.shape
    write_indexed_png(path, row.reshape(height // 2, 2, width // 2, 2, 3).mean(axis=(1, 3)))


def place(view, surfaces):
    """Scales and turns everything, and puts the surfaces on the floor."""
    turn = Matrix.Rotation(radians(view.turn), 4, "Z") @ Matrix.Scale(WIDTH / view.span, 4)
    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    evaluated = [surface.evaluated_get(graph) for surface in surfaces]
    low = min((turn @ o.matrix_world @ v.co).z for o in evaluated for v in o.data.vertices)
    lift = Matrix.Translation((0, 0, -low)) @ turn
    for anything in bpy.context.scene.objects:
        anything.matrix_world = lift @ anything.matrix_world
    bpy.context.view_layer.update()


def aim(view):
    """Points the studio's camera."""
    camera = bpy.context.scene.camera
    camera.data.ortho_scale = WIDTH
    elevation = radians(view.elevation)
    direction = Vector((0, -cos(elevation), sin(elevation)))
    middle = Vector((0, 0, view.height * WIDTH / view.span - LABEL / 2))
    camera.location = middle + DISTANCE * direction
    camera.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()


def _draw_wires(owner):
    mesh = owner.data
    creased = creased_edges(mesh)
    marked = sorted({edge.index for edge in mesh.edges if edge.use_edge_sharp} - {*creased})
    plain = sorted({*range(len(mesh.edges))} - {*creased, *marked})
    add_wire(owner, plain, "Wire", WIRE, 0.009)
    add_wire(owner, creased, "Crease", CREASE, 0.022)
    add_wire(owner, marked, "Marked", MARKED, 0.022)


def _write_label(label):
    """A text before the camera, at the bottom of the tile."""
    text = bpy.data.curves.new("Label", "FONT")
    text.body = label
    text.size = 0.155
    text.align_x = "CENTER"
    text.space_line = 0.85
    text.materials.append(_ink())
    board = bpy.data.objects.new("Label", text)
    bpy.context.scene.collection.objects.link(board)
    board.parent = bpy.context.scene.camera
    lines = label.count("\n")
    board.location = (0, -0.5 * WIDTH * TILE[1] / TILE[0] + 0.085 + 0.15 * lines, -1)
    for ray in ("diffuse", "glossy", "shadow", "transmission"):
        setattr(board, f"visible_{ray}", False)


def _ink():
    material = bpy.data.materials.new("Ink")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    emission, output = (
        tree.nodes.new("ShaderNodeEmission"),
        tree.nodes.new("ShaderNodeOutputMaterial"),
    )
    emission.inputs["Color"].default_value = (*INK, 1)
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def _on_paper(tile):
    alpha = tile[..., 3:]
    return alpha * tile[..., :3] + (1 - alpha) * np.float32(PAPER)
