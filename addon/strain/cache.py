# SPDX-License-Identifier: GPL-3.0-or-later
"""The last measured strain of each source; a timer updates shown ones while Blender runs."""

from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic
from typing import Any, cast

import bpy

from .. import core, events
from ..blender import Context, Object, current_context
from ..errors import JobError
from ..inspection import overlay
from ..live.full_level import is_dragging
from ..mesh.object import Reference, Showing, changed_keys, session_key
from ..queue import Queue
from ..redraw import tag_sidebars
from ..settings import Settings
from .measure import StrainJob, settings_for
from .strained import Strained

INTERVAL = 0.1  # seconds between two checks of shown sources
BRIEF = 0.3  # seconds; longer runs wait until nobody drags, and are cancelled by an edit


class _Watch:
    """The strain of one source, and a run that updates it."""

    def __init__(self, reference: Reference) -> None:
        self.reference = reference
        self.stale = True  # whether anything may have changed since
        self.error = ""
        self.job: StrainJob | None = None  # the job of the present result
        self._settings: Settings | None = None
        self._next: StrainJob | None = None
        self._queue: Queue | None = None
        self._begun = 0.0

    @property
    def result(self) -> Strained | None:
        return None if self.job is None else self.job.result

    @property
    def is_measured(self) -> bool:
        """Whether a run is in progress."""
        return self._queue is not None

    def advance(self, context: Context) -> bool:
        """A step of the timer. Returns whether there is something new to show."""
        source = self.reference.find()
        if source is None:
            return False
        if self._settings != settings_for(context, source):
            self.stale = True
        if self._queue is not None:
            return self._look(self._queue)
        is_slow = self.job is not None and self.job.taken > BRIEF
        if self.stale and not (is_slow and is_dragging(context)):
            return self._begin(context, source)
        return False

    def _look(self, queue: Queue) -> bool:
        if queue.finished:
            self._queue = None
            if queue.cancelled:
                return False
            self.error = queue.error or ""
            if not self.error:
                stale = self.stale
                self.keep(cast(StrainJob, self._next))
                self.stale = stale
            return True
        if self.stale and monotonic() - self._begun > BRIEF:
            queue.cancel()
        return False

    def _begin(self, context: Context, source: Object) -> bool:
        self.stale, self._settings = False, settings_for(context, source)
        try:
            with _unnoticed(context, source):
                self._next = StrainJob(context, source, self.job)
        except JobError as error:
            self.error = str(error)
            return True
        if self._next.result is not None:
            was, self.error = self.error, ""
            return bool(was)
        self._queue, self._begun = Queue([self._next], core.module().Monitor), monotonic()
        self._queue.start()
        return False

    def keep(self, job: StrainJob) -> None:
        """Makes a finished job the present result."""
        job.note()
        self.job, self.error, self.stale = job, "", False

    def cancel(self) -> None:
        if self._queue is not None:
            self._queue.cancel()
            self._queue.join()
            self._queue = None


_watches: dict[int, _Watch] = {}
shown_sources = Showing(lambda target: bool(target.discrete_fairing_strain.show))
_reading = False  # whether changes reported by Blender are caused by our own reading


def job_for(context: Context, source: Object) -> StrainJob:
    """A job for the source, which is done if nothing has changed; keep() stores its result. Raises
    JobError.
    """
    return StrainJob(context, source, _watch(source).job)


def keep(job: StrainJob) -> None:
    """Makes the result of a finished `job` the known one for its source."""
    source = job.reference.find()
    if source is not None:
        _watch(source).keep(job)


def found_of(source: Object) -> Strained | None:
    """The last result, perhaps for an earlier shape; None if there is none."""
    watch = _watches.get(session_key(source))
    return None if watch is None else watch.result


def is_behind(source: Object) -> bool:
    watch = _watches.get(session_key(source))
    return watch is not None and (watch.is_measured or watch.stale)


def trouble(source: Object) -> str:
    """Why the strain of `source` could not be measured, a sentence; empty if it could."""
    watch = _watches.get(session_key(source))
    return "" if watch is None else watch.error


def shown_changed(*_: Any) -> None:
    """Call this when an object's display of strain is switched on or off, or a file was opened."""
    shown_sources.forget()
    _start_timer()


def _watch(source: Object) -> _Watch:
    return _watches.setdefault(session_key(source), _Watch(Reference(source)))


def _start_timer() -> None:
    if not bpy.app.background:
        events.start_timer(_on_timer, 0.0)


def _on_timer() -> float | None:
    context, news = current_context(), False
    if core.why_missing():
        return None
    sources = list(shown_sources)
    for source in sources:
        news |= _watch(source).advance(context)
    if news:
        overlay.redraw()
        tag_sidebars(context)
    return INTERVAL if sources else None


@contextmanager
def _unnoticed(context: Context, source: Object) -> Iterator[None]:
    """Reading a mesh in Edit Mode makes Blender report a change, which is no edit."""
    global _reading
    _reading = True
    try:
        yield
    finally:
        if source.mode == "EDIT":
            context.view_layer.update()
        _reading = False


def _note_changes(_scene: Any, depsgraph: bpy.types.Depsgraph) -> None:
    if not _watches or _reading:
        return
    changed = changed_keys(depsgraph, moved=True)
    for watch in _watches.values():
        source = watch.reference.find()
        if source is not None and changed & {session_key(source), session_key(source.data)}:
            watch.stale = True


def _mark_stale(*_: Any) -> None:
    for watch in _watches.values():
        watch.stale = True


def _mark_all_stale(*_: Any) -> None:
    """Marks all results as out of date, shown ones too."""
    shown_changed()
    _mark_stale()


def _forget(*_: Any) -> None:
    for watch in _watches.values():
        watch.cancel()
    _watches.clear()
    shown_sources.forget()


HANDLERS = {
    "depsgraph_update_post": _note_changes,
    "frame_change_post": _mark_stale,
    "undo_post": _mark_all_stale,
    "redo_post": _mark_all_stale,
    "load_pre": _forget,
    "load_post": shown_changed,
}
TIMERS = (_on_timer,)


def register() -> None:
    _start_timer()  # for the file that is open now


def unregister() -> None:
    _forget()
