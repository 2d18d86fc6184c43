"""The guard: whoever is not our page is refused, on a real port, whatever of it they have got hold of."""

from __future__ import annotations

from collections.abc import Iterator, MutableMapping
from typing import Any

import pytest
from helpers.loopback import Site, guarded

from voronoi_tiles.studio.guard import POLICY, Receive, Send


async def open_house(scope: MutableMapping[str, Any], receive: Receive, send: Send) -> None:
    """Let everybody in."""
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.accept"})
        await send({"type": "websocket.send", "text": "welcome"})
        await receive()
    else:
        await send({"type": "http.response.start", "status": 200, "headers": [(b"x-secret", b"inside")]})
        await send({"type": "http.response.body", "body": b"welcome"})


@pytest.fixture(scope="module")
def house() -> Iterator[Site]:
    """A house that is open to everybody, behind a guard."""
    with guarded(open_house) as site:
        yield site


def test_our_page_is_let_in(house: Site) -> None:
    """With host, origin and cookie right, reading, writing and the live connection work, by both names."""
    for name in ("127.0.0.1", "localhost"):
        host = f"{name}:{house.port}"
        headers = {"Host": host, "Origin": f"http://{host}"}
        assert house.ask("/", headers).body == b"welcome"
        assert house.ask("/", {**headers, "Origin": None}).body == b"welcome"
        assert house.ask("/", headers, method="POST", body=b"x").body == b"welcome"
        with house.page(name) as page:
            assert page.recv() == "welcome"
    assert not house.refuses_page({})


def test_the_secret_in_the_address_becomes_a_cookie(house: Site) -> None:
    """And the page is shown at an address without it; scripts and other sites do not get at the cookie."""
    typed = {"Cookie": None, "Origin": None, "Sec-Fetch-Site": "none"}
    answer = house.ask(f"/?token={house.token}", typed)
    assert (answer.status, answer.headers["location"]) == (303, "/")
    cookie, *attributes = answer.headers["set-cookie"].split("; ")
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} == set(attributes)
    assert str(house.port) in cookie.partition("=")[0]  # browsers send cookies to all ports of a host
    assert house.ask("/", {"Cookie": cookie, "Origin": None}).body == b"welcome"


@pytest.mark.parametrize("by", [None, "cross-site"])
def test_a_file_leads_to_the_page(house: Site, by: str | None) -> None:
    """The file that opens the browser is another site, whose redirections go without the cookie: a page leads on."""
    answer = house.ask(f"/?token={house.token}", {"Cookie": None, "Origin": None, "Sec-Fetch-Site": by})
    assert answer.status == 200
    assert house.token in answer.headers["set-cookie"]
    assert b'content="0;url=/"' in answer.body
    assert house.token.encode() not in answer.body


@pytest.mark.parametrize("token", ["", "x", "{token}x", "{short}", "%00", "{token}&token={token}", "%C3%BC", "{upper}"])
def test_another_secret_is_none(house: Site, token: str) -> None:
    """No cookie, no page."""
    query = token.format(token=house.token, short=house.token[:-1], upper=house.token.swapcase())
    answer = house.ask(f"/?token={query}", {"Cookie": None, "Origin": None})
    assert answer.status == 403
    assert "set-cookie" not in answer.headers
    assert b"welcome" not in answer.body


def attacks(site: Site) -> dict[str, dict[str, str | None]]:
    """What others can make a browser, or a program, send: by what it is."""
    port, token = site.port, site.token
    cookie = f"voronoi-tiles-{port}={token}"
    return {
        "a name that leads here": {"Host": f"evil.test:{port}", "Origin": f"http://evil.test:{port}"},
        "a name that leads here, and our origin": {"Host": f"evil.test:{port}"},
        "another port": {"Host": f"127.0.0.1:{port + 1}"},
        "no port": {"Host": "127.0.0.1"},
        "an empty host": {"Host": ""},
        "a name with a dot": {"Host": f"localhost.:{port}", "Origin": f"http://localhost.:{port}"},
        "a page of another server of this machine": {"Origin": f"http://127.0.0.1:{port + 1}"},
        "a page of the other name": {"Origin": f"http://localhost:{port}"},
        "a page of the net": {"Origin": "https://example.com"},
        "a page of a file or a sandbox": {"Origin": "null"},
        "an empty origin": {"Origin": ""},
        "another scheme": {"Origin": f"https://127.0.0.1:{port}"},
        "no cookie": {"Cookie": None},
        "an empty cookie": {"Cookie": ""},
        "another secret": {"Cookie": f"voronoi-tiles-{port}={token[:-1]}"},
        "the cookie of another port": {"Cookie": f"voronoi-tiles-{port + 1}={token}"},
        "two cookies": {"Cookie": f"{cookie}; {cookie}"},
        "a cookie in a cookie": {"Cookie": f'other="{cookie}"'},
        "a cookie that is no ASCII": {"Cookie": f"voronoi-tiles-{port}=\xff"},
    }


ATTACKS = tuple(attacks(Site("http://127.0.0.1:1/?token=x")))


@pytest.mark.parametrize("name", ATTACKS)
def test_others_are_refused(house: Site, name: str) -> None:
    """Reading, writing and the live connection alike; the application hears nothing of them."""
    headers = attacks(house)[name]
    for method in ("GET", "POST"):
        answer = house.ask("/", headers, method=method)
        assert answer.status in (400, 403)
        assert b"welcome" not in answer.body
    assert house.refuses_page(headers)


@pytest.mark.parametrize(
    "host", ["evil.test:{port}", "127.0.0.1", "localhost.:{port}", "127.0.0.1:1", "[::1]:{port}", ""]
)
def test_names_that_lead_here_get_nothing(house: Site, host: str) -> None:
    """Neither the page with a cookie, nor a cookie with the secret: what a page of that name asks has no origin."""
    headers = {"Host": host.format(port=house.port), "Origin": None}
    assert house.ask("/", headers).status == 403
    answer = house.ask(f"/?token={house.token}", {**headers, "Cookie": None})
    assert answer.status == 403
    assert "set-cookie" not in answer.headers


def test_who_does_not_say_where_he_comes_from_only_reads(house: Site) -> None:
    """A missing origin, which programs and old browsers send, neither writes nor gets the live connection."""
    assert house.ask("/", {"Origin": None}).status == 200
    for method in ("POST", "PUT", "DELETE", "PATCH"):
        assert house.ask("/", {"Origin": None}, method=method).status == 403
    assert house.refuses_page({"Origin": None})


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_pages_of_others_do_not_embed_ours(house: Site, site: str) -> None:
    """An image or a script of ours in a page of others, also of another port of this machine, is refused."""
    assert house.ask("/", {"Origin": None, "Sec-Fetch-Site": site}).status == 403
    assert house.ask("/", {"Origin": None, "Sec-Fetch-Site": "same-origin"}).status == 200
    assert house.ask("/", {"Origin": None, "Sec-Fetch-Site": "none"}).status == 200


def test_two_hosts_are_none(house: Site) -> None:
    """Where one reader takes the first and another the last, both could be right."""
    import socket

    for double in (f"Host: {house.host}", f"Origin: http://{house.host}", f"Cookie: {house.ours['Cookie']}"):
        lines = [f"{name}: {value}" for name, value in house.ours.items()]
        request = "\r\n".join(["GET / HTTP/1.1", *lines, double, "Connection: close", "", ""])
        with socket.create_connection(("127.0.0.1", house.port), timeout=10) as connection:
            connection.sendall(request.encode())
            status = b"".join(iter(lambda: connection.recv(1 << 16), b"")).split()[1]
        assert status in (b"400", b"403"), double


def test_every_answer_keeps_the_page_to_itself(house: Site) -> None:
    """What is shown and what is refused alike: nothing is embedded, guessed, kept, or told to others."""
    token = f"/?token={house.token}"
    for path, headers in (("/", {}), ("/", {"Cookie": None}), (token, {"Cookie": None, "Origin": None})):
        found = house.ask(path, headers).headers
        assert found["content-security-policy"] == POLICY
        assert found["x-content-type-options"] == "nosniff"
        assert found["cross-origin-resource-policy"] == found["cross-origin-opener-policy"] == "same-origin"
        assert found["referrer-policy"] == "no-referrer"
        assert found["cache-control"] == "no-store"
        assert not [name for name in found if name.startswith("access-control")]


def test_the_policy_lets_nothing_in() -> None:
    """What is not named is not allowed, and nothing that a design could hold is run."""
    rules = dict(rule.split(" ", 1) for rule in POLICY.split("; "))
    assert rules["default-src"] == rules["base-uri"] == rules["form-action"] == rules["frame-ancestors"] == "'none'"
    assert rules["script-src"] == rules["style-src"] == rules["connect-src"] == rules["worker-src"] == "'self'"
    assert "unsafe" not in POLICY


def test_secrets_differ() -> None:
    """No two studios have the same, and none can be guessed."""
    with guarded(open_house) as one, guarded(open_house) as other:
        assert one.token != other.token
        assert len(one.token) >= 43  # 32 bytes
        assert other.ask("/", {"Cookie": f"voronoi-tiles-{other.port}={one.token}"}).status == 403
