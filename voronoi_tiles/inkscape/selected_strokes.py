"""What is selected in a drawing of Inkscape: the strokes of each site, and the rectangle that is the cell.

Everything is in millimetres from the page's lower left corner, y up, as the reader of drawings has it: paths and
matrices are read by it alone.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final, NamedTuple

import numpy as np

from voronoi_tiles.base.errors import DesignError
from voronoi_tiles.base.maps import Affine
from voronoi_tiles.base.text import counted
from voronoi_tiles.designs.drawn_files import outlines_of, remarks
from voronoi_tiles.formats.shapes import Dots, ReadDrawing, Shape
from voronoi_tiles.formats.svg.elements import GROUPS, INKSCAPE, SILENT, tag_of
from voronoi_tiles.formats.svg.reader import drawing_of_tree
from voronoi_tiles.formats.svg.xml_tree import Node
from voronoi_tiles.inkscape.cell_drawing import is_as_fitted
from voronoi_tiles.inkscape.dialog_fields import CELL_LABEL
from voronoi_tiles.inkscape.own_layers import ROLE
from voronoi_tiles.paths.paths import LINE, Paths

_LABEL: Final = f"{INKSCAPE}label"

_MODE: Final = f"{INKSCAPE}groupmode"

_SHOWN: Final = "".join(
    f";{said}!important"
    for said in ("display:inline", "visibility:visible", "opacity:1", "stroke:#000", "stroke-opacity:1")
)
"""The style of what is to be seen."""

_LOST: Final = {
    **dict.fromkeys(("text", "flowRoot"), "Convert it by Path > Object to Path, or leave it out of the selection."),
    **dict.fromkeys(("image", "foreignObject"), "Trace it by Path > Trace Bitmap, or leave it out of the selection."),
}
"""Objects that nobody would expect to be passed over, each with what to do."""


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
    and `to_page` the map from the drawing's user units, y down. `names` are the ids of all that is not of ours, and
    `fitted` those of layers with a cell that is to be fitted anew.
    """

    sites: tuple[SelectedSite, ...]
    cell: tuple[complex, ...] | None
    notes: tuple[str, ...]
    size: tuple[float, float] | None
    to_page: Affine
    names: frozenset[str]
    fitted: frozenset[str]


def selected(root: Node, file: str, ids: Sequence[str]) -> Selection:
    """What is selected of a drawing; a cell that was fitted, and that nobody has moved since, is none of it.

    Raises DesignError where nothing is selected, or what makes no strokes.
    """
    own, known = known_elements(root)
    fitted = frozenset(name for name, node in known.items() if is_as_fitted(node))
    own |= fitted | {known[name].children[0].attributes.get("id", "") for name in fitted}
    homes, cells = _homes(root, {*ids} - own), _cells(known)
    if homes.keys() <= cells and cells.intersection(ids):
        raise DesignError("only the cell is selected", remedy="Select the strokes as well.")
    if not homes:
        what, remedy = "nothing is selected", "Select the strokes of a tile: paths, shapes, or groups."
        if own.intersection(ids):
            what = "what is selected are tiles that were made before"
            remedy = "Select the strokes that they were made from."
        elif ids:
            what = f"what is selected is not drawn: {', '.join(ids[:8])}"
            remedy = "Select paths, shapes, or groups of them."
        raise DesignError(what, remedy=remedy)
    cells = cells & homes.keys() or cells - own
    drawing, to_page = drawing_of_tree(root, file, {*homes, *cells})
    for what in (*_LOST, "use of another file", "use of nothing"):
        if what in drawing.ignored:
            raise _lost_error(what, (known[name] for name in homes))
    shown = {shape.within: shape for shape in drawing.shapes if shape.within in cells}
    names = sorted(shown or cells)
    if len(names) > 1:
        raise DesignError(
            f'{counted(len(names), "rectangle")} have the label "{CELL_LABEL}": {", ".join(names[:8])}',
            remedy="Select the one that is meant as well.",
        )
    corners = None
    for name in names:
        corners = _corners(shown[name] if shown else _revealed(root, file, name))
    drawing = replace(drawing, shapes=tuple(shape for shape in drawing.shapes if shape.within not in cells))
    size = None if drawing.width is None or drawing.height is None else (drawing.width, drawing.height)
    sites, notes = tuple(_sites(drawing, known, homes)), tuple(_notes(drawing))
    return Selection(sites, corners, notes, size, to_page, frozenset(known).difference(own), fitted)


def known_elements(root: Node) -> tuple[set[str], dict[str, Node]]:
    """The ids of what stands in layers of ours, and all elements that are drawn by their ids, in the file's order."""
    own: set[str] = set()
    known: dict[str, Node] = {}
    todo = [(root, False)]
    while todo:
        node, inside = todo.pop()
        if node is not root and tag_of(node) in SILENT:
            continue
        inside = inside or node.attributes.get(ROLE, "cell") != "cell"
        name = node.attributes.get("id")
        if name is not None:
            known.setdefault(name, node)
            if inside:
                own.add(name)
        todo.extend((child, inside) for child in reversed(node.children))
    return own, known


def _homes(root: Node, ids: Collection[str]) -> dict[str, str]:
    """The elements that ids select, in the file's order, each with the id of the group that is its site, "" for none.

    In a layer each of its groups is a site, and what is in none is one that is called as the layer.
    """
    homes: dict[str, str] = {}
    todo = [(root, "")]
    while todo:
        node, layer = todo.pop()
        name, tag = node.attributes.get("id", ""), tag_of(node)
        inside = layer
        if tag in GROUPS and name and (layer or name in ids):
            homes[name] = inside = name
            if node.attributes.get(_MODE) != "layer":
                continue
        elif name in ids:
            homes[name] = layer
            continue
        if node is root or tag not in SILENT:
            todo.extend((child, inside) for child in reversed(node.children))
    return homes


def _lost_error(what: str, nodes: Iterable[Node]) -> DesignError:
    """The error for objects of which there is nothing to take, in the selection or in clones in it."""
    if what not in _LOST:
        remedy = "Unlink the clone, or leave it out of the selection."
        return DesignError(f"the selection has a {what}", remedy=remedy)
    todo = list(nodes)
    while todo:
        node = todo.pop()
        if tag_of(node) == what:
            name = node.attributes.get(_LABEL, node.attributes.get("id", ""))
            return DesignError(f'the {what} "{name}" is no path', remedy=_LOST[what])
        todo.extend(node.children)
    return DesignError(f"a clone in the selection shows a {what}", remedy=_LOST[what])


def _cells(known: Mapping[str, Node]) -> set[str]:
    """The ids of the rectangles with the label of the cell."""
    return {
        name
        for name, node in known.items()
        if tag_of(node) == "rect" and node.attributes.get(_LABEL, "").strip().casefold() == CELL_LABEL
    }


def _corners(shape: Shape) -> tuple[complex, ...]:
    """The corners of the cell's rectangle."""
    if (shape.paths.kind != LINE).any():
        raise DesignError(f'the rectangle "{CELL_LABEL}" has rounded corners', remedy="Make them sharp: Rx and Ry 0.")
    if len(shape.paths.start) != 4:
        raise _no_size()
    return tuple(shape.paths.start.tolist())


def _revealed(root: Node, file: str, name: str) -> Shape:
    """What an element draws that is hidden, as the layer of a cell is once it is in the way; all of the tree is shown.

    Raises DesignError where it draws nothing then.
    """
    todo = [root]
    while todo:
        node = todo.pop()
        node.attributes["style"] = f"{node.attributes.get('style', '')}{_SHOWN}"
        todo.extend(node.children)
    for shape in drawing_of_tree(root, file, {name}).read.shapes:
        return shape
    raise _no_size()


def _no_size() -> DesignError:
    """The error for a cell of no area."""
    return DesignError(
        f'the rectangle "{CELL_LABEL}" has no size', remedy="Change it, or delete it to have one fitted."
    )


def _sites(drawing: ReadDrawing, known: Mapping[str, Node], homes: Mapping[str, str]) -> Iterator[SelectedSite]:
    """One site for each group, and one for all that is in none."""
    sites: dict[str, list[SelectedObject]] = {name: [] for name in ("", *homes)}
    for shape in drawing.shapes:
        sites[homes[shape.within]].append(_lines(shape))
    for dots in drawing.dots:
        sites[homes[dots.within]].append(_points(dots))
    taken: set[str] = set()
    for home, objects in sites.items():
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
