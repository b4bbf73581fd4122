# SPDX-License-Identifier: GPL-3.0-or-later
"""One sheet of the gallery: a column for each surface, a row for each look, labels, and a legend of the colours."""

from dataclasses import dataclass
from math import cos, radians, sin
from pathlib import Path
from types import SimpleNamespace

import bpy
import numpy as np
from indexed_png import write_indexed_png
from mathutils import Matrix, Vector
from render_clay import CREASE, WIRE, add_wire, clay
from render_picture import PAPER, load_pixels
from render_studio import DISTANCE, build_studio, dress, render
from render_zebra import dress_in_zebra

from addon.inspection import display, measures
from addon.inspection.materials import curvature_material

TILE = 264, 250  # pixels in the picture; rendered twice as large
COLOURS = 256  # of the palette
HEAD = 34  # pixels over the first row, for the labels
WIDTH = 2.4  # of a tile, in the studio's units
SAMPLES = {"clay": 8, "zebra": 5, "curvature": 4}
ROWS = {
    "zebra": "zebra stripes:\nbreaks are folds,\nkinks are jumps\nin curvature",
    "curvature": "mean curvature:\nred bulges,\nblue is hollow",
}
DOT = 0.035  # in the studio's units
INK = (0.012, 0.013, 0.016)
CREASED_FROM = radians(30)  # where a surface with creases is shaded sharp


@dataclass
class Column:
    label: str
    vertices: np.ndarray
    faces: list
    crease_edges: list = ()
    is_control: bool = False
    creased: bool = False


def draw(path, folder, columns, view, looks, samples=1.0):
    """Writes the picture; it fills the current, empty scene."""
    looks = looks or ("clay", "zebra", "curvature")
    targets = [_object(column) for column in columns]
    limit = _measure(columns, targets, view) if "curvature" in looks else None
    _place(targets, view)
    build_studio(2 * TILE[0], 2 * TILE[1])
    _aim(view, targets)
    extras = {target: _dots(columns[0], target) if view.dots else [] for target in targets}
    extras[targets[0]] += _wires(columns[0], targets[0])
    tiles = {}
    for look in looks:
        _dress(look, targets, view)
        for k, target in enumerate(targets):
            if look != "clay" and columns[k].is_control:
                continue
            for other in targets:
                for part in (other, *extras[other]):
                    part.hide_render = other is not target
            tiles[look, k] = Path(folder) / f"{look} {k}.png"
            render(tiles[look, k], max(1, round(samples * SAMPLES[look])))
    sheet = _sheet(looks, columns, tiles)
    if limit is not None:
        _bar(sheet, len(looks))
    labels = _labels(columns, looks, limit)
    overlay = _rendered_text(labels, sheet.shape, Path(folder) / "text.png")
    sheet = overlay[..., 3:] * overlay[..., :3] + (1 - overlay[..., 3:]) * sheet
    height, width, _ = sheet.shape
    write_indexed_png(
        path, sheet.reshape(height // 2, 2, width // 2, 2, 3).mean(axis=(1, 3)), COLOURS
    )


def _object(column):
    mesh = bpy.data.meshes.new(column.label)
    mesh.from_pydata(column.vertices.tolist(), [], [list(map(int, f)) for f in column.faces])
    mesh.update()
    if not column.is_control:
        mesh.shade_smooth()
        if column.creased:
            mesh.set_sharp_from_angle(angle=CREASED_FROM)
    target = bpy.data.objects.new(column.label, mesh)
    bpy.context.scene.collection.objects.link(target)
    return target


def _measure(columns, targets, view):
    """Curvature colours on all surfaces, by one range, which is returned."""
    surfaces = [t for c, t in zip(columns, targets, strict=True) if not c.is_control]
    for target in surfaces:
        display.write_values(target, "MEAN", None)
    judge = surfaces[min(1, len(surfaces) - 1)].data
    mean = np.empty(len(judge.vertices), np.float32)
    judge.attributes[display.VALUES["MEAN"]].data.foreach_get("value", mean)
    limit = view.contrast * float(np.percentile(np.abs(mean), 90))
    limit = float(f"{limit:.2g}")
    for target in surfaces:
        settings = SimpleNamespace(use_fixed_range=True, fixed_range=limit)
        display.write_colours(target.data, "MEAN", settings)
    return limit


def _place(targets, view):
    """Turns and scales all surfaces alike, and puts each on the floor."""
    turn = Matrix.Rotation(radians(view.turn), 4, "Z")
    points = [np.array([(turn @ v.co)[:] for v in t.data.vertices]) for t in targets]
    low = np.min([p.min(0) for p in points], axis=0)
    high = np.max([p.max(0) for p in points], axis=0)
    up = cos(radians(view.elevation)) * (high[2] - low[2])
    depth = sin(radians(view.elevation)) * (high[1] - low[1])
    size = max((high[0] - low[0]) / 2.05, (up + depth) / 2.05)
    for target, own in zip(targets, points, strict=True):
        centre = Vector((-(low[0] + high[0]) / 2, -(low[1] + high[1]) / 2, -own[:, 2].min()))
        target.matrix_world = Matrix.Scale(1 / size, 4) @ Matrix.Translation(centre) @ turn
    bpy.context.view_layer.update()


def _aim(view, targets):
    camera = bpy.context.scene.camera
    camera.data.ortho_scale = WIDTH
    elevation = radians(view.elevation)
    direction = Vector((0, -cos(elevation), sin(elevation)))
    tops = [max((t.matrix_world @ v.co).z for v in t.data.vertices) for t in targets]
    middle = Vector((0, 0, max(tops) / 2))
    camera.location = middle + DISTANCE * direction
    camera.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()


def _wires(column, target):
    creased = {tuple(sorted(e)) for e in column.crease_edges}
    named = {tuple(sorted(e.vertices)): e.index for e in target.data.edges}
    plain = [i for edge, i in named.items() if edge not in creased]
    wires = [add_wire(target, plain, "Wire", WIRE, 0.011)]
    if creased:
        wires.append(add_wire(target, [named[edge] for edge in creased], "Crease", CREASE, 0.022))
    return wires


def _dots(column, target):
    """A ball on every control vertex: the surface's first vertices."""
    dots = []
    for vertex in target.data.vertices[: len(column.vertices)]:
        bpy.ops.mesh.primitive_uv_sphere_add(
            segments=24, ring_count=12, radius=DOT, location=target.matrix_world @ vertex.co
        )
        dots.append(bpy.context.object)
        dots[-1].data.shade_smooth()
        dress(dots[-1], _plain("Dot", CREASE))
    return dots


def _plain(name, colour):
    """A material that gives off this colour."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    emission, output = (
        tree.nodes.new("ShaderNodeEmission"),
        tree.nodes.new("ShaderNodeOutputMaterial"),
    )
    emission.inputs["Color"].default_value = (*colour, 1)
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def _dress(look, targets, view):
    if look == "zebra":
        dress_in_zebra(*targets, stripes=view.stripes)
        return
    material = clay() if look == "clay" else curvature_material()
    for target in targets:
        dress(target, material)


def _sheet(looks, columns, tiles):
    """The tiles on paper, at twice the size of the picture."""
    width, height = 2 * TILE[0], 2 * TILE[1]
    sheet = np.empty((2 * HEAD + len(looks) * height, len(columns) * width, 3), np.float32)
    sheet[:] = PAPER
    for (look, k), path in tiles.items():
        tile = load_pixels(path)
        across = np.linspace(0.0, 1.0, width, dtype=np.float32)
        fade = np.clip(np.minimum(across, 1 - across) / 0.04, 0, 1)  # of long shadows
        alpha = tile[..., 3:] * fade[:, None]
        top = 2 * HEAD + looks.index(look) * height
        place = sheet[top : top + height, k * width : (k + 1) * width]
        place[:] = alpha * tile[..., :3] + (1 - alpha) * place
    return sheet


def _bar_box(rows):
    """The legend's left, top, right and bottom, in pixels of the sheet."""
    top = 2 * HEAD + (rows - 1) * 2 * TILE[1] + round(1.28 * TILE[1])
    return round(0.3 * TILE[0]), top, round(1.7 * TILE[0]), top + 28


def _bar(sheet, rows):
    left, top, right, bottom = _bar_box(rows)
    linear = measures.colours_of(np.linspace(-1, 1, right - left), (-1.0, 1.0), True)[:, :3]
    sheet[top:bottom, left:right] = np.where(
        linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055
    )


def _labels(columns, looks, limit):
    """(text, x, y of its middle in the sheet's pixels, size)."""
    width, height = 2 * TILE[0], 2 * TILE[1]
    labels = [
        (c.label, (k + 0.5) * width, 1.15 * HEAD, 30)
        for k, c in enumerate(columns)
        if "clay" in looks or not c.is_control
    ]
    for row, look in enumerate(looks):
        if look in ROWS:
            middle = 2 * HEAD + (row + (0.47 if look == "zebra" else 0.4)) * height
            labels.append((ROWS[look], width / 2, middle, 30))
    if limit is not None:
        left, _, right, bottom = _bar_box(len(looks))
        for text, x in ((f"−{limit:g}", left), ("0", (left + right) / 2), (f"{limit:g}", right)):
            labels.append((text, x, bottom + 28, 25))
    return labels


def _rendered_text(labels, shape, path):
    """All labels as one transparent picture of the sheet's size."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    height, width, _ = shape
    build_studio(width, height)
    scene = bpy.context.scene
    for thing in scene.objects:
        thing.hide_render = thing.type != "CAMERA"
    scene.camera.data.ortho_scale = 1.0  # of the longer side
    scene.camera.location, scene.camera.rotation_euler = (0, 0, 5), (0, 0, 0)
    unit = 1.0 / max(width, height)
    ink = _plain("Ink", INK)
    for words, x, y, size in labels:
        text = bpy.data.curves.new("Label", "FONT")
        text.body, text.size = words, size * unit
        text.align_x, text.align_y = "CENTER", "CENTER"
        text.materials.append(ink)
        board = bpy.data.objects.new("Label", text)
        board.location = ((x - width / 2) * unit, (height / 2 - y) * unit, 0)
        scene.collection.objects.link(board)
    scene.cycles.use_denoising = False
    render(path, 8)
    return load_pixels(path)
