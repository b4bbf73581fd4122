# SPDX-License-Identifier: GPL-3.0-or-later
"""Auto keeps the flats of bevelled bodies, takes cages with other rims or hollows as Subdivision Surface does, and
says so."""

import bpy
import numpy as np
import pytest
from fake_layout import draw
from mathutils import Vector
from scenes import (
    add,
    add_rounded_box,
    add_suzanne,
    again,
    edit,
    fair,
    positions,
    settings,
    to_object_mode,
)
from shapes import lathe

from addon import core
from addon.jobs.fair import Job
from addon.mesh.read import read_mesh
from addon.ui import main

SIZE, LOOP = np.array([75.0, 150.0, 9.0]), 1.5


def phone():
    """A box with two loop cuts beside each edge, as for Subdivision Surface."""
    cuts = [np.array([-s / 2, LOOP - s / 2, s / 2 - LOOP, s / 2]) for s in SIZE]
    ids, faces = {}, []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in (0, 3):
            for i in range(3):
                for j in range(3):
                    face = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        at = [0, 0, 0]
                        at[axis], at[u], at[v] = end, a, b
                        face.append(ids.setdefault(tuple(at), len(ids)))
                    faces.append(face if end else face[::-1])
    return add("Phone", [[cuts[k][at[k]] for k in range(3)] for at in ids], faces)


def open_phone():
    source = phone()
    edit(source, "FACE", [4])
    bpy.ops.mesh.delete(type="FACE")
    to_object_mode()
    return source


def creased():
    source = phone()
    crease = source.data.attributes.new("crease_edge", "FLOAT", "EDGE").data
    crease.foreach_set("value", np.ones(len(source.data.edges), np.float32))
    return source


def marked():
    source = phone()
    bpy.ops.object.fairing_flat_faces()
    return source


def slab():
    bpy.ops.mesh.primitive_cube_add(scale=(1.0, 3.0, 0.4))
    return bpy.context.object


def stack():
    """A cylinder as Blender makes it: its side is one face high, longer than the caps are wide."""
    bpy.ops.mesh.primitive_cylinder_add()
    return bpy.context.object


def chamfered():
    """The same with chamfers around both caps, whose vertices have three faces each."""
    source = stack()
    caps = [f.index for f in source.data.polygons if len(f.vertices) > 4]
    edit(source, "FACE", caps)
    bpy.ops.mesh.bevel(offset=0.1, affect="EDGES")
    to_object_mode()
    return source


def bracket():
    """An L with chamfers all around: its two largest faces have six corners and are concave."""
    outline = np.array([(0, 0), (60, 0), (60, 20), (20, 20), (20, 50), (0, 50)], float)
    points = [(*corner, z) for z in (0.0, 30.0) for corner in outline]
    sides = [[k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6] for k in range(6)]
    source = add("Bracket", points, [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11], *sides])
    edit(source, "FACE", range(8))
    bpy.ops.mesh.bevel(offset=1.5, affect="EDGES")
    to_object_mode()
    return source


def edited(source, operator):
    edit(source, "FACE", range(len(source.data.polygons)))
    operator()
    to_object_mode()
    return source


def of_triangles(make):
    """The same cut into triangles: caps as fans, sides along their diagonals."""
    return edited(make(), bpy.ops.mesh.quads_convert_to_tris)


def vase():
    """A vase with walls, on a base of one face that flares into its side."""
    outside = [(3, 0), (4, 2), (4.5, 5), (3.5, 8), (2, 10), (2.5, 11)]
    inside = [(2.2, 11), (1.7, 10), (3.2, 8), (4.2, 5), (3.7, 2), (2.7, 0.4)]
    return add("Vase", *lathe(outside + inside, 16))


def dish():
    """A cube whose top is inset and pushed in: walls and a floor of one face each, as long as wide."""
    bpy.ops.mesh.primitive_cube_add(scale=(1.0, 1.0, 0.6))
    source = bpy.context.object
    top = max(source.data.polygons, key=lambda face: face.center.z).index
    edit(source, "FACE", [top])
    bpy.ops.mesh.inset(thickness=0.1)
    bpy.ops.mesh.extrude_region_move(TRANSFORM_OT_translate={"value": (0.0, 0.0, -1.0)})
    to_object_mode()
    return source


def bowl():
    """A bowl with walls on a base less wide than the faces around it."""
    outside, inside = (
        [(18, 0), (50, 18), (70, 40), (80, 70)],
        [(77, 70), (67, 41), (48, 20), (17, 4)],
    )
    return add("Bowl", *lathe(outside + inside, 16))


def flipped():
    return edited(bowl(), bpy.ops.mesh.flip_normals)


def with_a_knob():
    """A cube with a face inset and pulled out: no border of a face turns inwards all around."""
    source = dish()
    points = source.data.attributes["position"].data
    for vertex in source.data.vertices:
        if abs(vertex.co.z + 0.4) < 1e-3:
            points[vertex.index].vector = (*vertex.co.xy, 1.6)
    return source


def vertices_line():
    lines = [str(line) for line in draw(main.VIEW3D_PT_fairing)]
    return [line for line in lines if line.startswith(("Limit: ", "Flats: ", "Through every"))]


CAGES = {"loops": phone, "vase": vase, "dish": dish, "bowl": bowl, "bowl inside out": flipped}
BEVELLED = {
    "chamfer": lambda: add_rounded_box(SIZE, LOOP, 1),
    "rim": lambda: add_rounded_box(SIZE, LOOP, 2),
    "round rim": lambda: add_rounded_box(SIZE, LOOP, 4),
    "chamfered stack": chamfered,
    "chamfered stack of triangles": lambda: of_triangles(chamfered),
    "bracket": bracket,
}
OTHERS = {
    "open": open_phone,
    "creased": creased,
    "kept flat": marked,
    "triangles": lambda: of_triangles(phone),
    "slab": slab,
    "slab of triangles": lambda: of_triangles(slab),
    "stack": stack,
    "stack of triangles": lambda: of_triangles(stack),
    "knob": with_a_knob,
    "Suzanne": add_suzanne,
}


@pytest.mark.parametrize("name", CAGES)
def test_they_pass_where_subdivision_surface_does(name):
    source = CAGES[name]()
    job = Job(bpy.context, source, settings())
    assert job.settings.interpolation == "LIMIT"
    assert [n for n in job.notes if "tight rims, hollows or slits" in n and "Through" in n]
    assert vertices_line() == ["Limit: tight rims, hollows or slits"]


@pytest.mark.parametrize("name", BEVELLED)
def test_flats_and_walls_of_bevelled_bodies_are_kept(name):
    job = Job(bpy.context, BEVELLED[name](), settings())
    assert job.settings.interpolation == "FLATS" and len(job.arguments["flat_faces"])
    assert [n for n in job.notes if "flats and walls between tight rims" in n and "Through" in n]
    assert vertices_line() == ["Flats: flats and walls between tight rims"]
    others = Job(bpy.context, job.source, settings(energy="TOTAL_CURVATURE"))
    assert others.settings.interpolation in ("LIMIT", "EXACT"), "only Bending keeps flats"


def test_a_concave_face_does_not_fold():
    """Subdivision splits it from its middle, outside of which one of its sides lies: folds of 129 degrees."""
    bracket()
    surface = core.measured(read_mesh(fair(levels=3).data))
    assert surface.fold_angles[0].max() < 45.0


def test_edits_find_flats_anew():
    """A wall that is pulled out of its plane is flat no longer."""
    source = add_rounded_box(SIZE, LOOP, 2)
    job = Job(bpy.context, source, settings(interpolation="FLATS"))
    source.data.attributes["position"].data[0].vector += Vector((0.0, 0.0, 3.0))
    moved = Job(bpy.context, source, settings(interpolation="FLATS"))
    assert len(moved.arguments["flat_faces"]) < len(job.arguments["flat_faces"])


@pytest.mark.parametrize("name", OTHERS)
def test_all_else_passes_through_its_vertices(name):
    job = Job(bpy.context, OTHERS[name](), settings())
    assert job.settings.interpolation == "EXACT" and not job.notes
    assert vertices_line() == ["Through every vertex"]


@pytest.mark.parametrize(
    "changes", [{"interpolation": "EXACT"}, {"use_selection": True}, {"use_crease_angle": True}]
)
def test_settings_that_decide_otherwise(changes):
    source = phone()
    source.data.polygons[4].select = True
    assert Job(bpy.context, source, settings(**changes)).settings.interpolation == "EXACT"


def test_rims_may_be_a_modifiers():
    """With modifiers Auto judges the mesh that is faired: a box itself has no rims."""
    bpy.ops.mesh.primitive_cube_add(size=20.0)
    source = bpy.context.object
    bevel = source.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = LOOP, 2
    for read, interpolation in (("ORIGINAL", "EXACT"), ("EVALUATED", "FLATS")):
        job = Job(bpy.context, source, settings(mesh_source=read))
        assert job.settings.interpolation == interpolation
    bpy.context.scene.discrete_fairing.mesh_source = "EVALUATED"
    assert not vertices_line()  # the panel does not evaluate them


def test_flat_faces_are_flat_and_through_remains_a_choice():
    """Of both large sides, off their rims: what Through quilts by 1.5 mm is flat."""
    source = phone()

    def off(surface):
        points = positions(surface.data)
        inside = (np.abs(points[:, :2]) < 0.3 * SIZE[:2]).all(axis=1)
        return np.abs(np.abs(points[inside, 2]) - SIZE[2] / 2).max() / SIZE.max()

    surface = fair()
    assert surface.discrete_fairing.interpolation == "LIMIT" and off(surface) < 1e-4
    through = again(source, interpolation="EXACT")
    assert off(through) > 5e-3
    given = positions(source.data)
    np.testing.assert_array_equal(positions(through.data)[: len(given)], given)


@pytest.mark.parametrize("make", [chamfered, lambda: of_triangles(chamfered)])
def test_a_chamfered_cylinder_keeps_its_radius_and_nothing_is_wrong_with_it(capfd, make):
    """Bent everywhere it bulges by 6 %, of triangles by 10: its wall is one face high."""
    radii = {}
    for how in ("AUTO", "EXACT"):
        make()
        target = fair(levels=3, interpolation=how)
        radii[how] = np.hypot(*positions(target.data)[:, :2].T).max()
    assert abs(radii["AUTO"] - 1.0) < 2e-3 and radii["EXACT"] > 1.04
    assert "bulges" not in capfd.readouterr().out
