# SPDX-License-Identifier: GPL-3.0-or-later
"""Networks of curves as Blender's objects."""

import bpy


def bezier(curve):
    """A Bézier object, selected, exactly as the pieces of `curve` are."""
    count = len(curve.pieces) + (0 if curve.closed else 1)
    data, spline = _spline(curve.name, "BEZIER", "bezier_points", count, curve.closed)
    rows = spline.bezier_points
    for k, point in enumerate(rows):
        point.handle_left_type = point.handle_right_type = "FREE"
        ahead = curve.pieces[k] if k < len(curve.pieces) else None
        behind = curve.pieces[k - 1] if k or curve.closed else None
        point.co = ahead[0] if ahead is not None else behind[3]
        point.handle_right = ahead[1] if ahead is not None else point.co
        point.handle_left = behind[2] if behind is not None else point.co
    return _linked(curve.name, data)


def poly(name, points, closed=False, kind="POLY"):
    """A poly or NURBS object through, or near, `points`."""
    data, spline = _spline(name, kind, "points", len(points), closed)
    for row, point in zip(spline.points, points, strict=True):
        row.co = (*point, 1.0)
    return _linked(name, data)


def _spline(name, kind, rows, count, closed):
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new(kind)
    getattr(spline, rows).add(count - 1)
    spline.use_cyclic_u = closed
    return data, spline


def _linked(name, data):
    made = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(made)
    made.select_set(True)
    bpy.context.view_layer.objects.active = made
    return made


def scene(make):
    """The Bézier objects of a network, all selected, by name."""
    made = {curve.name: bezier(curve) for curve in make()}
    bpy.context.view_layer.update()
    return made


def surface(**settings):
    """Runs the operator on what is selected; the new surface."""
    assert bpy.ops.object.fairing_curves(**settings) == {"FINISHED"}
    return bpy.context.active_object
