# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import > Offsets: makes half a hull from a yard's table."""

from pathlib import Path
from typing import Any, cast

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ImportHelper

from ..blender import Answer, Context, Mesh, Object
from ..choices import OFFSET_UNITS
from ..errors import JobError
from ..fields import choice, switch
from ..mesh.layers import write_creases
from ..mesh.object import linked_object, select_only
from ..mesh.offset_names import write_names
from ..yard.hull_mesh import HullMesh, hull_mesh
from ..yard.offsets import read
from ..yard.sheet import UNITS, OffsetsError
from .mixins import Action
from .presets import set_job, suit_shapes

_CROWDED = (
    "If the stations' names are no places, give places in a column x, or a row 'spacing, 1200' above the head. "
    "This hull is shorter than it is wide"
)


class IMPORT_MESH_OT_fairing_offsets(ImportHelper, Action, bpy.types.Operator):
    """Make half a hull from a table of offsets (CSV), with vertices named by station and line"""

    bl_idname = "import_mesh.fairing_offsets"
    bl_label = "Import Offsets"
    reasons = ()
    filename_ext = ".csv"

    # without the path of the last import: a given file was dropped
    filepath: StringProperty(subtype="FILE_PATH", options={"SKIP_SAVE"})
    filter_glob: StringProperty(default="*.csv;*.tsv;*.txt", options={"HIDDEN"})
    unit: choice("Unit", "The unit of the table's numbers", OFFSET_UNITS)
    symmetry: switch(
        "Symmetry Plane",
        "Sets Symmetry Plane to Y where the half hull ends in it: keel and stem are round unless creased",
        True,
    )

    def invoke(self, context: Context, event: bpy.types.Event) -> Answer:
        """A dropped file is known; otherwise the browser asks for one."""
        if self.filepath:
            return self.execute(context)
        helper: Any = ImportHelper  # its stub returns None
        return helper.invoke(self, context, event)

    def act(self, context: Context) -> str:
        path = Path(bpy.path.abspath(self.filepath))
        try:
            table = read(path.read_text("utf-8-sig"), UNITS.get(self.unit))
        except OSError as error:
            raise JobError(
                f"Choose another file: {path} cannot be read ({error.strerror})."
            ) from error
        except UnicodeDecodeError as error:
            raise JobError(
                f"Save {path.name} as text in UTF-8: it is no table of offsets."
            ) from error
        except OffsetsError as error:
            raise JobError(f"{path.name}: {error}.") from error
        made = hull_mesh(table)
        if not made.faces:
            raise JobError(f"{path.name}: Add offsets: no two stations have points to join.")
        target = _object(context, path.stem, made)
        select_only(context, [target])
        if self.symmetry and made.is_half:
            context.scene.discrete_fairing.symmetry_plane = "Y"
        parts = [
            f"{len(table.points)} offsets at {len(table.stations)} stations",
            f"{len(made.faces)} faces",
        ]
        if made.creases:
            parts.append(f"{len(made.creases)} edges creased")
        if made.is_crowded:
            self.report({"WARNING"}, _CROWDED)
        set_job(context, "HULL")
        bending = suit_shapes(context, "HULL", [target], {})
        return ", ".join(parts) + (f". {bending}" if bending else "")


def _object(context: Context, name: str, made: HullMesh) -> Object:
    mesh = cast(Mesh, bpy.data.meshes.new(name))
    places = made.positions / context.scene.unit_settings.scale_length
    mesh.from_pydata(places.tolist(), [], made.faces)
    write_names(mesh, made.names)
    if made.creases:
        write_creases(mesh, dict.fromkeys(map(frozenset, made.creases), 1.0))
    return linked_object(context, mesh)


class IO_FH_fairing_offsets(bpy.types.FileHandler):
    """Accepts a table of offsets dropped onto the viewport."""

    bl_idname = "IO_FH_fairing_offsets"
    bl_label = "Offsets"
    bl_import_operator = "import_mesh.fairing_offsets"
    bl_file_extensions = ".csv;.tsv"

    @classmethod
    def poll_drop(cls, context: Context) -> bool:
        return context.area is not None and context.area.type == "VIEW_3D"
