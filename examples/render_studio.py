# SPDX-License-Identifier: GPL-3.0-or-later
"""A small photo studio: soft key, cool fill and a rim light, a floor that only takes shadows."""

from math import cos, radians, sin

import bpy
from mathutils import Vector

DISTANCE = 18.0
ELEVATION = radians(17)
SPACING = 2.35  # between the middles of the two objects, which are two units across


def build_studio(width, height):
    """Sets up the current scene for pictures of `width` × `height` pixels with a transparent background."""
    scene = bpy.context.scene
    _render_settings(scene, width, height)
    _world(scene)
    _floor()
    _light("Key", (-1.9, -3.4, 9.0), 5.0, 720, (1.0, 0.965, 0.92))
    _light("Fill", (7.0, -6.0, 3.0), 6.0, 60, (0.88, 0.94, 1.0), shadow=False)
    _light("Rim", (2.5, 7.0, 5.0), 3.0, 170, (1.0, 1.0, 1.0), shadow=False)
    _camera(scene)


def stand(originals, turn, tip=0.0):
    """Copies of `originals` side by side on the floor, all scaled alike to fit; `turn` about the vertical, `tip` sideways.

    The last one decides the size. The originals are hidden from the picture. Returns the copies.
    """
    copies = []
    size = None
    for original in reversed(originals):
        copy = original.copy()
        copy.data = original.data.copy()
        bpy.context.scene.collection.objects.link(copy)
        original.hide_render = True
        copy.location, copy.scale = (0, 0, 0), (1, 1, 1)
        copy.rotation_mode = "XYZ"
        copy.rotation_euler = (tip, 0, turn)
        bpy.context.view_layer.update()
        low, high = _bounds(copy)
        size = size or max((high.x - low.x) / 2.1, (high.z - low.z) / 1.95)
        copy.scale = (1 / size,) * 3
        copies.insert(0, (copy, low / size, high / size))
    middle = (len(copies) - 1) / 2
    for i, (copy, low, high) in enumerate(copies):
        centre = (low + high) / 2
        copy.location = ((i - middle) * SPACING - centre.x, -centre.y, -low.z)
    bpy.context.view_layer.update()
    aim_at_height(max(high.z - low.z for _, low, high in copies) / 2)
    return [copy for copy, _, _ in copies]


def aim_at_height(height):
    camera = bpy.context.scene.camera
    target = Vector((0, 0, height - 0.06))
    direction = Vector((0, -1, 0)) * cos(ELEVATION) + Vector((0, 0, 1)) * sin(ELEVATION)
    camera.location = target + DISTANCE * direction
    camera.rotation_euler = direction.to_track_quat("Z", "Y").to_euler()


def render(path, samples):
    scene = bpy.context.scene
    scene.cycles.samples = samples
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)


def dress(target, material):
    """Gives each face `material` and no other."""
    target.data.materials.clear()
    target.data.materials.append(material)


def _bounds(target):
    points = [target.matrix_world @ vertex.co for vertex in target.data.vertices]
    low, high = (Vector(map(pick, zip(*points, strict=True))) for pick in (min, max))
    return low, high


def _render_settings(scene, width, height):
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = True
    scene.cycles.denoising_quality = "BALANCED"
    scene.cycles.denoising_prefilter = "FAST"
    scene.cycles.max_bounces = 2
    scene.cycles.caustics_reflective = scene.cycles.caustics_refractive = False
    scene.render.film_transparent = True
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"
    scene.view_settings.view_transform = "Standard"


def _world(scene):
    world = bpy.data.worlds.new("Studio")
    scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.90, 0.93, 0.97, 1)
    background.inputs["Strength"].default_value = 0.24


def _floor():
    bpy.ops.mesh.primitive_plane_add(size=60)
    floor = bpy.context.object
    floor.name = "Floor"
    floor.is_shadow_catcher = True


def _light(name, location, size, watts, colour, shadow=True):
    light = bpy.data.lights.new(name, "AREA")
    light.shape = "DISK"
    light.size, light.energy, light.color = size, watts, colour
    light.use_shadow = shadow
    lamp = bpy.data.objects.new(name, light)
    bpy.context.scene.collection.objects.link(lamp)
    lamp.location = location
    lamp.rotation_euler = (
        (Vector(location) - Vector((0, 0, 0.8))).to_track_quat("Z", "Y").to_euler()
    )


def _camera(scene):
    camera = bpy.data.cameras.new("Camera")
    camera.type = "ORTHO"  # both objects are seen from the very same direction
    camera.ortho_scale = 2 * SPACING + 0.55
    scene.camera = bpy.data.objects.new("Camera", camera)
    scene.collection.objects.link(scene.camera)
