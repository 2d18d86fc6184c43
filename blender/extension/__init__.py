# SPDX-License-Identifier: GPL-3.0-or-later
"""Voronoi tiles in Blender: curves as sites, their tiles while one draws, fields, solids and files of them."""

from __future__ import annotations

from . import requirements


def register() -> None:
    """Take up work; where the engine cannot be loaded, only the panel, which says why."""
    if requirements.usable():
        from . import live, operators, settings

        settings.register()
        operators.register()
        live.register()
    from . import panel

    panel.register()


def unregister() -> None:
    """Leave nothing behind but what is in the file."""
    from . import panel

    panel.unregister()
    if requirements.usable():
        from . import live, operators, settings

        live.unregister()
        operators.unregister()
        settings.unregister()
