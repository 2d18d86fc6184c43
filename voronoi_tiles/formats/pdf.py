"""PDF: one page of the exact size, every layer an optional content group, lines and cubic curves and nothing else.

PDF 1.5 (Adobe, PDF Reference, fourth edition), the first with optional content; readers of 1.4 skip that. The content
is in millimetres: one matrix scales it to points, so that a coordinate in the file is the coordinate in the drawing.

Why by hand: a library would take the content, nearly all of the file, as bytes as well; what it would write around them
are the few objects below.
"""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import BinaryIO, Final

import numpy as np

from voronoi_tiles.base.units import MILLIMETRES
from voronoi_tiles.formats.cubics import cubic_blocks
from voronoi_tiles.formats.decimals import PLACES, WIDTH, decimals
from voronoi_tiles.formats.page import Drawing, Layer
from voronoi_tiles.paths.paths import CUBIC, Paths

POINTS_PER_MM: Final = float(1 / MILLIMETRES["pt"])

_SPACE, _BREAK = ord(" "), ord("\n")


def write_pdf(drawing: Drawing, file: BinaryIO) -> None:
    """Write a drawing as a page of PDF, in the order of the drawing.

    Lines and curves are those of the drawing, rounded to a nanometre; circular arcs become cubic curves within
    1e-6 mm. The paths of one item are one object. A layer that is filled is filled by the even-odd rule, in its
    colour, and not drawn; closed paths are closed. Title and recipe stand in the document's information. The same
    drawing gives the same bytes.
    """
    names = [f"L{k}" for k in range(len(drawing.layers))]
    packer = zlib.compressobj(6)
    content = bytearray()
    for part in _content(drawing, names):
        content += packer.compress(part)
    content += packer.flush()
    stream = b"<< /Length %d /Filter /FlateDecode >>\nstream\n%s\nendstream" % (len(content), content)
    _write_objects(file, [*_objects(drawing, names), stream])


def _content(drawing: Drawing, names: list[str]) -> Iterator[bytes]:
    """The page's content stream."""
    yield f"q {POINTS_PER_MM:.12f} 0 0 {POINTS_PER_MM:.12f} 0 0 cm 1 J 1 j\n".encode()
    for layer, name in zip(drawing.layers, names, strict=True):
        red, green, blue = (_number(int(layer.colour[k : k + 2], 16) / 255) for k in (1, 3, 5))
        yield (
            f"/OC /{name} BDC\nq {red} {green} {blue} RG {red} {green} {blue} rg {_number(layer.stroke)} w\n"
        ).encode()
        yield from _items(layer)
        yield b"Q\nEMC\n"
    yield b"Q\n"


def _items(layer: Layer) -> Iterator[bytes]:
    """The paths of a layer, painted item by item."""
    paint = b"f*\n" if layer.filled else b"S\n"
    for cubics, items in cubic_blocks(layer):
        yield _operators(cubics, items.tolist(), paint)


def _operators(cubics: Paths, items: list[int], paint: bytes) -> bytes:
    """Path operators of some items: m, l, c, h, and the painting of each item."""
    start, end = _pairs(cubics.start), _pairs(cubics.end)
    rows = [b"%sl\n" % text for text in end]
    bent = np.flatnonzero(cubics.kind == CUBIC)
    controls = _pairs(cubics.control[bent].ravel())
    for k, place in enumerate(bent.tolist()):
        rows[place] = b"%s%s%sc\n" % (controls[2 * k], controls[2 * k + 1], end[place])
    offsets, closed = cubics.offsets.tolist(), cubics.closed.tolist()
    parts = []
    for a, b in pairwise(items):
        for path in range(a, b):
            if offsets[path] == offsets[path + 1]:
                continue
            parts.append(b"%sm\n" % start[offsets[path]])
            parts += rows[offsets[path] : offsets[path + 1]]
            if closed[path]:
                parts.append(b"h\n")
        if offsets[a] < offsets[b]:
            parts.append(paint)
    return b"".join(parts)


def _pairs(points: np.ndarray[tuple[int], np.dtype[np.complex128]]) -> list[bytes]:
    """Points as "x y ", rounded to a nanometre."""
    texts = np.empty((len(points), 2 * (WIDTH + 1) + 1), np.uint8)
    used = np.ones(texts.shape, np.bool_)
    for k, values in enumerate((points.real, points.imag)):
        place = slice(k * (WIDTH + 1), k * (WIDTH + 1) + WIDTH)
        texts[:, place], used[:, place] = decimals(values)
        texts[:, place.stop] = _SPACE
    texts[:, -1] = _BREAK
    return texts[used].tobytes().split(b"\n")[:-1]


def _number(value: float) -> str:
    """One number, rounded as coordinates are."""
    text = f"{value:.{PLACES}f}".rstrip("0").rstrip(".")
    return text or "0"


# --- objects ----------------------------------------------------------------------------------------------------


def _objects(drawing: Drawing, names: list[str]) -> list[bytes]:
    """Every object but the content stream, from number 1; the groups of the layers begin at number 4."""
    groups = [f"{4 + k} 0 R" for k in range(len(names))]
    listed = " ".join(groups)
    width, height = (_number(length * POINTS_PER_MM) for length in (drawing.width, drawing.height))
    properties = " ".join(f"/{name} {group}" for name, group in zip(names, groups, strict=True))
    layers = f"<< /OCGs [{listed}] /D << /Order [{listed}] /ON [{listed}] >> >>"
    resources = f"<< /Properties << {properties} >> >>"
    place = f"/MediaBox [0 0 {width} {height}] /Resources {resources} /Contents {5 + len(names)} 0 R"
    objects = [
        f"<< /Type /Catalog /Pages 2 0 R /OCProperties {layers} >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R {place} >>",
    ]
    objects += [f"<< /Type /OCG /Name {_text(layer.name)} >>" for layer in drawing.layers]
    objects.append(_information(drawing.title, drawing.recipe))
    return [text.encode("ascii") for text in objects]


def _information(title: str, recipe: Mapping[str, str]) -> str:
    """The document's information: its title, and the recipe as JSON."""
    entries = f" /Title {_text(title)}" if title else ""
    entries += f" /Subject {_text(json.dumps(dict(recipe)))}" if recipe else ""
    return f"<< /Producer (voronoi-tiles){entries} >>"


def _text(text: str) -> str:
    """A text string in hexadecimal digits: UTF-16 with its mark, which holds every character."""
    return f"<FEFF{text.encode('utf-16-be', 'replace').hex().upper()}>"


def _write_objects(file: BinaryIO, objects: list[bytes]) -> None:
    """Write the file around its objects: header, objects from 1, the table of their places, trailer."""
    header = b"%PDF-1.5\n%\xe2\xe3\xcf\xd3\n"
    file.write(header)
    place, places = len(header), []
    for number, body in enumerate(objects, start=1):
        text = b"%d 0 obj\n%s\nendobj\n" % (number, body)
        file.write(text)
        places.append(place)
        place += len(text)
    file.write(b"xref\n0 %d\n0000000000 65535 f \n" % (len(objects) + 1))
    file.write(b"".join(b"%010d 00000 n \n" % at for at in places))
    information = len(objects) - 1
    file.write(
        b"trailer\n<< /Size %d /Root 1 0 R /Info %d 0 R >>\nstartxref\n%d\n%%%%EOF\n"
        % (len(objects) + 1, information, place)
    )
