"""Layers in the bytes of a drawing: whatever XML that is, they come and go, and all else stays."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from hypothesis import given, settings
from hypothesis import strategies as st

from voronoi_tiles.inkscape.own_layers import OwnGroup, layer_text, with_layers

ROLE = "{urn:voronoi-tiles:recipe}role"

LAYER = layer_text("tiles", "tiles", "n", [OwnGroup("a<b", 'font:"x"', [(b"M 0 0 L 1 1", "Küche & 'Bad'")])])

OWN = 'vt:role="tiles"'

texts = st.sampled_from(
    ["", " ", "\n", "a/>", "]]&gt;&amp;", "é", "<!-- <g/> -->", "<![CDATA[</g><a/>]]>", "<?p </g>?>"]
)
attributes = st.sampled_from(["", ' a="/>"', " b='>'", ' c="&lt;/svg>"', ' vt:role="sheet"'])


def element(name: str, said: str, content: str, loose: str) -> str:
    """An element, without an end tag where it has no content and is to be short."""
    return f"<{name}{said}{loose}/>" if not content else f"<{name}{said}{loose}>{content}</{name}{loose}>"


trees = st.recursive(
    texts,
    lambda inner: st.tuples(
        texts,
        st.builds(
            element,
            st.sampled_from(["g", "path", "a"]),
            attributes,
            st.lists(inner, max_size=3).map("".join),
            st.sampled_from(["", " "]),
        ),
        texts,
    ).map("".join),
    max_leaves=8,
)

own_layers = st.lists(st.tuples(trees, st.sampled_from(["", "g"])), max_size=3)


@settings(max_examples=300, deadline=None)
@given(st.lists(trees, min_size=1, max_size=4), own_layers, trees)
def test_a_layer_takes_the_place_of_those_of_its_role(parts: list[str], own: list[tuple[str, str]], last: str) -> None:
    """Of all there are one is left, as it was written; without it the bytes are those of the drawing without any."""
    head, tail = (
        '<?xml version="1.0"?>\n<!-- <svg/> -->\n<svg xmlns:vt="urn:voronoi-tiles:recipe">',
        "</svg>\n<!-- e -->\n",
    )
    without, having = [head], [head]
    for k, part in enumerate(parts):
        without.append(part)
        having.append(part)
        if k < len(own):
            content, home = own[k]
            layer = f"<g {OWN}>{content}</g>" if content else f"<g {OWN}/>"
            without.append(f"<{home}></{home}>" if home else "")
            having.append(f"<{home}>{layer}</{home}>" if home else layer)
    bare, full = ("".join((*words, last, tail)).encode() for words in (without, having))
    made = with_layers(full, "tiles", LAYER)
    assert made.count(LAYER) == 1
    assert made.replace(LAYER, b"") == bare
    assert with_layers(made, "tiles", LAYER) == made
    assert [one.get(ROLE) for one in ET.fromstring(made)].count("tiles") == 1
