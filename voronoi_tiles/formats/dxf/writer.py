"""DXF in millimetres: polylines with bulges or of chords, splines in Bezier form, and R12 for the oldest readers.

ezdxf makes the frame of the document (header, tables, blocks, objects). The entities, which are nearly all of the file,
are written here as text. For a sheet of 7,814 tiles ezdxf's own take 13 seconds instead of 1.4 as polylines with
bulges, 15 instead of 2.4 as splines, and 90 instead of 2, with 700 MB, as R12's, which have an object for each vertex.
"""

from __future__ import annotations

import io
import json
import re
import unicodedata
from collections.abc import Callable, Sequence
from dataclasses import replace
from decimal import Decimal
from itertools import pairwise
from typing import Any, BinaryIO, Final

import numpy as np

from voronoi_tiles.base.arrays import Bools, Complexes, Floats, Ints
from voronoi_tiles.formats.cubics import all_cubic
from voronoi_tiles.formats.decimals import decimal_texts
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.formats.path_blocks import path_blocks
from voronoi_tiles.formats.presets import DxfCurves, DxfVersion
from voronoi_tiles.paths.paths import ARC, CUBIC, LINE, QUAD, Paths

GRID_MM: Final = 1e-6
"""The last decimal that is written; millimetres."""

_NAMES: Final = {LINE: "LINE", QUAD: "QUAD", CUBIC: "CUBIC", ARC: "ARC"}
_TAKES: Final[dict[DxfCurves, tuple[int, ...]]] = {
    "arc": (LINE, ARC),
    "spline": (LINE, QUAD, CUBIC),
    "polyline": (LINE,),
}
_NAME_MAX: Final = 31  # R12 takes no longer names of layers
_COMMENT_MAX: Final = 200  # old readers take lines of 255 characters
_PLANAR: Final = 8  # of a spline's flags the only one; 1 is closed
_UNIT: Final = "  9\n$INSUNITS\n 70\n4\n  9\n$MEASUREMENT\n 70\n1\n"  # millimetres, and metric

_UNDATED: Final = {"$TDCREATE", "$TDUCREATE", "$TDUPDATE", "$TDUUPDATE", "$VERSIONGUID", "$FINGERPRINTGUID"}
_EPOCH: Final = "2451545.0"  # the Julian date of 2000-01-01
_NO_GUID: Final = "{00000000-0000-0000-0000-000000000000}"


def write_dxf(
    drawing: Drawing,
    file: BinaryIO,
    *,
    curves: DxfCurves,
    accuracy: float,
    version: DxfVersion = "R2000",
    spline_edges: bool = False,
) -> None:
    """Write a drawing as DXF in millimetres, y up, an entity for each path, in the order of the drawing.

    "arc": an LWPOLYLINE with bulges for each path of LINE and ARC. "polyline": one for each path of LINE. "spline": a
    SPLINE of degree 3 in Bezier form for each path of LINE, QUAD and CUBIC, exact; a path of nothing but LINE is an
    LWPOLYLINE, as exact, a third as long, and read by every program. With `spline_edges` there is a SPLINE or a LINE
    for each segment instead: OpenCASCADE's areas are wrong by percents where an edge has corners inside. In R12
    polylines are POLYLINE, and there are no splines. Closed polylines have the closed flag. Splines have not, which end
    where they begin, digit for digit: CadQuery drops closed ones, and LibreCAD rounds their corners.

    Layers have the drawing's names in upper case, without what DXF does not take in a name, and the nearest colour of
    the AutoCAD index; those of one name are one. That a layer is filled cannot be said. Extents and limits are the
    bounds of all paths, the page's where there is none. The recipe, with `curves` and `accuracy`, stands as JSON in the
    comments at the top. Coordinates are rounded to GRID_MM. The same drawing gives the same bytes.

    `accuracy` (millimetres) is what the segments keep to. Raises ValueError for segments of another kind, for splines
    in R12, and where `accuracy` is finer than the rounding.
    """
    if curves not in _TAKES:
        raise ValueError(f"curves must be one of {', '.join(_TAKES)}, not {curves!r}")
    r12 = version == "R12"
    if r12 and curves == "spline":
        raise ValueError("R12 has no splines")
    if not accuracy >= GRID_MM:
        raise ValueError(f"an accuracy of {accuracy} mm is finer than the {GRID_MM} mm of a DXF file")
    for layer in drawing.layers:
        _refuse_others(layer, curves)
    names = _layer_names([layer.name or layer.work for layer in drawing.layers])
    bodies_of = _lwpolylines if curves != "spline" else _edges if spline_edges else _splines
    each = bodies_of is _edges
    used = sum(int((layer.paths.counts if each else layer.paths.counts > 0).sum()) for layer in drawing.layers)
    head, tail, owner, handle = _frame(drawing, names, used, r12=r12)
    file.write((_comments(drawing, curves, accuracy) + head).encode("ascii"))
    for layer, name in zip(drawing.layers, names, strict=True):
        for block in path_blocks(layer.paths):
            if r12:
                bodies = _polylines(block, name)
            else:
                bodies = [_with_head(body, handle + k, owner, name) for k, body in enumerate(bodies_of(block))]
                handle += len(bodies)
            file.write("".join(bodies).encode("ascii"))
    file.write(tail.encode("ascii"))


def _refuse_others(layer: Layer, curves: DxfCurves) -> None:
    """Raise ValueError where a layer has segments that the entities cannot hold."""
    others = set(np.unique(layer.paths.kind).tolist()) - set(_TAKES[curves])
    if others:
        takes = " and ".join(_NAMES[kind] for kind in _TAKES[curves])
        found = " and ".join(_NAMES[kind] for kind in sorted(others))
        raise ValueError(f'{curves} curves take pieces of the kinds {takes}; layer "{layer.name}" has {found}')


# --- entities ---------------------------------------------------------------------------------------------------


def _with_head(body: str, handle: int, owner: str, layer: str) -> str:
    """An entity of R2000: its type, which stands before the first line break, handle, owner, layer, and the rest."""
    kind, _, rest = body.partition("\n")
    return f"  0\n{kind}\n  5\n{handle:X}\n330\n{owner}\n100\nAcDbEntity\n  8\n{layer}\n{rest}"


def _lwpolylines(paths: Paths) -> list[str]:
    """LWPOLYLINE entities without their heads; shape (p,)."""
    rows, first, last = _vertex_rows(paths)
    return [
        f"LWPOLYLINE\n100\nAcDbPolyline\n 90\n{b - a}\n 70\n{closed:d}\n" + "".join(rows[a:b])
        for a, b, closed in zip(first.tolist(), last.tolist(), paths.closed.tolist(), strict=True)
    ]


def _splines(paths: Paths) -> list[str]:
    """SPLINE entities without their heads, LWPOLYLINE where there is no curve; shape (p,)."""
    straight = np.maximum.reduceat(paths.kind, paths.offsets[:-1]) == LINE
    return _sorted_out(paths, straight, _lwpolylines)


def _edges(paths: Paths) -> list[str]:
    """SPLINE and LINE entities without their heads, one for each segment; shape (n,)."""
    count = len(paths.start)
    apart = replace(paths, offsets=np.arange(count + 1), closed=np.zeros(count, np.bool_))
    return _sorted_out(apart, apart.kind == LINE, _lines)


def _sorted_out(paths: Paths, straight: Bools, written: Callable[[Paths], list[str]]) -> list[str]:
    """SPLINE entities without their heads, and those that `written` makes of straight paths, in the paths' order."""
    bodies = np.empty(len(paths), object)
    bodies[straight] = written(paths.take(np.flatnonzero(straight)))
    bodies[~straight] = _curved_splines(paths.take(np.flatnonzero(~straight)))
    return list(bodies)


def _lines(paths: Paths) -> list[str]:
    """LINE entities without their heads, of paths of one segment; shape (p,)."""
    ends = zip(_points(paths.start), _points(paths.end, group=11), strict=True)
    return [f"LINE\n100\nAcDbLine\n{start}{end}" for start, end in ends]


def _curved_splines(paths: Paths) -> list[str]:
    """SPLINE entities without their heads: the cubic segments with knots 0 0 0 0 1 1 1 2 2 2 ... n n n n."""
    cubics = all_cubic(paths)
    points = np.stack((cubics.start, *cubics.control.T), axis=1).ravel()
    ends = cubics.end[cubics.offsets[1:] - 1]
    rows = _points(points)
    knots = [f" 40\n{k}.0\n" * 3 for k in range(int(cubics.counts.max(initial=0)) + 1)]
    return [
        f"SPLINE\n100\nAcDbSpline\n210\n0.0\n220\n0.0\n230\n1.0\n 70\n{_PLANAR}\n 71\n3\n"
        f" 72\n{3 * (b - a) + 5}\n 73\n{3 * (b - a) + 1}\n 74\n0\n 42\n0.0000000001\n 43\n0.0000000001\n"
        f" 40\n0.0\n{''.join(knots[: b - a + 1])} 40\n{b - a}.0\n{''.join(rows[3 * a : 3 * b])}{end}"
        for (a, b), end in zip(pairwise(cubics.offsets.tolist()), _points(ends), strict=True)
    ]


def _polylines(paths: Paths, layer: str) -> list[str]:
    """POLYLINE entities of R12, whole; shape (p,)."""
    rows, first, last = _vertex_rows(paths, more=" 30\n0.0\n")
    rows = [f"  0\nVERTEX\n  8\n{layer}\n{row}" for row in rows]
    return [
        f"  0\nPOLYLINE\n  8\n{layer}\n 66\n1\n 10\n0.0\n 20\n0.0\n 30\n0.0\n 70\n{closed:d}\n"
        f"{''.join(rows[a:b])}  0\nSEQEND\n  8\n{layer}\n"
        for a, b, closed in zip(first.tolist(), last.tolist(), paths.closed.tolist(), strict=True)
    ]


def _vertex_rows(paths: Paths, *, more: str = "") -> tuple[list[str], Ints, Ints]:
    """Every vertex as groups 10 and 20, `more`, and 42, its bulge, where an arc begins; and whose they are.

    Path k has those from `first[k]` up to, not including, `last[k]`.
    """
    points, first, last = _vertices(paths)
    rows = [row + more for row in _plane_points(points)]
    bulges, bent = paths.bulges(), np.flatnonzero(paths.kind == ARC)
    # Vertices of open paths, one more than their segments, push the later ones on.
    places = bent + (np.cumsum(~paths.closed) - ~paths.closed)[paths.owner[bent]]
    for place, bulge in zip(places.tolist(), _figures(bulges[bent]), strict=True):
        rows[place] += f" 42\n{bulge}\n"
    return rows, first, last


def _vertices(paths: Paths) -> tuple[Complexes, Ints, Ints]:
    """The starts of all segments, and the end of the last one of an open path.

    Path k has those from `first[k]` up to, not including, `last[k]`.
    """
    is_open = ~paths.closed
    stops = paths.offsets[1:]
    points = np.insert(paths.start, stops[is_open], paths.end[stops[is_open] - 1])
    last = stops + np.cumsum(is_open)
    return points, last - paths.counts - is_open, last


# --- numbers ----------------------------------------------------------------------------------------------------


def _points(points: Complexes, group: int = 10) -> list[str]:
    """Points as groups 10, 20 and 30, or those from another one on."""
    return [f"{row} {group + 20}\n0.0\n" for row in _plane_points(points, group)]


def _plane_points(points: Complexes, group: int = 10) -> list[str]:
    """Points as groups 10 and 20, or those from another one on; "12.5", "3.0"."""
    x, y = (decimal_texts(values, point=True) for values in (points.real, points.imag))
    return [f" {group}\n{u}\n {group + 10}\n{v}\n" for u, v in zip(x, y, strict=True)]


def _figures(values: Floats) -> list[str]:
    """Numbers of twelve significant digits, without exponent. Raises ValueError for one that is not finite."""
    if not np.isfinite(values).all():
        raise ValueError("an arc whose ends are one point has no bulge")
    texts = [f"{value:#.12g}" for value in values.tolist()]
    for k in np.flatnonzero((np.abs(values) >= 1e11) | (np.abs(values) < 1e-3)).tolist():
        texts[k] = f"{Decimal(texts[k]):f}" if values[k] else "0.0"
    return texts


# --- the frame --------------------------------------------------------------------------------------------------


def _frame(drawing: Drawing, names: Sequence[str], entities: int, *, r12: bool) -> tuple[str, str, str, int]:
    """The document without its entities, so many: the text before and after them.

    With it the handle of the modelspace, and the first one for the entities.
    """
    from ezdxf import units
    from ezdxf.document import Drawing as Document

    document = Document.new("R12" if r12 else "R2000")
    if r12:
        document.header["$HANDLING"] = 0  # handles are a choice there, and half of the text
    else:
        document.units = units.MM
        document.header["$PSVPSCALE"] = 1.0  # LibreCAD prints at this scale; ezdxf writes 0
        document.header["$MEASUREMENT"] = 1
    for layer, name in zip(drawing.layers, names, strict=True):
        if name not in document.layers:
            document.layers.add(name, color=nearest_index(layer.colour), linetype="Continuous")
    left, bottom, right, top = _extents(drawing)
    modelspace = document.modelspace()
    modelspace.reset_extents((left, bottom, 0.0), (right, top, 0.0))
    modelspace.reset_limits((left, bottom), (right, top))
    # ezdxf takes no corner from the modelspace that is the origin.
    document.header["$EXTMIN"], document.header["$EXTMAX"] = (left, bottom, 0.0), (right, top, 0.0)
    stream = io.StringIO()
    document.write(stream)
    text = _undated(stream.getvalue(), document.ezdxf_metadata())
    head, mark, tail = text.partition("  0\nSECTION\n  2\nENTITIES\n")
    assert mark
    if r12:
        # R12 does not know them, and ezdxf leaves them out: readers that ask for the unit ask for nothing else.
        return head.replace("  0\nENDSEC\n", f"{_UNIT}  0\nENDSEC\n", 1) + mark, tail, "", 0
    before, seed, after = re.split(r"(?<=\$HANDSEED\n  5\n)([0-9A-F]+)(?=\n)", head)
    head = f"{before}{int(seed, 16) + entities:X}{after}"
    return head + mark, tail, modelspace.layout_key, int(seed, 16)


def _undated(text: str, metadata: Any) -> str:
    """The frame without dates and random identifiers, of the document as of ezdxf."""
    from ezdxf.version import __version__

    for key in ("CREATED_BY_EZDXF", "WRITTEN_BY_EZDXF"):
        text = text.replace(metadata[key], __version__)
    head, mark, rest = text.partition("ENDSEC\n")
    for name in _UNDATED:
        fixed = _NO_GUID if name.endswith("GUID") else _EPOCH
        head = re.sub(rf"({re.escape(name)}\n *\d+\n).*\n", rf"\g<1>{fixed}\n", head)
    return head + mark + rest


def _extents(drawing: Drawing) -> tuple[float, float, float, float]:
    """The bounds of all paths, rounded as the coordinates are; the page's where there is no path."""
    boxes = [layer.paths.bounds for layer in drawing.layers if len(layer.paths.start)]
    if not boxes:
        return 0.0, 0.0, drawing.width, drawing.height
    left, bottom, right, top = zip(*boxes, strict=True)
    return round(min(left), 6), round(min(bottom), 6), round(max(right), 6), round(max(top), 6)


def _layer_names(names: Sequence[str]) -> list[str]:
    """Names that every version of DXF takes: upper case, letters, digits, $ - _, at most 31; alike for equal names."""
    taken = {"0", "DEFPOINTS"}
    found: dict[str, str] = {}
    for name in dict.fromkeys(names):
        plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode().upper()
        stem = re.sub(r"[^A-Z0-9$_-]+", "_", plain).strip("_")[:_NAME_MAX] or "LAYER"
        legal, number = stem, 1
        while legal in taken:
            number += 1
            legal = f"{stem[: _NAME_MAX - 1 - len(str(number))]}-{number}"
        taken.add(legal)
        found[name] = legal
    return [found[name] for name in names]


def nearest_index(colour: str) -> int:
    """The number from 1 to 255 of the AutoCAD colour that is nearest to "#rrggbb"; 7 is black on white paper."""
    from ezdxf.colors import DXF_DEFAULT_COLORS

    wanted = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)])
    # 7 is drawn white or black, whichever the background is not.
    palette = np.array([0, *DXF_DEFAULT_COLORS[1:]])
    shades = np.stack((palette >> 16 & 255, palette >> 8 & 255, palette & 255), axis=1)
    return int(((shades - wanted) ** 2).sum(axis=1).argmin()) or 7


def _comments(drawing: Drawing, curves: DxfCurves, accuracy: float) -> str:
    """The recipe as JSON in comments: what follows "recipe " in all of them, joined."""
    recipe = {"title": drawing.title, **drawing.recipe, "curves": curves, "accuracy_mm": accuracy}
    text = json.dumps(recipe)
    parts = [text[k : k + _COMMENT_MAX] for k in range(0, len(text), _COMMENT_MAX)]
    return "".join(f"999\nrecipe {part}\n" for part in parts)
