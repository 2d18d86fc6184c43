"""A server of files on the loopback, for tests that open modules of the studio's page in a browser."""

from __future__ import annotations

import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from types import TracebackType
from typing import ClassVar, Self

import voronoi_tiles.raster
from helpers.page import PAGE

SHADER = Path(voronoi_tiles.raster.__path__[0]) / "exact.glsl"
BLANK = b"<!doctype html><html lang=en><title>Test</title><body></body></html>"


class PageServer:
    """Serves the files of the page, the shader of the raster stage as /gl/exact.glsl, and an empty document at /.

    Used in a `with` statement; `url` is its address, without a slash at the end.
    """

    def __init__(self) -> None:
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), _Handler)
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}"

    def __enter__(self) -> Self:
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._server.shutdown()
        self._server.server_close()


class _Handler(BaseHTTPRequestHandler):
    """Answers GET."""

    TYPES: ClassVar = {".js": "text/javascript", ".css": "text/css", ".glsl": "text/plain", ".html": "text/html"}

    def do_GET(self) -> None:
        """Send a file, or 404."""
        path = self.path.partition("?")[0]
        file = SHADER if path == "/gl/exact.glsl" else (PAGE / path.lstrip("/")).resolve()
        body = BLANK if path == "/" else file.read_bytes() if file.is_file() else None
        self.send_response(404 if body is None else 200)
        self.send_header("Content-Type", "text/html" if path == "/" else self.TYPES.get(file.suffix, "text/plain"))
        self.send_header("Content-Length", str(len(body or b"")))
        self.end_headers()
        self.wfile.write(body or b"")

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002  (the base class's name)
        """Say nothing."""
