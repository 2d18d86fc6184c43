"""The drawings of docs/how-it-works.md that show bisectors, envelopes and cells; every curve comes from the engine."""

from __future__ import annotations

import numpy as np
from diagrams_scene import Ints, Scene, group_scene, lone_scene
from diagrams_style import (
    FIELDS,
    GREY,
    INK,
    LINE,
    PALE,
    PARABOLA,
    TILE,
    Complexes,
    bare,
    drawing,
    edges,
    fill,
    strokes,
)
from matplotlib.axes import Axes

from voronoi_tiles import Design, Operation

DESIGN = {
    "schema": 1,
    "group": "p4",
    "cell": {"a": 40},
    "site": [{"name": "hook", "strokes": [{"polyline": [[4.5, 5], [14, 3], [17.5, 10], [9, 14.5]]}]}],
}

_SEGMENT: Ints = np.array([[0, 1]])
_NO_SEGMENT: Ints = np.zeros((0, 2), np.intp)
_FEET = np.array([0.6, 2.2, 3.8, 5.4, 7.0, 8.6, 10.2])


def write() -> None:
    """Write the drawings."""
    _parabola()
    _bisector()
    _envelope()
    _fan()
    _cells()


def _points(*pairs: tuple[float, float]) -> Complexes:
    return np.array([complex(*pair) for pair in pairs])


def _draw(axes: Axes, points: Complexes, **style: object) -> None:
    axes.plot(points.real, points.imag, **style)


def _parabola() -> None:
    """A point and a line: equal distances from points of the parabola."""
    line, focus = _points((0, 0), (12, 0)), _points((5.2, 3.0))
    scene = lone_scene([(line, _SEGMENT), (focus, _NO_SEGMENT)])
    side = next(r for r in range(len(scene.rows)) if scene.rows.straight[r] and scene.rows.axis[r].real > 0)
    with drawing("parabola.svg", (6.0, 3.0)) as (_, axes):
        bare(axes, _points((-0.5, -1.0), (12.5, 8.4)))
        for part in np.flatnonzero(scene.row == side).tolist():
            _draw(axes, scene.curve(part), color=PARABOLA, lw=2.0)
            inside = (scene.start[part] <= _FEET) & (scene.end[part] > _FEET)
            s = _FEET[inside]
            on = scene.points(side, s, scene.functions.value(np.full(len(s), scene.lowest[part]), s))
            for z, foot in zip(on, scene.points(side, s, 0.0 * s), strict=True):
                _draw(axes, np.array([focus[0], z, foot]), color=GREY, lw=0.8)
                axes.plot(z.real, z.imag, "o", color=PARABOLA, ms=4, zorder=5)
        _draw(axes, line, color=INK, lw=2.4, solid_capstyle="round")
        _draw(axes, focus, color=INK, marker="o", ms=6)
        axes.annotate("focus: the point", (5.2, 3.0), (-38, 34), textcoords="offset points")
        axes.annotate("directrix: the line", (0.1, 0), (0, -11), textcoords="offset points")


def _bisector() -> None:
    """Two segments, and the curve that is equally far from both, in pieces by kind."""
    one, other = _points((0, 0), (8, 1.5)), _points((2.0, 6.0), (6.5, 3.6))
    scene = lone_scene([(one, _SEGMENT), (other, _SEGMENT)])
    window = _points((-4.5, -1.0), (12.5, 7.2))
    with drawing("two-segments.svg", (6.4, 3.4)) as (_, axes):
        bare(axes, window)
        for part in scene.bounded:
            curve = scene.curve(part, 400)
            shown = curve[np.isfinite(curve) & (abs(curve) < 60)]
            if not len(shown):
                continue
            colour = PARABOLA if scene.parabola(part) else LINE
            _draw(axes, shown, color=colour, lw=2.2, solid_capstyle="butt", zorder=3)
            if not scene.parabola(part):
                continue
            # The pieces of other kinds end at those of parabolas.
            for z, foot in zip(curve[[0, -1]], scene.feet(part), strict=True):
                _draw(axes, np.array([foot, z, _nearest(other, z)]), color=GREY, lw=0.7, zorder=2)
                axes.plot(z.real, z.imag, "o", color="white", mec=INK, mew=0.8, ms=4, zorder=5)
        for segment in (one, other):
            _draw(axes, segment, color=INK, lw=2.4, solid_capstyle="round", zorder=4)


def _nearest(segment: Complexes, z: complex) -> complex:
    """The point of a segment nearest to z."""
    along = segment[1] - segment[0]
    t = ((z - segment[0]) * along.conjugate()).real / abs(along) ** 2
    return complex(segment[0] + min(max(t, 0.0), 1.0) * along)


def _envelope() -> None:
    """The functions h(s) over one side of a segment with their lower envelope, and the region below it."""
    base = _points((0, 0), (10, 0))
    others = [
        (_points((-0.4, 6.4), (3.6, 4.4)), _SEGMENT),
        (_points((5.0, 4.2)), _NO_SEGMENT),
        (_points((6.2, 6.8), (10.4, 3.2)), _SEGMENT),
    ]
    scene = lone_scene([(base, _SEGMENT), *others])
    side = next(r for r in range(len(scene.rows)) if scene.rows.straight[r] and scene.rows.axis[r].real > 0)
    with drawing("envelope.svg", (7.4, 3.0), 2) as (_, (left, right)):
        _functions(left, scene, side)
        bare(right, _points((-1.2, -1.0), (11.2, 7.2)))
        for part in np.flatnonzero(scene.row == side).tolist():
            curve = scene.curve(part, 40)
            area = np.concatenate([curve, scene.feet(part)[::-1]])
            colour = FIELDS[scene.site[scene.lowest[part]]]
            right.fill(area.real, area.imag, fc=colour, ec="none", alpha=0.55)
            _draw(right, curve, color=_dark(scene.site[scene.lowest[part]]), lw=2.4)
        _draw_sites(right, [(base, _SEGMENT), *others])


def _dark(target: int) -> str:
    return ("", "#2a6fa3", "#b5482b", "#3c7d36")[target]


def _draw_sites(axes: Axes, sites: list[tuple[Complexes, Ints]]) -> None:
    """The first site in ink, the others in their dark colours."""
    for k, (nodes, segments) in enumerate(sites):
        style = {"lw": 2.4} if len(segments) else {"marker": "o", "ms": 6}
        _draw(axes, nodes, color=INK if k == 0 else _dark(k), solid_capstyle="round", **style)


def _envelope_of(axes: Axes, scene: Scene, row: int) -> None:
    """The functions of a row, thin, and their lower envelope, bold."""
    functions = scene.functions
    for k in np.flatnonzero(functions.row == row):
        x = np.linspace(functions.low[k], functions.high[k], 40)
        axes.plot(x, functions.value(np.full(40, k), x), color=_dark(scene.site[k]), lw=0.9, alpha=0.8)
    for part in np.flatnonzero(scene.row == row).tolist():
        x = np.linspace(scene.start[part], scene.end[part], 40)
        colour = _dark(scene.site[scene.lowest[part]])
        axes.plot(x, functions.value(np.full(40, scene.lowest[part]), x), color=colour, lw=3.0, solid_capstyle="butt")


def _functions(axes: Axes, scene: Scene, row: int) -> None:
    _envelope_of(axes, scene, row)
    for part in np.flatnonzero(scene.row == row).tolist():
        axes.axvline(scene.start[part], color=PALE, lw=0.8, zorder=0)
    axes.set(xlim=(0, 10), ylim=(0, 7.2), xlabel="s along the segment", ylabel="h: height of the bisector")
    axes.set_aspect("equal")
    axes.spines[["top", "right"]].set_visible(False)


def _fan() -> None:
    """The same about the free end of a segment, in its polar frame: the functions of x, and the region."""
    base = _points((-5, 0), (0, 0))
    others = [
        (_points((-1.0, 5.0), (3.0, 4.6)), _SEGMENT),
        (_points((5.2, 1.4)), _NO_SEGMENT),
        (_points((1.0, -5.2), (4.6, -2.6)), _SEGMENT),
    ]
    scene = lone_scene([(base, _SEGMENT), *others])
    fans = [r for r in range(len(scene.rows)) if not scene.rows.straight[r] and abs(scene.rows.origin[r]) < 1e-12]
    with drawing("fan.svg", (7.4, 3.2), 2) as (_, (left, right)):
        bare(right, _points((-5.6, -5.8), (6.0, 5.8)))
        for row in fans:
            _fan_functions(left, scene, row)
            for part in np.flatnonzero(scene.row == row).tolist():
                curve = scene.curve(part, 40)
                colour = FIELDS[scene.site[scene.lowest[part]]]
                area = np.append(curve, scene.rows.origin[row])
                right.fill(area.real, area.imag, fc=colour, ec="none", alpha=0.55)
                _draw(right, curve, color=_dark(scene.site[scene.lowest[part]]), lw=2.4)
            ray = np.array([0, 7 * scene.rows.ray0[row]])
            _draw(right, ray, color=GREY, lw=0.6, dashes=(3, 3), zorder=0)
        _draw_sites(right, [(base, _SEGMENT), *others])


def _fan_functions(axes: Axes, scene: Scene, row: int) -> None:
    """The functions of one fan; the fans of a point share their variable."""
    _envelope_of(axes, scene, row)
    axes.axvline(scene.rows.low[row], color=PALE, lw=0.8, zorder=0)
    axes.set(
        xlim=(-1, 1), ylim=(-0.9, 0), xlabel="x, the tangent of half the angle from the axis", ylabel="-(1 + x²) / r"
    )
    axes.set_xticks([-1, -0.5, 0, 0.5, 1])
    axes.spines[["top", "right"]].set_visible(False)


def _cells() -> None:
    """A tile as the union of its elements' cells, and what is left when the inner walls are dropped."""
    design = Design.from_dict(DESIGN)
    scene, tile = group_scene(design), design.tessellate().tiles[0]
    with drawing("cells.svg", (7.4, 3.7), 2) as (_, (left, right)):
        _regions(left, scene)
        for text in ("-y,x", "y,-x+1", "-y+1,x", "-x,-y", "-x+1,-y", "y,-x", "-x,-y+1", "-x+1,-y+1"):
            fill(right, tile.copy(Operation.parse(text)), fc=PALE, lw=1.0)
        fill(right, tile.outline, fc=TILE, ec="none")
        edges(right, tile.outline, 2.2)
        box = tile.outline.bounds
        for axes in (left, right):
            bare(axes, _points(box[:2], box[2:]), 1.2)
            strokes(axes, tile.site.elements, INK, 2.4)


def _regions(axes: Axes, scene: Scene) -> None:
    for part in scene.bounded:
        row = scene.row[part]
        corner = not scene.rows.straight[row]
        element = scene.contour.corner_node[scene.rows.corner[row]] if corner else scene.rows.half_edge[row] >> 1
        curve = scene.curve(part)
        area = np.concatenate([curve, scene.feet(part)[::-1]])
        colour = FIELDS[4 + element % 4] if corner else FIELDS[element % 4]
        axes.fill(area.real, area.imag, fc=colour, ec=colour, lw=0.3)
        if scene.inner(part):
            _draw(axes, curve, color="white", lw=1.2, dashes=(3, 2), zorder=3)
        else:
            _draw(axes, curve, color=PARABOLA if scene.parabola(part) else LINE, lw=2.0, zorder=3)
