# SPDX-License-Identifier: GPL-3.0-or-later
"""A boat builder's day: table of offsets, fair hull, wrong offsets found and eased, sections, plan, hydrostatics, STEP.

`python boat_day.py [OUT]` in a Python with `bpy` and the extension's folder on the path, or in Blender's text editor
with the extension installed. Each line that calls an operator is a click, or two where a file is named; `hulls.py`
has the three tables, and the truth.
"""

import sys
from pathlib import Path

import bpy
import hulls
import numpy as np

DRAUGHTS = {"offsets_bulb.csv": 1.5, "offsets_chine.csv": 0.5, "offsets_yacht.tsv": 0.45}  # metres


def error(hull: hulls.Hull, target: bpy.types.Object) -> tuple[float, float]:
    """Root mean square and largest distance of the vertices of `target` from the truth, in millimetres."""
    truth = np.array(list(hull.points.values()))
    names = [item.value.decode() for item in target.data.attributes["fair_offset"].data]
    keys = [f"station {s}, {n}" if s[:1].isdigit() else f"{s}, {n}" for s, n in hull.points]
    places = dict(zip(keys, truth))
    off = [
        np.linalg.norm(1000.0 * np.array(v.co) - places[n])
        for v, n in zip(target.data.vertices, names)
    ]
    return float(np.sqrt(np.mean(np.square(off)))), float(max(off))


def day(hull: hulls.Hull, out: Path) -> dict[str, float]:
    """Runs the whole day for one table, writes files to `out`, and returns the measurements."""
    clicks = 0
    stem = Path(hull.file).stem

    def click(operator, cost: int = 1, **settings) -> None:
        nonlocal clicks
        if operator(**settings) != {"FINISHED"}:
            raise RuntimeError(f"{operator.idname()} did not finish")
        clicks += cost

    click(bpy.ops.import_mesh.fairing_offsets, 3, filepath=str(hulls.HERE / hull.file))
    source = bpy.context.active_object
    before = error(hull, source)
    click(bpy.ops.object.fairing_select_strained, by="FLOOR")
    click(bpy.ops.object.fairing_ease_selected)
    click(bpy.ops.object.mode_set, mode="OBJECT")
    after = error(hull, source)
    click(bpy.ops.object.fairing_strain_table, 2, filepath=str(out / f"{stem}_strain.csv"))
    # Bending: the STEP file of Flow Lines takes 90 s for 1
    click(bpy.ops.object.fairing_surface, symmetry_plane="Y", use_corner_angle=True)
    click(bpy.ops.object.fairing_close)
    closed = bpy.context.active_object
    click(bpy.ops.object.fairing_hydrostatics, 2, draught=DRAUGHTS[hull.file])
    click(
        bpy.ops.object.fairing_hydrostatics_table, 2, filepath=str(out / f"{stem}_hydrostatics.csv")
    )
    click(bpy.ops.export_scene.fairing_lines, 3, filepath=str(out / f"{stem}.dxf"))
    click(bpy.ops.export_scene.fairing_step, 3, filepath=str(out / f"{stem}.step"))
    click(bpy.ops.object.fairing_section_curves)
    sections = len(bpy.context.selected_objects)
    faces = len(closed.data.polygons)
    return {
        "clicks": clicks,
        "rms before": before[0],
        "largest before": before[1],
        "rms after": after[0],
        "largest after": after[1],
        "sections": sections,
        "faces": faces,
    }


def main(out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    for make in hulls.HULLS:
        hull = make()
        for target in list(bpy.data.objects):
            bpy.data.objects.remove(target)
        found = day(hull, out)
        said = ", ".join(f"{name} {value:.4g}" for name, value in found.items())
        print(f"{hull.file}: {said}")


if __name__ == "__main__":
    if not hasattr(bpy.types, "IMPORT_MESH_OT_fairing_offsets"):
        sys.path.append(str(Path(__file__).resolve().parents[1]))
        import addon

        addon.register()
    main(Path(sys.argv[1] if len(sys.argv) > 1 and not bpy.app.binary_path else "out/boat_day"))
