"""Reading DXF by ezdxf: what the model space draws, in millimetres.

Drawn are LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE, POLYLINE and SPLINE, also in blocks. All else is counted and left out,
as is what lies on hidden layers or stands tilted in space.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from voronoi_tiles.base.maps import Affine
from voronoi_tiles.base.text import counted
from voronoi_tiles.formats.dxf.drawing_unit import unit_of
from voronoi_tiles.formats.dxf.entities import NotDrawn, draw_entity
from voronoi_tiles.formats.dxf.loading import REMEDY, LoadedDxf, load_dxf, reason_of
from voronoi_tiles.formats.dxf.mending import COUNTED
from voronoi_tiles.formats.dxf.xclip import Clip, clip_of, clipped_shapes
from voronoi_tiles.formats.pen import Pen
from voronoi_tiles.formats.shapes import (
    DEPTH_MAX,
    DXF_COPIES_MAX,
    DXF_INSERTS_MAX,
    Dots,
    DrawingError,
    ReadDrawing,
    Shape,
)

if TYPE_CHECKING:
    from ezdxf.entities.dxfgfx import DXFGraphic
    from ezdxf.entities.insert import Insert

_DRAWN: Final = frozenset({"LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE"})
_BY_BLOCK, _BY_LAYER, _FOREGROUND = 0, 256, 7


def dxf_drawing(data: bytes, file: str, element: str | None = None) -> ReadDrawing:
    """Read the content of a DXF file; `file` is its name for messages.

    With `element` only the entity of the model space that has that handle is drawn and counted.
    The coordinates stay where they are, in millimetres by $INSUNITS. Curves keep their kind: arcs are arcs, splines
    without weights of up to the third degree are exact, ellipses and other splines become cubics within CURVE_ACCURACY.
    Raises DrawingError for what is broken, hostile or beyond the limits.
    """
    try:
        return _DxfWalk(load_dxf(data), element).drawing()
    except DrawingError as error:
        raise error.with_file(file) from None
    except Exception as error:  # ezdxf raises what its parts raise, whatever that is
        raise DrawingError(f"broken DXF: {reason_of(error)}", file=file, remedy=REMEDY) from error


class _DxfVisit(NamedTuple):
    """An entity with what it takes from the blocks around it."""

    entity: Any
    layer: str  # what layer 0 of a block stands for
    colour: int | tuple[int, int, int]  # what "by block" stands for
    blocks: tuple[str, ...]
    source: str  # what an entity of a block, which has no handle of its own, is called
    clips: tuple[Clip, ...] = ()  # the polygons that clip it, the outermost first


class _DxfWalk:
    """Draws the model space, with its own stack: blocks in blocks are no depth of calls."""

    def __init__(self, loaded: LoadedDxf, element: str | None) -> None:
        self._document = loaded.document
        self._unit = unit_of(loaded.stated)
        self._remarks = list(loaded.remarks)
        self._element = None if element is None else element.upper()
        self._pen = Pen()
        self._ignored: Counter[str] = Counter()
        self._looks: list[tuple[str, str, float | None, str]] = []
        self._clips: list[tuple[Clip, ...]] = []
        self._clones = 0
        self._copies = 0

    def drawing(self) -> ReadDrawing:
        """All that is drawn."""
        to_page = Affine(complex(self._unit.millimetres), 0j, 0j)
        for visit in self._entities():
            entity = visit.entity
            kind = entity.dxftype()
            source = visit.source or f"{kind} {entity.dxf.handle}"
            if kind not in _DRAWN:
                self._count(visit)
                continue
            self._pen.begin(to_page)
            try:
                self._remarks += draw_entity(self._pen, entity, to_page)
            except NotDrawn as reason:
                self._ignored[f"{kind} {reason}"] += 1
            except DrawingError as error:
                raise error.under(source) from None
            except Exception as error:
                raise DrawingError(f"broken: {reason_of(error)}", key=source, remedy=REMEDY) from error
            self._looks.append((self._layer(visit), self._colour(visit), self._width(entity), source))
            self._clips.append(visit.clips)
        shapes, dots = [], []
        drawn = clipped_shapes(self._pen.shapes(), self._clips, float(self._unit.millimetres))
        for (layer, colour, width, source), (paths, places) in zip(self._looks, drawn, strict=True):
            if len(places):
                dots.append(Dots(places, layer, colour, source))
            if len(paths):
                shapes.append(Shape(paths, layer, colour, None, width, source))
        self._say_paper_space(not shapes)
        return ReadDrawing(
            format="dxf",
            width=None,
            height=None,
            unit=self._unit.name,
            unit_known=bool(self._unit.name),
            shapes=tuple(shapes),
            ignored=dict(sorted(self._ignored.items())),
            clones=self._clones,
            remarks=tuple(dict.fromkeys(self._remarks)),
            dots=tuple(dots),
            unit_guess=self._unit.guess,
        )

    def _say_paper_space(self, empty: bool) -> None:
        """Say what lies on pages for plotting, where the model space is empty."""
        layouts = [layout for layout in self._document.layouts if layout.is_any_paperspace]
        count = sum(entity.dxftype() in _DRAWN for layout in layouts for entity in layout)
        if count and empty and self._element is None:
            self._remarks.append(f"all lies in paper space, which is not read: {counted(count, 'object')}")

    def _entities(self) -> Iterator[_DxfVisit]:
        """Every visible entity, blocks replaced by what they hold."""
        space = list(self._document.modelspace())
        if self._element is not None:
            space = [top for top in space if str(top.dxf.handle).upper() == self._element]
            if not space:
                raise DrawingError(
                    f"has no entity with the handle {self._element[:80]!r}", remedy="Choose by its layer, or draw all."
                )
        for top in space:
            stack = [_DxfVisit(top, "0", _FOREGROUND, (), "")]
            while stack:
                visit = stack.pop()
                if self._is_hidden(visit):
                    self._ignored["hidden"] += 1
                elif visit.entity.dxftype() == "INSERT":
                    stack.extend(reversed(self._inserted(visit)))
                else:
                    yield visit

    def _inserted(self, visit: _DxfVisit) -> list[_DxfVisit]:
        """The entities of a block, where it is inserted."""
        insert: Insert = visit.entity
        name = insert.dxf.name
        block: Any = self._document.blocks.get(name)
        if block is None:
            self._ignored["INSERT of nothing"] += 1
            return []
        if block.block is not None and block.block.is_xref:
            self._ignored["INSERT of another file"] += 1
            return []
        key = name.lower()
        if key in visit.blocks:
            raise DrawingError(f"the block {name[:60]!r} contains itself", remedy="Explode it.")
        if len(visit.blocks) >= DEPTH_MAX:
            raise DrawingError(f"blocks nested more than {DEPTH_MAX:,} deep", remedy="Explode them.")
        self._clones += 1
        if self._clones > DXF_INSERTS_MAX:
            raise DrawingError(f"inserts more than {DXF_INSERTS_MAX:,} blocks", remedy="Explode or remove them.")
        places = max(1, insert.mcount)
        self._copies += places * max(1, len(block))
        if self._copies > DXF_COPIES_MAX:
            raise DrawingError(f"blocks draw more than {DXF_COPIES_MAX:,} entities", remedy="Explode or remove them.")
        self._ignored.update(["ATTRIB"] * len(insert.attribs))
        clip, not_read = clip_of(insert)
        if not_read:
            self._ignored[not_read] += 1
        clips = visit.clips
        if clip is not None:
            clips = (*clips, clip)
            self._remarks.append("blocks are clipped (XCLIP), and were read so; many programs draw them whole")
        layer, colour = self._layer(visit), self._own_colour(visit)
        source = visit.source or f"INSERT {insert.dxf.handle}"
        copies = insert.multi_insert() if places > 1 else [insert]

        def visited(entity: Any) -> _DxfVisit:
            return _DxfVisit(entity, layer, colour, (*visit.blocks, key), f"{entity.dxftype()} in {source}", clips)

        def skip(entity: DXFGraphic, _reason: str) -> None:
            self._count(visited(entity))

        # These have no copies, and ezdxf says nothing of it.
        for entity in block:
            if entity.dxftype().endswith(COUNTED):
                self._count(visited(entity), places)
        return [visited(entity) for copy in copies for entity in copy.virtual_entities(skipped_entity_callback=skip)]

    def _count(self, visit: _DxfVisit, times: int = 1) -> None:
        """Count what is not read, by its name."""
        name = str(visit.entity.dxftype()).removesuffix(COUNTED)[:40]
        self._ignored["hidden" if self._is_hidden(visit) else name] += times

    def _layer(self, visit: _DxfVisit) -> str:
        """The layer of an entity."""
        name = str(_said(visit.entity, "layer", "0"))
        return visit.layer if name == "0" and visit.blocks else name

    def _table_entry(self, visit: _DxfVisit) -> Any:
        """The layer's entry in the table of layers, None where it has none."""
        name = self._layer(visit)
        return self._document.layers.get(name) if self._document.layers.has_entry(name) else None

    def _is_hidden(self, visit: _DxfVisit) -> bool:
        entry = self._table_entry(visit)
        return bool(_said(visit.entity, "invisible", 0)) or (
            entry is not None and (entry.is_off() or entry.is_frozen())
        )

    def _own_colour(self, visit: _DxfVisit) -> int | tuple[int, int, int]:
        """The colour of an entity: red, green and blue, or the number of an AutoCAD colour."""
        rgb = visit.entity.rgb
        if rgb is not None:
            return int(rgb[0]), int(rgb[1]), int(rgb[2])
        number = int(visit.entity.dxf.get("color", _BY_LAYER))
        if number == _BY_BLOCK:
            return visit.colour
        if number == _BY_LAYER:
            entry = self._table_entry(visit)
            if entry is None:
                return _FOREGROUND
            return tuple(entry.rgb) if entry.rgb is not None else abs(int(entry.color))
        return number

    def _colour(self, visit: _DxfVisit) -> str:
        """The colour of an entity, "#rrggbb"; AutoCAD's foreground, white on black, is black on paper."""
        from ezdxf.colors import aci2rgb

        colour = self._own_colour(visit)
        if not isinstance(colour, int):
            rgb = colour
        elif colour == _FOREGROUND or not 0 < colour < _BY_LAYER:
            rgb = (0, 0, 0)
        else:
            rgb = aci2rgb(colour)
        return f"#{bytes(rgb).hex()}"

    def _width(self, entity: Any) -> float | None:
        """The width of the line; millimetres."""
        weight = int(entity.dxf.get("lineweight", -1))
        return weight / 100 if weight >= 0 else None


def _said(entity: Any, name: str, default: Any) -> Any:
    """What an entity says of a common property, also one that is only counted."""
    properties = entity.graphic_properties() if entity.dxftype().endswith(COUNTED) else entity.dxf
    return properties.get(name, default)
