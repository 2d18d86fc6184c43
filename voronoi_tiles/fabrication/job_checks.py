"""What in a job cannot be, or contradicts itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voronoi_tiles.fabrication.job_options import JobError

if TYPE_CHECKING:
    from voronoi_tiles.fabrication.job import Job


def refuse_contradictions(job: Job) -> None:
    """Refuse a job whose options cannot be together. Raises JobError."""
    for check in (_check_sheet, _check_edges, _check_colours, _check_packing, _check_count):
        check(job)
    if (job.nests or job.count is not None) and job.not_nestable is not None:
        message, remedy = job.not_nestable
        raise JobError(f"`layout='{job.layout}'` {message}", remedy=remedy)


def _check_sheet(job: Job) -> None:
    """Refuse what a sheet, or none, leaves no sense."""
    if job.frame is not None and job.fit == "clip":
        raise JobError("`fit='clip'` leaves no `frame`", remedy="Use one of the two.")
    if job.pieces is not None and job.fit == "clip":
        raise JobError("`pieces` counts whole tiles, and `fit='clip'` cuts them", remedy="Use `fit='whole'`.")
    if job.sheet is None:
        for name in () if job.pieces is not None else ("frame", "fit", "offset", "marks"):
            if getattr(job, name) != job.options()[name].default:
                raise JobError(f"`{name}` is about a sheet, and there is none", remedy="Add `sheet='600x300mm'`.")
    elif not isinstance(job.sheet, str) and 2.0 * job.margin >= min(job.sheet):
        width, height = job.sheet
        raise JobError(
            f"a `margin` of {job.margin:g} mm leaves nothing of a sheet of {width:g} x {height:g} mm",
            remedy="Make the margin smaller, or the sheet larger.",
        )


def _check_edges(job: Job) -> None:
    """Refuse what edges that are cut once, or touch, do not allow."""
    name = job.needs_pieces()
    if job.edges == "once" and name is not None:
        raise JobError(
            f"`{name}` needs `edges='pieces'`: an edge that is cut once belongs to two of them",
            remedy=f"Use that, or leave `{name}` out.",
        )
    touching = job.apart is None and not job.pack and not job.nests
    if job.tabs > 0.0 and job.sheet is not None and job.cuts_pieces and touching:
        raise JobError(
            "`tabs` hold nothing where the contours of two pieces lie on each other",
            remedy="Pull the pieces apart, `gap='1mm'`, or use `edges='once'`.",
        )
    if job.fit == "frame" and job.apart is not None:
        raise JobError(
            f"`{'gap' if job.gap else 'kerf'}` pulls the tiles apart, and `fit='frame'` leaves them no room",
            remedy="Cut the frame without it, use `fit='whole'`, or `pack=True`: pieces beside the frame, a file each.",
        )


def _check_colours(job: Job) -> None:
    """Refuse what colours, or none, contradict."""
    if job.into is not None and job.split != job.into:
        if job.colours == "none":
            raise JobError("`into` is about colours, and there are none", remedy="Add `colours='fewest'`.")
        raise JobError(
            f"`colours='{job.colours}'` and `into='{job.into}'` contradict each other",
            remedy="Use `colours='fewest'`.",
        )


def _check_packing(job: Job) -> None:
    """Refuse what cannot be packed, or be packed with."""
    if not job.pack:
        if job.stock is not None:
            raise JobError("`stock` is what pieces are packed on, and none are", remedy="Add `pack=True`.")
        return
    for wrong, message, remedy in (
        (
            job.sheet is None and job.pieces is None,
            "`pack` packs the tiles of a sheet, and there is none",
            "Add `sheet='600x300mm'`.",
        ),
        (job.split == "layers", "`pack` makes files of colours, and no layers", "Use `into='files'`."),
        (job.fit == "clip", "`pack` packs whole tiles, and `fit='clip'` cuts them", "Use `fit='whole'`."),
        (job.gap == 0.0, "`pack` with a `gap` of 0 would cut where pieces touch twice", "Use `gap='1mm'`."),
        (
            not isinstance(job.sheet, tuple) and job.stock is None,
            "`pack` needs sheets to pack on, and this one is a drawing, or not known",
            "Add their size, `stock='600x300mm'`.",
        ),
    ):
        if wrong:
            raise JobError(message, remedy=remedy)


def _check_count(job: Job) -> None:
    """Refuse a count of what is not nested."""
    for wrong, message, remedy in (
        (
            job.count is None and job.sheets is not None and not (job.pack and job.layout == "nested"),
            "`sheets` are for a `count` of pieces, or for those of colours that are packed and nested",
            "Add `count=40`, or `pack=True` and `layout='nested'`.",
        ),
        (
            job.count is not None and job.pack,
            "`count` is of pieces wherever they belong, and `pack` packs those of a picture",
            "Use one of the two.",
        ),
        (
            job.count is not None and job.layout not in ("nested", "auto"),
            f"`count` is of pieces that are nested, and `layout='{job.layout}'` lays others",
            "Use `layout='nested'`.",
        ),
    ):
        if wrong:
            raise JobError(message, remedy=remedy)
