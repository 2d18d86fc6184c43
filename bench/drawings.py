"""Drawings and colours made at random, in the many ways that SVG and CSS have of saying the same things."""

from __future__ import annotations

from random import Random

SYSTEM = ("Canvas", "CanvasText", "LinkText", "GrayText", "buttonface", "MARK", "Field", "VisitedText", "WindowText")
NAMES = ("red", "RebeccaPurple", "seagreen", "BLACK", "lightgoldenrodyellow", "transparent")
BROKEN = ("nocolour", "#12", "rgb(1,2)", "hsl(1deg)", "rgb(1 2 3 4)", "12px", "red blue", "rgb(1%, 2, 3, 4, 5)", "#ggg")
SHAPES = ("rect", "circle", "ellipse", "line", "path", "polyline", "polygon")


def any_colour(generator: Random) -> str:  # noqa: PLR0911, PLR0912 - one for each notation
    """A colour in one of the notations of CSS Color 4 and 5, or now and then a text that is none."""
    pick, number = generator.choice, generator.uniform

    def share() -> str:
        return f"{number(0, 100):.4g}%"

    def hue() -> str:
        return (
            pick(["{:.4g}", "{:.4g}deg", "{:.4g}DEG"]).format(number(-400, 400))
            if number(0, 1) < 0.7
            else pick([f"{number(-1, 2):.3g}turn", f"{number(-7, 7):.4g}rad", f"{number(0, 500):.4g}grad"])
        )

    def alpha() -> str:
        return pick(["", "", " / 1", " / 100%"])

    def three(*parts: str) -> str:
        return " ".join("none" if number(0, 1) < 0.05 else part for part in parts)

    kind = pick(
        [
            "name",
            "system",
            "hex",
            "rgb",
            "rgb",
            "rgb old",
            "hsl",
            "hsl",
            "hsl old",
            "hwb",
            "lab",
            "lch",
            "oklab",
            "oklch",
            "color",
            "color",
            "mix",
            "scheme",
            "broken",
        ]
    )
    match kind:
        case "name":
            return pick(NAMES)
        case "system":
            return pick(SYSTEM)
        case "hex":
            digits = pick([3, 6])
            text = "".join(pick("0123456789abcdefABCDEF") for _ in range(digits))
            return f"#{text}{pick(['', 'f' if digits == 3 else 'ff'])}"
        case "rgb":
            channels = [pick([f"{number(-20, 300):.4g}", f"{number(0, 2.5):.3g}e2", f"{number(-10, 110):.4g}%"])] * 3
            return f"{pick(['rgb', 'RGBA'])}({three(*channels)}{alpha()})"
        case "rgb old":
            unit = pick(["", "%"])
            return f"rgb({','.join(f'{number(0, 255):.4g}{unit}' for _ in range(3))}{pick(['', ',1', ', 100%'])})"
        case "hsl":
            return f"hsl({three(hue(), share(), share())}{alpha()})"
        case "hsl old":
            return f"{pick(['hsl', 'hsla'])}({hue()}, {share()}, {share()}{pick(['', ', 1'])})"
        case "hwb":
            return f"hwb({three(hue(), share(), share())}{alpha()})"
        case "lab" | "oklab":
            size = 100 if kind == "lab" else 0.3
            axes = [f"{number(-size, size):.4g}" if number(0, 1) < 0.7 else f"{number(-90, 90):.4g}%" for _ in range(2)]
            return f"{kind}({three(share(), *axes)}{alpha()})"
        case "lch" | "oklch":
            chroma = number(0, 100 if kind == "lch" else 0.3)
            return f"{kind}({three(share(), f'{chroma:.4g}', hue())}{alpha()})"
        case "color":
            space = pick(["srgb", "srgb-linear", "display-p3", "a98-rgb", "prophoto-rgb", "xyz", "xyz-d50"])
            return f"color({space} {three(*(pick([f'{number(-0.1, 1.1):.4g}', share()]) for _ in range(3)))}{alpha()})"
        case "mix":
            space = pick(["srgb", "oklab", "lab", "srgb-linear", "xyz", "hsl", "oklch longer hue"])
            return f"color-mix(in {space}, {pick(NAMES[:5])} {share()}, {pick(NAMES[:5])})"
        case "scheme":
            return f"light-dark({pick(NAMES)}, {pick(NAMES)})"
        case _:
            return pick(BROKEN)


class _Maker:
    """Makes one drawing: its elements, and the rules of its style sheet."""

    def __init__(self, generator: Random) -> None:
        self.random = generator
        self.rules: list[str] = []
        self.count = 0

    def drawing(self) -> str:
        """The text of a whole file."""
        pick = self.random.choice
        box = pick(["0 0 400 300", "-20 10 200 150", "0 0 40 30"])
        body = "".join(self.element(0) for _ in range(self.random.randint(3, 7)))
        self.random.shuffle(self.rules)
        sheet = "\n".join(self.rules)
        sheet = pick([sheet, f"<![CDATA[{sheet}]]>", f"@media screen {{ {sheet} }}", f"/* a */ {sheet} /* b */"])
        extra = pick(["", "@media print { * { display: none } }", "rect:hover { fill: red }", "@layer base, top;"])
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="400" height="300" viewBox="{box}">'
            f"<style>{extra}{sheet}</style>{body}</svg>"
        )

    def element(self, depth: int) -> str:
        """A shape, a group, a nested drawing or a switch."""
        kind = self.random.random()
        if depth > 2 or kind < 0.55:
            return self.shape()
        inner = "".join(self.element(depth + 1) for _ in range(self.random.randint(1, 3)))
        pick = self.random.choice
        if kind < 0.75:
            return f"<g{self.said('g', {**self.paint(), **self.transform()})}>{inner}</g>"
        if kind < 0.85:
            ratio = pick(["", ' preserveAspectRatio="none"', ' preserveAspectRatio="xMinYMax slice"'])
            size = f'x="{self.number(0, 20)}" y="{self.number(0, 9)}" width="{self.number(10, 80)}" height="50%"'
            return f'<svg {size} viewBox="0 0 {self.number(5, 90)} 50" overflow="visible"{ratio}>{inner}</svg>'
        if kind < 0.93:
            refused = pick(['systemLanguage="de"', 'requiredExtensions="http://x.org"', 'systemLanguage=""'])
            return (
                f"<switch><g {refused}>{self.shape()}</g><g systemLanguage='fr, en'>{inner}</g>{self.shape()}</switch>"
            )
        return f'<svg style="font-size: {self.number(5, 20)}px" overflow="visible">{inner}</svg>'

    def number(self, low: float, high: float) -> str:
        return f"{self.random.uniform(low, high):.3g}"

    def length(self, low: float, high: float) -> str:
        unit = self.random.choice(["", "", "px", "mm", "pt", "%", "em", "q", "PX"])
        scale = {"mm": 0.26, "pt": 0.75, "em": 0.06, "q": 1.05}.get(unit, 1.0)
        text = f"{self.random.uniform(low, high) * scale:.3g}{unit}"
        return f"calc({text} + {self.number(0, 3)}px)" if self.random.random() < 0.1 and unit else text

    def paint(self) -> dict[str, str]:
        """Paint that a browser and a reader can agree on."""
        found = {}
        for name in ("stroke", "fill"):
            if self.random.random() < 0.6:
                colour = self.random.choice(["none", "currentColor", any_colour(self.random), any_colour(self.random)])
                found[name] = "#123456" if colour in BROKEN else colour
        if self.random.random() < 0.2:
            found["color"] = self.random.choice(NAMES[:5])
        if self.random.random() < 0.1:
            found["visibility"] = self.random.choice(["hidden", "visible", "VISIBLE", "collapse"])
        return found

    def transform(self) -> dict[str, str]:
        """A transform attribute, or CSS's properties."""
        pick, number = self.random.choice, self.number
        if self.random.random() < 0.4:
            return {}
        found = {}
        if self.random.random() < 0.5:
            parts = [
                f"translate({number(-9, 9)} {number(-9, 9)})",
                f"rotate({number(-99, 99)}, 3, 4)",
                "scale(-1 .7)",
                f"skewX({number(-40, 40)})",
                f"matrix(.9 .1 -.2 1.1 {number(-5, 5)} 2)",
                f"rotate({number(0, 90)})",
            ]
            found["@transform"] = " ".join(pick(parts) for _ in range(self.random.randint(1, 3)))
        if self.random.random() < 0.5:
            parts = [
                f"translate({number(-9, 9)}px, 10%)",
                f"rotate({number(-99, 99)}deg)",
                "scale(1.2, 70%)",
                f"skew({number(-40, 40)}deg, .1rad)",
                "translateX(2mm)",
                "rotate(.1turn)",
                "scaleY(-1)",
                "matrix(.9, .1, -.2, 1.1, 5, 2)",
                "translate3d(1px, 2px, 3px)",
                "rotateZ(20grad)",
                "SkewY(5DEG)",
            ]
            found["transform"] = pick(["none", " ".join(pick(parts) for _ in range(self.random.randint(1, 3)))])
        if self.random.random() < 0.2:
            found["translate"] = pick(["3px", "5px 10%", "none", "1mm 2px 3px"])
        if self.random.random() < 0.2:
            found["rotate"] = pick(["30deg", "none", "z 40deg", ".1turn"])
        if self.random.random() < 0.2:
            found["scale"] = pick(["1.1", ".9 120%", "none", "-1 1"])
        if self.random.random() < 0.3:
            found["transform-origin"] = pick(["center", "10px 20px", "left 5px", "bottom right", "50% 20%", "top"])
        return found

    def shape(self) -> str:
        """A shape with whatever may be said of it."""
        length = self.length
        tag = self.random.choice(SHAPES)
        match tag:
            case "rect":
                said = {"x": length(0, 40), "y": length(0, 40), "width": length(5, 30), "height": length(5, 30)}
                said |= {"rx": length(0, 6)} if self.random.random() < 0.3 else {}
            case "circle":
                said = {"cx": length(0, 40), "cy": length(0, 40), "r": length(3, 20)}
            case "ellipse":
                said = {"cx": length(0, 40), "cy": length(0, 40), "rx": length(3, 20)}
                said |= {"ry": length(3, 20)} if self.random.random() < 0.7 else {}
            case "line":
                said = {"@x1": length(0, 40), "@y1": length(0, 40), "@x2": length(0, 40), "@y2": length(0, 40)}
            case "path":
                said = {
                    "@d": f"M{self.number(0, 9)} 3L20 {self.number(0, 9)}q5 5 9-{self.number(1, 9)}"
                    f"a4 {self.number(2, 9)} "
                    f"{self.number(0, 90)} {self.random.randint(0, 1)}0 7 7c1 2 3 4 9 {self.number(0, 9)}z"
                }
            case _:
                said = {"@points": " ".join(self.number(0, 30) for _ in range(6))}
        said |= {"fill": "none", "stroke": "red", **self.paint(), **self.transform()}
        if tag != "path" and self.random.random() < 0.1:
            said["transform-box"] = self.random.choice(["fill-box", "view-box"])
        if self.random.random() < 0.05:
            said["display"] = self.random.choice(["none", "inline", "block", "NONE"])
        return f"<{tag}{self.said(tag, said)}/>"

    def said(self, tag: str, said: dict[str, str]) -> str:
        """The attributes of an element that say all this, some of it through rules; "@name" is an attribute only."""
        self.count += 1
        name, pick = f"e{self.count}", self.random.choice
        attributes, style = {"id": name, "class": f"k{self.count} all"}, []
        selectors = [
            f"#{name}",
            f".k{self.count}",
            f"{tag}#{name}",
            f"svg .k{self.count}.all",
            f"[id={name}]",
            f"*:not(g, a)#{name}" if tag != "g" else f"#{name}",
            f":is({tag}, a)#{name}",
            f"svg > #{name}, #{name}",
        ]
        for item, value in said.items():
            if item.startswith("@"):
                attributes[item[1:]] = value
                continue
            css = value if not value[-1].isdigit() or item in ("fill", "stroke", "color", "scale") else f"{value}px"
            mark = pick(["", "", "", " !important", " ! IMPORTANT"])
            shown = pick([item, item, item.upper()])
            sources = (
                ["style", "rule"]
                if item in ("translate", "rotate", "scale", "transform", "transform-box")
                else ["attribute", "attribute", "style", "rule"]
            )
            source = pick(sources)
            if source == "attribute":
                attributes[item] = value
            elif source == "style":
                style.append(f"{shown}: {css}{mark}")
            else:
                rule = f"{pick(selectors)} {{ {shown}: {css}{mark}; }}"
                self.rules.append(pick([rule, rule, f"@layer {pick(['base', 'top'])} {{ {rule} }}"]))
            if source != "attribute" and item in ("fill", "stroke") and pick([True, False]):
                attributes[item] = "#654321"
            if source != "attribute" and self.random.random() < 0.2:
                style.append(
                    pick(["/* ; */", "--a: {b:c}", f"{item} blue", "unknown: url(a;b)", f"{item}:", "fill: {a;b}"])
                )
        if style:
            attributes["style"] = "; ".join(style)
        return "".join(f' {key}="{value}"' for key, value in attributes.items())


def any_drawing(generator: Random) -> str:
    """The text of an SVG file, all of which a browser understands."""
    return _Maker(generator).drawing()
