"""Applications behind a guard on a real port of this machine, and requests to them, header by header."""

from __future__ import annotations

import asyncio
import http.client
import socket
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

import uvicorn
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin

from voronoi_tiles.studio.guard import Application, Guard
from voronoi_tiles.studio.server import bind


@dataclass(frozen=True)
class Answer:
    """What a server has answered; the names of headers in small letters."""

    status: int
    headers: Mapping[str, str]
    body: bytes


@dataclass(frozen=True)
class Site:
    """A server of this machine behind a guard, by the address that it is opened with."""

    address: str

    @property
    def port(self) -> int:
        """Its port."""
        return int(self.address.split(":")[2].split("/")[0])

    @property
    def token(self) -> str:
        """Its secret."""
        return self.address.partition("?token=")[2]

    @property
    def host(self) -> str:
        """What it is called, with the port."""
        return f"127.0.0.1:{self.port}"

    @property
    def ours(self) -> dict[str, str]:
        """The headers that its own page sends."""
        return {
            "Host": self.host,
            "Origin": f"http://{self.host}",
            "Cookie": f"voronoi-tiles-{self.port}={self.token}",
        }

    def ask(
        self, path: str, headers: Mapping[str, str | None] | None = None, *, method: str = "GET", body: bytes = b""
    ) -> Answer:
        """Send a request as our own page would, but for some headers; None leaves one out."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
        for name, value in {**self.ours, "Content-Length": str(len(body)), **(headers or {})}.items():
            if value is not None:
                connection.putheader(name, value)
        connection.endheaders(body)
        response = connection.getresponse()
        answer = Answer(response.status, {k.lower(): v for k, v in response.getheaders()}, response.read())
        connection.close()
        return answer

    def page(self, name: str = "127.0.0.1", query: str = "") -> ClientConnection:
        """The live connection, as our own page opens it by a name of this machine."""
        host = f"{name}:{self.port}"
        connected: ClientConnection = connect(
            f"ws://{host}/ws{query}",
            sock=socket.create_connection(("127.0.0.1", self.port)),
            origin=Origin(f"http://{host}"),
            additional_headers={"Cookie": self.ours["Cookie"]},
            max_size=None,
            compression=None,
            proxy=None,
        )
        return connected

    def refuses_page(self, headers: Mapping[str, str | None]) -> bool:
        """Whether the live connection is refused to whoever sends such headers."""
        upgrade = {
            "Connection": "Upgrade",
            "Upgrade": "websocket",
            "Sec-WebSocket-Version": "13",
            "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
            "Content-Length": None,
        }
        status = self.ask("/ws", {**upgrade, **headers}).status
        assert status in (101, 400, 403)
        return status != 101


@contextmanager
def guarded(application: Application) -> Iterator[Site]:
    """An application behind a guard, served for the block."""
    listener = bind(0)
    guard = Guard(application, listener.getsockname()[1])
    server = uvicorn.Server(
        uvicorn.Config(guard, log_config=None, lifespan="off", ws="websockets-sansio", timeout_graceful_shutdown=1)
    )
    thread = threading.Thread(target=lambda: asyncio.run(server.serve(sockets=[listener])), daemon=True)
    thread.start()
    try:
        yield Site(guard.address)
    finally:
        server.should_exit = True
        thread.join()
