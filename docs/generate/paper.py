"""Make docs/paper.md: the paper's figures with our own sites, and its sentences about the groups, measured."""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from string import Template

import figures
from census import EVEN, POINTS, Census, census, censuses
from claims import CLAIMS, WRONG, Claim, groups_of, outcome, table
from curves_in_steps import KERF
from in_blocks import add_options, in_blocks
from random_sites import TOLERANCE
from running import ROOT, Command, command_block, image_table, run_all
from sentences import DRAWS, NOTICEABLE, TILES, Sentences

from voronoi_tiles import Design
from voronoi_tiles.groups.wallpaper import GROUPS

SITES = 1000
"""Random sites per group; a count."""

EVEN_GROUP = "cmm"
"""The group that is measured in cells with a = b as well, a tenth as often: there its rectangles are squares."""

PAGE = ROOT / "docs" / "paper.md"

PICTURES = "docs/paper"
"""Where the pictures are, from the repository's root."""

PGG = {
    "pgg-grid": "A point in pgg that is chosen so that the edges are straight lines. Glide lines are dashed; there"
    " are no mirrors.",
    "fig05-pgg": "A line in pgg as it falls: no straight line remains.",
}
"""Pictures about pgg: their designs and captions."""

ALWAYS = {
    "pm-on-mirrors": "pm without a straight line: every mirror (red) carries a site that is its own image.",
    "p4m-scattered": "p4m with curves: the two strokes of one site lie in different chambers.",
    "p4m-two-sites": "p4m with curves: two sites share every chamber.",
}
"""Pictures of what *always* leaves out: their designs and captions."""

STROKES = {
    "any-strokes": "A closed stroke with branches, and two that cross, whose tile lies within that of the other site.",
}
"""The picture of strokes that are no simple curves: its design and caption."""


def picture(name: str) -> Command:
    """The command for the picture of a design that a sentence is tried at."""
    design = name if name.startswith("fig") else f"claim-{name}"
    options = ("--size", "440", "--overlay", "outline", "--overlay", "symmetry", "--renderer", "cpu")
    return Command(
        ("voronoi-tiles", "render"),
        f"examples/paper/{design}.toml",
        f"{PICTURES}/claim-{name}.png",
        options,
    )


def commands() -> list[Command]:
    """The commands of all pictures."""
    return [*figures.commands(), *(picture(name) for name in PGG | ALWAYS | STROKES)]


def pictures(captions: dict[str, str]) -> str:
    """Pictures beside each other, with the commands that made them."""
    rows = [(name, f"paper/claim-{name}.png", caption) for name, caption in captions.items()]
    return image_table(rows, len(rows)) + "\n" + command_block(picture(name) for name in captions)


def agrees(design: Path) -> bool:
    """Whether the image and the exact outlines of a design agree, by the cross-check."""
    return Design.load(design).tessellate().check(renderer="cpu").passed


def sentences(found: dict[str, Census], even: dict[str, Census]) -> str:
    """The paper's sentences with their verdicts, as a Markdown table; `even` are censuses with a = b."""
    lines = ["| | the sentence, in substance | verdict | measured |", "|---|---|---|---|"]
    for claim in CLAIMS:
        outcomes = {group: outcome(claim, found[group], even.get(group)) for group in claim.groups}
        measured = _measured(claim, found, even, outcomes)
        lines.append(f"| {claim.key} | {claim.sentence} | {_verdict(claim, outcomes)} | {measured} |")
    return "\n".join(lines)


def _verdict(claim: Claim, outcomes: dict[str, str]) -> str:
    """Put what is found of a sentence in its groups into one phrase."""
    wrong = [group for group, found in outcomes.items() if found == WRONG]
    parts = [f"**wrong for {', '.join(wrong)}**"] if wrong else []
    if len(wrong) < len(outcomes):
        parts.append(f"{'else ' if wrong else ''}holds" + (f" if {claim.condition}" if claim.condition else ""))
    parts += [f"for {group} it {found}" for group, found in outcomes.items() if found not in (WRONG, "holds")]
    return "; ".join(parts)


def _measured(claim: Claim, found: dict[str, Census], even: dict[str, Census], outcomes: dict[str, str]) -> str:
    """Say what a sentence is judged by: groups of which the same can be said together."""
    groups: dict[str, list[str]] = {}
    for group, how in outcomes.items():
        groups.setdefault(claim.judge(found[group]).because, []).append(group)
        if group in even and how != "holds":
            groups.setdefault(claim.judge(even[group]).because, []).append(f"{group} with a = b")
    return "<br>".join(f"{', '.join(names)}: {because}" for because, names in groups.items())


def page(rows: Sequence[Census], even: Census, agreed: Sequence[bool], others: Sentences) -> str:
    """Write the page from the measurements of the groups and the cross-checks of the designs.

    `even` is the census of EVEN_GROUP in cells with a = b, `others` are the sentences about no group.
    """
    found = groups_of(rows)
    evenly = {even.group: even}
    lines = next(claim for claim in CLAIMS if claim.key == "curved").groups
    lined = [tile for group in lines for tile in found[group].tiles]
    sites = len(rows[0].tiles)
    tiles = [tile for row in rows for tile in row.tiles]
    scattered = [tile for row in rows for tile in row.scattered]
    having = sum(tile.endless > 0 for tile in found["pgg"].tiles)
    template = (Path(__file__).parent / "paper-template.md").read_text(encoding="utf-8")
    text = Template(template).substitute(
        designs=len(agreed),
        agreed="all" if all(agreed) else f"only {sum(agreed)}",
        sites=f"{sites:,}",
        total=f"{len(tiles):,}",
        points=POINTS,
        tolerance=TOLERANCE,
        pgg_endless=f"{having:,}" if having else "none",
        pgg_without=f"{sites - having:,}",
        endless_off_mirrors=f"{sum(tile.endless_off_mirrors > 0 for tile in tiles):,}",
        strangers=sum(row.strangers for row in rows),
        refused=f"{sum(row.refused for row in rows):,}",
        unproved=sum(row.unproved for row in rows) or "none",
        beyond=f"{max(tile.beyond for tile in tiles):.1e}",
        area_error=f"{max(tile.area_error for tile in tiles):.1e}",
        scattered=f"{len(scattered):,}",
        scattered_curved=f"{sum(tile.curves > 0 for tile in scattered):,}",
        census_command=f"python docs/generate/census.py pgg --sites {sites}",
        figures="\n".join(map(figures.markdown, figures.FAMILIES)).strip(),
        claims=sentences(found, evenly),
        table=table(rows, evenly),
        even=f"{len(even.tiles):,}",
        even_command=f"python docs/generate/census.py {even.group} --even --sites {len(even.tiles)}",
        lined=f"{len(lined):,}",
        uncurved=f"{sum(tile.curves == 0 for tile in lined):,}",
        pgg_pictures=pictures(PGG).strip(),
        always_pictures=pictures(ALWAYS).strip(),
        other=others.table(),
        points_table=others.points_table(),
        cmm_shapes=f"{found['cmm'].shapes:,}",
        pmm_shapes=f"{found['pmm'].shapes:,}",
        steps_table=others.steps_table(),
        curves=f"{len(others.steps):,}",
        kerf=KERF,
        tiles=TILES,
        colours_table=others.colours_table(),
        noticeable=NOTICEABLE,
        draws=f"{DRAWS:,}",
        pairs_a_tile=f"{others.colours.pairs:.1f}",
        least=f"{others.colours.least:.0f}",
        strokes_table=others.strokes_table(),
        worst=f"{max(row.worst for row in others.strokes):.0e}",
        strokes_pictures=pictures(STROKES).strip(),
    )
    return "<!-- Written by docs/generate/paper.py (make paper). -->\n\n" + text


def main() -> None:
    """Make the pictures, measure, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sites", type=int, default=SITES, help=f"random sites per group (default: {SITES})")
    add_options(parser)
    options = parser.parse_args()
    where = {"workers": options.workers, "scheduler": options.scheduler}
    began = time.monotonic()
    run_all(commands())
    print(f"pictures: {time.monotonic() - began:.0f} s", flush=True)
    agreed = in_blocks(agrees, sorted((ROOT / "examples" / "paper").glob("*.toml")), **where)
    rows = censuses(GROUPS, options.sites, **where)
    even = census(EVEN_GROUP, options.sites // 10, EVEN)
    PAGE.write_text(page(rows, even, agreed, Sentences.measured()), encoding="utf-8")
    print(f"{PAGE.relative_to(ROOT)}: {time.monotonic() - began:.0f} s in all")


if __name__ == "__main__":
    main()
