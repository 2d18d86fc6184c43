"""What others could try in the browser of somebody who has the studio open, and what a design of theirs could hold."""

from __future__ import annotations

import http.server
import shutil
import socket
import threading
from collections.abc import Iterator
from typing import Any

import pytest
from helpers.studio import Studio, Window, link_of, opened, running

POINTS = 100_000


def design_of(strokes: list[dict[str, Any]], **site: Any) -> dict[str, Any]:
    """A design of one site."""
    return {"schema": 1, "group": "p4", "cell": {"a": 60}, "site": [{**site, "strokes": strokes}]}


WING = {"polyline": [[6.0, 9.0], [20.0, 4.0], [25.0, 18.0]]}


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Studio]:
    """A studio on a new design."""
    with running(tmp_path_factory.mktemp("safety")) as found:
        yield found


@pytest.fixture(scope="module")
def window(chromium: Any, studio: Studio) -> Iterator[Window]:
    """Its page."""
    with opened(chromium, studio, viewport={"width": 900, "height": 640}) as found:
        found.wait()
        yield found


@pytest.fixture(scope="module")
def other_port() -> Iterator[int]:
    """The port of another server of this machine, whose pages are empty."""

    class Empty(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(b"<!doctype html><title>other</title>")

        def log_message(self, *_: Any) -> None:
            """Say nothing."""

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Empty) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server.server_port
        server.shutdown()


SOCKET = """address => new Promise((done) => {
    const socket = new WebSocket(address);
    socket.onopen = () => done("open");
    socket.onerror = () => done("refused");
})"""


def test_a_page_at_another_port_is_refused(window: Window, studio: Studio, other_port: int) -> None:
    """Cookies do not tell ports apart: the browser sends ours along, and the studio looks at where it comes from."""
    page = window.page.context.new_page()
    page.goto(f"http://127.0.0.1:{other_port}/")
    assert page.evaluate(SOCKET, f"ws://127.0.0.1:{studio.port}/ws") == "refused"
    posted = page.evaluate(
        "address => fetch(address, {method: 'POST', credentials: 'include'}).then(() => 'read', () => 'no')",
        f"http://127.0.0.1:{studio.port}/toml",
    )
    assert posted == "no"
    shown = page.evaluate(
        """address => new Promise((done) => {
            const frame = document.createElement("iframe");
            frame.src = address;
            frame.onload = () => { try { done(frame.contentDocument ? "read" : "no"); } catch { done("no"); } };
            document.body.append(frame);
        })""",
        f"http://127.0.0.1:{studio.port}/",
    )
    assert shown == "no"
    page.close()
    assert (
        window.page.evaluate(
            SOCKET.replace('done("open")', '{ socket.close(); done("open"); }'),
            f"ws://127.0.0.1:{studio.port}/ws?again=1",
        )
        == "open"
    )
    window.page.reload()
    window.load()


def test_no_token_no_page(chromium: Any, studio: Studio) -> None:
    """A browser that was not let in sees nothing but that."""
    context = chromium.new_context()
    page = context.new_page()
    for address in ("/", "/tables.json", "/?token=guessed"):
        answer = page.goto(f"http://127.0.0.1:{studio.port}{address}")
        assert answer.status == 403
    context.close()


def test_a_rebound_name_is_refused(chromium: Any, studio: Studio) -> None:
    """A name of theirs that leads to this machine, even with the token."""
    browser = chromium.browser_type.launch(
        executable_path=shutil.which("chromium"),
        args=["--no-sandbox", "--host-resolver-rules=MAP evil.test 127.0.0.1"],
    )
    try:
        page = browser.new_page()
        assert page.goto(studio.address.replace("127.0.0.1", "evil.test")).status == 403
        assert page.goto(studio.address).ok
    finally:
        browser.close()


def test_a_socket_without_origin_is_refused(window: Window, studio: Studio) -> None:
    """A program that has got hold of the cookie, but is no page."""
    [cookie] = window.page.context.cookies()

    def status(*headers: str) -> bytes:
        with socket.create_connection(("127.0.0.1", studio.port), timeout=20) as connection:
            lines = [
                "GET /ws HTTP/1.1",
                f"Host: 127.0.0.1:{studio.port}",
                "Upgrade: websocket",
                "Connection: Upgrade",
                "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==",
                "Sec-WebSocket-Version: 13",
                f"Cookie: {cookie['name']}={cookie['value']}",
                *headers,
            ]
            connection.sendall("\r\n".join([*lines, "", ""]).encode())
            return connection.recv(100).split()[1]

    assert status() == b"403"
    assert status("Origin: http://evil.test") == b"403"
    assert status("Origin: null") == b"403"
    assert status(f"Origin: http://127.0.0.1:{studio.port}") == b"101"
    assert cookie["httpOnly"]
    assert cookie["sameSite"] == "Strict"
    window.page.reload()
    window.load()


def test_hostile_names(window: Window) -> None:
    """Names are text, wherever they are shown, and go to no file that is not the design's."""
    name = "<img src=x onerror=document.title='hit'>"
    page = window.page
    window.begin(design_of([WING], name=name))
    page.locator("#measure").get_by_text("mm").wait_for()
    page.get_by_role("button", name="Add a site").click()
    window.page.get_by_role("alert").get_by_text("no stroke").wait_for()
    page.get_by_role("button", name="Undo").click()
    window.wait()
    page.keyboard.press("Control+e")
    page.get_by_label("Name", exact=True).fill("../../outside")
    with page.expect_download() as download:
        page.get_by_role("button", name="Download").click()
    assert "/" not in download.value.suggested_filename
    page.locator("dialog").wait_for(state="detached")
    assert page.locator("img").count() == 0
    assert "hit" not in page.title()


def test_a_group_that_there_is_not(window: Window) -> None:
    """The server says it; the page goes on."""
    window.begin({**design_of([WING]), "group": "p7"}, "refused")
    assert "p7" in window.page.get_by_role("alert").inner_text()
    window.page.get_by_role("button", name="Undo").click()
    window.wait()


def test_a_design_that_is_too_large(window: Window) -> None:
    """One message, and what was drawn stays."""
    before = window.text
    link = link_of(design_of([{"polyline": [[k % 300, k // 300] for k in range(POINTS)]}]))
    window.page.evaluate("link => { location.hash = link; }", link)
    alert = window.page.get_by_role("alert")
    alert.get_by_text("100,000 points").wait_for()
    assert window.text == before
    window.page.get_by_role("button", name="Close").click()
    assert window.page.locator("#banner").is_hidden()


def test_the_page_runs_nothing_else(chromium: Any, studio: Studio, other_port: int) -> None:
    """Its policy blocks what is evaluated, what is written into it, and what is elsewhere."""
    with opened(chromium, studio, complaints=False) as window:
        page = window.page
        outcome = page.evaluate(
            """async address => {
                const script = document.createElement("script");
                script.textContent = "window.written = true";
                document.head.append(script);
                const image = new Image();
                image.setAttribute("onerror", "window.handled = true");
                image.src = "data:,";
                document.body.append(image);
                await new Promise((done) => { image.addEventListener("error", done); });
                return [
                    await fetch(address).then(() => "fetched", () => "blocked"),
                    window.written ?? "blocked",
                    window.handled ?? "blocked",
                ];
            }""",
            f"http://127.0.0.1:{other_port}/",
        )
        assert outcome == ["blocked"] * 3
        # What devtools evaluate is above the policy; a worker of the page's own is not.
        assert (
            page.evaluate(
                """() => new Promise((done) => {
                document.addEventListener("securitypolicyviolation", (event) => done(event.blockedURI), { once: true });
                setTimeout("window.timed = true", 0);
                setTimeout(() => done(window.timed ?? "no report"), 3000);
            })"""
            )
            == "eval"
        )


@pytest.mark.parametrize("how", ["patched", pytest.param("argument", marks=pytest.mark.slow)])
def test_without_webgl(chromium: Any, studio: Studio, how: str) -> None:
    """The exact outlines are the picture, in several colours, and follow what is dragged."""
    browser = chromium
    if how == "argument":
        browser = chromium.browser_type.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu", "--disable-3d-apis"]
        )
    patch = (
        "const old = HTMLCanvasElement.prototype.getContext;"
        "HTMLCanvasElement.prototype.getContext = function (kind, ...more) {"
        " return kind.startsWith('webgl') ? null : old.call(this, kind, ...more); };"
        "const other = OffscreenCanvas.prototype.getContext;"
        "OffscreenCanvas.prototype.getContext = function (kind, ...more) {"
        " return kind.startsWith('webgl') ? null : other.call(this, kind, ...more); };"
    )
    try:
        with opened(
            browser, studio, script=patch if how == "patched" else "", viewport={"width": 900, "height": 640}
        ) as window:
            page = window.page
            stay = page.get_by_role("button", name="Begin anew")
            page.wait_for_function(
                "() => document.querySelector('dialog') || document.documentElement.dataset.exact.startsWith('proved')"
            )
            if stay.count():
                stay.click()
            window.begin(design_of([WING]))
            assert page.locator("#picture").is_hidden()
            seen = (
                "([x, y]) => [...document.getElementById('tiles').getContext('2d')"
                ".getImageData(x, y, 1, 1).data].join()"
            )
            box = page.locator("#overlay").bounding_box()

            def colours() -> set[str]:
                """The colours of four tiles."""
                places = (window.at(x, y) for x, y in ((14, 12), (14, 44), (46, 46), (44, 14)))
                return {page.evaluate(seen, [round(x - box["x"]), round(y - box["y"])]) for x, y in places}

            page.wait_for_function("() => document.documentElement.dataset.exact.startsWith('proved')")
            assert len(before := colours()) >= 2
            window.choose("Line 1")
            window.drag((25, 18), (24, 24))
            window.wait()
            assert page.locator("#tiles").is_visible()
            assert page.locator("#outlines").is_hidden()
            assert colours() == before
    finally:
        if browser is not chromium:
            browser.close()
