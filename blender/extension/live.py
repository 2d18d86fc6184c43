# SPDX-License-Identifier: GPL-3.0-or-later
"""Tiles while one draws: handlers mark what has changed, a timer computes it, and proves it when all is quiet.

A handler must not change data: that would call it again. Names are held between events, never objects of Blender.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import Any

import bpy
from bpy.app.handlers import persistent

from .settings import is_local, tilings
from .updating import update

STEP_S = 0.02
"""How often the timer looks while there is something to do; seconds: two frames of a display."""

QUIET_S = 0.3
"""How long nothing has changed when tiles are proved; seconds: a pause of the hand."""

_changed: set[str] = set()
_doubtful: set[str] = set()
"""Of those that have changed the tilings of which it is not known what is shown."""

_quiet: dict[str, float] = {}


def mark(tiling: Any) -> None:
    """Have the tiles of a tiling computed soon."""
    _mark([tiling.name])


def _mark(names: Iterable[str]) -> None:
    _changed.update(names)
    if _changed and not bpy.app.timers.is_registered(tick):
        bpy.app.timers.register(tick, first_interval=STEP_S, persistent=True)


def tick() -> float | None:
    """Do what there is to do; when to be called again, None when nothing is left."""
    if bpy.app.is_job_running("RENDER"):
        return QUIET_S
    now = time.monotonic()
    # Taken out first: what cannot be computed is not tried for ever.
    while _changed:
        name = _changed.pop()
        _quiet[name] = now
        anew = name in _doubtful
        _doubtful.discard(name)
        _update(name, proof=False, anew=anew)
    for name in [name for name, since in _quiet.items() if now - since >= QUIET_S]:
        del _quiet[name]
        _update(name, proof=True)
    return STEP_S if _changed or _quiet else None


def _update(name: str, *, proof: bool, anew: bool = False) -> None:
    tiling = bpy.data.objects.get(name)
    if tiling is not None and tiling.voronoi_tiles.role == "tiling" and is_local(tiling) and tiling.users_scene:
        update(tiling, proof=proof, anew=anew)


@persistent
def on_change(_scene: Any, depsgraph: Any) -> None:
    """Mark the tilings whose sites, or whose origin, have changed, by hand or from frame to frame."""
    if bpy.app.is_job_running("RENDER"):  # in a thread of its own
        return
    found = set()
    for change in depsgraph.updates:
        if not isinstance(change.id, bpy.types.Object):
            continue
        settings = change.id.original.voronoi_tiles
        if settings.role == "site" and (change.is_updated_geometry or change.is_updated_transform):
            tiling = settings.of
        elif settings.role == "tiling" and change.is_updated_transform:
            tiling = change.id.original
        else:
            continue
        if tiling is not None and tiling.voronoi_tiles.live and is_local(tiling):
            found.add(tiling.name)
    _mark(found)


@persistent
def on_other_state(*_: Any) -> None:
    """After undo, redo and the loading of a file: what was known is of another state.

    Undo reads only what differs between its steps: what the timer has changed since the last of them may stay, and what
    is shown may be of another state than what says so.
    """
    _changed.clear()
    _doubtful.clear()
    _quiet.clear()
    found = [tiling.name for tiling in tilings() if tiling.voronoi_tiles.live]
    _doubtful.update(found)
    _mark(found)


HANDLERS = (
    ("depsgraph_update_post", on_change),
    ("frame_change_post", on_change),
    ("undo_post", on_other_state),
    ("redo_post", on_other_state),
    ("load_post", on_other_state),
)


def register() -> None:
    """Listen."""
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)


def unregister() -> None:
    """Listen no more."""
    for name, handler in HANDLERS:
        if handler in getattr(bpy.app.handlers, name):
            getattr(bpy.app.handlers, name).remove(handler)
    if bpy.app.timers.is_registered(tick):
        bpy.app.timers.unregister(tick)
    _changed.clear()
    _doubtful.clear()
    _quiet.clear()
