"""What is selected in a drawing of Inkscape: the strokes of each site, and the rectangle that is the cell.

Everything is in millimetres from the page's lower left corner, y up, as the reader of drawings has it: paths and
matrices are read by it alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Affine
from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.drawn_files import outlines_of, remarks
from voronoi_tiles.formats.shapes import Dots, ReadDrawing, Shape
from voronoi_tiles.formats.svg.elements import INKSCAPE, SILENT, source_of, tag_of
from voronoi_tiles.formats.svg.reader import drawing_of_tree
from voronoi_tiles.formats.svg.xml_tree import Node
from voronoi_tiles.inkscape.dialog_fields import CELL_LABEL
from voronoi_tiles.inkscape.own_layers import ROLE
from voronoi_tiles.paths.paths import LINE, Paths

_LABEL: Final = f"{INKSCAPE}label"

_LOST: Final = {
    **dict.fromkeys(("text", "flowRoot"), "Convert it by Path > Object to Path, or leave it out of the selection."),
    **dict.fromkeys(("image", "foreignObject"), "Trace it by Path > Trace Bitmap, or leave it out of the selection."),
}
"""Objects that nobody would expect to be passed over, each with what to do."""

_CLONED: Final = (*_LOST, "use of another file", "use of nothing")


class SelectedObject(NamedTuple):
    """What one object draws: paths, or the places of points where it has no size; `source` names it."""

    source: str
    paths: Paths
    points: tuple[complex, ...]


class SelectedSite(NamedTuple):
    """A site: its name, and what its objects draw."""

    name: str
    objects: tuple[SelectedObject, ...]


@dataclass(frozen=True, eq=False)
class Selection:
    """The sites that are selected, and the corners of the cell's rectangle in its order, None where there is none.

    `notes` are sentences on what was taken otherwise than it looks. `size` is that of the page, None where it has none,
    and `to_page` the map from the drawing's user units, y down. `names` are the ids of all that is not of ours.
    """

    sites: tuple[SelectedSite, ...]
    cell: tuple[complex, ...] | None
    notes: tuple[str, ...]
    size: tuple[float, float] | None
    to_page: Affine
    names: frozenset[str]


def selected(root: Node, file: str, ids: Sequence[str]) -> Selection:
    """What is selected of a drawing. Raises DesignError where that is nothing, or what makes no strokes."""
    own, known = known_elements(root)
    chosen = [name for name in known if name in set(ids) and name not in own]
    if not chosen:
        what, remedy = "nothing is selected", "Select the strokes of a tile: paths, shapes, or groups."
        if own.intersection(ids):
            what = "what is selected are tiles that were made before"
            remedy = "Select the strokes that they were made from."
        elif ids:
            what = f"what is selected is not drawn: {', '.join(ids[:8])}"
            remedy = "Select paths, shapes, or groups of them."
        raise DesignError(what, remedy=remedy)
    _refuse_lost(known[name] for name in chosen)
    cell = _cell(known.values(), {*chosen}, own)
    wanted = {*chosen} if cell is None else {*chosen, cell.attributes["id"]}
    drawing, to_page = drawing_of_tree(root, file, wanted)
    for what in _CLONED:
        if what in drawing.ignored:
            raise DesignError(
                f"a clone in the selection shows a {what}" if what in _LOST else f"the selection has a {what}",
                remedy=_LOST.get(what, "Unlink the clone, or leave it out of the selection."),
            )
    corners = None
    if cell is not None:
        source = source_of(cell, "rect")
        corners = _corners(drawing, source)
        drawing = _without(drawing, source)
    size = None if drawing.width is None or drawing.height is None else (drawing.width, drawing.height)
    names = frozenset(known).difference(own)
    return Selection(tuple(_sites(drawing, known, chosen)), corners, tuple(_notes(drawing)), size, to_page, names)


def known_elements(root: Node) -> tuple[set[str], dict[str, Node]]:
    """The ids of what stands in layers of ours, and all elements that are drawn by their ids, in the file's order."""
    own: set[str] = set()
    known: dict[str, Node] = {}
    todo = [(root, False)]
    while todo:
        node, inside = todo.pop()
        if node is not root and tag_of(node) in SILENT:
            continue
        inside = inside or ROLE in node.attributes
        name = node.attributes.get("id")
        if name is not None:
            known.setdefault(name, node)
            if inside:
                own.add(name)
        todo.extend((child, inside) for child in reversed(node.children))
    return own, known


def _refuse_lost(nodes: Iterable[Node]) -> None:
    """Refuse texts and images by their names."""
    todo = list(nodes)
    while todo:
        node = todo.pop()
        tag = tag_of(node)
        if tag in _LOST:
            name = node.attributes.get(_LABEL, node.attributes.get("id", ""))
            raise DesignError(f'the {tag} "{name}" is no path', remedy=_LOST[tag])
        todo.extend(node.children)


def _cell(nodes: Iterable[Node], chosen: set[str], own: set[str]) -> Node | None:
    """The rectangle that is the cell: a selected one, or the only one that there is."""
    found = [
        node
        for node in nodes
        if tag_of(node) == "rect"
        and node.attributes.get(_LABEL, "").strip().casefold() == CELL_LABEL
        and node.attributes["id"] not in own
    ]
    found = [node for node in found if node.attributes["id"] in chosen] or found
    if len(found) > 1:
        names = ", ".join(node.attributes["id"] for node in found[:8])
        raise DesignError(
            f'{counted(len(found), "rectangle")} have the label "{CELL_LABEL}": {names}',
            remedy="Select the one that is meant as well.",
        )
    return found[0] if found else None


def _corners(drawing: ReadDrawing, source: str) -> tuple[complex, ...] | None:
    """The corners of the cell's rectangle, None where it is hidden."""
    for shape in drawing.shapes:
        if shape.source == source:
            if len(shape.paths.start) != 4 or (shape.paths.kind != LINE).any():
                raise DesignError(
                    f'the rectangle "{CELL_LABEL}" has rounded corners', remedy="Make them sharp: Rx and Ry 0."
                )
            return tuple(shape.paths.start.tolist())
    return None


def _without(drawing: ReadDrawing, source: str) -> ReadDrawing:
    """The drawing without one object."""
    return replace(drawing, shapes=tuple(shape for shape in drawing.shapes if shape.source != source))


def _sites(drawing: ReadDrawing, known: Mapping[str, Node], chosen: Sequence[str]) -> Iterator[SelectedSite]:
    """One site for each group, and one for all that is in none."""
    groups = [name for name in chosen if tag_of(known[name]) in {"g", "a", "switch"}]
    homes: dict[str, list[SelectedObject]] = {name: [] for name in ("", *groups)}
    for shape in drawing.shapes:
        homes.get(shape.within, homes[""]).append(_lines(shape))
    for dots in drawing.dots:
        homes.get(dots.within, homes[""]).append(_points(dots))
    taken: set[str] = set()
    for home, objects in homes.items():
        if objects:
            name = _site_name(known[home] if home else None, taken, len(taken) + 1)
            taken.add(name)
            yield SelectedSite(name, tuple(objects))
    if not taken:
        raise DesignError("nothing of the selection is drawn", remedy="Give it a stroke, and show it.")


def _lines(shape: Shape) -> SelectedObject:
    """What a shape draws; what is filled is drawn around."""
    return SelectedObject(shape.source, outlines_of([shape])[0], ())


def _points(dots: Dots) -> SelectedObject:
    return SelectedObject(dots.source, Paths.empty(), tuple(np.unique(dots.places).tolist()))


def _site_name(node: Node | None, taken: set[str], number: int) -> str:
    """What a site is called: as its group, where that is a name and no other site has it."""
    attributes = {} if node is None else node.attributes
    name = (attributes.get(_LABEL) or attributes.get("id", "")).strip()
    if 0 < len(name) <= 100 and name.isprintable() and name not in taken:
        return name
    while f"site{number}" in taken:
        number += 1
    return f"site{number}"


def _notes(drawing: ReadDrawing) -> Iterator[str]:
    """Sentences on what was taken otherwise than it looks."""
    if drawing.clones:
        yield f"taken as what they show: clones ({drawing.clones:,})"
    what = ", ".join(f"{name} ({count:,})" for name, count in drawing.ignored.items())
    if what:
        yield f"not followed: {what}"
    joined = sum(outlines_of([shape])[1] for shape in drawing.shapes)
    yield from (note.partition(": ")[2] for note in remarks("", joined=joined, guides=False))
