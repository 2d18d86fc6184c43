"""Who may talk to the studio: the page that the command has opened, and nobody else on this machine or the network.

The server listens on the loopback interface only; what is left are other pages in the user's browser, and names that
lead here (DNS rebinding). A request is answered only where its Host is one of a fixed list, its Origin, where a page of
a browser is behind it, is that host, and it carries the secret as a cookie. To compare the Origin with the Host alone
would not do: a name that leads here forges both. The cookie is got by the secret in the address.
"""

from __future__ import annotations

import hmac
import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from typing import Any, Final
from urllib.parse import parse_qs

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
Application = Callable[[Scope, Receive, Send], Awaitable[None]]

NAMES: Final = ("127.0.0.1", "localhost")
"""What the server is called by those that it answers."""

POLICY: Final = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
    "worker-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""What the page may load and run: our own files, and nothing that is written in it."""

HEADERS: Final = (
    (b"content-security-policy", POLICY.encode()),
    (b"x-content-type-options", b"nosniff"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"referrer-policy", b"no-referrer"),
    (b"cache-control", b"no-store"),
)
"""What every answer carries."""

_REFUSED: Final = (
    b"<!doctype html><html lang=en><title>Studio</title><p>This studio is opened by the address that "
    b"<code>voronoi-tiles studio</code> has printed.</p></html>"
)
"""What those see that are refused."""

_ONWARDS: Final = (
    b'<!doctype html><html lang=en><title>Studio</title><meta http-equiv="refresh" content="0;url=/"></html>'
)
"""What leads on to the page."""


class Guard:
    """An application behind its guard; `port` is where the server listens.

    `address` is what is to be opened: it holds the secret.
    """

    def __init__(self, application: Application, port: int) -> None:
        self._application = application
        self._secret = secrets.token_urlsafe(32)
        self._cookie = f"voronoi-tiles-{port}"
        self._hosts = frozenset(f"{name}:{port}".encode() for name in NAMES)
        self.address = f"http://{NAMES[0]}:{port}/?token={self._secret}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, or refuse, a request."""
        if scope["type"] not in ("http", "websocket"):
            await self._application(scope, receive, send)
            return
        headers = dict(scope["headers"])
        if len(headers) < len(scope["headers"]) and _doubled(scope["headers"]):
            await _refuse(scope, send, 400)
        elif headers.get(b"host") not in self._hosts:
            await _refuse(scope, send, 403)
        elif self._is_first(scope):
            await self._admit(send, typed=headers.get(b"sec-fetch-site") == b"none")
        elif not (self._is_ours(scope, headers) and self._has_cookie(headers)):
            await _refuse(scope, send, 403)
        else:
            await self._application(scope, receive, _with_headers(send))

    def _is_first(self, scope: Scope) -> bool:
        """Whether the secret is in the address."""
        if scope["type"] != "http" or scope["method"] != "GET" or scope["path"] != "/":
            return False
        given = parse_qs(scope["query_string"].decode("latin-1")).get("token", [])
        return len(given) == 1 and hmac.compare_digest(given[0].encode(), self._secret.encode())

    async def _admit(self, send: Send, *, typed: bool) -> None:
        """Give the cookie for the secret, and lead to the page without it in the address.

        Where the address was not `typed`, but a file led here, the browser counts a redirection as made by that file,
        and would keep the cookie back: a page of ours has to lead on.
        """
        cookie = f"{self._cookie}={self._secret}; Path=/; HttpOnly; SameSite=Strict"
        headers = [(b"content-type", b"text/html; charset=utf-8"), (b"set-cookie", cookie.encode()), *HEADERS]
        if typed:
            headers.append((b"location", b"/"))
        await send({"type": "http.response.start", "status": 303 if typed else 200, "headers": headers})
        await send({"type": "http.response.body", "body": b"" if typed else _ONWARDS})

    def _is_ours(self, scope: Scope, headers: MutableMapping[bytes, bytes]) -> bool:
        """Whether a request is made by our page, or by somebody who types the address."""
        origin = headers.get(b"origin")
        if origin is None:
            reads = scope["type"] == "http" and scope["method"] in ("GET", "HEAD")
            return reads and headers.get(b"sec-fetch-site", b"none") in (b"none", b"same-origin")
        return origin == b"http://" + headers[b"host"]  # which is one of ours: that was asked before

    def _has_cookie(self, headers: MutableMapping[bytes, bytes]) -> bool:
        """Whether a request carries the secret."""
        # By hand: the library gives up at the first cookie of another server on this host that it does not like.
        pairs = (pair.strip().partition(b"=") for pair in headers.get(b"cookie", b"").split(b";"))
        given = [value for name, _, value in pairs if name == self._cookie.encode()]
        return len(given) == 1 and hmac.compare_digest(given[0], self._secret.encode())


def _doubled(headers: list[tuple[bytes, bytes]]) -> bool:
    """Whether a header that decides is there twice: who reads the first and who the last would differ."""
    names = [name for name, _ in headers if name in (b"host", b"origin", b"cookie")]
    return len(set(names)) < len(names)


def _with_headers(send: Send) -> Send:
    """What sends answers with our headers."""

    async def sending(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            message = {**message, "headers": [*message.get("headers", ()), *HEADERS]}
        await send(message)

    return sending


async def _refuse(scope: Scope, send: Send, status: int) -> None:
    """Refuse a request; a websocket is closed before it is opened, which browsers see as 403."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    headers = [(b"content-type", b"text/html; charset=utf-8"), *HEADERS]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": _REFUSED})
