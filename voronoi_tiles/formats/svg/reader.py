"""Reading SVG: what is drawn, in millimetres on the page, y up.

Drawn are path, rect, circle, ellipse, line, polyline and polygon, in groups, under transforms, and through `use`. Text,
images, nested drawings and what lies outside the file are counted and left out; nothing outside the file is opened.
"""

from __future__ import annotations

from collections import Counter
from typing import Final, NamedTuple

from voronoi_tiles.base.maps import Affine
from voronoi_tiles.formats.pen import Pen
from voronoi_tiles.formats.shapes import DEPTH_MAX, VISITS_MAX, Dots, DrawingError, ReadDrawing, Shape
from voronoi_tiles.formats.svg.basic_shapes import DRAWN, draw_shape
from voronoi_tiles.formats.svg.style import Style, StyleSheet, inherited, properties
from voronoi_tiles.formats.svg.transforms import parse_transform
from voronoi_tiles.formats.svg.viewport import Page, length, read_page, view_box, viewport
from voronoi_tiles.formats.svg.xml_tree import Node, parse_tree

SVG: Final = "http://www.w3.org/2000/svg "
XLINK: Final = "http://www.w3.org/1999/xlink "
INKSCAPE: Final = "http://www.inkscape.org/namespaces/inkscape "

_GROUPS: Final = frozenset({"g", "a", "switch"})
# What SVG itself does not draw where it stands.
_NOT_HERE: Final = """
    defs symbol clipPath mask marker pattern linearGradient radialGradient filter metadata title desc style view
    cursor color-profile font font-face solidcolor meshgradient hatch
"""
_SILENT: Final = frozenset(_NOT_HERE.split())
# What changes how an object looks, and is not followed.
_EFFECTS: Final = (
    "clip-path",
    "mask",
    "transform-origin",
    "stroke-dasharray",
    "marker-start",
    "marker-mid",
    "marker-end",
)


def svg_drawing(data: bytes, file: str, element: str | None = None) -> ReadDrawing:
    """Read the content of an SVG file, plain or compressed; `file` is its name for messages.

    With `element` only what has that id, or stands in a group that has it, is drawn and counted.
    Curves keep their kind; arcs of ellipses, and of circles under a transform that makes ellipses of them, become
    cubics within CURVE_ACCURACY. Raises DrawingError for what is broken, hostile or beyond the limits.
    """
    root = parse_tree(data, file, frozenset({f"{SVG}style", "style"}))
    tag = _tag(root)
    if tag != "svg":
        raise DrawingError(f"no SVG drawing: its root is <{root.tag.rpartition(' ')[2][:40]}>", file=file)
    try:
        page = read_page(root.attributes)
    except DrawingError as error:
        raise _at(error, root, file) from None
    return _SvgWalk(root, page, file, element).drawing()


def _tag(node: Node) -> str:
    """The name of an SVG element, "" for those of other namespaces; files without a namespace are taken as SVG."""
    if node.tag.startswith(SVG):
        return node.tag[len(SVG) :]
    return "" if " " in node.tag else node.tag


def _at(error: DrawingError, node: Node, file: str) -> DrawingError:
    """The same error with its file and line."""
    return DrawingError(error.message, file=file, key=error.key, line=node.line, remedy=error.remedy)


def _source(node: Node, tag: str) -> str:
    """What messages call an object."""
    name = node.attributes.get("id")
    return f"{tag} {name[:80]!r}, line {node.line}" if name else f"{tag}, line {node.line}"


class _SvgVisit(NamedTuple):
    """An element that is to be drawn, with what it takes from those around it."""

    node: Node
    to_page: Affine
    style: Style
    layer: str
    depth: int
    users: frozenset[int]  # the clones around it, by their targets: a clone of one of them is a circle
    chosen: bool  # whether it is the element that is asked for, or stands in it
    symbol_size: tuple[str | None, str | None] | None = None


def _transformed(visit: _SvgVisit) -> Affine:
    """The map to the page from the coordinates inside an element."""
    text = visit.node.attributes.get("transform")
    to_page = visit.to_page if text is None else visit.to_page @ parse_transform(text)
    if not abs(to_page.c) < float("inf"):
        raise DrawingError("transforms beyond all measure", remedy="Draw in units that keep numbers small.")
    return to_page


class _SvgWalk:
    """Draws a tree, with its own stack: the depth of a file is no depth of calls."""

    def __init__(self, root: Node, page: Page, file: str, element: str | None) -> None:
        self._root = root
        self._element = element
        self._page = page
        self._file = file
        self._pen = Pen()
        self._sheet = StyleSheet()
        self._targets: dict[str, Node] = {}
        self._ignored: Counter[str] = Counter()
        self._drawn: list[_SvgVisit] = []
        self._clones = 0
        self._stack: list[_SvgVisit] = []

    def drawing(self) -> ReadDrawing:
        """All that is drawn."""
        self._index()
        page = self._page
        # y is turned about the page's height; a file without one keeps the origin where it is.
        to_page = Affine(0j, 1 + 0j, complex(0.0, page.height or 0.0)) @ page.to_page
        if self._element is not None and self._element not in self._targets:
            raise self._no_element(self._element)
        chosen = self._element in {None, self._root.attributes.get("id")}
        self._push_children(
            _SvgVisit(self._root, to_page, self._style(self._root, Style()), "", 0, frozenset(), chosen)
        )
        visits = 0
        while self._stack:
            visit = self._stack.pop()
            visits += 1
            if visits > VISITS_MAX:
                raise DrawingError(
                    f"draws more than {VISITS_MAX:,} elements, clones counted with what they hold",
                    file=self._file,
                    line=visit.node.line,
                    remedy="Unlink the clones, or draw fewer of them.",
                )
            try:
                self._visit(visit)
            except DrawingError as error:
                raise _at(error, visit.node, self._file) from None
        if self._sheet.unread:
            self._ignored["style rule"] += self._sheet.unread
        shapes, dots = self._shapes()
        return ReadDrawing(
            format="svg",
            width=page.width,
            height=page.height,
            unit=page.unit,
            unit_known=page.unit_known,
            shapes=shapes,
            ignored=dict(sorted((+self._ignored).items())),
            clones=self._clones,
            dots=dots,
        )

    def _shapes(self) -> tuple[tuple[Shape, ...], tuple[Dots, ...]]:
        """The shapes that were drawn, and what has no size."""
        try:
            drawn = self._pen.shapes()
        except DrawingError as error:
            raise error.with_file(self._file) from None
        shapes, dots = [], []
        for visit, (paths, places) in zip(self._drawn, drawn, strict=True):
            node, style = visit.node, visit.style
            if len(places):
                dots.append(Dots(places, visit.layer, style.stroke, _source(node, _tag(node))))
            if not len(paths):
                continue
            try:
                width = abs(length(style.width, self._page.view[0])) * visit.to_page.scale
            except DrawingError as error:
                raise _at(error.under("stroke-width"), node, self._file) from None
            shapes.append(Shape(paths, visit.layer, style.stroke, style.fill, width, _source(node, _tag(node))))
        return tuple(shapes), tuple(dots)

    def _leave_out(self, visit: _SvgVisit, what: str) -> None:
        """Count what is not read."""
        self._ignored[what] += visit.chosen

    def _no_element(self, name: str) -> DrawingError:
        """The error for an id that the file has not."""
        there = ", ".join(repr(known[:40]) for known in list(self._targets)[:8])
        remedy = f"Its first ones are {there}." if there else "It has none at all: leave the id out."
        return DrawingError(f"has no element with the id {name[:80]!r}", file=self._file, remedy=remedy)

    def _index(self) -> None:
        """Find the targets of clones and the style sheets."""
        todo = [self._root]
        while todo:
            node = todo.pop()
            if "id" in node.attributes:
                self._targets.setdefault(node.attributes["id"], node)
            if _tag(node) == "style":
                self._sheet.add(node.text)
            todo.extend(reversed(node.children))

    def _style(self, node: Node, parent: Style) -> Style:
        return inherited(parent, properties(node, _tag(node), self._sheet))

    def _push_children(self, visit: _SvgVisit) -> None:
        """Have the children drawn next, in their order."""
        self._stack.extend(
            visit._replace(node=child, depth=visit.depth + 1, symbol_size=None)
            for child in reversed(visit.node.children)
        )

    def _visit(self, visit: _SvgVisit) -> None:
        """Draw one element, or have its content drawn."""
        if visit.depth > DEPTH_MAX:
            raise DrawingError(f"clones and groups nested more than {DEPTH_MAX:,} deep", remedy="Ungroup the drawing.")
        node = visit.node
        tag = _tag(node)
        if not visit.chosen and node.attributes.get("id") == self._element:
            visit = visit._replace(chosen=True)
        if tag == "symbol" and visit.symbol_size is not None:
            self._symbol(visit)
            return
        if not tag or tag in _SILENT:
            return
        said = properties(node, tag, self._sheet)
        if said.get("display") == "none":
            return
        if tag not in DRAWN and tag not in _GROUPS and tag != "use":
            self._leave_out(visit, "nested svg" if tag == "svg" else tag[:40])
            return
        for effect in _EFFECTS:
            if node.attributes.get(effect, "none") != "none":
                self._leave_out(visit, effect)
        visit = visit._replace(to_page=_transformed(visit), style=inherited(visit.style, said))
        if tag in DRAWN:
            self._draw(visit, tag)
        elif tag == "use":
            self._use(visit)
        else:
            if node.attributes.get(f"{INKSCAPE}groupmode") == "layer":
                visit = visit._replace(layer=node.attributes.get(f"{INKSCAPE}label", node.attributes.get("id", "")))
            self._push_children(visit)

    def _draw(self, visit: _SvgVisit, tag: str) -> None:
        """Draw a shape; one that nobody sees, or that a transform flattens to nothing, is left out."""
        if not visit.chosen or not visit.style.visible or (visit.style.stroke is None and visit.style.fill is None):
            return
        if visit.to_page.scale == 0.0:
            return
        self._pen.begin(visit.to_page)
        draw_shape(self._pen, tag, visit.node.attributes, self._page.view)
        self._drawn.append(visit)

    def _use(self, visit: _SvgVisit) -> None:
        """Have the target of a clone drawn."""
        attributes = visit.node.attributes
        target = attributes.get("href", attributes.get(f"{XLINK}href", "")).strip()
        if not target.startswith("#"):
            self._leave_out(visit, "use of another file" if target else "use of nothing")
            return
        node = self._targets.get(target[1:])
        if node is None:
            self._leave_out(visit, "use of nothing")
            return
        if id(node) in visit.users:
            raise DrawingError(f"the clone {target[:60]!r} contains itself", remedy="Remove it.")
        across, down = self._page.view
        shift = complex(length(attributes.get("x", "0"), across), length(attributes.get("y", "0"), down))
        self._clones += visit.chosen
        self._stack.append(
            visit._replace(
                node=node,
                to_page=visit.to_page @ Affine(1 + 0j, 0j, shift),
                depth=visit.depth + 1,
                users=visit.users | {id(node)},
                symbol_size=(attributes.get("width"), attributes.get("height")),
            )
        )

    def _symbol(self, visit: _SvgVisit) -> None:
        """Have the content of a symbol drawn, in its own viewport where it has one."""
        node = visit.node
        said = properties(node, "symbol", self._sheet)
        if said.get("display") == "none":
            return
        to_page = _transformed(visit)
        box = view_box(node.attributes)
        if box is not None and visit.symbol_size is not None:
            size = [
                length(said_size or node.attributes.get(name) or "100%", whole)
                for said_size, name, whole in zip(visit.symbol_size, ("width", "height"), self._page.view, strict=True)
            ]
            if min(size) <= 0.0:
                return
            to_page = to_page @ viewport(box, (size[0], size[1]), node.attributes.get("preserveAspectRatio", ""))
        self._push_children(visit._replace(to_page=to_page, style=inherited(visit.style, said)))
