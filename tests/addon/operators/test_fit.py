# SPDX-License-Identifier: GPL-3.0-or-later
"""Fair Surface on Scan: scans and cages in their places, and cages that it makes."""

import bmesh
import bpy
import numpy as np
import pytest
from fake_layout import draw
from live_scenes import follow
from mathutils import Matrix
from scans import blob_cage, blob_scan, cube_sphere, on_blob
from scenes import (
    CUBE,
    activate,
    add,
    add_ball,
    bmesh_of,
    faces_at_edges,
    positions,
    recompute,
    refused,
    to_object_mode,
)

from addon import errors
from addon.cad.fit import PatchJob
from addon.check.defects import recall_defects
from addon.inspection import display
from addon.inspection.colours import NEUTRAL, value_range
from addon.jobs.fit import OUTLIERS, TOO_COARSE, UNCOVERED
from addon.live import registry, switch
from addon.mesh.layers import layer_values
from addon.mesh.scans import read_scans
from addon.settings import PatchOptions
from addon.surfaces.freshness import SCAN_CHANGED, SCAN_MOVED, SOURCE_CHANGED, why_stale
from addon.ui.inspect import VIEW3D_PT_fairing_inspect
from addon.ui.main import VIEW3D_PT_fairing


def cage_of_cube():
    return add("Cage", (0.6 * np.array(CUBE[0])).tolist(), CUBE[1])


def fit(*objects, **options):
    """The surface on the scans, drawn to the cage that is the last of `objects`, if there is one."""
    if objects:
        activate(*objects)
    assert bpy.ops.object.fairing_fit(**options) == {"FINISHED"}
    return bpy.context.active_object


def world(target):
    matrix = np.array(target.matrix_world)
    return positions(target.data) @ matrix[:3, :3].T + matrix[:3, 3]


def test_the_border_near_a_cloud_stays_as_far_as_the_cage(capsys):
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=40, y_subdivisions=40)
    points = positions(bpy.context.object.data)
    points[:, 2] = 0.6 * np.cos(1.5 * points[:, 0]) - 0.1
    cloud = add("Cloud", points.tolist(), [])
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=5, y_subdivisions=5, size=1.9)
    made = fit(cloud, bpy.context.object, levels=2)
    assert np.abs(world(made)[:, :2]).max() == pytest.approx(0.95, abs=0.03)
    assert made.discrete_fairing.boundary == "FREE" and "stays as far" in capsys.readouterr().out
    assert why_stale(made) == ""


@pytest.mark.parametrize(
    ("faces", "said", "off"), [(40, "QuadriFlow made no cage", 0.06), (90, "With 90 faces", 0.05)]
)
def test_a_cage_reaches_into_every_part_of_a_scan(faces, said, off, capsys):
    """A ball with a rod, which quads leave out, or few quads do."""
    scan = add_ball("Scan", 5)
    bpy.ops.mesh.primitive_cylinder_add(radius=0.15, depth=3, location=(0, 0, 1.5))
    activate(bpy.context.object, scan)
    bpy.ops.object.join()
    scan.data.remesh_voxel_size = 0.04
    bpy.ops.object.voxel_remesh()
    made = fit(levels=2, cage_faces=faces)
    assert said in capsys.readouterr().out
    assert positions(bpy.data.objects["Scan Cage"].data)[:, 2].max() > 2.5
    assert world(made)[:, 2].max() == pytest.approx(3, abs=off)
    assert len([mesh for mesh in bpy.data.meshes if "Cage" in mesh.name]) == 2  # and the surface's


@pytest.mark.parametrize("size", [1.0, 1e-3])
def test_scans_of_any_size_get_a_cage_of_quads(size):
    """QuadriFlow refuses edges shorter than 1e-4: of a scan in metres those are a tenth of a millimetre."""
    scan = add_ball("Scan", 6, radius=size)
    scan.data.vertices[0].co = scan.data.vertices[scan.data.edges[0].vertices[1]].co * 0.99999
    made = fit(scan, levels=1, cage_faces=60)
    cage = bpy.data.objects["Scan Cage"]
    assert {len(face.vertices) for face in cage.data.polygons} == {4}
    assert np.linalg.norm(world(made), axis=1).mean() == pytest.approx(size, rel=0.02)


def part(name, keep, **place):
    """A ball's vertices that `keep` takes, in an object that stands and is scaled somehow."""
    made = add_ball(name, 5, noise=0.003)
    for key, value in place.items():
        setattr(made, key, value)
    follow()
    with bmesh_of(made.data) as bm:
        lost = [vertex for vertex in bm.verts if not keep(vertex.co)]
        bmesh.ops.delete(bm, geom=lost, context="VERTS")
    made.data.transform(made.matrix_world.inverted())
    return made


def test_scans_alone_get_one_cage():
    place = {"location": (1, 2, 3), "scale": (2, 0.5, 3), "rotation_euler": (1, 0.3, 0)}
    above = part("Above", lambda co: co.z > -0.3, **place)
    below = part("Below", lambda co: co.z < 0.2, scale=(0.01, 0.01, 0.01))
    made, cage = fit(above, below, levels=2, cage_faces=80), bpy.data.objects["Above Cage"]
    assert made.name == "Above Cage Fit" and 40 < len(cage.data.polygons) < 160
    assert set(faces_at_edges(cage.data)) == {2}  # one closed cage, where the scans overlap
    assert off(made) < 0.004
    assert [scan.target for scan in made.discrete_fairing_fit.scans] == [above, below]
    assert why_stale(made) == ""
    open_ones = [part(name, lambda co: co.z > 0.5) for name in ("Cap", "Cap 2")]
    count = len(bpy.data.objects), len(bpy.data.meshes)
    activate(*open_ones)
    refused("Cap, Cap 2: Close", bpy.ops.object.fairing_fit)
    assert (len(bpy.data.objects), len(bpy.data.meshes)) == count


def test_what_cannot_be_fitted_is_said():
    scan, cage = add_ball("Scan", 3), cage_of_cube()
    count = len(bpy.data.objects)
    activate(scan, cage)
    cage.scale.x = 0
    refused("Cage: Type a scale other than 0", bpy.ops.object.fairing_fit)
    cage.scale.x = 1
    scan.data.vertices[3].co.x = np.nan
    refused("Scan: Delete", bpy.ops.object.fairing_fit)
    scan.data.vertices[3].co.x = 0
    activate(cage, scan)
    refused("Scan: Select the scan first and the cage last", bpy.ops.object.fairing_fit)
    activate(cage)
    cage.select_set(False)
    refused("Select the scan", bpy.ops.object.fairing_fit)
    cloud = add("Cloud", positions(scan.data).tolist(), [])
    activate(cloud)
    refused("Cloud: Draw a cage over it", bpy.ops.object.fairing_fit)
    add_ball("Lost", 3).data.vertices[3].co.x = np.nan
    refused("Lost: Delete", bpy.ops.object.fairing_fit)
    line = [(i, i + 1, i + 2) for i in range(40)]
    activate(add("Line", [(float(i), 0.0, 0.0) for i in range(42)], line))
    refused("Line: Draw a cage over it", bpy.ops.object.fairing_fit)
    activate(add("Box", *CUBE))
    refused("Box: Select a scan. This mesh has 8 points", bpy.ops.object.fairing_fit)
    activate(add("Bare", [], []))
    refused("Bare: Select a scan. This mesh has 0 points", bpy.ops.object.fairing_fit)
    assert len(bpy.data.objects) == count + 5


def test_a_surface_that_crosses_itself_near_a_scan_asks_for_a_nearer_cage(capsys):
    vertices, faces = blob_cage(6, 0.02)
    cage = add("Cage", (3 * vertices).tolist(), faces.tolist())
    sphere, quads = cube_sphere(40)
    scan = add("Scan", on_blob(sphere * [1.9, 1.2, 1.1]).tolist(), quads.tolist())
    fit(scan, cage)
    for said in (capsys.readouterr().out, " ".join(draw(VIEW3D_PT_fairing))):
        assert "crosses itself" in said and "draw the cage nearer to the scan" in said
        assert "set Vertices" not in said


def test_a_scan_that_is_inside_out_is_said(capsys):
    scan = add_ball("Scan", 4)
    scan.scale = (1, -1, 1)  # which turns nothing inside out
    follow()
    fit(scan, levels=1, cage_faces=40)
    assert "inside out" not in capsys.readouterr().out
    scan.hide_set(False)
    scan.data.flip_normals()
    fit(scan, levels=1, cage_faces=40)
    said = capsys.readouterr().out
    assert "Flip the normals of scan and cage" in said and "They point inwards" in said


def fitted():
    scan, cage = add_ball("Scan", 5, noise=0.01), cage_of_cube()
    return scan, cage, fit(scan, cage, levels=3)


def test_the_surface_alone_is_shown_and_show_source_shows_what_it_was_made_from():
    """All three lay among one another."""
    scan, cage, made = fitted()
    assert [o.visible_get() for o in (scan, cage, made)] == [False, False, True]
    assert bpy.ops.object.fairing_show_source() == {"FINISHED"}
    assert scan.visible_get() and cage.visible_get() and cage.select_get() and not scan.select_get()
    bpy.context.scene.discrete_fairing.hide_source = False
    fit(scan, cage, levels=1)
    assert scan.visible_get() and cage.visible_get()


def test_patches_near_a_scan_are_mended_at_the_cage():
    """Curvature, which settles sooner elsewhere, is not for scans."""
    job = PatchJob(bpy.context, fitted()[2], PatchOptions(1e-4, 1e-3, 4))
    said = errors.remedy("SURFACE_TOLERANCE", job.settings, job.remedies)
    assert "cage" in said and "Curvature" not in said


def off(target, centre=(0, 0, 0)):
    return np.sqrt(np.mean((np.linalg.norm(world(target) - centre, axis=1) - 1) ** 2))


def test_recompute_fits_again_and_follows_the_cage():
    scan, cage, made = fitted()
    assert made.name == "Cage Fit" and made not in (scan, cage)
    assert np.array_equal(positions(cage.data), np.float32(0.6 * np.array(CUBE[0])))
    before = world(made)
    assert len(before) == 386 and off(made) < 0.007  # with noise of 0.01, and cells of 0.2
    scan.hide_set(True)  # its modifiers count as before
    recompute(made)
    np.testing.assert_array_equal(world(made), before)
    assert why_stale(made) == ""
    cage.data.vertices[0].co *= 1.3
    cage.data.update()
    follow()
    assert why_stale(made) == SOURCE_CHANGED
    recompute()
    assert np.abs(world(made) - before).max() > 0 and off(made) < 0.007


def test_amount_of_the_panel_counts_when_it_is_made_again():
    _, _, made = fitted()
    near, weight = made.discrete_fairing_fit, made.discrete_fairing_fit.weight
    near.amount, near.tolerance = "TOLERANCE", 0.05
    recompute()
    assert near.amount == "TOLERANCE" and near.weight < weight / 2
    shown = draw(VIEW3D_PT_fairing)
    above = shown[: shown.index("object.fairing_recompute")]
    assert {"Scan to Surface", "amount", "tolerance"} <= set(above)
    assert "of 95 % of the scan" in " ".join(map(str, above))


def test_a_scan_that_is_gone_is_said():
    scan, _, made = fitted()
    bpy.data.objects.remove(scan)
    refused("Its scan was deleted", bpy.ops.object.fairing_recompute)
    assert off(made) < 0.007


def test_a_scan_that_moves_or_is_edited_leaves_the_surface_out_of_date():
    scan, cage, made = fitted()
    both = [scan, cage]
    for one in both:
        one.location.x += 0.5
    follow()
    recompute(made)  # which follows its cage
    assert why_stale(made) == ""
    scan.location.z += 0.1
    follow()
    assert why_stale(made) == SCAN_MOVED
    recompute(made)
    assert why_stale(made) == ""
    assert off(made, (0.5, 0, 0.1)) < 0.007
    scan.data.vertices[3].co *= 1.1
    scan.data.update()
    follow()
    assert why_stale(made) == SCAN_CHANGED


def test_live_follows_the_scan():
    scan, _, made = fitted()
    switch.switch_on(made)
    (session,) = registry.sessions()
    assert not session.needs_look()
    scan.location.z += 0.1
    follow()
    assert session.needs_look() and session.follow()  # as the timer does
    assert off(made, (0, 0, 0.1)) < 0.02
    assert not session.needs_look()
    scan.data.transform(Matrix.Scale(1.2, 4))
    scan.data.update()
    follow()
    assert session.needs_look() and session.follow()
    switch.switch_off(made, bpy.context)
    radii = np.linalg.norm(world(made) - (0, 0, 0.1), axis=1)
    assert radii == pytest.approx(1.2, abs=0.03) and why_stale(made) == ""


def deviation(made):
    display.show(made, "DEVIATION", bpy.context.scene.discrete_fairing_inspection)
    return layer_values(made.data.attributes["fair_deviation"])


def test_deviation_is_from_the_scan():
    scan, _, made = fitted()
    assert 0.001 < np.abs(deviation(made)).mean() < 0.01
    # a scan whose points are all off by as much
    scan.scale = (0.9, 0.9, 0.9)
    follow()
    assert deviation(made).mean() == pytest.approx(0.1, abs=0.01)
    scan.data.clear_geometry()
    scan.data.from_pydata((1.2 * world(made)).tolist(), [], [])
    assert deviation(made).mean() == pytest.approx(-0.08, abs=0.01)  # points, inwards


def test_faces_that_are_too_coarse_and_strays_are_listed_in_check():
    points, (vertices, faces) = blob_scan(26_000, 0.004), blob_cage(2)
    points[7] *= 1.5
    scan = add("Scan", points.tolist(), [])
    cage = add("Cage", vertices.tolist(), faces.tolist())
    fit(scan, cage, levels=1)
    defects, _ = recall_defects(cage)
    (coarse,) = [defect for defect in defects if defect["code"] == TOO_COARSE]
    activate(cage)
    assert bpy.ops.object.fairing_select_defect(index=defects.index(coarse)) == {"FINISHED"}
    assert bpy.context.mode == "EDIT_MESH"
    to_object_mode()
    chosen = [face.index for face in cage.data.polygons if face.select]
    assert chosen == coarse["elements"]
    (strays,) = recall_defects(scan)[0]
    assert strays["code"] == OUTLIERS and 7 in strays["elements"]


def test_faces_without_points_are_grey_and_can_be_selected():
    points, (vertices, faces) = blob_scan(26_000, 0.002), blob_cage(6)
    scan = add("Scan", points[points[:, 0] < 0.9].tolist(), [])  # its end is not scanned
    cage = add("Cage", vertices.tolist(), faces.tolist())
    made = fit(scan, cage, levels=2)
    bare = np.repeat([polygon.index for polygon in cage.data.polygons], 16)
    (uncovered,) = [d for d in recall_defects(cage)[0] if d["code"] == UNCOVERED]
    bare = np.isin(bare, uncovered["elements"])
    assert 3 < len(uncovered["elements"]) < len(faces) / 4
    settings = bpy.context.scene.discrete_fairing_inspection
    made.discrete_fairing_inspection.mode = "DEVIATION"
    rgba = layer_values(made.data.attributes[display.COLOUR])
    grey = (rgba == np.float32((*NEUTRAL, 1))).all(axis=1).reshape(-1, 4)
    np.testing.assert_array_equal(grey.all(axis=1), bare)
    np.testing.assert_array_equal(grey.any(axis=1), bare)
    values = layer_values(made.data.attributes["fair_deviation"])
    everywhere = value_range(values, np.ones(len(values), bool), True)
    assert display.legend(made.data)[1] < 0.7 * everywhere[1]  # of faces with points
    assert "Grey: no points of the scan" in draw(VIEW3D_PT_fairing_inspect)
    settings.deviation_object = cage  # which is everywhere
    assert "Grey: no points of the scan" not in draw(VIEW3D_PT_fairing_inspect)
    assert "object.fairing_select_faults" in draw(VIEW3D_PT_fairing)
    assert bpy.ops.object.fairing_select_faults() == {"FINISHED"}
    to_object_mode()
    chosen = np.array([face.select for face in made.data.polygons])
    np.testing.assert_array_equal(chosen, bare)


def test_instances_and_point_clouds_count():
    part = add_ball("Part", 4)
    bpy.context.collection.objects.unlink(part)
    shared = bpy.data.collections.new("Shared")
    shared.objects.link(part)
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", shared
    empty.location, empty.scale = (3, 0, 0), (2, 2, -2)
    bpy.context.collection.objects.link(empty)
    follow()
    found = read_scans(bpy.context, [empty])
    assert np.linalg.norm(found.points - (3, 0, 0), axis=1) == pytest.approx(2, abs=1e-5)
    a, b, c = (found.points[found.triangles[:, k]] for k in range(3))
    assert (np.einsum("ij,ij->i", np.cross(b - a, c - a), a - (3, 0, 0)) > 0).all()
    cage = cage_of_cube()
    cage.location, cage.scale = (3, 0, 0), (2, 2, 2)
    radii = np.linalg.norm(world(fit(empty, cage, levels=3)) - (3, 0, 0), axis=1)
    assert np.abs(radii - 2).max() < 0.05
