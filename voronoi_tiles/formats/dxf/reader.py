"""Reading DXF by ezdxf: what the model space draws, in millimetres.

Drawn are LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE, POLYLINE and SPLINE, also in blocks. All else is counted and left out,
as is what lies on hidden layers or stands tilted in space.
"""

from __future__ import annotations

import io
import logging
from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from voronoi_tiles.base.maps import Affine
from voronoi_tiles.base.units import MILLIMETRES
from voronoi_tiles.formats.dxf.entities import Tilted, draw_entity
from voronoi_tiles.formats.pen import Pen
from voronoi_tiles.formats.shapes import (
    DEPTH_MAX,
    DXF_BYTES_MAX,
    DXF_COPIES_MAX,
    DXF_INSERTS_MAX,
    ELEMENTS_MAX,
    DrawingError,
    ReadDrawing,
    Shape,
)

if TYPE_CHECKING:
    from ezdxf.document import Drawing
    from ezdxf.entities.dxfgfx import DXFGraphic
    from ezdxf.entities.insert import Insert

_DRAWN: Final = frozenset({"LINE", "ARC", "CIRCLE", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "SPLINE"})
_REMEDY: Final = "Save it again as DXF (R2000 or newer, text) in the program that made it."

# By $INSUNITS.
_UNITS: Final = (
    *("", "in", "ft", "mi", "mm", "cm", "m", "km", "microinch", "mil", "yd", "angstrom", "nm", "um", "dm", "dam", "hm"),
)
_BY_BLOCK, _BY_LAYER, _FOREGROUND = 0, 256, 7


def dxf_drawing(data: bytes, file: str, element: str | None = None) -> ReadDrawing:
    """Read the content of a DXF file; `file` is its name for messages.

    With `element` only the entity of the model space that has that handle is drawn and counted.
    The coordinates stay where they are, in millimetres by $INSUNITS. Curves keep their kind: arcs are arcs, splines
    without weights of up to the third degree are exact, ellipses and other splines become cubics within CURVE_ACCURACY.
    Raises DrawingError for what is broken, hostile or beyond the limits.
    """
    if not data.strip():
        raise DrawingError("the file is empty", file=file, remedy=_REMEDY)
    if data.startswith(b"AutoCAD Binary DXF"):
        raise DrawingError("a binary DXF file", file=file, remedy=_REMEDY)
    if data.startswith(b"AC10"):
        raise DrawingError("a DWG file, not DXF", file=file, remedy=_REMEDY)
    if len(data) > DXF_BYTES_MAX:
        raise DrawingError(f"larger than {DXF_BYTES_MAX >> 20} MiB", file=file, remedy="Split the drawing.")
    if _entity_count(data) > ELEMENTS_MAX:
        raise DrawingError(f"more than {ELEMENTS_MAX:,} entities", file=file, remedy="Split the drawing.")
    try:
        document = _load(data)
        return _DxfWalk(document, element).drawing()
    except DrawingError as error:
        raise error.with_file(file) from None
    except Exception as error:  # ezdxf raises what its parts raise, whatever that is
        raise DrawingError(f"broken DXF: {_reason(error)}", file=file, remedy=_REMEDY) from error


def _reason(error: Exception) -> str:
    text = " ".join(str(error).split()).rstrip(".")
    name = type(error).__name__
    return text[:200] if text.startswith(name) else f"{name}{': ' if text else ''}{text[:200]}"


def _entity_count(data: bytes) -> int:
    """How many entities, and table entries, the text of a DXF file has: they are the values of group code 0.

    Counted before they are parsed, which takes thousands of times as long. Codes and values take turns, a line each.
    """
    text = np.frombuffer(data, np.uint8)
    begins = np.append(0, np.flatnonzero(text[:-1] == ord("\n")) + 1)
    # A code is 0 however it is written: " 0", "00".
    zero = np.logical_or.reduceat(text == ord("0"), begins)[::2]
    more = np.logical_or.reduceat((text >= ord("1")) & (text <= ord("9")), begins)[::2]
    return int(np.count_nonzero(zero & ~more))


def _load(data: bytes) -> Drawing:
    """The document of a DXF file."""
    from ezdxf.filemanagement import dxf_stream_info, read

    # Without a handler of its own, ezdxf's warnings would go to standard error.
    log = logging.getLogger("ezdxf")
    if not log.handlers:
        log.addHandler(logging.NullHandler())
    if b"\x00" in data[:4096]:
        raise DrawingError("not a DXF file: it holds binary data", remedy=_REMEDY)
    text = data.decode("latin-1")
    encoding = dxf_stream_info(io.StringIO(text)).encoding
    if encoding not in {"latin-1", "cp1252", "ascii"}:
        text = data.decode(encoding, errors="surrogateescape")
    return read(io.StringIO(text.replace("\r\n", "\n")))


class _DxfVisit(NamedTuple):
    """An entity with what it takes from the blocks around it."""

    entity: Any
    layer: str  # what layer 0 of a block stands for
    colour: int | tuple[int, int, int]  # what "by block" stands for
    blocks: tuple[str, ...]
    source: str  # what an entity of a block, which has no handle of its own, is called


class _DxfWalk:
    """Draws the model space, with its own stack: blocks in blocks are no depth of calls."""

    def __init__(self, document: Drawing, element: str | None) -> None:
        self._document = document
        self._element = None if element is None else element.upper()
        self._pen = Pen()
        self._ignored: Counter[str] = Counter()
        self._looks: list[tuple[str, str, float | None, str]] = []
        self._clones = 0
        self._copies = 0
        units = int(document.header.get("$INSUNITS", 0))
        self._unit = _UNITS[units] if 0 < units < len(_UNITS) else ""

    def drawing(self) -> ReadDrawing:
        """All that is drawn."""
        to_page = Affine(complex(MILLIMETRES[self._unit or "mm"]), 0j, 0j)
        for visit in self._entities():
            entity = visit.entity
            kind = entity.dxftype()
            source = visit.source or f"{kind} {entity.dxf.handle}"
            if kind not in _DRAWN:
                self._ignored[str(kind)[:40]] += 1
                continue
            self._pen.begin(to_page)
            try:
                draw_entity(self._pen, entity, to_page)
            except Tilted as tilted:
                self._ignored[f"{kind} {tilted}"] += 1
            except DrawingError as error:
                raise error.under(source) from None
            except Exception as error:
                raise DrawingError(f"broken: {_reason(error)}", key=source, remedy=_REMEDY) from error
            self._looks.append((self._layer(visit), self._colour(visit), self._width(entity), source))
        shapes = tuple(
            Shape(paths, layer, colour, None, width, source)
            for (layer, colour, width, source), paths in zip(self._looks, self._pen.shapes(), strict=True)
            if len(paths)
        )
        return ReadDrawing(
            format="dxf",
            width=None,
            height=None,
            unit=self._unit,
            unit_known=bool(self._unit),
            shapes=shapes,
            ignored=dict(sorted(self._ignored.items())),
            clones=self._clones,
        )

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
        layer, colour = self._layer(visit), self._own_colour(visit)
        source = visit.source or f"INSERT {insert.dxf.handle}"
        copies = insert.multi_insert() if places > 1 else [insert]
        return [
            _DxfVisit(entity, layer, colour, (*visit.blocks, key), f"{entity.dxftype()} in {source}")
            for copy in copies
            for entity in copy.virtual_entities(skipped_entity_callback=self._skip)
        ]

    def _skip(self, entity: DXFGraphic, _reason: str) -> None:
        self._ignored[str(entity.dxftype())[:40]] += 1

    def _layer(self, visit: _DxfVisit) -> str:
        """The layer of an entity."""
        name = str(visit.entity.dxf.get("layer", "0"))
        return visit.layer if name == "0" and visit.blocks else name

    def _table_entry(self, visit: _DxfVisit) -> Any:
        """The layer's entry in the table of layers, None where it has none."""
        name = self._layer(visit)
        return self._document.layers.get(name) if self._document.layers.has_entry(name) else None

    def _is_hidden(self, visit: _DxfVisit) -> bool:
        entry = self._table_entry(visit)
        return bool(visit.entity.dxf.get("invisible", 0)) or (
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
