"""3MF files: an object for each piece, or for each colour, in millimetres, with the recipe that they were made by.

Why our own: lib3mf is seven megabytes of binaries, trimesh wants lxml and networkx for it, and what is needed is a
page. Numbers are written with all their digits, so that what neighbours share is the same text in both; the same solid
gives the same bytes. Source: 3D Manufacturing Format, Core Specification 1.3, 3MF Consortium.
"""

from __future__ import annotations

import html
import io
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from voronoi_tiles.base.text import xml_attribute, xml_text
from voronoi_tiles.base.version import __version__
from voronoi_tiles.formats.png import Sink
from voronoi_tiles.formats.recipe import THREEMF_MODEL
from voronoi_tiles.formats.svg.writer import RECIPE_NAMESPACE
from voronoi_tiles.solid.mesh import TriangleMesh
from voronoi_tiles.solid.pieces import SolidPiece

_CORE: Final = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_PACKAGE: Final = "http://schemas.openxmlformats.org/package/2006"

_PARTS: Final = {
    "[Content_Types].xml": f'<Types xmlns="{_PACKAGE}/content-types">'
    '<Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>'
    '<Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>',
    "_rels/.rels": f'<Relationships xmlns="{_PACKAGE}/relationships"><Relationship Id="model" '
    f'Target="/{THREEMF_MODEL}" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>',
}
"""What the package says of its parts."""

_XML: Final = '<?xml version="1.0" encoding="UTF-8"?>\n'
_EPOCH: Final = (1980, 1, 1, 0, 0, 0)
_UNIX: Final = 3
_COLOURS: Final = 1
"""The number of the colours among the resources; those of objects follow."""


def write_threemf(
    pieces: Sequence[SolidPiece],
    title: str,
    colours: Sequence[str],
    recipe: Mapping[str, str],
    file: Sink,
    *,
    grouped: bool,
) -> None:
    """Write all pieces as objects with colours, "#rrggbb"; where they are grouped, those of one are parts of one."""
    facts = {"Title": title, "Application": f"voronoi-tiles {__version__}"}
    facts |= {f"vt:{name}": text for name, text in recipe.items()}
    model = "".join((*_head(facts), *_resources(pieces, colours, grouped=grouped)))
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as package:
        for name, text in (*_PARTS.items(), (THREEMF_MODEL, model)):
            # When and where it was written is not said: the same solid gives the same bytes.
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.create_system, entry.external_attr, entry.compress_type = _UNIX, 0o644 << 16, zipfile.ZIP_DEFLATED
            package.writestr(entry, f"{_XML}{text}\n")
    file.write(buffer.getvalue())


def _head(facts: Mapping[str, str]) -> Iterator[str]:
    """The beginning of the model's text, with its metadata."""
    yield f'<model unit="millimeter" xml:lang="en" xmlns="{_CORE}" xmlns:vt="{RECIPE_NAMESPACE}">\n'
    for name, text in facts.items():
        yield f'<metadata name="{name}">{html.escape(xml_text(text), quote=False)}</metadata>\n'


def _resources(pieces: Sequence[SolidPiece], colours: Sequence[str], *, grouped: bool) -> Iterator[str]:
    """The rest of it: colours, objects, and which of these are to be built."""
    yield f'<resources>\n<basematerials id="{_COLOURS}">'
    for number, shade in enumerate(colours, 1):
        yield f'<base name="colour {number}" displaycolor="{shade.upper()}"/>'
    yield "</basematerials>\n"
    first = _COLOURS + 1
    for number, piece in enumerate(pieces, first):
        name = xml_attribute(piece.name)
        yield f'<object id="{number}" type="model" name={name} pid="{_COLOURS}" pindex="{piece.colour}">\n'
        yield from _mesh(piece.mesh)
        yield "</object>\n"
    build = range(first, first + len(pieces))
    if grouped:
        build = range(build.stop, build.stop + len(colours))
        for colour, number in enumerate(build):
            yield f'<object id="{number}" type="model" name="colour {colour + 1}"><components>'
            for part, piece in enumerate(pieces, first):
                if piece.colour == colour:
                    yield f'<component objectid="{part}"/>'
            yield "</components></object>\n"
    yield "</resources>\n<build>"
    for number in build:
        yield f'<item objectid="{number}"/>'
    yield "</build>\n</model>"


def _mesh(mesh: TriangleMesh) -> Iterator[str]:
    """The text of a mesh."""
    yield "<mesh><vertices>\n"
    for x, y, z in mesh.vertices.tolist():
        yield f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>\n'
    yield "</vertices><triangles>\n"
    for a, b, c in mesh.triangles.tolist():
        yield f'<triangle v1="{a}" v2="{b}" v3="{c}"/>\n'
    yield "</triangles></mesh>\n"
