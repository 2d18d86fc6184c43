"""What the server answers: the page's files, what it knows, files to download, and the live connection."""

from __future__ import annotations

import asyncio
import json
import os
from collections.abc import AsyncGenerator, AsyncIterator, Callable, Coroutine, Mapping
from contextlib import aclosing
from importlib.util import find_spec
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import quote

from starlette.applications import Starlette
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route, WebSocketRoute

from voronoi_tiles.base.errors import ArgumentError, VoronoiTilesError
from voronoi_tiles.base.units import UNIT_MM
from voronoi_tiles.base.values import shown
from voronoi_tiles.studio.art_files import lay_beside
from voronoi_tiles.studio.lanes import Answer
from voronoi_tiles.studio.messages import (
    DROP_MAX,
    MESSAGE_MAX,
    Table,
    read_design,
    read_job,
    read_object,
    read_text,
    refuse_others,
)
from voronoi_tiles.studio.refusals import error_document
from voronoi_tiles.studio.sessions import Desk

if TYPE_CHECKING:
    from starlette.requests import Request

PAGE: Final = Path(__file__).parent / "page"
"""Where the page's files are."""

_TYPES: Final = {
    ".css": "text/css",
    ".glsl": "text/plain",
    ".html": "text/html",
    ".js": "text/javascript",
    ".svg": "image/svg+xml",
}
"""The kinds of files that the page is made of."""

_DOWNLOADS: Final = {
    ".3mf": "model/3mf",
    ".dxf": "image/vnd.dxf",
    ".gcode": "text/x-gcode",
    ".json": "application/json",
    ".lbrn2": "application/xml",
    ".pdf": "application/pdf",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".stl": "model/stl",
    ".zip": "application/zip",
}
"""The kinds of files that can be downloaded."""

_NAME_MAX: Final = 100
"""Longest name of a design; characters."""

_SHADER: Final = "gl/exact.glsl"
"""What the page calls the shader of the raster stage."""


_GIVEN_UP: Final = {"message": "This was given up.", "remedy": "Ask for it again."}
_TOO_LARGE: Final = {"message": "This is too large.", "remedy": "Draw less, or split the file."}


def application(desk: Desk, page: Path = PAGE) -> Starlette:
    """The application; `page` is the folder of the page's files."""
    routes = _Routes(desk, page)
    return Starlette(
        routes=[
            WebSocketRoute("/ws", desk.serve),
            Route("/tables.json", routes.tables),
            Route("/examples.json", routes.examples),
            Route("/export", routes.export, methods=["POST"]),
            Route("/solid", routes.solid, methods=["POST"]),
            Route("/coupon", routes.coupon, methods=["POST"]),
            Route("/drop", routes.drop, methods=["POST"]),
            Route("/fits", routes.fits, methods=["POST"]),
            Route("/fits/art", routes.art, methods=["POST"]),
            Route("/toml", routes.toml, methods=["POST"]),
            Route("/{path:path}", routes.file),
        ]
    )


class _Routes:
    """The answers to requests."""

    def __init__(self, desk: Desk, page: Path) -> None:
        self._desk, self._page = desk, page
        self._known: dict[str, Response] = {}

    async def file(self, request: Request) -> Response:
        """A file of the page."""
        name = request.path_params["path"] or "index.html"
        found = _shader() if name == _SHADER else page_file(self._page, name)
        if found is None:
            return _failed({"message": "There is no such file.", "remedy": "Load the page again."}, 404)
        return Response(found.read_bytes(), media_type=_TYPES[found.suffix])

    async def tables(self, _request: Request) -> Response:
        """What the page knows of groups, strokes, jobs and presets."""
        return await self._computed("tables")

    async def examples(self, _request: Request) -> Response:
        """The starters."""
        return await self._computed("examples")

    async def export(self, request: Request) -> Response:
        """The file that a job makes of a design."""
        return await _answered(request, lambda table: self._made("export", table))

    async def solid(self, request: Request) -> Response:
        """The file of a design's solids."""
        return await _answered(request, lambda table: self._made("solid_file", table))

    async def _made(self, task: str, table: Table) -> Response:
        """The file that a worker makes of a design by a job."""
        refuse_others(table, ("design", "job", "name"))
        design, job = read_design(table), read_job(table)
        self._desk.check_files(design, job)
        name = _read_name(table, self._desk.document.name)
        return _download(await self._desk.jobs.ask({"task": task, "design": design, "job": job, "name": name}))

    async def coupon(self, request: Request) -> Response:
        """The file of a coupon."""

        async def made(table: Table) -> Response:
            options = read_job({"job": table})
            self._desk.check_files({}, options)
            return _download(await self._desk.jobs.ask({"task": "coupon", "options": options}))

        return await _answered(request, made)

    async def toml(self, request: Request) -> Response:
        """A design as the text of a design file."""

        async def written(table: Table) -> Response:
            refuse_others(table, ("design",))
            text = await self._desk.keeper(self._desk.document.toml, read_design(table))
            return Response(text, media_type="text/plain")

        return await _answered(request, written)

    async def drop(self, request: Request) -> Response:
        """What is in a drawing, a design, or a file of ours that was dropped onto the page."""
        asked = {name: request.query_params.get(name, "") for name in ("name", "units")}
        data = await _body_of(request, DROP_MAX)
        if data is None:
            return _failed(_TOO_LARGE, 413)
        if asked["units"] not in UNIT_MM:
            return _failed({"message": "The units of the design are missing.", "remedy": "Load the page again."}, 422)

        async def dropped() -> Response:
            answer = await self._desk.jobs.ask({"task": "drop", **asked, "folder": self._desk.document.folder}, data)
            if answer.error is not None:
                return _failed(answer.error, 422)
            return Response(answer.body, media_type="application/json")

        return await _unless_given_up(request, dropped())

    async def fits(self, request: Request) -> Response:
        """Designs whose tiles come near to an outline that was dropped onto the page: a line of JSON each."""
        asked = {name: request.query_params.get(name, "") for name in ("name", "groups")}
        ticked = {
            "mirrored": request.query_params.get("mirrored", "yes") == "yes",
            "symmetric": request.query_params.get("symmetric", "no") == "yes",
        }
        data = await _body_of(request, DROP_MAX)
        if data is None:
            return _failed(_TOO_LARGE, 413)
        messages = self._desk.fits.messages({**asked, **ticked}, data)

        async def begun() -> Response:
            first = await anext(messages)
            if first["type"] == "failed":
                return _failed(first["error"], 422)
            return StreamingResponse(_lines(first, messages), media_type="application/x-ndjson")

        return await _unless_given_up(request, begun())

    async def art(self, request: Request) -> Response:
        """The art of such a design, laid beside ours: its table, with the name of its file."""

        async def laid(table: Table) -> Response:
            refuse_others(table, ("number",))
            found, document = self._desk.fits.art(table.get("number")), self._desk.document
            file = await self._desk.keeper(lay_beside, document.folder, document.name, found.svg)
            return JSONResponse({**found.table, "file": file})

        return await _answered(request, laid)

    async def _computed(self, task: str) -> Response:
        """What a worker computes once."""
        if task not in self._known:
            answer = await self._desk.outlines.ask({"task": task}, urgent=task != "examples")
            if answer.error is not None:
                return _failed(answer.error, 500)
            self._known[task] = Response(answer.body, media_type="application/json")
        return self._known[task]


async def _lines(first: Table, others: AsyncGenerator[Table, None]) -> AsyncIterator[str]:
    """Messages, a line of JSON each."""
    async with aclosing(others):
        yield json.dumps(first, allow_nan=False) + "\n"
        async for message in others:
            yield json.dumps(message, allow_nan=False) + "\n"


async def _answered(request: Request, answer: Callable[[Table], Coroutine[Any, Any, Response]]) -> Response:
    """The answer to a request whose body is an object of JSON; what goes wrong is said."""
    data = await _body_of(request, MESSAGE_MAX)
    if data is None:
        return _failed(_TOO_LARGE, 413)
    try:
        return await _unless_given_up(request, answer(read_object(data)))
    except Exception as error:  # noqa: BLE001 - whatever it is, the page is told
        return _failed(error_document(error), 422 if isinstance(error, VoronoiTilesError) else 500)


async def _unless_given_up(request: Request, answering: Coroutine[Any, Any, Response]) -> Response:
    """The answer to a request whose body was read; where who asked hangs up, what makes it is cancelled."""
    answer = asyncio.ensure_future(answering)
    gone = asyncio.ensure_future(_hung_up(request))
    try:
        await asyncio.wait((answer, gone), return_when=asyncio.FIRST_COMPLETED)
        return answer.result() if answer.done() else _failed(_GIVEN_UP, 499)
    finally:
        for task in (answer, gone):
            task.cancel()
        await asyncio.gather(answer, gone, return_exceptions=True)


async def _hung_up(request: Request) -> None:
    """Wait until who asked is gone; that the body has ended may be said once more before."""
    while (await request.receive())["type"] != "http.disconnect":
        pass


async def _body_of(request: Request, most: int) -> bytes | None:
    """The body of a request, None where it is larger than so many bytes; no more than these are kept."""
    data = bytearray()
    async for part in request.stream():
        data += part
        if len(data) > most:
            return None
    return bytes(data)


def _read_name(table: Table, default: str) -> str:
    """The name of a design, as files say it, by default that of the file. Raises ArgumentError."""
    name = read_text(table, "name", default)
    if name != default and not (name.isprintable() and 0 < len(name) <= _NAME_MAX):
        raise ArgumentError(f"{shown(name)} is no name", remedy="Give a short one.")
    return name


def _download(answer: Answer) -> Response:
    """A file to be downloaded, never shown: what a drawing of others holds is not to run here."""
    if answer.error is not None:
        return _failed(answer.error, 422)
    name = answer.head["file"]
    headers = {"content-disposition": f"attachment; filename*=utf-8''{quote(name)}"}
    return Response(answer.body, media_type=_DOWNLOADS[PurePath(name).suffix], headers=headers)


def page_file(folder: Path, name: str) -> Path | None:
    """A file of the page, None where there is none of this name, or the name leads elsewhere."""
    parts = name.split("/")
    if any(not part or part.startswith(".") or not part.isascii() or "\\" in part for part in parts):
        return None
    found = folder.joinpath(*parts)
    return found if found.suffix in _TYPES and os.path.isfile(found) else None  # noqa: PTH113 - any name, however long


def _shader() -> Path | None:
    """The shader of the raster stage, found without loading it."""
    spec = find_spec("voronoi_tiles.raster")
    assert spec is not None
    assert spec.submodule_search_locations is not None
    found = Path(spec.submodule_search_locations[0]) / "exact.glsl"
    return found if found.is_file() else None


def _failed(error: Mapping[str, Any], status: int) -> Response:
    """An error as an answer."""
    return JSONResponse(dict(error), status)
