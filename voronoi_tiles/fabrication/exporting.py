"""Products written as files: whole or not at all, a file for each colour, and never over what they are made from."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.base.files import STDOUT, is_special, refuse_overwriting, writing
from voronoi_tiles.designs.design import Design
from voronoi_tiles.fabrication.job import Job
from voronoi_tiles.fabrication.job_limits import ACCURACY_MM
from voronoi_tiles.fabrication.job_options import JobError
from voronoi_tiles.formats.page import Drawing
from voronoi_tiles.formats.presets import FORMATS, SUFFIXES, Format
from voronoi_tiles.formats.writing import write_drawing
from voronoi_tiles.vector.tessellation import Tessellation

if TYPE_CHECKING:
    from voronoi_tiles.fabrication.product import Product

Name = TypeVar("Name", bound=str)


class Exported(NamedTuple):
    """A file that was written, and the product in it; None where it holds the exact tiles as they lie in the plane."""

    path: str
    product: Product | None


def format_of(path: str | os.PathLike[str], formats: Sequence[Name]) -> Name:
    """The format that a file's suffix names. Raises OutputError where it names none of these."""
    suffix = Path(path).suffix.lower().removeprefix(".")
    for name in formats:
        if name == SUFFIXES.get(suffix, suffix):
            return name
    suffixes = " or ".join(f".{name}" for name in formats)
    raise OutputError(f"cannot tell the format of {os.fspath(path)!r}: give it the suffix {suffixes}", path=path)


def write_products(
    design: Design,
    tessellation: Tessellation,
    path: str,
    file_format: str,
    job: Job,
    evidence: Mapping[str, Any] | None,
    progress: Callable[[float, float], None] | None = None,
) -> tuple[Exported, ...]:
    """Write the files of a job: one, or one for each colour or sheet, with its number before the suffix.

    What was proved and checked, `evidence`, goes into each; `progress` is told of a search for places. A job that
    cannot be done leaves nothing, and no file takes its place before all are written. Raises JobError, and OutputError
    where a file cannot be written, or the job reads it.
    """
    from voronoi_tiles.fabrication.product import make, make_several

    if evidence is not None and job.pieces is not None and job.sheet is not None:
        raise JobError(
            "`pieces` scales the design, and the cross-check is of this one",
            remedy="Write the design at the scale that is found, and check that.",
        )
    if not job.several:
        products = {path: make(design, tessellation, job, file_format, progress)}
    else:
        refuse_stream(path, "sheets" if job.sheets is not None else "into")
        products = numbered(path, make_several(design, tessellation, job, file_format, progress))
    if evidence is not None:
        products = {name: product.with_evidence(evidence) for name, product in products.items()}
    return write_all(products)


def refuse_stream(path: str, option: str) -> None:
    """Refuse what is no name of several files. Raises JobError, which names the option that makes them several."""
    if path == STDOUT or is_special(path):
        raise JobError(
            f"`{option}`: several files need a name that they can begin with",
            remedy="Write to a file such as sheet.svg.",
        )


def numbered(path: str, products: Sequence[tuple[str, Product]]) -> dict[str, Product]:
    """Products by the files that they go to: each has its name, which is given with it, before the suffix."""
    place = Path(path)
    return {str(place.with_name(f"{place.stem}-{name}{place.suffix}")): product for name, product in products}


def write_all(products: Mapping[str, Product]) -> tuple[Exported, ...]:
    """Write products to the files that they are given by: no file takes its place before all are written.

    Raises OutputError where a file cannot be written, or a product is made from it.
    """
    refuse_overwriting(products, (file for product in products.values() for file in product.files))
    with ExitStack() as stack:
        for name, product in products.items():
            product.write(stack.enter_context(writing(name)))
    return tuple(Exported(name, product) for name, product in products.items())


def drawing_format(path: str | os.PathLike[str]) -> Format:
    """The format of a drawing by its file's suffix, SVG without one. Raises OutputError for another."""
    return format_of(path, FORMATS) if Path(path).suffix else "svg"


def save_drawing(drawing: Drawing, path: str | os.PathLike[str]) -> None:
    """Write a drawing that is no tiling's, whole or not at all. Raises OutputError."""
    form = drawing_format(path)
    with writing(path) as file:
        write_drawing(drawing, file, form, accuracy=ACCURACY_MM)
