# SPDX-License-Identifier: GPL-3.0-or-later
"""Records the pages' first clicks of each trade in a window, picture by picture. Run by
build_tools/recordings.py, as `blender … --python record_trades.py -- NAME`. Time stands still while
Blender works, so a recording says nothing about speed. The pictures have no pointer; its places are in
frames.json.
"""

import json
import os
import sys
import traceback
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "blender"))
sys.path.insert(0, str(Path(__file__).parent))

import bpy
import harness
import jobs
import settings_meshes
from trade_pages import scripted

HOLD = 8  # frames that a result stays: a second
GLIDE = 3  # frames of the pointer on its way to a button
DRAG = 14  # of a vertex, each a picture
ORBIT = 12
PURPOSES = ("HULL", "PANEL", "MECHANICAL", "CHARACTER", "SCAN_PATCH", "POINTS")  # in two rows
NEARER = 0.8  # than Blender takes the view
SCALE = 0.8  # of the interface, so that the whole panel is seen


class Film:
    """Frames in their order: a picture, the pointer, and how many frames it stays."""

    def __init__(self):
        self.folder = Path(os.environ["DF_SCREENSHOTS"])
        self.frames, self.pictures, self.pointer = [], 0, (480, 400)

    def note(self, stays=1, pressed=False):
        """Adds the last picture once more."""
        picture = f"{self.pictures - 1:03}.png"
        self.frames.append([picture, *self.pointer, stays, pressed])

    def shoot(self, stays=1, pressed=False):
        """A new picture, once the viewport is drawn; a generator."""
        yield from harness.drawn()
        yield 0.3
        harness.photograph(f"{self.pictures:03}")
        self.pictures += 1
        self.note(stays, pressed)

    def glide(self, place):
        """Moves the pointer there over the last picture."""
        start = self.pointer
        for step in range(1, GLIDE + 1):
            share = step / GLIDE
            self.pointer = tuple(
                round(a + share * (b - a)) for a, b in zip(start, place, strict=True)
            )
            self.note()

    def click(self, call, below, share=0.5):
        """Clicks a button of the sidebar; a generator that ends when no run is left."""
        place = yield from harness.find_button(
            harness.sidebar(), f"bpy.ops.object.{call}", share, below
        )
        self.glide(place)
        self.note(2, pressed=True)
        harness.xdotool("mousemove", *place)
        yield 0.3
        harness.xdotool("click", 1)
        yield 0.5
        yield from jobs.waited()
        harness.sidebar().tag_redraw()
        yield from self.shoot(HOLD)

    def orbit(self):
        """Turns the view a little around the model; a generator."""
        for way in ("ORBITLEFT", "ORBITRIGHT"):
            for _ in range(ORBIT // 2):
                with bpy.context.temp_override(**harness.view()):
                    bpy.ops.view3d.view_orbit(angle=0.07, type=way)
                yield from self.shoot()
        self.note(HOLD)

    def end(self):
        window, area = harness.view()["window"], harness.view()["area"]
        top = window.height - area.y - area.height
        crop = [area.width, area.height, area.x, top]
        text = json.dumps({"crop": crop, "frames": self.frames})
        (self.folder / "frames.json").write_text(text)


def viewport_alone():
    """Closes the other areas, so that a small window has room; a generator."""
    preferences = bpy.context.preferences
    preferences.view.show_splash, preferences.view.ui_scale = False, SCALE
    preferences.system.use_region_overlap = False
    yield 1.0
    for kind in ("OUTLINER", "PROPERTIES", "DOPESHEET_EDITOR"):
        for area in [a for a in harness.view()["screen"].areas if a.type == kind]:
            shown = harness.view()
            with bpy.context.temp_override(
                window=shown["window"], screen=shown["screen"], area=area
            ):
                bpy.ops.screen.area_close()
        yield 0.3
    space = harness.view()["area"].spaces.active
    space.show_region_toolbar = space.show_region_hud = False
    space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_axis_y = False
    yield from harness.open_sidebar("Fairing")


def seen(model, turn=0.6, up=0.35):
    """The model in the middle of the viewport, as the only selected object; a generator."""
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.select_all(action="DESELECT")
        model.select_set(True)
        bpy.context.view_layer.objects.active = model
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=turn, type="ORBITRIGHT")
        bpy.ops.view3d.view_orbit(angle=up, type="ORBITUP")
        bpy.ops.view3d.view_selected()
        harness.view()["area"].spaces.active.region_3d.view_distance *= NEARER
        bpy.ops.ed.undo_push(message="the model is there")
    yield 0.5


def job(film, purpose):
    """One click on a picture under Fair for; a generator."""
    number = PURPOSES.index(purpose)
    share, below = (0.15, 0.45, 0.75)[number % 3], (95, 155)[number // 3]
    yield from film.click(f"fairing_for(purpose='{purpose}'", below, share)


def zebra(film):
    yield from film.click("fairing_inspect(mode='ZEBRA'", 380, share=0.32)


def scan_of(page):
    """The object that a page's first script makes."""
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    return scripted(page)


def drag(film, source, vertex, way):
    """Grabs a vertex of the source with the mouse, while Live is on; a generator."""
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.fairing_show_source()
    harness.select_vertex(source, vertex)
    yield from film.shoot(HOLD // 2)
    region, space = harness.view()["region"], harness.view()["area"].spaces.active
    seen_at = (
        space.region_3d.perspective_matrix
        @ source.matrix_world
        @ source.data.vertices[vertex].co.to_4d()
    )
    x = region.x + round((seen_at.x / seen_at.w + 1) / 2 * region.width)
    y = (
        harness.view()["window"].height
        - region.y
        - round((seen_at.y / seen_at.w + 1) / 2 * region.height)
    )
    film.glide((x, y))
    harness.xdotool("mousemove", x, y)
    yield 0.3
    harness.xdotool("key", "g")
    yield 0.3
    for step in range(1, DRAG + 1):
        film.pointer = (x + round(way[0] * step / DRAG), y + round(way[1] * step / DRAG))
        harness.xdotool("mousemove", *film.pointer)
        yield 0.3
        yield from film.shoot(pressed=True)
    harness.xdotool("click", 1)
    yield 1.0
    yield from film.shoot(HOLD)


def record_start(film):
    """A coarse mesh becomes a surface that follows it."""
    for other in list(bpy.data.objects):
        bpy.data.objects.remove(other)
    source = settings_meshes.torus()
    source.data.shade_flat()
    yield from seen(source)
    yield from film.shoot(HOLD)
    yield from film.click("fairing_surface(", 330)
    yield from zebra(film)
    yield from film.click("fairing_live(", 390)
    yield from drag(film, source, 0, (50, -40))


def record_job(film, model, purpose, turn=0.6):
    """One click, stripes, and a look around."""
    yield from seen(model(), turn)
    yield from film.shoot(HOLD)
    yield from job(film, purpose)
    yield from zebra(film)
    yield from film.orbit()


def record_hull(film):
    """Strain finds a misread offset, which is corrected; the hull is even."""
    hull = scan_of("trades/hull")
    yield from seen(hull, turn=3.5, up=0.25)
    yield from film.shoot(HOLD)
    yield from job(film, "HULL")
    yield from zebra(film)
    bpy.context.scene.discrete_fairing_strain.label_count = 1
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.fairing_strain()
    yield from jobs.waited()
    yield from film.shoot(2 * HOLD)
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.fairing_strain()
    hull.data.vertices[22].co.y = 0.70
    hull.data.update()
    yield 1.0
    yield from film.shoot(HOLD // 2)
    yield from film.click("fairing_recompute(", 230)
    yield from film.orbit()


def record_panel(film):
    """A panel, stripes, and a sharp edge around the arch."""
    fender = scan_of("trades/panel")
    yield from seen(fender, turn=-0.5)
    yield from film.shoot(HOLD)
    yield from job(film, "PANEL")
    yield from zebra(film)
    crease = fender.data.attributes.new("crease_edge", "FLOAT", "EDGE")
    for edge in fender.data.edges:
        crease.data[edge.index].value = float(set(edge.vertices) <= set(range(9, 18)))
    fender.data.update()
    yield 1.0
    yield from film.shoot(HOLD // 2)
    yield from film.click("fairing_recompute(", 230)
    yield from film.orbit()


def record_scan(film):
    """A hole is filled and the noise removed."""
    yield from seen(scan_of("trades/scan"), turn=0.4)
    yield from film.shoot(HOLD)
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.fairing_fill("INVOKE_DEFAULT")
    yield 0.5
    yield from jobs.waited()
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.object.shade_smooth()
    yield from film.shoot(HOLD)
    yield from zebra(film)
    yield from job(film, "SCAN_PATCH")
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.mode_set(mode="OBJECT")
    yield from film.orbit()


def record_cad(film):
    """A hull's surface, and the patches that its STEP file will have."""
    yield from seen(jobs.begin("cad"), turn=3.6)
    yield from film.shoot(HOLD)
    yield from job(film, "HULL")
    surface = bpy.context.view_layer.objects.active
    yield from film.click("fairing_show_patches(", 230, share=0.75)
    surface.hide_set(True)  # which is at the same place
    with bpy.context.temp_override(**harness.view()):
        bpy.ops.object.mode_set(mode="EDIT")
    yield from film.shoot(HOLD)
    yield from film.orbit()


RECORDINGS = {
    "start": record_start,
    "hull": record_hull,
    "panel": record_panel,
    "character": partial(record_job, model=partial(jobs.begin, "character"), purpose="CHARACTER"),
    "scan": record_scan,
    "machine-part": partial(
        record_job, model=partial(jobs.begin, "mechanical"), purpose="MECHANICAL"
    ),
    "cad": record_cad,
}


def walk(name):
    yield from harness.drawn()
    harness.fresh_scene(empty=False)
    yield from harness.drawn()
    yield 0.5
    yield from viewport_alone()
    film = Film()
    yield from RECORDINGS[name](film)
    film.end()
    print(f"RECORDED {name}: {film.pictures} pictures", flush=True)


def step(steps):
    """One step of the timer; Blender quits at the end, and after an error."""
    try:
        return next(steps)
    except StopIteration:
        bpy.ops.wm.quit_blender()
    except BaseException:
        traceback.print_exc()
        harness.photograph("failed")
        bpy.ops.wm.quit_blender()
    return None


steps_of_the_film = walk(sys.argv[sys.argv.index("--") + 1])
bpy.app.timers.register(partial(step, steps_of_the_film), first_interval=0.5, persistent=True)
