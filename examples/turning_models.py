# SPDX-License-Identifier: GPL-3.0-or-later
"""The models of the site's page of turning surfaces, as Blender exports them: one glTF file a model.

    .venv/bin/python examples/turning_models.py FOLDER

A file has the control mesh's edges as lines, and a surface for each way, under the names that the page shows.
"""

import sys
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import demo_meshes  # noqa: E402
from jobs import modelled, subdivided  # noqa: E402
from quiet import quiet  # noqa: E402
from render_modelling import MODELS  # noqa: E402

import addon  # noqa: E402

TURNING = {
    **{name: MODELS[name][0] for name in ("hull", "fender")},
    "branching": modelled(demo_meshes.branching),
}
WAYS = {
    "Subdivision Surface": subdivided,
    "Thin plate": lambda control: faired(control, "THIN_PLATE"),
    "Total curvature": lambda control: faired(control, "TOTAL_CURVATURE"),
}


def faired(control, energy):
    """The surface of an energy, beside its control mesh."""
    bpy.ops.object.select_all(action="DESELECT")
    control.select_set(True)
    bpy.context.view_layer.objects.active = control
    with quiet():
        bpy.ops.object.fairing_surface(energy=energy)
    return bpy.context.active_object


def control_lines(control):
    """The edges alone: a file would have faces as triangles."""
    mesh = bpy.data.meshes.new("Control mesh")
    edges = [tuple(edge.vertices) for edge in control.data.edges]
    mesh.from_pydata([vertex.co for vertex in control.data.vertices], edges, [])
    return linked(bpy.data.objects.new("Control mesh", mesh))


def linked(made):
    """The same object, in the scene."""
    bpy.context.scene.collection.objects.link(made)
    return made


def surface(make, name):
    """One surface under its name, with modifiers applied and without its control mesh."""
    control = make()
    made = WAYS[name](control)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    mesh = bpy.data.meshes.new_from_object(made.evaluated_get(depsgraph))
    mesh.materials.clear()
    for used in {control, made}:
        bpy.data.objects.remove(used)
    return linked(bpy.data.objects.new(name, mesh))


def export(name, path):
    """Writes one model."""
    make = TURNING[name]
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    for way in WAYS:
        surface(make, way)
    control = make()
    control_lines(control)
    bpy.data.objects.remove(control)
    with quiet():
        bpy.ops.export_scene.gltf(
            filepath=str(path),
            export_format="GLB",
            export_materials="NONE",
            export_texcoords=False,
            export_animations=False,
            use_mesh_edges=True,
        )


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    addon.register()
    try:
        for model in TURNING:
            export(model, folder / f"{model}.glb")
    finally:
        addon.unregister()  # the module bpy would hang at exit with classes of ours still registered
