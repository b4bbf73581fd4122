# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture for each setting: the same object with different values, side by side, for docs/reference/settings.md.

    .venv/bin/python examples/render_settings.py            all of them, to docs/images/settings/
    .venv/bin/python examples/render_settings.py levels     only those named

`python3 build_tools/dev.py setup` makes `.venv`. The pictures are made by the operator itself and rendered by Cycles on
the processor, one after the other: some ten seconds a tile.
"""

import sys
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "examples")]

import settings_meshes as meshes  # noqa: E402
from render_row import View, draw_rows, render_tile  # noqa: E402

OUT = ROOT / "docs" / "images" / "settings"


@dataclass(frozen=True)
class Variant:
    label: str
    settings: dict = field(default_factory=dict)
    key: float = 0.0  # the value of the second shape key, if there is one
    as_it_is: bool = False  # the control mesh itself, not faired
    wires: bool = True  # on it
    make: object = None  # another mesh than the figure's


@dataclass(frozen=True)
class Figure:
    make: object  # a function of settings_meshes
    view: View
    variants: tuple
    common: dict = field(default_factory=dict)  # settings of all variants


def _values(name, *values, label="{}", **others):
    return tuple(Variant(label.format(value), {name: value, **others}) for value in values)


SMOOTH = {"shade_smooth": True, "levels": 4, "energy": "THIN_PLATE"}

FIGURES = {
    "levels": Figure(
        meshes.vase,
        View(3.0, turn=10, height=1.0, wires=True),
        (Variant("Control mesh", as_it_is=True), *_values("levels", 1, 2, 3, label="Levels {}")),
        {"energy": "THIN_PLATE"},
    ),
    "energy": Figure(
        meshes.octahedron,
        View(2.5, turn=32, elevation=17, height=1.0),
        (
            Variant("Control mesh", as_it_is=True),
            *(
                Variant(name, {"energy": key})
                for key, name in (
                    ("THIN_PLATE", "Bending"),
                    ("TOTAL_CURVATURE", "Curvature"),
                )
            ),
        ),
        SMOOTH | {"levels": 5},
    ),
    "zebra": Figure(
        meshes.torus,
        View(3.3, turn=0, elevation=17, height=1.0, look="zebra"),
        (Variant("Control mesh", as_it_is=True, wires=False), Variant("Fair Surface")),
        SMOOTH,
    ),
    "vertices": Figure(
        meshes.scan,
        View(2.5, look="zebra", height=0.9, stripes=9),
        (
            Variant("Through"),
            Variant(
                "Near, 0.01",
                {"interpolation": "APPROXIMATE", "tolerance": 0.01, "tolerance_unit": "SCENE"},
            ),
            Variant(
                "Near, 0.04",
                {"interpolation": "APPROXIMATE", "tolerance": 0.04, "tolerance_unit": "SCENE"},
            ),
        ),
        SMOOTH,
    ),
    "offsets": Figure(
        meshes.offsets,
        View(6.4, turn=-58, elevation=26, look="zebra", height=0.7, stripes=14),
        (
            Variant("As measured"),
            Variant(
                "Near, 10 mm",
                {"interpolation": "APPROXIMATE", "tolerance": 0.01, "tolerance_unit": "SCENE"},
            ),
            Variant("Eased", key=1.0, make=meshes.eased_offsets),
        ),
        SMOOTH | {"symmetry_plane": "Y"},
    ),
    "tension": Figure(
        meshes.finned,
        View(5.2, turn=35, elevation=20, height=1.5),
        (
            Variant("Control mesh", as_it_is=True),
            *_values("tension", 0, 0.3, 1, label="Tension {}", energy="TOTAL_CURVATURE"),
        ),
        SMOOTH,
    ),
    "boundary_edges": Figure(
        meshes.tent,
        View(3.2, turn=20, elevation=30, height=0.85),
        (
            Variant("Control mesh", as_it_is=True),
            Variant("Smooth all around", {"boundary": "CURVE"}),
            Variant(
                "One side Straight", {"boundary": "CURVE"}, make=lambda: meshes.tent_with_side(2)
            ),
            Variant("One side Free", {"boundary": "CURVE"}, make=lambda: meshes.tent_with_side(3)),
        ),
        SMOOTH,
    ),
    "fixed_normals": Figure(
        meshes.sheet_with_normal,
        View(3.0, turn=20, elevation=24, height=0.4),
        (
            Variant("None fixed"),
            Variant("30° from upright", make=lambda: meshes.sheet_with_normal(30)),
            Variant("50° from upright", make=lambda: meshes.sheet_with_normal(50)),
        ),
        SMOOTH,
    ),
    "creases": Figure(
        meshes.rimmed_box,
        View(2.1, turn=30, elevation=28, height=0.5),
        (
            Variant("Control mesh", as_it_is=True),
            Variant("Edge Creases off", {"use_crease_attribute": False}),
            Variant("Edge Creases on"),
            Variant("On, Corner Angle 60°", {"use_corner_angle": True}),
        ),
        SMOOTH,
    ),
    "threshold": Figure(
        lambda: meshes.rimmed_box(0.8, 0.3),
        View(2.0, turn=30, elevation=12, height=0.45),
        (
            Variant("Creases 0.8 and 0.3", as_it_is=True),
            *_values("crease_threshold", 0.2, 0.5, 1.0, label="Threshold {}"),
        ),
        SMOOTH,
    ),
    "crease_angle": Figure(
        meshes.can,
        View(2.9, turn=5, elevation=25, height=0.75),
        (
            Variant("Off"),
            Variant("Crease Angle 40°", {"use_crease_angle": True}),
            Variant("Crease Angle 20°", {"use_crease_angle": True, "crease_angle": 0.349}),
        ),
        SMOOTH,
    ),
    "sharp_edges": Figure(
        meshes.marked_can,
        View(2.9, turn=5, elevation=25, height=0.75),
        (
            Variant("Control mesh", as_it_is=True),
            Variant("Sharp Edges off"),
            Variant("Sharp Edges on", {"use_sharp_edges": True}),
        ),
        SMOOTH,
    ),
    "spacing": Figure(
        meshes.uneven,
        View(3.0, elevation=12, height=1.1),
        (
            Variant("Control mesh", as_it_is=True),
            *(
                Variant(f"Spacing {text}", {"metric_exponent": value})
                for text, value in (("0", 0), ("½", 0.5), ("1", 1))
            ),
        ),
        SMOOTH,
    ),
    "joint": Figure(
        meshes.ramp,
        View(8.0, turn=-18, elevation=12, height=1.0),
        (
            Variant("Touching", {"joint": "POSITION"}),
            Variant("Tangent", {"joint": "TANGENT"}),
            Variant("Curvature", {"joint": "CURVATURE"}),
        ),
        SMOOTH | {"use_selection": True},
    ),
    "control_mesh": Figure(
        meshes.half_suzanne,
        View(3.1, turn=20, height=0.85),
        (Variant("As Modelled"), Variant("With Modifiers", {"mesh_source": "EVALUATED"})),
        SMOOTH | {"levels": 3},
    ),
    "shape_keys": Figure(
        meshes.suzanne_with_key,
        View(3.6, turn=10, height=1.15),
        tuple(Variant(f"Value {key:.1f}", key=key) for key in (0.0, 0.5, 1.0)),
        SMOOTH | {"levels": 3},
    ),
    "copy_modifiers": Figure(
        meshes.bent_column,
        View(3.2, turn=0, elevation=12, height=1.15),
        (
            Variant("The source, bent", as_it_is=True, wires=False),
            Variant("Copy Modifiers off"),
            Variant("Copy Modifiers on", {"copy_modifiers": True}),
        ),
        SMOOTH,
    ),
}


def draw_variant(figure, variant, tile):
    control = (variant.make or figure.make)()
    surfaces = [control]
    wired = variant.as_it_is and variant.wires or figure.view.wires
    if not variant.as_it_is:
        bpy.ops.object.fairing_surface(**figure.common | variant.settings)
        surfaces = [bpy.context.active_object]
        if surfaces[0].data.shape_keys:
            surfaces[0].data.shape_keys.key_blocks[1].value = variant.key
    render_tile(tile, variant.label, figure.view, control, surfaces, wired)


ROWS = {
    name: [partial(draw_variant, figure, variant) for variant in figure.variants]
    for name, figure in FIGURES.items()
}

if __name__ == "__main__":
    draw_rows(sys.argv[1:], ROWS, OUT)
