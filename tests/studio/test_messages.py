"""What the page sends is read, checked and bounded: whatever comes, there is one error for people, and no more."""

from __future__ import annotations

import json
import random
import time
from collections.abc import Iterator
from contextlib import suppress
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from helpers.running_studio import RunningStudio, running, tell, told
from websockets.exceptions import ConnectionClosed

from voronoi_tiles.base.errors import ArgumentError, DesignError, OutputError, TouchingCopiesError
from voronoi_tiles.base.operations import Operation
from voronoi_tiles.designs.starters import starter, starter_text
from voronoi_tiles.studio.messages import (
    FILES_MAX,
    DesignMessage,
    JobMessage,
    NewMessage,
    ReloadMessage,
    SaveMessage,
    SolidMessage,
    ThumbnailMessage,
    check_files,
    named_files,
    read_message,
    read_object,
)
from voronoi_tiles.studio.refusals import error_document, refusal

DESIGN = json.loads(json.dumps(starter("p4").to_dict()))


def read(**message: Any) -> object:
    """A message, read."""
    return read_message(read_object(json.dumps(message)))


def test_messages_are_read() -> None:
    """Each kind, with what may be left out."""
    assert read(type="design", rev=1, design=DESIGN) == DesignMessage(1, DESIGN, True, None)
    moving = read(type="design", rev=1, design=DESIGN, rest=False, tolerance=1)
    assert moving == DesignMessage(1, DESIGN, False, 1.0)
    job = read(type="job", rev=2, design=DESIGN, job={"kerf": 0.1, "sheet": [1, 2], "tabs": None}, limits={"neck": 1})
    assert job == JobMessage(2, DESIGN, {"kerf": 0.1, "sheet": [1, 2]}, {"neck": 1})
    assert read(type="solid", rev=7, design=DESIGN, job={"height": 5}) == SolidMessage(7, DESIGN, {"height": 5})
    assert read(type="solid", rev=8, design=DESIGN) == SolidMessage(8, DESIGN, {})
    assert read(type="thumbnail", rev=3, design=DESIGN) == ThumbnailMessage(3, DESIGN)
    assert read(type="save", rev=4, design=DESIGN, over=True) == SaveMessage(4, DESIGN, True)
    assert read(type="reload") == ReloadMessage()
    assert read(type="new", rev=5, design=DESIGN) == NewMessage(5, DESIGN, "")
    assert read(type="new", rev=6, design=DESIGN, name="leaf") == NewMessage(6, DESIGN, "leaf")


BROKEN = (
    *("", "{", "[]", "3", "null", '"x"', "{} {}", '{"a": NaN}', '{"a": Infinity}', '{"a": 1e999}', "{'a': 1}"),
    *('{"a": "\\ud800"}', '{"\\udfff": 1}', f'{{"a": {"9" * 5000}}}', f'{{"a": {"[" * 17}{"]" * 17}}}', "\0"),
    *('{"a": ' * 100_000, "[" * 1_000_000, '{"type": 3}', '{"type": "design"}', '{"type": ["design"]}', "{}"),
    *(f'{{"type": "design", "design": {{}}, "rev": {rev}}}' for rev in ("-1", "1.5", "true", '"1"', "null", "1e20")),
    *(f'{{"type": "design", "rev": 1, "design": {design}}}' for design in ("3", "null", "[]", '"x"')),
    *(f'{{"type": "design", "rev": 1, "design": {{}}, "tolerance": {t}}}' for t in ("0", "-1", '"1"', "true", "[]")),
    *(f'{{"type": "design", "rev": 1, "design": {{}}, "rest": {rest}}}' for rest in ("0", '"x"', "null", "[]")),
    *(f'{{"type": "job", "rev": 1, "design": {{}}, "job": {job}}}' for job in ("3", '"x"', "[1]", '{"kerf": {}}')),
    *(
        '{"type": "solid", "rev": 1, "design": {}, "limits": {}}',
        '{"type": "solid", "rev": 1, "design": {}, "job": []}',
    ),
    *('{"type": "new", "name": "leaf"}', '{"type": "new", "rev": 1, "design": {}, "name": 3}'),
    *('{"type": "reload", "rev": 1}', '{"type": "design", "rev": 1, "design": {}, "job": {}}'),
    *('{"type": "job", "rev": 1, "design": {}, "limits": 3}', '{"type": "save", "rev": 1, "design": {}, "over": 1}'),
)
"""What no page of ours sends."""


@pytest.mark.parametrize("text", BROKEN, ids=lambda text: text[:50])
def test_what_is_no_message_is_refused(text: str) -> None:
    """By one short error, and in no time."""
    begun = time.process_time()
    with pytest.raises(ArgumentError) as caught:
        read_message(read_object(text))
    assert len(str(caught.value)) < 400
    assert caught.value.remedy
    assert time.process_time() - begun < 2.0


@pytest.mark.parametrize(
    ("strokes", "word"),
    [
        ([{"point": [1, 2]}] * 2001, "2,001 strokes"),
        ([{"polyline": [[0, k] for k in range(20_001)]}], "20,001 points"),
        ([{"path": "M 0 0" + " L 1 2" * 20_000}], "20,001 points"),
        ([{"path": "M0,0" + "l1-2" * 20_000}], "20,001 points"),
        ([{"bezier": [[0, k] for k in range(15_001)]}, {"hermite": [], "tangents": [[0, 1]] * 5_000}], "20,001 points"),
    ],
)
def test_designs_are_bounded(strokes: list[Any], word: str) -> None:
    """A design that would take seconds is refused before it is begun; one less is not."""
    design = {**DESIGN, "site": [{"strokes": strokes[:-1]}, {"strokes": strokes[-1:]}]}
    with pytest.raises(DesignError, match=word):
        read(type="design", rev=1, design=design)
    design["site"][0]["strokes"] = design["site"][0]["strokes"][:-1]
    fewer = json.loads(json.dumps(design).replace("[0, 20000]", "[]").replace(" L 1 2", "", 1).replace("l1-2", "", 1))
    read(type="design", rev=1, design={**fewer})


def test_files_stay_in_the_folder(tmp_path: Path) -> None:
    """What a page names lies in the design's folder, whatever it is called; what the design on disk names may not."""
    home, outside = tmp_path / "home", tmp_path / "outside"
    for folder in (home, home / "art", outside):
        folder.mkdir()
    (home / "link.svg").symlink_to(outside / "x.svg")
    (home / "folder").symlink_to(outside)

    def design(name: object) -> dict[str, Any]:
        """A design with this file in a stroke."""
        return {"site": [{"strokes": [{"point": [1, 1]}, {"file": name}]}]}

    for name in ("x.svg", "art/x.svg", "./x.svg", "art/../x.svg", "ä ö.svg", 3, None, ["/etc/passwd"]):
        check_files(design(name), {}, str(home), ())
    for name in (
        "../outside/x.svg",
        "/etc/passwd",
        "link.svg",
        "folder/x.svg",
        str(outside / "x.svg"),
        "x\0.svg",
        "..",
    ):
        for table, key in (
            (design(name), "site[0].strokes[1].file"),
            ({"site": [{"art": {"file": name}}]}, "site[0].art.file"),
            ({"site": [{"art": name}]}, "site[0].art.file"),
            ({"key": [{"strokes": [{"file": name}]}]}, "key[0].strokes[0].file"),
        ):
            with pytest.raises(DesignError) as caught:
                check_files(table, {}, str(home), ())
            assert caught.value.key == key
            check_files(table, {}, str(home), {name})
            assert named_files(table) == {name}
    for job in ({"sheet": "../x.svg"}, {"sheet": "/x.DXF"}, {"layout": "../x.pdf"}, {"preset": "../x.toml"}):
        with pytest.raises(DesignError, match="outside"):
            check_files({}, job, str(home), ())
    check_files({}, {"sheet": "300x200mm", "preset": "plain"}, str(home), ())


def test_errors_are_for_people() -> None:
    """Each says what is wrong and what to do, with the key or the place; the bugs too, and nobody's folders."""
    touching = TouchingCopiesError("bird", "bird", Operation.parse("-x,-y"), 3 + 4j)
    assert error_document(touching, 2.0)["at"] == [1.5, 2.0]
    wrong = error_document(DesignError("is missing", key="cell.a", remedy="Write it.", file="leaf.svg", line=3))
    assert wrong == {"message": "leaf.svg: line 3: is missing.", "remedy": "Write it.", "key": "cell.a"}
    assert error_document(OutputError("the disk is full", "x"))["message"] == "the disk is full."
    for error in (ValueError("x"), MemoryError(), RecursionError(), OSError(28, "No space left"), KeyError()):
        told_ = error_document(error)
        assert set(told_) == {"message", "remedy"}
        assert all(told_.values())
    assert refusal({"type": "save", "rev": 3}, ValueError("x"))["type"] == "failed"
    assert refusal({"type": "job", "rev": 3}, ValueError("x"))["lane"] == "job"
    assert refusal({"type": "design", "rev": "x"}, ValueError("x"))["type"] == "trouble"
    assert refusal({"type": "thumbnail", "rev": 3}, {"message": "m"})["error"] == {"message": "m"}


# --- against a running studio -----------------------------------------------------------------------------------


def hostile(dice: random.Random) -> str:
    """A message that wishes nobody well."""
    values: list[Any] = [
        *(None, True, -1, 0, 1e308, -1e-308, 2**60, "", "x" * 5000, "../../secret.svg", "/etc/passwd", "\0", "\u202e"),
        *([], {}, [[]], [None] * 50, {"__proto__": {}}, "<script>", "$(id)", "file:///etc/passwd", "-", "secret.svg"),
        *([[0, 0], [1, 1]], [1e300, 1e300], [[0, 0]] * 30, {"file": "link.svg"}, {"file": "../secret.svg"}),
    ]
    design = json.loads(json.dumps(DESIGN))
    message: dict[str, Any] = {"type": dice.choice(["design", "job", "thumbnail", "save"]), "rev": 1, "design": design}
    message |= {"rest": dice.random() < 0.5, "job": {dice.choice(["kerf", "sheet", "preset", "format"]): "x"}}
    for _ in range(dice.randint(1, 4)):  # somewhere in it
        place: Any = message
        while True:
            keys = list(place) if isinstance(place, dict) else list(range(len(place)))
            key = dice.choice([*keys, *(("file", "art", "scale", "strokes") if isinstance(place, dict) else ())])
            inner = place[key] if key in keys else None
            if isinstance(inner, dict | list) and inner and dice.random() < 0.7:
                place = inner
                continue
            place[key] = deepcopy(dice.choice(values))
            break
    text = json.dumps(message)
    cut = dice.random()
    return text[: dice.randrange(len(text))] if cut < 0.1 else text.replace("0", "1e999", 1) if cut < 0.15 else text


def contents(folder: Path) -> dict[str, object]:
    """All files of a folder, with what is in them and when they were written."""
    return {
        str(path): (path.lstat().st_mtime_ns, path.read_bytes() if path.is_file() else None)
        for path in folder.rglob("*")
    }


def memory(process: int) -> int:
    """The most memory that a process has had; bytes."""
    status = Path(f"/proc/{process}/status").read_text()
    return 1024 * int(next(line for line in status.splitlines() if line.startswith("VmHWM")).split()[1])


@pytest.fixture(scope="module")
def studio(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningStudio]:
    """A studio in a folder with links out of it, and with a secret beside it."""
    top = tmp_path_factory.mktemp("hostile")
    (top / "secret.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="7mm" height="7mm" viewBox="0 0 7 7">'
        '<path d="M1 1 L5 4.321" stroke="black"/></svg>'
    )
    home = top / "home"
    home.mkdir()
    (home / "link.svg").symlink_to(top / "secret.svg")
    (home / "bird.toml").write_text(starter_text("p4"), encoding="utf-8")
    with running(home, "bird.toml") as found:
        yield found


KINDS = {"outline", "refused", "product", "group", "trouble", "saved", "failed", "conflict", "changed"}


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="only Linux tells how much memory processes have")
def test_a_thousand_hostile_messages(studio: RunningStudio) -> None:
    """The studio lives on, answers what is asked next, touches nothing outside its folder, and stays small."""
    top = studio.said.parents[1]
    outside = {path: what for path, what in contents(top).items() if "/home" not in path}
    dice = random.Random(14)  # noqa: S311 - no secrets
    with studio.page() as page:
        told(page)
        for k in range(1000):
            page.send(hostile(dice) if k % 100 else bytes([dice.randrange(256)]))
            if k % 100 == 99:
                tell(page, "design", rev=10_000 + k, design=DESIGN, rest=True)
                while True:
                    message = told(page)
                    assert message["type"] in KINDS
                    text = json.dumps(message)
                    assert "4.321" not in text
                    assert "Traceback" not in text
                    assert "This is a bug" not in text, text[:2000]
                    if message.get("rev") == 10_000 + k:
                        assert message["type"] == "outline"
                        break
        for process in (studio.process.pid, *studio.workers()):
            assert memory(process) < 600 << 20
    assert {path: what for path, what in contents(top).items() if "/home" not in path} == outside
    assert studio.said.read_text() == ""


@pytest.mark.parametrize("name", ["../secret.svg", "link.svg", "{top}/secret.svg"])
def test_a_page_reads_no_file_elsewhere(studio: RunningStudio, name: str) -> None:
    """Neither as a stroke of whatever is asked for, nor as a sheet."""
    file = name.format(top=studio.said.parents[1])
    strokes = {**DESIGN, "site": [{"strokes": [{"file": file}]}]}
    with studio.page() as page:
        told(page)
        for kind, more in (
            ("design", {"design": strokes}),
            ("job", {"design": strokes}),
            ("job", {"design": DESIGN, "job": {"sheet": file}}),
            ("thumbnail", {"design": strokes}),
            ("save", {"design": strokes}),
        ):
            tell(page, kind, rev=1, **more)
            assert "outside" in told(page)["error"]["message"]


def test_a_message_that_is_too_large_ends_the_connection(studio: RunningStudio) -> None:
    """It is not read to its end; the page comes again and is served."""
    with studio.page() as page:
        told(page)
        page.send("x" * (1 << 20))  # as large as may be: no JSON
        assert told(page)["type"] == "trouble"
        with suppress(ConnectionClosed):  # by the other end, at some time
            page.send("x" * (4 << 20))
        with pytest.raises(ConnectionClosed):
            told(page)
    with studio.page() as page:
        assert told(page)["type"] == "opened"


def test_who_sends_and_never_reads_is_not_waited_for(studio: RunningStudio) -> None:
    """Answers that nobody takes do not pile up: the newest wins, and another page is served."""
    with studio.page() as page:
        for k in range(300):
            tell(page, "design", rev=k, design=DESIGN, rest=False)
        with studio.page() as other:
            assert told(other)["type"] == "opened"
            tell(other, "design", rev=1, design=DESIGN, rest=True)
            assert told(other, "outline")["rev"] == 1


@pytest.mark.parametrize(
    "site",
    [
        [{"art": "a/" * 500_000}],
        [{"art": "a/" * 480 + f"{k}.svg"} for k in range(1_000)],
        [{"strokes": [{"file": f"{k}.svg"}]} for k in range(50_000)],
        [{"art": "same.svg"}] * 70_000,
    ],
    ids=["one", "long", "many", "same"],
)
def test_files_are_looked_for_in_no_time(tmp_path: Path, site: list[Any]) -> None:
    """Whoever names them a million letters long, or by the thousand: the server answers others meanwhile."""
    took = []
    for _ in range(3):  # garbage of tests before may be collected in one of them
        begun = time.process_time()
        with suppress(DesignError):
            check_files({"site": site}, {}, str(tmp_path), ())
        took.append(time.process_time() - begun)
    assert min(took) < 0.5


def test_the_files_of_a_design_are_counted(tmp_path: Path) -> None:
    """Each once, and none of its own."""
    many = [f"{k}.svg" for k in range(FILES_MAX + 1)]
    check_files({"site": [{"art": name} for name in many[1:] * 2]}, {}, str(tmp_path), ())
    check_files({"site": [{"art": name} for name in many]}, {}, str(tmp_path), many[:1])
    with pytest.raises(DesignError, match="names 201 files"):
        check_files({"site": [{"art": name} for name in many]}, {}, str(tmp_path), ())
    with pytest.raises(DesignError, match="too long"):
        check_files({"site": [{"art": "x" * 1_001}]}, {}, str(tmp_path), ())
