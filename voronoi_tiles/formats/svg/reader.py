"""Reading SVG as browsers draw it: what is drawn, in millimetres on the page, y up.

Drawn are path, rect, circle, ellipse, line, polyline and polygon, in groups and nested drawings, under transforms, and
through `use`, as attributes and styles say. Text, images, what lies outside the file and what is not understood are
counted; nothing outside the file is opened.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping
from functools import partial
from typing import Final, NamedTuple

from voronoi_tiles.base.maps import IDENTITY_MAP, Affine
from voronoi_tiles.formats.pen import Pen
from voronoi_tiles.formats.shapes import DEPTH_MAX, VISITS_MAX, Dots, DrawingError, ReadDrawing, Shape
from voronoi_tiles.formats.svg.basic_shapes import DRAWN, diagonal, draw_shape
from voronoi_tiles.formats.svg.cascade import Cascade, Declarations
from voronoi_tiles.formats.svg.conditions import applies, first_that_applies
from voronoi_tiles.formats.svg.element_transform import placed
from voronoi_tiles.formats.svg.elements import (
    ANIMATIONS,
    GROUPS,
    INKSCAPE,
    MARKED,
    SERVERS,
    SILENT,
    SIZED,
    SVG,
    XLINK,
    source_of,
    tag_of,
)
from voronoi_tiles.formats.svg.lengths import Units, length
from voronoi_tiles.formats.svg.properties import EFFECTS, MARKERS, opacity
from voronoi_tiles.formats.svg.style import Style, Styles
from voronoi_tiles.formats.svg.viewport import Clip, Page, read_page, view_box, viewport
from voronoi_tiles.formats.svg.xml_tree import Node, parse_tree

_WITHOUT: Final = frozenset({"none", "normal", "auto", "1", "100%"})
"""The values of effects that mean none."""

_FLAT: Final = 1e-7
"""An object is nothing but a line where a transform makes it so much flatter: what rounding leaves of a scale of 0."""


def svg_drawing(data: bytes, file: str, element: str | None = None) -> ReadDrawing:
    """Read the content of an SVG file, plain or compressed; `file` is its name for messages.

    With `element` only what has that id, or stands in a group that has it, is drawn and counted.
    Curves keep their kind; arcs of ellipses, and of circles under a transform that makes ellipses of them, become
    cubics within CURVE_ACCURACY. Raises DrawingError for what is broken, hostile or beyond the limits.
    """
    root, sheets = svg_tree(data, file)
    return drawing_of_tree(root, file, None if element is None else {element}, sheets=sheets, cloned=True).read


class SvgDrawing(NamedTuple):
    """What was read, and the map from user units of the outermost element, y down, to its millimetres."""

    read: ReadDrawing
    to_page: Affine


def svg_tree(data: bytes, file: str) -> tuple[Node, int]:
    """The elements of an SVG file, and how many style sheets of other files it asks for. Raises DrawingError."""
    root, sheets = parse_tree(data, file, frozenset({f"{SVG}style", "style"}))
    if tag_of(root) != "svg":
        raise DrawingError(f"no SVG drawing: its root is <{root.tag.rpartition(' ')[2][:40]}>", file=file)
    return root, sheets


def drawing_of_tree(
    root: Node, file: str, elements: Collection[str] | None, *, sheets: int = 0, cloned: bool = False
) -> SvgDrawing:
    """What a tree draws, as `svg_drawing`; of some elements alone, by their ids, where these are given.

    `sheets` counts style sheets that are not there. With `cloned` clones of these elements are drawn as well.
    """
    return _SvgWalk(root, file, elements, cloned, Counter({"style sheet of another file": sheets})).drawing()


def _at(error: DrawingError, node: Node, file: str) -> DrawingError:
    """The same error with its file and line."""
    return DrawingError(error.message, file=file, key=error.key, line=node.line, remedy=error.remedy)


class _SvgVisit(NamedTuple):
    """An element that is to be drawn, with what it takes from those around it."""

    node: Node
    to_page: Affine
    style: Style
    layer: str
    depth: int
    users: frozenset[int]  # the clones around it, by their targets: a clone of one of them is a circle
    chosen: bool  # whether it is an element that is asked for, or stands in one
    view: tuple[float, float]  # what percentages refer to
    clips: tuple[Clip, ...] = ()
    faded: bool = False  # whether an opacity of 0 hides it
    size: tuple[str | None, str | None] | None = None  # width and height of the clone that draws it
    within: str = ""  # the id of that element


class _SvgWalk:
    """Draws a tree, with its own stack: the depth of a file is no depth of calls."""

    def __init__(
        self, root: Node, file: str, elements: Collection[str] | None, cloned: bool, ignored: Counter[str]
    ) -> None:
        self._root = root
        self._elements = elements
        self._cloned = cloned
        self._file = file
        self._pen = Pen()
        self._cascade = Cascade(root)
        self._styles = Styles(self._is_server)
        self._targets: dict[str, Node] = {}
        self._ignored = ignored
        self._drawn: list[_SvgVisit] = []
        self._clones = 0
        self._stack: list[_SvgVisit] = []

    def drawing(self) -> SvgDrawing:
        """All that is drawn."""
        self._index()
        for element in self._elements or ():
            if element not in self._targets:
                raise self._no_element(element)
        try:
            page = self._begin()
        except DrawingError as error:
            raise _at(error, self._root, self._file) from None
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
        shapes, dots = self._shapes()
        self._ignored["style rule"] += self._cascade.unread
        read = ReadDrawing(
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
        return SvgDrawing(read, page.upwards)

    def _begin(self) -> Page:
        """Read the page, and have what it holds drawn."""
        root = self._root
        said = self._cascade.declared(root)
        said.note = partial(self._leave_out, True)
        style = self._styles.inherited(Style(), said)
        page = read_page(said.geometry(), style.units, said.note)
        em = style.units.em
        style = style._replace(units=Units(em, em, page.window))
        to_page = page.upwards
        name = root.attributes.get("id", "")
        chosen = self._elements is None or name in self._elements
        visit = _SvgVisit(root, to_page, style, "", 0, frozenset(), chosen, page.view)
        visit = visit._replace(within=name if chosen and self._elements is not None else "")
        said.note = partial(self._leave_out, chosen)
        self._note_effects(visit, said)
        if placed(said, page.view, style.units, None) != IDENTITY_MAP:
            said.note("transform of the page")
        if not _is("none", said, "display"):
            self._push(visit._replace(faded=_is_faded(said)), root.children)
        return page

    def _shapes(self) -> tuple[tuple[Shape, ...], tuple[Dots, ...]]:
        """The shapes that were drawn, and what has no size."""
        try:
            drawn = self._pen.shapes()
        except DrawingError as error:
            raise error.with_file(self._file) from None
        shapes, dots = [], []
        for visit, (paths, places) in zip(self._drawn, drawn, strict=True):
            node, style = visit.node, visit.style
            source = source_of(node, tag_of(node))
            shown = (style.stroke_shown, style.fill_shown)
            stroke, fill = (None if paint is None else paint.rgb for paint in shown)
            if len(places):
                dots.append(Dots(places, visit.layer, stroke, source, visit.within))
            if not len(paths):
                continue
            held = [clip.holds(paths) for clip in visit.clips]
            if not all(held):
                self._ignored["clip of a nested svg"] += 1
            if False in held:
                continue
            width = style.width.of(diagonal(visit.view)) * visit.to_page.scale
            shapes.append(Shape(paths, visit.layer, stroke, fill, width, source, visit.within))
        return tuple(shapes), tuple(dots)

    def _leave_out(self, chosen: bool, what: str) -> None:
        """Count what is not read."""
        self._ignored[what] += chosen

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
            if tag_of(node) == "style" and node.attributes.get("type", "text/css").strip().lower() in {"", "text/css"}:
                try:
                    self._cascade.add_sheet(node)
                except DrawingError as error:
                    raise _at(error, node, self._file) from None
            todo.extend(reversed(node.children))

    def _is_server(self, name: str) -> bool:
        """Whether the file has a gradient or a pattern of this name."""
        return name in self._targets and tag_of(self._targets[name]) in SERVERS

    def _push(self, visit: _SvgVisit, nodes: list[Node]) -> None:
        """Have elements drawn next, in their order, as children of one."""
        self._stack.extend(visit._replace(node=node, depth=visit.depth + 1, size=None) for node in reversed(nodes))

    def _visit(self, visit: _SvgVisit) -> None:
        """Draw one element, or have its content drawn."""
        if visit.depth > DEPTH_MAX:
            raise DrawingError(f"clones and groups nested more than {DEPTH_MAX:,} deep", remedy="Ungroup the drawing.")
        node = visit.node
        tag = tag_of(node)
        visit = self._asked(visit)
        is_viewport = tag == "svg" or (tag == "symbol" and visit.size is not None)
        if not tag or (tag in SILENT and not is_viewport) or not applies(node):
            return
        said = self._cascade.declared(node)
        note = partial(self._leave_out, visit.chosen)
        is_read = tag in DRAWN or tag in GROUPS or tag == "use" or is_viewport
        if is_read:
            said.note = note
        style = self._styles.inherited(visit.style, said)  # with the variables that `display` may need
        unboxed = _is("contents", said, "display")  # as if its children stood in its place
        if _is("none", said, "display") or (unboxed and tag in DRAWN):
            return
        if not is_read:
            note(tag[:40])
            return
        visit = visit._replace(style=style, faded=visit.faded or _is_faded(said))
        self._note_effects(visit, said)
        if tag in DRAWN:
            self._draw(visit, said, tag)
            return
        if not unboxed:
            visit = visit._replace(to_page=visit.to_page @ placed(said, visit.view, style.units, None))
        if tag == "use":
            self._use(visit, said)
        elif is_viewport:
            self._viewport(visit, said)
        else:
            if node.attributes.get(f"{INKSCAPE}groupmode") == "layer":
                visit = visit._replace(layer=node.attributes.get(f"{INKSCAPE}label", node.attributes.get("id", "")))
            self._push(visit, first_that_applies(node) if tag == "switch" else node.children)

    def _asked(self, visit: _SvgVisit) -> _SvgVisit:
        """An element, chosen where it is asked for."""
        name = visit.node.attributes.get("id", "")
        if name not in (self._elements or ()) or (visit.users and not self._cloned):
            return visit
        return visit._replace(chosen=True, within=name)

    def _note_effects(self, visit: _SvgVisit, said: Declarations) -> None:
        """Count the effects of an element, which are not followed."""
        for effect in EFFECTS:
            if effect in said.names and (said.own(effect) or "none").lower().split()[0] not in _WITHOUT:
                said.note(effect)
        tag = tag_of(visit.node)
        if tag in DRAWN or tag == "use":
            for child in visit.node.children:
                if tag_of(child) in ANIMATIONS:
                    said.note(tag_of(child))

    def _draw(self, visit: _SvgVisit, said: Declarations, tag: str) -> None:
        """Draw a shape; one that nobody sees, or that a transform flattens to nothing, is left out."""
        style = visit.style
        if not visit.chosen or not style.visible or (style.stroke is None and style.fill is None):
            return
        stroke, fill = style.stroke_shown, style.fill_shown
        if visit.faded or (stroke is None and fill is None):
            if style.shown(style.stroke, 1.0) or style.shown(style.fill, 1.0):
                said.note("invisible object")
            return
        attributes = said.geometry()
        if 0.0 in visit.view and any("%" in value for name, value in attributes.items() if name in SIZED):
            said.note("percentage of a page without a size")

        def bounds() -> tuple[float, float, float, float] | None:
            pen = Pen()
            pen.begin(IDENTITY_MAP)
            draw_shape(pen, tag, attributes, visit.view, style.units)
            ((paths, _),) = pen.shapes()
            return paths.bounds if len(paths) else None

        to_page = visit.to_page @ placed(said, visit.view, style.units, bounds)
        if to_page.scale <= _FLAT * to_page.largest:
            return
        if stroke is not None and style.dashed:
            said.note("stroke-dasharray")
        for name, marked in zip(MARKERS, style.markers, strict=True):
            if marked and tag in MARKED:
                said.note(name)
        self._pen.begin(to_page)
        draw_shape(self._pen, tag, attributes, visit.view, style.units)
        self._drawn.append(visit._replace(to_page=to_page))

    def _use(self, visit: _SvgVisit, said: Declarations) -> None:
        """Have the target of a clone drawn."""
        attributes = said.geometry()
        target = attributes.get("href", attributes.get(f"{XLINK}href", "")).strip()
        if not target.startswith("#"):
            said.note("use of another file" if target else "use of nothing")
            return
        node = self._targets.get(target[1:])
        if node is None:
            said.note("use of nothing")
            return
        if id(node) in visit.users:
            raise DrawingError(f"the clone {target[:60]!r} contains itself", remedy="Remove it.")
        style = visit.style
        self._clones += visit.chosen
        self._stack.append(
            visit._replace(
                node=node,
                to_page=visit.to_page @ _shift(attributes, visit),
                style=style._replace(used=(style.shown(style.fill, 1.0), style.shown(style.stroke, 1.0))),
                depth=visit.depth + 1,
                users=visit.users | {id(node)},
                size=(attributes.get("width"), attributes.get("height")),
            )
        )

    def _viewport(self, visit: _SvgVisit, said: Declarations) -> None:
        """Have the content of a nested drawing or a symbol drawn, in its own viewport."""
        node, attributes = visit.node, said.geometry()
        sides = []
        for name, whole, size in zip(("width", "height"), visit.view, visit.size or (None, None), strict=True):
            if attributes.get(name) != node.attributes.get(name):
                said.note(f"{name} of a nested svg in a style")  # Chromium and Firefox do not agree on it
            text = size or node.attributes.get(name) or "100%"
            sides.append(length("100%" if text.strip() == "auto" else text, whole, visit.style.units))
        across, down = sides
        box = view_box(node.attributes, nested=True)
        if min(sides) <= 0.0 or (box is not None and min(box[2:]) <= 0.0):
            return
        to_page = visit.to_page @ _shift(attributes, visit)
        clips, view = visit.clips, (across, down)
        if (said.own("overflow") or "hidden").lower().split()[0] not in {"visible", "auto"}:
            clips = (*clips, Clip(to_page, view))
        if box is not None:
            to_page = to_page @ viewport(box, view, node.attributes.get("preserveAspectRatio", ""))
            view = box[2:]
        self._push(visit._replace(to_page=to_page, clips=clips, view=view), node.children)


def _is(word: str, said: Declarations, name: str) -> bool:
    """Whether a property that is not inherited has this value."""
    return name in said.names and (said.own(name) or "").lower() == word


def _is_faded(said: Declarations) -> bool:
    """Whether an opacity of 0 hides an element."""
    value = said.own("opacity") if "opacity" in said.names else None
    return value is not None and opacity(value) == 0.0


def _shift(attributes: Mapping[str, str], visit: _SvgVisit) -> Affine:
    """The translation by x and y."""
    x, y = (
        length(attributes.get(name, "0"), whole, visit.style.units)
        for name, whole in zip(("x", "y"), visit.view, strict=True)
    )
    return Affine(1 + 0j, 0j, complex(x, y))
