"""What the launchers run: one entry of Inkscape's, from its command line to the changed drawing on standard output.

Whatever goes wrong is a sentence on standard error, which Inkscape shows, with the exit codes of the command line; then
nothing is on standard output, and the drawing stays as it is.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, Never

from voronoi_tiles.base.errors import VoronoiTilesError

if TYPE_CHECKING:
    from voronoi_tiles.inkscape.entries import EntryName

DEBUG_VARIABLE: Final = "VORONOI_TILES_DEBUG"

_USAGE: Final = 2
_BUG: Final = 70


def run() -> Never:
    """Run the entry that the first word names, with Inkscape's command line behind it, and exit."""
    # Nothing of ours is work for the threads that OpenBLAS starts when numpy is imported: half of that import's time.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    try:
        data = answer(sys.argv[1], sys.argv[2:])
    except (Exception, KeyboardInterrupt) as error:
        if os.environ.get(DEBUG_VARIABLE):
            raise
        code, message = explained_error(error)
        sys.stderr.buffer.write(f"{message}\n".encode(errors="replace"))
        sys.exit(code)
    sys.stdout.buffer.write(data)
    sys.stdout.buffer.flush()
    sys.exit(0)


def answer(entry: EntryName | str, words: Sequence[str]) -> bytes:
    """The drawing that an entry makes of what Inkscape calls it with. Raises VoronoiTilesError."""
    from voronoi_tiles.inkscape.call import Call

    call = Call.of(words)
    match entry:
        case "tiles":
            from voronoi_tiles.inkscape.dialog_fields import TilesFields
            from voronoi_tiles.inkscape.effects import tiles

            (given,) = call.arguments(TilesFields)
            return tiles(call.drawing(), call.ids, TilesFields(**given))
        case "sheet":
            from voronoi_tiles.fabrication.job_fields import JobFields
            from voronoi_tiles.inkscape.dialog_fields import DesignFields
            from voronoi_tiles.inkscape.effects import sheet

            given, job = call.arguments(DesignFields, JobFields)
            return sheet(call.drawing(), call.ids, DesignFields(**given), job)
        case "strokes":
            from voronoi_tiles.inkscape.opened_design import beside

            return beside(call.drawing())
        case "open":
            from voronoi_tiles.inkscape.opened_design import opened

            return opened(call.file)
        case _:
            raise ValueError(entry)


def explained_error(error: BaseException) -> tuple[int, str]:
    """The exit code and what to say of an error."""
    match error:
        case VoronoiTilesError():
            from voronoi_tiles.inkscape.inx import in_dialog

            return error.exit_code, in_dialog(str(error))
        case KeyboardInterrupt():
            return 130, "Interrupted."
        case MemoryError():
            return _USAGE, "There is not enough memory for this. Allow a larger tolerance, or draw less."
        case _:
            remedy = f"please report it, with the drawing. {DEBUG_VARIABLE}=1 shows where it is."
            return _BUG, f"{type(error).__name__}: {error}. This is a bug in voronoi-tiles: {remedy}"
