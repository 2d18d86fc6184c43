"""What is to be made of a tiling: the sheet, how its edges are cut, what is engraved. All lengths are millimetres."""

from __future__ import annotations

from typing import cast, get_args

from voronoi_tiles.fabrication.job_fields import Into, JobFields
from voronoi_tiles.fabrication.job_limits import APART_MM, FRAME_MM
from voronoi_tiles.fabrication.job_options import SHEETS_MOST, JobError, explained

__all__ = ["Job", "JobError"]


class Job(JobFields):
    """What is to be made of a tiling; lengths are numbers of millimetres or texts with a unit, "0.15mm".

    Without a `sheet`, one of each tile is made, as a closed contour. The design's origin lies in the middle of the
    sheet, turned by `rotate` and moved by `offset`; whole tiles without an offset are moved to where most of them fit,
    in the middle of the sheet. A `frame` means `fit="frame"`. `edges` None is once for sheets, and pieces without, or
    where another option needs them. With a kerf, pieces are pulled 1 mm or twice the kerf apart, unless `gap` says how
    far, lest a cut hurts the next piece. Raises JobError for values that cannot be, and that contradict each other.

    >>> import voronoi_tiles as vt
    >>> vt.Job(sheet="30x20cm", kerf="0.15mm")
    Job(sheet=(300.0, 200.0), kerf=0.15)
    >>> vt.Job(kerf=0.15, edges="once")
    Traceback (most recent call last):
    voronoi_tiles.fabrication.job_options.JobError: `kerf` needs `edges='pieces'`: an edge that is cut once belongs to
    two of them. Use that, or leave `kerf` out.
    """

    def _refuse_contradictions(self) -> None:
        """Refuse options that cannot be together; a frame means that it is fitted. Raises JobError."""
        if self.frame is not None and self.fit == "whole":
            object.__setattr__(self, "fit", "frame")
        for check in (
            self._check_sheet,
            self._check_edges,
            self._check_colours,
            self._check_packing,
            self._check_count,
        ):
            check()
        if (self.nests or self.count is not None) and self.not_nestable is not None:
            message, remedy = self.not_nestable
            raise JobError(f"`layout='{self.layout}'` {message}", remedy=remedy)

    @property
    def moves_contours(self) -> bool:
        """Whether contours differ from the tiles' outlines: by half a kerf, or by round corners."""
        return self.kerf > 0.0 or self.fillet > 0.0

    @property
    def scheme(self) -> str | int:
        """What tiles have the same colour by: "fewest", "site", "handedness", "orientation", or a number of colours.

        "none" where all of one colour are packed.
        """
        if self.pack and self.colours == "none":
            return "none"
        return "fewest" if self.colours in {"none", *get_args(Into)} else self.colours

    @property
    def split(self) -> Into | None:
        """What there is one of for each colour: layers or files; None without colours, unless tiles are packed."""
        if self.colours == "none":
            return "files" if self.pack else None
        if self.colours in get_args(Into):
            return cast("Into", self.colours)
        return self.into or ("files" if self.pack else "layers")

    @property
    def several(self) -> bool:
        """Whether there is a file for each of several colours or sheets."""
        return self.split == "files" or self.sheets is not None

    @property
    def frame_width(self) -> float:
        """The least width of a frame around tiles; 0 where there is none."""
        return 0.0 if self.fit != "frame" else FRAME_MM if self.frame is None else self.frame

    @property
    def nests(self) -> bool:
        """Whether pieces lie elsewhere than the tessellation has them, on one sheet."""
        return self.layout not in ("tessellated", "auto")

    @property
    def apart(self) -> float | None:
        """How far contours are kept apart on the sheet; None where they may stay where they are."""
        if self.pack or self.nests:
            return None
        if self.gap is None:
            return self._enough if self.kerf > 0.0 else None
        return self.gap if self.gap > 0.0 or self.kerf > 0.0 else None

    @property
    def side_by_side(self) -> float:
        """How far contours that are packed, or nested, are kept apart; millimetres."""
        return self._enough if self.gap is None else self.gap

    @property
    def _enough(self) -> float:
        """How far contours are kept apart where no gap says; millimetres."""
        return max(APART_MM, 2 * self.kerf)

    @property
    def cuts_pieces(self) -> bool:
        """Whether every tile is a closed contour of its own."""
        if self.edges is not None:
            return self.edges == "pieces"
        return self.sheet is None or self.needs_pieces() is not None

    def needs_pieces(self) -> str | None:
        """The name of an option that needs closed pieces, None where none does."""
        for name in ("kerf", "gap", "fillet"):
            if (getattr(self, name) or 0.0) > 0.0:
                return name
        if self.colours != "none" or self.only_colour is not None:
            return "colours"
        if self.pack:
            return "pack"
        return "layout" if self.nests else None

    @property
    def not_nestable(self) -> tuple[str, str] | None:
        """Why pieces cannot be nested, and what to do; None where they can."""
        if self.pack and self.layout == "nested":  # on the stock, those of each colour
            return None if self.pieces is None else ("nests the pieces of a picture's size", "Leave `pieces` out.")
        for wrong, message, remedy in (
            (self.sheet is None, "needs a sheet", "Give its size, `sheet='600x300mm'`, or a drawing of it."),
            (self.fit != "whole", f"nests whole tiles, and `fit='{self.fit}'` is more", "Use `fit='whole'`."),
            (self.gap == 0.0, "with a `gap` of 0 would cut where pieces touch twice", "Use `gap='1mm'`."),
            (
                self.pieces is not None,
                "nests in full size, and `pieces` scales the tessellation until so many fit as it lies",
                f"Use `count={self.pieces}` instead.",
            ),
            (self.offset is not None, "moves every piece anew, and none by an `offset`", "Leave it out."),
            (
                self.pack and self.layout == "auto",
                "nests no woods, as `layout='nested'` does with `pack`",
                "Use that.",
            ),
            (
                self.pack,
                "lays the pieces of a file, and `pack` those of a picture",
                "Leave out `pack`, `colours` and `stock`, and give the size of the stock as `sheet`.",
            ),
            (self.split is not None, "parts neighbours, by which tiles get `colours`", "Leave these out."),
        ):
            if wrong:
                return message, remedy
        return None

    def _check_sheet(self) -> None:
        """Refuse what a sheet, or none, leaves no sense."""
        if self.frame is not None and self.fit == "clip":
            raise JobError("`fit='clip'` leaves no `frame`", remedy="Use one of the two.")
        if self.pieces is not None and self.fit == "clip":
            raise JobError("`pieces` counts whole tiles, and `fit='clip'` cuts them", remedy="Use `fit='whole'`.")
        if self.sheet is None:
            for name in () if self.pieces is not None else ("frame", "fit", "offset", "marks"):
                if getattr(self, name) != self.options()[name].default:
                    raise JobError(f"`{name}` is about a sheet, and there is none", remedy="Add `sheet='600x300mm'`.")
        elif not isinstance(self.sheet, str) and 2.0 * self.margin >= min(self.sheet):
            width, height = self.sheet
            raise JobError(
                f"a `margin` of {self.margin:g} mm leaves nothing of a sheet of {width:g} x {height:g} mm",
                remedy="Make the margin smaller, or the sheet larger.",
            )

    def _check_edges(self) -> None:
        """Refuse what edges that are cut once, or touch, do not allow."""
        name = self.needs_pieces()
        if self.edges == "once" and name is not None:
            raise JobError(
                f"`{name}` needs `edges='pieces'`: an edge that is cut once belongs to two of them",
                remedy=f"Use that, or leave `{name}` out.",
            )
        touching = self.apart is None and not self.pack and not self.nests
        if self.tabs > 0.0 and self.sheet is not None and self.cuts_pieces and touching:
            raise JobError(
                "`tabs` hold nothing where the contours of two pieces lie on each other",
                remedy="Pull the pieces apart, `gap='1mm'`, or use `edges='once'`.",
            )
        if self.fit == "frame" and self.apart is not None:
            raise JobError(
                f"`{'gap' if self.gap else 'kerf'}` pulls the tiles apart, and `fit='frame'` leaves them no room",
                remedy="Cut the frame without it, use `fit='whole'`, or `pack=True`: pieces beside the frame, a file "
                "each.",
            )

    def _check_colours(self) -> None:
        """Refuse what colours, or none, contradict."""
        if self.into is not None and self.split != self.into:
            if self.colours == "none":
                raise JobError("`into` is about colours, and there are none", remedy="Add `colours='fewest'`.")
            raise JobError(
                f"`colours='{self.colours}'` and `into='{self.into}'` contradict each other",
                remedy="Use `colours='fewest'`.",
            )

    def _check_packing(self) -> None:
        """Refuse what cannot be packed, or be packed with."""
        if not self.pack:
            if self.stock is not None:
                raise JobError("`stock` is what pieces are packed on, and none are", remedy="Add `pack=True`.")
            return
        for wrong, message, remedy in (
            (
                self.sheet is None and self.pieces is None,
                "`pack` packs the tiles of a sheet, and there is none",
                "Add `sheet='600x300mm'`.",
            ),
            (self.split == "layers", "`pack` makes files of colours, and no layers", "Use `into='files'`."),
            (self.fit == "clip", "`pack` packs whole tiles, and `fit='clip'` cuts them", "Use `fit='whole'`."),
            (self.gap == 0.0, "`pack` with a `gap` of 0 would cut where pieces touch twice", "Use `gap='1mm'`."),
            (
                not isinstance(self.sheet, tuple) and self.stock is None,
                "`pack` needs sheets to pack on, and this one is a drawing, or not known",
                "Add their size, `stock='600x300mm'`.",
            ),
        ):
            if wrong:
                raise JobError(message, remedy=remedy)

    def _check_count(self) -> None:
        """Refuse a count of what is not nested."""
        for wrong, message, remedy in (
            (
                (self.sheets or 0) > SHEETS_MOST,
                f"`sheets={self.sheets}` are more than pieces are nested on, {SHEETS_MOST:,}",
                "Give fewer.",
            ),
            (
                self.count is None and self.sheets is not None and not (self.pack and self.layout == "nested"),
                "`sheets` are for a `count` of pieces, or for those of colours that are packed and nested",
                "Add `count=40`, or `pack=True` and `layout='nested'`.",
            ),
            (
                self.count is not None and self.pack,
                "`count` is of pieces wherever they belong, and `pack` packs those of a picture",
                "Use one of the two.",
            ),
            (
                self.count is not None and self.layout not in ("nested", "auto"),
                f"`count` is of pieces that are nested, and `layout='{self.layout}'` lays others",
                "Use `layout='nested'`.",
            ),
        ):
            if wrong:
                raise JobError(message, remedy=remedy)


Job.__doc__ = explained(Job)
