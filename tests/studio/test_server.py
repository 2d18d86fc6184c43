"""The studio as it runs: what it answers, what it keeps, and how it ends."""

from __future__ import annotations

import asyncio
import http.client
import json
import os
import signal
import socket
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest
from helpers.outline_drawings import FISH
from helpers.outlines import CommandLine
from helpers.running_studio import RunningStudio, running, tell, told
from helpers.solid_frames import read_frame
from test_lanes import is_alive, is_gone
from websockets.exceptions import ConnectionClosed

from voronoi_tiles.designs.starters import starter, starter_text
from voronoi_tiles.studio.server import bind

linux = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="only Linux tells whose processes there are")
"""For tests that look for processes."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a design."""
    made = tmp_path_factory.mktemp("studio")
    (made / "bird.toml").write_text(starter_text("p4"), encoding="utf-8")
    return made


@pytest.fixture(scope="module")
def studio(folder: Path) -> Iterator[RunningStudio]:
    """A studio at this design."""
    with running(folder, "bird.toml") as found:
        yield found


def test_a_design_is_answered_by_its_outline(studio: RunningStudio) -> None:
    """What is open is said first; each design is answered with its revision, one that is refused by the place."""
    with studio.page() as page:
        opened = told(page)
        assert (opened["type"], opened["file"], opened["saved"], opened["again"]) == (
            "opened",
            "bird.toml",
            True,
            False,
        )
        design = opened["design"]
        tell(page, "design", rev=1, design=design, rest=True)
        outline = told(page)
        assert (outline["type"], outline["rev"], outline["proved"]) == ("outline", 1, True)
        touching = {**design, "scale": 2.0, "site": [{"strokes": [{"segment": [[-5, 0], [20, 1]]}]}]}
        tell(page, "design", rev=2, design=touching, rest=False)
        refused = told(page)
        assert (refused["type"], refused["rev"], refused["lane"]) == ("refused", 2, "outline")
        x, y = refused["error"]["at"]
        assert -6 <= x <= 21  # in the coordinates of the drawing
        assert -2 <= y <= 2
        assert "touch" in refused["error"]["message"]
        assert "touch" not in refused["error"]["remedy"].partition(":")[0]
        tell(page, "design", rev=3, design={**design, "cell": {}}, rest=True)
        assert told(page)["error"]["key"] == "cell.a"
        tell(page, "job", rev=4, design=design, job={"sheet": "100x100mm"})
        product = told(page)
        assert (product["type"], product["rev"]) == ("product", 4)
        tell(page, "job", rev=5, design=design, job={"sheet": "x"})
        assert told(page)["error"]["key"] == "sheet"


def test_what_is_short_is_sent_at_once() -> None:
    """A proof follows its outline: no connection waits with it until what was sent before is acknowledged."""

    async def story() -> bool:
        listener = bind(0)
        served: asyncio.Queue[asyncio.StreamWriter] = asyncio.Queue()
        server = await asyncio.start_server(lambda _, writer: served.put_nowait(writer), sock=listener)
        async with server:
            _, page = await asyncio.open_connection(*listener.getsockname())
            writer = await served.get()
            option = writer.get_extra_info("socket").getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
            for end in (page, writer):
                end.close()
        return bool(option)

    assert asyncio.run(story())


def home_of(opened: Mapping[str, Any]) -> str:
    """How a page that comes again names the design that it has."""
    return quote(f"{opened['folder']}/{opened['file']}")


def test_a_page_that_is_reloaded_is_served(studio: RunningStudio) -> None:
    """One page at a time: the newer takes the place of the older, which is told so; one that comes again goes on."""
    with studio.page() as older:
        told(older)
        with studio.page() as newer:
            opened = told(newer)
            assert opened["type"] == "opened"
            with pytest.raises(ConnectionClosed) as caught:
                told(older)
            assert caught.value.rcvd is not None
            assert caught.value.rcvd.code == 4001
    with studio.page(query=f"?again={home_of(opened)}") as page:
        assert told(page)["again"] is True
    for other in ("", "1", home_of({**opened, "file": "leaf.toml"})):
        with studio.page(query=f"?again={other}") as page:
            assert told(page)["again"] is False


def test_a_design_is_answered_by_its_solid(studio: RunningStudio) -> None:
    """As a frame with its meshes; outlines go on meanwhile, and of solids that wait the newest alone is made."""
    with studio.page() as page:
        design = told(page)["design"]
        for rev in range(1, 20):
            tell(page, "solid", rev=rev, design=design, job={"height": rev, "clearance": 0.2})
        tell(page, "design", rev=1, design=design, rest=True)
        heard: list[dict[str, Any]] = []
        while not heard or heard[-1]["rev"] < 19:
            received = page.recv(timeout=60)
            if isinstance(received, str):
                assert json.loads(received)["type"] == "outline"
                continue
            message, pieces = read_frame(received)
            assert len(pieces) == message["count"]
            heard.append(message)
        assert len(heard) <= 2  # what was begun before the others came, and the last
        assert heard[-1]["tiles"][0]["size"][2] == 19.0
        tell(page, "solid", rev=20, design=design, job={"chamfer": 2})
        refused = told(page)
        assert (refused["type"], refused["lane"], refused["rev"]) == ("refused", "solid", 20)
        assert refused["error"]["key"] == "chamfer"


def test_outlines_do_not_wait_for_solids(studio: RunningStudio) -> None:
    """Of a slow loft a coarse one comes first; a design that is drawn meanwhile is answered before it."""
    with studio.page() as page:
        design = told(page)["design"]
        loft = {**design, "solid": {"height": 30, "turn": 5, "layers": 100, "about": [15, 10]}}
        tell(page, "solid", rev=1, design=loft, job={})
        heard: list[str] = []
        while heard[-1:] not in (["exact"], ["refused"]):
            received = page.recv(timeout=60)
            if isinstance(received, str):
                heard.append(json.loads(received)["type"])
                continue
            message, _ = read_frame(received)
            heard.append("coarse" if message["coarse"] else "exact")
            if message["coarse"]:
                tell(page, "design", rev=2, design=design, rest=True)
        assert heard == ["coarse", "outline", "exact"]


def test_solids_are_downloaded(studio: RunningStudio) -> None:
    """In the formats that there are, under the design's name; what cannot be is said, with its option."""
    design = json.loads(json.dumps(starter("p4").to_dict()))
    for form, kind in (("3mf", "model/3mf"), ("stl", "model/stl")):
        body = json.dumps({"design": design, "job": {"format": form}}).encode()
        answer = studio.ask("/solid", method="POST", body=body)
        assert answer.status == 200
        assert answer.headers["content-type"] == kind
        assert f"bird.{form}" in answer.headers["content-disposition"]
        assert len(answer.body) > 1000
    for job in ({"format": "svg"}, {"sheet": "../elsewhere.svg"}):
        answer = studio.ask("/solid", method="POST", body=json.dumps({"design": design, "job": job}).encode())
        assert answer.status == 422
        assert json.loads(answer.body)["key"] == next(iter(job))


@pytest.mark.slow
def test_thumbnails_wait(studio: RunningStudio) -> None:
    """For a job that is asked for after them; a design that has no tile is said, by its number."""
    with studio.page() as page:
        design = told(page)["design"]
        tell(page, "job", rev=1, design=design, job={})
        tell(page, "thumbnail", rev=3, design=design)
        tell(page, "job", rev=2, design=design, job={})
        heard = [told(page)]
        while heard[-1]["type"] != "thumbnail":
            heard.append(told(page))
        # The first job is done where it was begun before the second one came.
        assert [message["rev"] for message in heard][-2:] == [2, 3]
        assert heard[-1]["tiles"]
        tell(page, "thumbnail", rev=4, design={**design, "cell": {}})
        refused = told(page)
        assert (refused["type"], refused["lane"], refused["rev"]) == ("refused", "thumbnail", 4)
        assert refused["error"]["key"] == "cell.a"


def test_what_is_asked_for_by_address_is_answered(studio: RunningStudio) -> None:
    """The shader, the tables and the starters; nothing beyond the page's files; wrong methods are none of ours."""
    assert b"FETCH_BLOCK" in studio.ask("/gl/exact.glsl").body
    for name, kind in (("tables", dict), ("examples", list)):
        answer = studio.ask(f"/{name}.json")
        assert answer.headers["content-type"] == "application/json"
        assert isinstance(json.loads(answer.body), kind)
    climbing = (
        "/../server.py /%2e%2e/server.py /..%2fserver.py /page/../../server.py /gl/../../server.py /gl%5c..%5cx.js"
    )
    for path in (
        *climbing.split(),
        "//etc/passwd",
        "/.hidden",
        "/exact.glsl%00.js",
        "/index.html/",
        "/C:/x.js",
        "/no.js",
        f"/{'a' * 5000}.js",
    ):
        answer = studio.ask(path)
        assert answer.status == 404, path
        assert set(json.loads(answer.body)) == {"message", "remedy"}
    assert studio.ask("/export").status in (404, 405)
    assert studio.ask("/tables.json", method="POST").status == 405


def test_files_are_downloaded(studio: RunningStudio, folder: Path, voronoi_tiles: CommandLine) -> None:
    """The same bytes as the command line's for the saved design, as an attachment under the design's name."""
    design = tomllib.loads((folder / "bird.toml").read_text(encoding="utf-8"))
    body = json.dumps({"design": design, "job": {"sheet": "100x100mm", "format": "svg"}}).encode()
    answer = studio.ask("/export", method="POST", body=body)
    assert answer.status == 200
    assert answer.headers["content-disposition"] == "attachment; filename*=utf-8''bird.svg"
    assert answer.headers["content-type"].startswith("image/svg+xml")
    assert voronoi_tiles("export", "bird.toml", "-o", "x.svg", "--sheet", "100x100mm", cwd=folder).returncode == 0
    assert answer.body == (folder / "x.svg").read_bytes()
    dropped = studio.ask("/drop?name=bird.svg&units=mm", method="POST", body=answer.body)
    assert json.loads(dropped.body)["design"]["group"] == "p4"
    text = studio.ask("/toml", method="POST", body=json.dumps({"design": design}).encode())
    assert tomllib.loads(text.body.decode()) == design
    coupon = studio.ask("/coupon", method="POST", body=b'{"thickness": "3mm"}')
    assert coupon.headers["content-disposition"] == "attachment; filename*=utf-8''coupon.svg"


@pytest.mark.parametrize(
    ("path", "body", "status", "word"),
    [
        ("/export", b"{", 422, "JSON"),
        ("/export", b"[]", 422, "object"),
        ("/export", b"{}", 422, "design"),
        ("/export", b'{"design": {}}', 422, "missing"),
        ("/export", b'{"design": {}, "job": {"format": "exe"}}', 422, "exe"),
        ("/export", b'{"design": {}, "job": {"sheet": "/etc/passwd.svg"}}', 422, "outside"),
        ("/export", b'{"design": {}, "name": "\\u0007"}', 422, "name"),
        ("/export", b"x" * (1 << 20) + b"x", 413, "large"),
        ("/coupon", b'{"thickness": "thick"}', 422, "thick"),
        ("/coupon", b'{"thickness": 3, "preset": "../../x.toml"}', 422, "outside"),
        ("/export", b'{"design": {}, "format": "dxf"}', 422, "'format'"),
        ("/toml", b'{"design": {}, "job": {}}', 422, "'job'"),
        ("/toml", b'{"design": 3}', 422, "object"),
        ("/drop?name=x.svg", b"<svg/>", 422, "units"),
        ("/drop?name=x.svg&units=mm", b"<svg", 422, "x.svg"),
        ("/drop?name=x.txt&units=mm", b"hello", 422, "neither"),
        ("/fits?name=x.svg", b"<svg", 422, "x.svg"),
        ("/fits?name=x.png", b"\x89PNG", 422, "pixels"),
        ("/fits/art", b'{"number": 1}', 422, "another search"),
        ("/fits/art", b'{"file": "../x.svg"}', 422, "file"),
    ],
)
def test_requests_that_cannot_be_done_are_refused(
    studio: RunningStudio, path: str, body: bytes, status: int, word: str
) -> None:
    """By one error for people, with what to do about it."""
    answer = studio.ask(path, method="POST", body=body)
    error = json.loads(answer.body)
    assert answer.status == status
    assert word in f"{error['message']} {error.get('key')}"
    assert error["remedy"]
    assert "Traceback" not in answer.body.decode()


def test_a_design_is_saved_as_it_is_drawn(studio: RunningStudio, folder: Path) -> None:
    """The file's own text with what has changed; others' changes are noticed, and never overwritten unasked."""
    file = folder / "bird.toml"
    before = file.read_text(encoding="utf-8")
    with studio.page() as page:
        design = told(page)["design"]
        design["cell"]["a"] = 61
        tell(page, "save", rev=9, design=design, over=False)
        assert told(page, "saved")["rev"] == 9
        after = file.read_text(encoding="utf-8")
        pairs = zip(before.splitlines(), after.splitlines(), strict=True)
        assert len([pair for pair in pairs if pair[0] != pair[1]]) == 1
        file.write_text(after.replace("61", "62"), encoding="utf-8")
        assert told(page, "changed")["design"]["cell"]["a"] == 62
        design["cell"]["a"] = 63
        tell(page, "save", rev=10, design=design, over=False)
        conflict = told(page)
        assert (conflict["type"], conflict["rev"], conflict["design"]["cell"]["a"]) == ("conflict", 10, 62)
        assert "62" in file.read_text(encoding="utf-8")
        tell(page, "reload")
        assert told(page)["design"]["cell"]["a"] == 62
        design["cell"]["a"] = 60
        tell(page, "save", rev=11, design=design)
        told(page, "saved")
    assert file.read_text(encoding="utf-8") == before


def test_what_changed_while_the_page_was_away_is_not_overwritten(studio: RunningStudio, folder: Path) -> None:
    """A page that has lost its connection comes again with what it has, and saves: that is a conflict all the same."""
    file = folder / "bird.toml"
    before = file.read_text(encoding="utf-8")
    with studio.page() as page:
        opened = told(page)
    design = opened["design"]
    file.write_text(before.replace("60", "62"), encoding="utf-8")
    with studio.page(query=f"?again={home_of(opened)}") as page:
        assert told(page)["design"] == design
        tell(page, "save", rev=1, design={**design, "cell": {"a": 63}})
        assert told(page, "conflict")["design"]["cell"]["a"] == 62
        file.write_text(before, encoding="utf-8")


@linux
def test_an_export_that_is_given_up_is_not_made(tmp_path: Path) -> None:
    """Who hangs up has the worker ended that makes the file: whatever comes next does not wait for it."""
    body = json.dumps(
        {"design": tomllib.loads(starter_text("p4")), "job": {"sheet": "2000x2000mm", "kerf": 0.15}}
    ).encode()
    with running(tmp_path, "bird.toml") as studio:
        assert studio.ask("/tables.json").status == 200
        (outliner,) = studio.workers()
        export = http.client.HTTPConnection("127.0.0.1", studio.port)
        export.request("POST", "/export", body, studio.ours)
        end = time.monotonic() + 60
        while not (found := [pid for pid in studio.workers() if pid != outliner]) and time.monotonic() < end:
            time.sleep(0.02)
        (worker,) = found
        time.sleep(0.3)  # it starts, or has begun
        assert is_alive(worker)
        export.close()
        assert is_gone(worker)
        assert is_alive(outliner)
        assert studio.ask("/coupon", method="POST", body=b'{"thickness": "3mm"}').status == 200


def descendants(pid: int) -> set[int]:
    """The processes that a process has started, those that these have started, and so on."""
    parents = {}
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError, ValueError):
            parents[int(folder.name)] = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
    found = {pid}
    while more := {child for child, parent in parents.items() if parent in found} - found:
        found |= more
    return found - {pid}


@linux
@pytest.mark.parametrize("killed", [False, True])
def test_a_search_for_fits_delays_and_outlives_nobody(tmp_path: Path, killed: bool) -> None:
    """Outlines are answered while it goes on, by its own worker; where who asked hangs up it ends, and with the studio.

    All of its processes do, also those that its worker has started.
    """
    with running(tmp_path) as studio, studio.page() as page:
        design = told(page)["design"]
        tell(page, "design", rev=1, design=design, rest=True)
        told(page, "outline")
        before = descendants(studio.process.pid)
        search = http.client.HTTPConnection("127.0.0.1", studio.port, timeout=60)
        search.request("POST", "/fits?name=fish.svg", FISH.encode(), studio.ours)
        answer = search.getresponse()
        assert answer.status == 200
        assert json.loads(answer.readline()) == {"type": "outline", "notes": []}
        assert json.loads(answer.readline())["type"] == "progress"  # of 13 groups one is looked through
        tell(page, "design", rev=2, design=design, rest=True)
        assert told(page, "outline")["rev"] == 2
        looking = descendants(studio.process.pid) - before
        assert looking
        rank = os.getpriority(os.PRIO_PROCESS, studio.process.pid)
        assert all(os.getpriority(os.PRIO_PROCESS, pid) > min(rank, 18) for pid in looking)
        if killed:
            studio.process.kill()
            assert all(map(is_gone, looking))
        answer.close()
        search.close()
        assert all(map(is_gone, looking))
        assert killed or all(map(is_alive, before))


@linux
def test_no_process_outlives_a_studio_that_is_killed(tmp_path: Path) -> None:
    """Whatever it and its workers do: nothing is left to be cleaned up, and the file is whole."""
    with running(tmp_path) as studio, studio.page() as page:
        design = told(page)["design"]
        tell(page, "design", rev=1, design=design, rest=True)
        told(page, "outline")
        tell(page, "thumbnail", rev=2, design=design)
        workers = studio.workers()
        assert workers
        studio.process.kill()
        assert all(map(is_gone, workers))


@pytest.mark.slow
def test_what_was_drawn_is_found_again_after_kill(tmp_path: Path) -> None:
    """A studio that is killed leaves a whole file, and what was drawn a second ago."""
    (tmp_path / "bird.toml").write_text(starter_text("p4"), encoding="utf-8")
    with running(tmp_path, "bird.toml") as studio, studio.page() as page:
        design = told(page)["design"]
        design["cell"]["a"] = 70
        tell(page, "design", rev=1, design=design, rest=True)
        told(page, "outline")
        tell(page, "bye")
        tell(page, "reload")  # which is answered when all before it is done
        told(page, "opened")
        studio.process.kill()
    assert tomllib.loads((tmp_path / "bird.toml").read_text(encoding="utf-8"))["cell"]["a"] == 60
    with running(tmp_path, "bird.toml") as studio, studio.page() as page:
        assert told(page)["recovery"]["design"]["cell"]["a"] == 70


@linux
@pytest.mark.parametrize(
    ("name", "code", "word"),
    [
        ("SIGINT", 0, "studio ended"),
        pytest.param("SIGTERM", 143, "", marks=pytest.mark.slow),
        pytest.param("SIGHUP", 129, "", marks=pytest.mark.slow),
    ],
)
def test_signals_end_it_in_good_order(
    tmp_path: Path,
    name: str,
    code: int,
    word: str,
    heard_signals: None,  # noqa: ARG001 - it only has to be there
) -> None:
    """With its workers, whatever they do, and with a page open; it says no more than that."""
    with running(tmp_path) as studio, studio.page() as page:
        design = told(page)["design"]
        tell(page, "design", rev=1, design=design, rest=True)
        told(page, "outline")
        tell(page, "thumbnail", rev=1, design=design)
        workers = studio.workers()
        assert workers
        assert all(map(is_alive, workers))
        assert studio.end(getattr(signal, name)) == (code, f"{word}\n" if word else "")
        assert all(map(is_gone, workers))


@pytest.mark.skipif(not hasattr(signal, "SIGPIPE"), reason="no such signal here")
def test_connections_that_break_end_nothing(tmp_path: Path) -> None:
    """What tells a command that its reader has hung up tells the studio of one connection of many."""
    with running(tmp_path) as studio:
        studio.process.send_signal(signal.SIGPIPE)
        with studio.page() as page:
            assert told(page)["type"] == "opened"
        assert studio.process.poll() is None


@linux
@pytest.mark.slow
def test_a_worker_that_is_killed_is_replaced(studio: RunningStudio) -> None:
    """The page is told of what it waited for, and the next design is answered."""
    with studio.page() as page:
        design = told(page)["design"]
        tell(page, "design", rev=1, design=design, rest=True)
        told(page, "outline")
        for worker in studio.workers():
            subprocess.run(["kill", "-9", str(worker)], check=True)  # noqa: S607 - that of the system
        tell(page, "design", rev=2, design=design, rest=True)
        answer = told(page)
        if answer["type"] == "refused":
            assert "started again" in answer["error"]["message"]
            tell(page, "design", rev=3, design=design, rest=True)
            answer = told(page)
        assert answer["type"] == "outline"


def test_the_port_may_be_in_use(tmp_path: Path, voronoi_tiles: CommandLine) -> None:
    """One message, and exit code 2."""
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        done = voronoi_tiles("studio", "--port", port, "--no-browser", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"Error: the --port {port} is in use.")
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("name", "text", "word"),
    [
        ("broken.toml", "a = [", "broken.toml"),
        ("broken.json", "[3]", "broken.json"),
        ("leaf.svg", "<svg/>", "drawing"),
        ("-", None, "saves"),
    ],
)
def test_what_is_no_design_is_refused(
    tmp_path: Path, voronoi_tiles: CommandLine, name: str, text: str | None, word: str
) -> None:
    """Before there is a page: one message that names the file, and exit code 2."""
    if text is not None:
        (tmp_path / name).write_text(text, encoding="utf-8")
    own = {**os.environ, "XDG_STATE_HOME": str(tmp_path / "state")}
    done = voronoi_tiles("studio", name, "--no-browser", cwd=tmp_path, environment=own)
    assert (done.returncode, done.stdout) == (2, "")
    assert word in done.stderr
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.slow
def test_without_a_browser_the_address_is_said(
    tmp_path: Path,
    heard_signals: None,  # noqa: ARG001 - it only has to be there
) -> None:
    """On standard error, with the reason; the studio goes on until it is ended."""
    said = tmp_path / "said.txt"
    script = (
        "import sys, webbrowser\n"
        "def get(): raise webbrowser.Error('none')\n"
        "webbrowser.get = get\n"
        "sys.argv[1:] = ['studio']\n"
        "from voronoi_tiles.cli.main import run; run()\n"
    )
    own = {**os.environ, "XDG_STATE_HOME": str(tmp_path)}
    with said.open("w") as errors:
        studio = subprocess.Popen([sys.executable, "-c", script], stdout=errors, stderr=errors, cwd=tmp_path, env=own)
    with studio:
        end = time.monotonic() + 60
        while said.read_text().count("\n") < 2 and time.monotonic() < end:
            time.sleep(0.05)
        studio.send_signal(signal.SIGINT)
        assert studio.wait(timeout=60) == 0
    lines = said.read_text().splitlines()
    assert lines[0].startswith("studio at http://127.0.0.1:")
    assert "open the address yourself" in lines[1]
    assert lines[2:] == ["studio ended"]


def test_the_browser_is_opened_by_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The secret is on no command line: a file that only we may read leads to the address, and is removed."""
    import webbrowser

    from voronoi_tiles.studio.browser import Browser

    opened: list[tuple[str, int, str]] = []

    class Fake:
        """A browser."""

        name = "fake"

        def open(self, url: str) -> bool:
            """Take an address."""
            path = Path(url.removeprefix("file://"))
            opened.append((url, path.stat().st_mode & 0o777, path.read_text()))
            return True

    monkeypatch.setattr(webbrowser, "get", Fake)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    said: list[str] = []
    with Browser(said.append) as browser:
        browser.open("http://127.0.0.1:1/?token=secret")
        assert browser.opening is not None
        browser.opening.join()
    ((url, mode, text),) = opened
    assert "secret" not in url
    assert mode == 0o600
    assert 'content="0;url=http://127.0.0.1:1/?token=secret"' in text
    assert list(tmp_path.iterdir()) == []
    assert len(said) == 1
    monkeypatch.setattr(Fake, "name", "/usr/bin/w3m")
    with Browser(said.append) as browser:
        browser.open("http://127.0.0.1:1/?token=secret")
        assert browser.opening is not None
        browser.opening.join()
    assert len(opened) == 1
    assert "yourself" in said[-1]


@pytest.mark.slow
def test_a_design_of_any_name_is_downloaded(tmp_path: Path) -> None:
    """Where the page names it not."""
    name = "a\u200b" + "b" * 150
    (tmp_path / f"{name}.toml").write_text(starter_text("p4"), encoding="utf-8")
    with running(tmp_path, f"{name}.toml") as studio:
        body = json.dumps({"design": starter("p4").to_dict(), "job": {"format": "json"}}).encode()
        answer = studio.ask("/export", method="POST", body=body)
        assert (answer.status, answer.headers["content-disposition"][-6:]) == (200, "b.json")


@pytest.mark.slow
def test_two_studios_at_one_file_are_said(tmp_path: Path) -> None:
    """The second is told of the first, and neither overwrites the other unasked."""
    (tmp_path / "bird.toml").write_text(starter_text("p4"), encoding="utf-8")
    at = running(tmp_path, "bird.toml"), running(tmp_path, "bird.toml")
    with at[0] as first, at[1] as second, first.page() as one, second.page() as two:
        design = told(one)["design"]
        assert "nother studio" in told(two)["note"]
        tell(one, "save", rev=1, design={**design, "cell": {"a": 71}}, over=False)
        told(one, "saved")
        tell(two, "save", rev=1, design={**design, "cell": {"a": 72}}, over=False)
        assert told(two, "conflict")["design"]["cell"]["a"] == 71


@pytest.mark.slow
def test_a_new_design_is_a_starter(tmp_path: Path) -> None:
    """Without a name it is the starter of p4, under a name that is free, and nothing is written yet."""
    (tmp_path / "design.toml").write_text(starter_text("p1"), encoding="utf-8")
    with running(tmp_path) as studio, studio.page() as page:
        opened = told(page)
        assert (opened["file"], opened["saved"]) == ("design-2.toml", False)
        assert opened["design"] == json.loads(json.dumps(starter("p4").to_dict()))
        assert not (tmp_path / "design-2.toml").exists()
