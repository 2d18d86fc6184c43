"""The file behind the studio: whole whatever happens, nobody's work overwritten, what was not saved found again."""

from __future__ import annotations

import errno
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable, Iterator
from contextlib import closing
from copy import deepcopy
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from voronoi_tiles.base.errors import DesignError, OutputError
from voronoi_tiles.designs.starters import starter_text
from voronoi_tiles.studio.design_document import Document

AS_ROOT = hasattr(os, "geteuid") and os.geteuid() == 0

TEXT = """\
# Mine.
schema = 1
group = "p4"

[cell]
a = 60.0   # side

# The bird.
[[site]]
strokes = [
  { segment = [[20, 15], [4, 41]] },   # the body
  # its eye
  { point = [39.0, 15] },
]
"""


@pytest.fixture(autouse=True)
def state(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A state folder of the test's own."""
    folder = tmp_path_factory.mktemp("state")
    monkeypatch.setenv("XDG_STATE_HOME", str(folder))
    return folder / "voronoi-tiles" / "studio"


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A design in the folder where we are."""
    folder = tmp_path / "work"
    folder.mkdir()
    monkeypatch.chdir(folder)
    (folder / "bird.toml").write_bytes(TEXT.encode())
    return folder / "bird.toml"


@pytest.fixture
def opens() -> Iterator[Callable[..., Document]]:
    """Opens documents, which are closed at the end."""
    documents = []

    def opened(path: str | None = "bird.toml", **more: Any) -> Document:
        documents.append(Document.open(path, **more))
        return documents[-1]

    yield opened
    for document in documents:
        document.close()


def design_of(document: Document) -> dict[str, Any]:
    """The design as a page gets it: through JSON, with numbers as JavaScript writes them."""
    design = json.loads(json.dumps(document.opened()["design"], allow_nan=False), parse_float=_number)
    assert isinstance(design, dict)
    return design


def _number(text: str) -> float:
    """A number as JavaScript has it."""
    return int(float(text)) if float(text).is_integer() else float(text)


def moved(design: dict[str, Any], by: float = 0.5) -> dict[str, Any]:
    """The design with a point moved."""
    design = deepcopy(design)
    design["site"][0]["strokes"][1]["point"][0] += by
    return design


def copies(state: Path) -> list[Path]:
    """The recovery copies that there are."""
    return sorted(state.glob("*.json"))


Opens = Callable[..., Document]


def test_a_design_is_opened(file: Path, opens: Opens) -> None:
    """With its file, its folder and what it says."""
    document = opens()
    assert document.opened() == {
        "file": "bird.toml",
        "folder": str(file.parent),
        "design": tomllib.loads(TEXT),
        "saved": True,
    }
    assert (document.path, document.folder, document.name) == (str(file), str(file.parent), "bird")


def test_an_unchanged_design_is_not_written(file: Path, opens: Opens) -> None:
    """Its bytes and its time stay."""
    before = file.stat()
    document = opens()
    assert document.save(design_of(document)) == {"type": "saved", "file": "bird.toml"}
    after = file.stat()
    assert (file.read_bytes(), after.st_mtime_ns, after.st_ino) == (TEXT.encode(), before.st_mtime_ns, before.st_ino)


def test_a_save_keeps_the_layout(file: Path, opens: Opens) -> None:
    """One point moved is one number in the file; again and again."""
    document = opens()
    design = design_of(document)
    for by in (0.5, 7, 1.25):
        design = moved(design, by)
        document.save(design)
    assert file.read_bytes() == TEXT.replace("39.0", "47.75").encode()
    assert document.changed() is None


@pytest.mark.parametrize("bom", [b"", b"\xef\xbb\xbf"], ids=["plain", "bom"])
@pytest.mark.parametrize("newline", ["\n", "\r\n"], ids=["lf", "crlf"])
@pytest.mark.parametrize("ended", [True, False], ids=["ended", "cut"])
def test_line_ends_and_the_byte_order_mark_stay(
    file: Path, opens: Opens, bom: bytes, newline: str, ended: bool
) -> None:
    """As Windows' editors write them, and with a last line that does not end."""
    text = TEXT if ended else TEXT.rstrip()
    file.write_bytes(bom + text.replace("\n", newline).encode())
    document = opens()
    document.save(moved(design_of(document)))
    assert file.read_bytes() == bom + text.replace("39.0", "39.5").replace("\n", newline).encode()


@pytest.mark.parametrize("indent", [None, 1, 2, "\t"])
def test_json_stays_json(file: Path, opens: Opens, indent: int | str | None) -> None:
    """With its indent, its order of keys and its kinds of numbers."""
    path = file.with_name("bird.json")
    point: list[float] = [1.0, 2]
    site = {"name": "ü", "strokes": [{"point": point}]}
    design = {"group": "p1", "schema": 1, "cell": {"a": 60.0}, "site": [site]}
    path.write_text(json.dumps(design, indent=indent, ensure_ascii=False) + "\n", encoding="utf-8")
    document = opens("bird.json")
    read = design_of(document)
    read["site"][0]["strokes"][0]["point"][1] = 2.5
    document.save(read)
    point[1] = 2.5
    assert path.read_text(encoding="utf-8") == json.dumps(design, indent=indent, ensure_ascii=False) + "\n"
    assert tomllib.loads(document.toml(read)) == design


def test_a_new_design_has_a_free_name(file: Path, opens: Opens) -> None:
    """It is written by the first save; a second studio takes the next name."""
    (file.parent / "design-2.toml").touch()
    first, second = opens(None), opens(None, folder=str(file.parent))
    answer = first.opened()
    assert (answer["file"], answer["saved"]) == ("design.toml", False)
    assert "no design.toml yet" in answer["note"]
    assert Path(second.path).name == "design-3.toml"
    assert not Path(first.path).exists()
    first.save(design_of(first))
    assert Path(first.path).read_text() == starter_text("p4", "design.toml")
    assert first.opened()["saved"] is True


def test_a_new_design_is_begun_beside_another(file: Path, opens: Opens) -> None:
    """Under its name or the next that is free, never a file that is there, nor one that a studio draws now."""
    document = opens(file.name)
    (file.parent / "taken.toml").write_text("mine")
    with closing(document.beside(" leaf ")) as leaf:
        assert leaf.path == str(file.parent / "leaf.toml")
        assert leaf.opened()["saved"] is False
        assert not Path(leaf.path).exists()
        for name in ("taken", "taken.toml", file.name):
            with pytest.raises(DesignError, match="is there already"):
                document.beside(name)
        with pytest.raises(DesignError, match="that a studio has open"):
            document.beside("leaf")
        with closing(document.beside("")) as free, closing(document.beside("")) as next_free:
            assert [Path(one.path).name for one in (free, next_free)] == ["design.toml", "design-2.toml"]
    for name in ("../leaf", "a/b.toml", "c:leaf", ".hidden", "le\naf", "\0", "..", "x" * 200):
        with pytest.raises(DesignError, match="is no name of a file"):
            document.beside(name)
    assert sorted(path.name for path in file.parent.iterdir()) == [file.name, "taken.toml"]


@pytest.mark.parametrize("newline", ["\n", "\r\n"], ids=["lf", "crlf"])
def test_a_starters_comments_stay_true(file: Path, opens: Opens, newline: str) -> None:
    """What it says of its group is what the starter of the new one says; whatever else is written stays."""
    mine = "# A tile design in the wallpaper group p4: quarter turns, my first."
    text = starter_text("p4").replace("\n[cell]", f"\n{mine}\n[cell]")
    file.write_text(text, newline=newline)
    document = opens()
    for group in ("pmm", "p1", "p6m"):
        design = design_of(document) | {"group": group}
        shared = document.toml(design)
        document.save(design)
        assert file.read_bytes().decode() == shared
        lines, starter = shared.split(newline), starter_text(group).splitlines()
        assert (lines[0], lines[-2]) == (starter[0], starter[-1])
        assert mine in lines
    document.save(design_of(document) | {"group": "p4"})
    assert file.read_bytes().decode() == text.replace("\n", newline)


def test_comments_stay_where_the_group_does(file: Path, opens: Opens) -> None:
    """Whatever they say."""
    file.write_text(starter_text("p2").replace('group = "p2"', 'group = "p4"'))
    document = opens()
    design = design_of(document)
    document.save(design | {"scale": 2})
    assert file.read_text().splitlines()[0] == starter_text("p2").splitlines()[0]


def test_what_is_neither_saved_nor_noted_is_not_left(file: Path, opens: Opens, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no copies can be kept, and something is drawn."""
    document = opens()
    document.check_kept(moved(design_of(document)))  # copies can be kept
    monkeypatch.setenv("XDG_STATE_HOME", str(file))
    with closing(Document.open(file.name)) as other:
        other.check_kept(design_of(other))
        with pytest.raises(OutputError, match="no copy of it can be kept"):
            other.check_kept(moved(design_of(other)))


def test_a_name_in_a_folder_that_is_not_there_is_refused(tmp_path: Path) -> None:
    """A design that could not be saved is not begun."""
    with pytest.raises(DesignError, match="its folder is not there"):
        Document.open(str(tmp_path / "missing" / "bird.toml"))


def test_a_name_that_is_not_there_is_a_new_design(file: Path, opens: Opens) -> None:
    """TOML or JSON, as its name says."""
    document = opens("new.json")
    assert document.opened()["saved"] is False
    design = design_of(document)
    document.save(design)
    assert json.loads((file.parent / "new.json").read_text()) == design


def test_a_new_design_overwrites_nothing(file: Path, opens: Opens) -> None:
    """A file that has come to be there meanwhile is a conflict."""
    document = opens("new.toml")
    (file.parent / "new.toml").write_text(TEXT)
    answer = document.save(design_of_text(starter_text("p4")))
    assert answer["type"] == "conflict"
    assert answer["design"] == tomllib.loads(TEXT)
    assert (file.parent / "new.toml").read_text() == TEXT


def design_of_text(text: str) -> dict[str, Any]:
    """The design in a text."""
    return tomllib.loads(text)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"schema = ", "line 1: not TOML"),
        (b"\xff\xfe", "not a text in UTF-8"),
        (b"", "is empty"),
        (b"schema = 1\n", "group: is missing"),
        (b"group = 1\n[cell]\n[[site]]\nstrokes = []\n", "group: must be a text"),
        (b"group = 'p1'\ncell = 5\n[[site]]\n", "cell: must be a table"),
        (b"group = 'p1'\n[cell]\n[site]\n", "site: must be an array"),
        (b"group = 'p1'\n[cell]\n[[site]]\n", r"site\[0\].strokes: is missing"),
        (b"group = 'p1'\n[cell]\n[[site]]\nstrokes = [1]\n", r"site\[0\].strokes\[0\]: must be a table"),
        (b"<svg/>", "is a drawing|not TOML"),
        (b"group = 'p1'\nx = " + b"[" * 60 + b"]" * 60, "nested too deeply"),
        (b"x = " + b"[" * 5000 + b"]" * 5000, "nested too deeply"),
    ],
)
def test_what_is_no_design_is_refused(file: Path, content: bytes, said: str) -> None:
    """With the file and the place; the file stays as it is."""
    file.write_bytes(content)
    with pytest.raises(DesignError, match=f"^bird.toml.*{said}"):
        Document.open("bird.toml")
    assert file.read_bytes() == content


@pytest.mark.usefixtures("file")
@pytest.mark.parametrize("path", ["-", "a\0b", "x" * 5000, "bird.toml/x.toml"])
def test_names_that_are_none_are_refused(path: str) -> None:
    """One message, no traceback."""
    with pytest.raises(DesignError):
        Document.open(path)


def test_folders_and_pipes_are_refused(file: Path) -> None:
    """To read a pipe could take for ever."""
    (file.parent / "folder.toml").mkdir()
    with pytest.raises(DesignError, match="Is a directory"):
        Document.open("folder.toml")
    os.mkfifo(file.parent / "pipe.toml")
    with pytest.raises(DesignError, match="pipe"):
        Document.open("pipe.toml")


def test_a_design_that_cannot_be_tiled_is_opened(file: Path, opens: Opens) -> None:
    """Whatever its numbers and keys: it can be mended in the page, and what the page does not know stays."""
    text = TEXT.replace("60.0", "nan").replace("schema = 1", "schema = 1\nwhen = 2026-01-02\nx.y = inf")
    file.write_text(text)
    document = opens()
    design = design_of(document)
    assert (design["cell"]["a"], design["when"], design["x"]["y"]) == ("nan", "2026-01-02", "inf")
    document.save(moved(design))
    assert file.read_text() == text.replace("39.0", "39.5")


def test_changes_from_outside_are_said_once(file: Path, opens: Opens) -> None:
    """A change is what another program has saved, in whatever way; not what we have."""
    document = opens()
    design = design_of(document)
    assert document.changed() is None
    document.save(moved(design))
    assert document.changed() is None
    theirs = TEXT.replace("60.0", "70.0")
    file.write_text(theirs)
    answer = document.changed()
    assert answer is not None
    assert answer["design"] == tomllib.loads(theirs)
    assert answer["file"] == "bird.toml"
    assert document.changed() is None
    other = file.with_name("other")
    other.write_text(TEXT)
    other.replace(file)
    assert document.changed() is not None
    os.utime(file)
    assert document.changed() is None


def test_a_change_of_the_same_size_and_time_is_noticed(file: Path, opens: Opens) -> None:
    """By who sets the time back as well."""
    document = opens()
    before = file.stat()
    file.write_text(TEXT.replace("60.0", "70.0"))
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert document.changed() is not None
    assert document.save(moved(tomllib.loads(TEXT)))["type"] == "conflict"


@pytest.mark.parametrize(
    ("content", "said"), [(None, "was removed"), (b"", "is empty"), (b"schema = ", "not TOML"), (b"\xff", "UTF-8")]
)
def test_half_of_a_save_is_not_said(file: Path, opens: Opens, content: bytes | None, said: str) -> None:
    """What is gone, empty or broken is said when it stays so; then the page's design can be saved in its place."""
    document = opens()
    design = design_of(document)

    def spoil() -> None:
        file.unlink() if content is None else file.write_bytes(content)

    spoil()
    assert document.changed() is None
    file.write_text(TEXT)
    assert document.changed() is None
    spoil()
    assert document.changed() is None
    answer = document.changed()
    assert answer is not None
    assert answer["design"] is None
    assert said in answer["note"]
    assert document.changed() is None
    assert document.save(moved(design))["type"] == "conflict"
    answer = document.save(moved(design), over=True)
    assert answer["type"] == "saved"
    assert file.read_text() == TEXT.replace("39.0", "39.5")
    backups = list(file.parent.glob("*backup*"))
    assert [path.read_bytes() for path in backups] == ([] if content is None else [content])


def test_a_conflict_does_nothing(file: Path, opens: Opens) -> None:
    """What is there is answered, and stays; the page may take it, or keep its own, and both are there then."""
    document = opens()
    design = moved(design_of(document))
    theirs = TEXT.replace("60.0", "70.0") + "# theirs\n"
    file.write_text(theirs)
    for _ in range(2):
        answer = document.save(design)
        assert (answer["type"], answer["design"]) == ("conflict", tomllib.loads(theirs))
        assert file.read_text() == theirs
    answer = document.save(design, over=True)
    assert answer["type"] == "saved"
    assert "bird-backup.toml" in answer["note"]
    assert file.read_text() == TEXT.replace("39.0", "39.5")
    assert file.with_name("bird-backup.toml").read_text() == theirs
    file.write_text(theirs)
    document.save(design, over=True)
    assert file.with_name("bird-backup-2.toml").read_text() == theirs
    file.write_text(theirs)
    assert document.reload()["design"] == tomllib.loads(theirs)
    assert document.save(moved(tomllib.loads(theirs)))["type"] == "saved"
    assert file.read_text() == theirs.replace("39.0", "39.5")


def test_comments_that_others_write_are_no_conflict(file: Path, opens: Opens) -> None:
    """An edit of comments and layout alone is kept, and ours made in it; the same edit twice is one."""
    document = opens()
    design = moved(design_of(document))
    theirs = TEXT.replace("# Mine.", "# Mine and theirs.").replace("60.0", "6e1")
    file.write_text(theirs)
    assert document.changed() is None
    assert document.save(design)["type"] == "saved"
    assert file.read_text() == theirs.replace("39.0", "39.5")
    file.write_text(theirs.replace("39.0", "40.50"))
    assert document.save(moved(design, 1.0))["type"] == "saved"
    assert file.read_text() == theirs.replace("39.0", "40.50")


def test_undo_brings_back_what_a_save_had_removed(file: Path, opens: Opens) -> None:
    """Its comments and its spelling; but not in the place of what others have written since."""
    document = opens()
    design = design_of(document)
    joined = deepcopy(design)
    joined["site"][0]["strokes"] = [{"polyline": [[20, 15], [4, 41], [39, 15]]}]
    for _ in range(2):
        assert document.save(joined) == {"type": "saved", "file": "bird.toml"}
        without = file.read_text()
        assert "39.0" not in without
        assert document.save(design) == {"type": "saved", "file": "bird.toml"}
        assert file.read_text() == TEXT
    document.save(joined)
    file.write_text(without.replace("# Mine.", "# Mine and theirs."))
    document.save(design)
    assert "# Mine and theirs." in file.read_text()
    assert tomllib.loads(file.read_text()) == tomllib.loads(TEXT)


def test_links_stay_links(file: Path, opens: Opens) -> None:
    """What they lead to is written, also where that is not there yet; one lock holds for both names."""
    link = file.with_name("link.toml")
    link.symlink_to("bird.toml")
    document = opens("link.toml")
    document.save(moved(design_of(document)))
    assert link.is_symlink()
    assert file.read_text() == TEXT.replace("39.0", "39.5")
    assert "Another studio" in opens().opened()["note"]
    file.with_name("to-come.toml").symlink_to("target.toml")
    new = opens("to-come.toml")
    new.save(design_of(new))
    assert file.with_name("target.toml").is_file()
    assert file.with_name("to-come.toml").is_symlink()


def test_a_full_disk_loses_nothing(file: Path, opens: Opens, state: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The file is as it was, nothing lies beside it, and the next save is one."""
    document = opens()
    design = moved(design_of(document))

    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(os, "write", full)
        with pytest.raises(OutputError, match=r"bird.toml.*No space left.*Make room"):
            document.save(design)
        with pytest.raises(OutputError, match=r"recovery copy.*No space left.*Make room.*Save the design"):
            document.note(design)
    assert [path.name for path in file.parent.iterdir()] == ["bird.toml"]
    assert copies(state) == []
    assert file.read_text() == TEXT
    assert document.save(design)["type"] == "saved"


def test_a_file_that_is_a_folder_now(file: Path, opens: Opens) -> None:
    """Is not overwritten, and said."""
    document = opens()
    design = moved(design_of(document))
    file.unlink()
    file.mkdir()
    assert document.changed() is None
    answer = document.changed()
    assert answer is not None
    assert "Is a directory" in answer["note"]
    assert document.save(design)["type"] == "conflict"
    with pytest.raises(OutputError, match="Is a directory"):
        document.save(design, over=True)
    assert file.is_dir()


@pytest.mark.skipif(AS_ROOT, reason="root may write everywhere")
def test_what_must_not_be_written_is_said(file: Path, opens: Opens) -> None:
    """A file or a folder that is read-only stays as it is; the recovery copy is kept all the same."""
    document = opens()
    design = moved(design_of(document))
    for path, mode in ((file, 0o444), (file.parent, 0o555)):
        path.chmod(mode)
        with pytest.raises(OutputError, match=r"bird.toml"):
            document.save(design)
        document.note(design)
        path.chmod(0o755)
    assert file.read_text() == TEXT
    file.chmod(0o000)
    with pytest.raises(DesignError, match="Permission denied"):
        Document.open("bird.toml")


def test_a_failed_backup_overwrites_nothing(file: Path, opens: Opens, monkeypatch: pytest.MonkeyPatch) -> None:
    """What another has written is there until its backup is."""
    document = opens()
    design = moved(design_of(document))
    file.write_text("theirs")

    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "write", full)
    with pytest.raises(OutputError, match=r"bird-backup.toml"):
        document.save(design, over=True)
    assert file.read_text() == "theirs"


def test_what_was_not_saved_is_found_again(file: Path, opens: Opens, state: Path) -> None:
    """With the time of its writing; after a save there is nothing to find."""
    document = opens()
    design = moved(design_of(document))
    document.note(design)
    document.close()
    again = opens()
    answer = again.opened()
    assert answer["design"] == tomllib.loads(TEXT)
    assert answer["recovery"]["design"] == design
    age = datetime.now(UTC) - datetime.fromisoformat(answer["recovery"]["at"])
    assert timedelta(0) <= age < timedelta(minutes=1)
    again.save(design)
    assert copies(state) == []
    assert "recovery" not in again.opened()
    assert [path.name for path in file.parent.iterdir()] == ["bird.toml"]


@pytest.mark.usefixtures("file")
def test_a_copy_is_offered_until_it_is_decided(opens: Opens) -> None:
    """A page that opens with the file's design, and goes on from there, does not overwrite what it is offered."""
    document = opens()
    lost = moved(design_of(document))
    document.note(lost)
    document.close()
    again = opens()
    design = design_of(again)
    again.note(design)
    assert again.opened()["recovery"]["design"] == lost
    again.note(moved(design, 5))
    again.note(design)  # undone
    again.close()
    last = opens()
    assert last.opened()["recovery"]["design"] == lost
    newer = moved(design, 9)
    last.note(newer)
    assert last.opened()["recovery"]["design"] == newer  # a page that is loaded again
    last.note(moved(design, 10))
    last.note(design)
    assert last.opened()["recovery"]["design"] == newer


def test_old_copies_are_not_offered(file: Path, opens: Opens, state: Path) -> None:
    """Where the file is newer, or says the same, or the copy is none."""
    document = opens()
    design = moved(design_of(document))
    document.note(design)
    document.close()
    (copy,) = copies(state)
    copy.with_name(copy.name.replace("-1.json", "-2.json")).write_text('{"design": 5, "at": "x"}')
    copy.with_name(copy.name.replace("-1.json", "-3.json")).write_text("{")

    def is_offered() -> bool:
        document = opens()
        answer = document.opened()
        document.close()
        assert "note" not in answer
        return "recovery" in answer

    assert is_offered()
    file.write_text(TEXT.replace("39.0", "39.5"))
    os.utime(file, (1, 1))
    assert not is_offered()
    file.write_text(TEXT)
    os.utime(file, (1, 1))
    assert is_offered()
    os.utime(file, (time.time() + 5, time.time() + 5))
    assert not is_offered()


def test_a_new_design_is_found_again(file: Path, opens: Opens) -> None:
    """Though there is no file yet."""
    document = opens(None)
    design = deepcopy(document.opened()["design"])
    design["cell"]["a"] = 77.0
    document.note(design)
    document.close()
    assert not file.with_name("design.toml").exists()
    assert opens(None).opened()["recovery"]["design"] == design


def test_a_broken_file_says_that_there_is_a_copy(file: Path, opens: Opens) -> None:
    """It can be had by moving the file away."""
    document = opens()
    design = moved(design_of(document))
    document.note(design)
    document.close()
    file.write_text("schema = ")
    with pytest.raises(DesignError, match=r"not TOML.*Move it away to have what was drawn until 20"):
        Document.open("bird.toml")
    file.rename("broken.toml")
    assert opens().opened()["recovery"]["design"] == design


@pytest.mark.usefixtures("file")
def test_two_studios(opens: Opens, state: Path) -> None:
    """The second is told who has the file; neither takes the other's copy, and neither overwrites."""
    first = opens()
    design = design_of(first)
    first.note(moved(design, 1))
    second = opens()
    answer = second.opened()
    assert f"Another studio has bird.toml open (process {os.getpid()}, since 20" in answer["note"]
    assert "recovery" not in answer
    second.note(moved(design, 2))
    assert second.save(moved(design, 2))["type"] == "saved"
    assert len(copies(state)) == 1
    assert first.save(moved(design, 1))["type"] == "conflict"
    first.close()
    answer = second.opened()
    assert "note" not in answer
    assert answer["design"] == moved(design, 2)
    assert "Another studio" in opens().opened()["note"]


def test_without_a_state_folder(file: Path, opens: Opens, state: Path) -> None:
    """All works but the copies, which is said."""
    state.parent.parent.mkdir(parents=True, exist_ok=True)
    state.parent.write_text("a file")
    document = opens()
    assert "No recovery copies can be kept" in document.opened()["note"]
    design = moved(design_of(document))
    document.note(design)
    assert document.save(design)["type"] == "saved"
    assert file.read_text() == TEXT.replace("39.0", "39.5")


@pytest.mark.usefixtures("file")
def test_copies_are_private(opens: Opens, state: Path) -> None:
    """Nobody else reads them, or lays links in their place."""
    document = opens()
    document.note(moved(design_of(document)))
    assert state.stat().st_mode & 0o077 == 0


@pytest.mark.parametrize("value", [None, {"x": None}], ids=repr)
def test_what_no_file_can_hold_is_refused(file: Path, opens: Opens, value: object) -> None:
    """The file stays as it is."""
    document = opens()
    with pytest.raises(DesignError, match="TOML"):
        document.save(design_of(document) | {"extra": value})
    assert file.read_text() == TEXT


def test_the_text_to_share(opens: Opens, file: Path) -> None:
    """Is what a save would write."""
    document = opens()
    design = moved(design_of(document))
    text = document.toml(design)
    assert file.read_text() == TEXT
    document.save(design)
    assert file.read_text() == text


def test_numpy_is_not_loaded(file: Path) -> None:
    """The server's process does without: it would take a tenth of a second."""
    code = "import sys; from voronoi_tiles.studio.design_document import Document; d = Document.open('bird.toml')"
    code += "; d.save(d.opened()['design']); d.close(); print('numpy' in sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=file.parent)
    assert run.stdout.split() == ["False"]


DRAWS = """
import time
from voronoi_tiles.studio.design_document import Document
document = Document.open("bird.toml")
design = document.opened()["design"]
noted = 0.0
for k in range(1, 1000000):
    strokes = [{"segment": [[k, k + 0.5], [k + 1, 7]]}, {"polyline": [[n, k] for n in range(400)]}]
    design = {**design, "site": [{"strokes": strokes}]}
    print("drawn", k, time.monotonic(), flush=True)
    if time.monotonic() - noted >= 0.5:
        noted = time.monotonic()
        document.note(design)
    if k % 70 == 0:
        document.save(design)
        print("saved", k, time.monotonic(), flush=True)
    time.sleep(0.004)
"""


def number_of(design: dict[str, Any]) -> int:
    """The number of a design that was drawn, which is in all its points; 0 for the one that was there before."""
    strokes = design["site"][0]["strokes"]
    if design == tomllib.loads(TEXT):
        return 0
    k = int(strokes[0]["segment"][0][0])
    assert strokes == [{"segment": [[k, k + 0.5], [k + 1, 7]]}, {"polyline": [[n, k] for n in range(400)]}]
    return k


@pytest.mark.slow
@pytest.mark.parametrize("run", range(50))
def test_killed_at_any_moment(file: Path, opens: Opens, run: int) -> None:
    """The file is whole and one of those that were saved; what was drawn is there but for the last second."""
    call = [sys.executable, "-c", DRAWS]
    with subprocess.Popen(call, stdout=subprocess.PIPE, text=True, cwd=file.parent) as process:
        assert process.stdout is not None
        lines = [process.stdout.readline()]
        time.sleep(random.Random(run).uniform(0.0, 1.5))  # noqa: S311 - no secret
        process.kill()
        killed = time.monotonic()
        lines += process.stdout.readlines()
    assert process.returncode == -signal.SIGKILL
    said = [line.split() for line in lines if line.endswith("\n")]
    drawn = {int(k): float(at) for word, k, at in said if word == "drawn"}
    saved = [int(k) for word, k, _ in said if word == "saved"]
    on_disk = number_of(tomllib.loads(file.read_text()))
    assert on_disk % 70 == 0
    assert on_disk - max(saved, default=0) in (0, 70)  # the next save may have been done, and not yet said
    answer = opens().opened()
    assert "note" not in answer  # the lock of one that was killed keeps nobody out
    found = max(number_of(part["design"]) for part in (answer, answer.get("recovery", answer)))
    assert killed - min((at for k, at in drawn.items() if k > found), default=killed) <= 1.0
    assert {path.name for path in file.parent.iterdir() if not path.name.endswith(".tmp")} == {"bird.toml"}


@pytest.mark.usefixtures("file")
def test_a_clock_that_is_set_back_loses_nothing(opens: Opens, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was drawn after the file was written is found, whatever time it is."""
    document = opens()
    design = moved(design_of(document))
    assert document.save(design)["type"] == "saved"
    newer = moved(design, 3)
    now = time.time()
    monkeypatch.setattr(time, "time", lambda: now - 86_400)
    document.note(newer)
    document.close()
    assert opens().opened()["recovery"]["design"] == newer


@pytest.mark.parametrize("at", ["1e308", "-1e300", "NaN", "Infinity", "1e17"])
def test_a_copy_of_no_time_is_none(file: Path, opens: Opens, state: Path, at: str) -> None:
    """A copy that was damaged is passed over."""
    document = opens()
    document.note(moved(design_of(document)))
    document.close()
    (copy,) = copies(state)
    copy.write_text(f'{{"design": {{}}, "at": {at}, "of": {file.stat().st_mtime_ns}}}')
    assert "recovery" not in opens().opened()


@pytest.mark.usefixtures("file")
def test_a_state_folder_that_is_cleared_away_is_made_again(opens: Opens, state: Path) -> None:
    """By the next copy."""
    document = opens()
    design = moved(design_of(document))
    document.note(design)
    shutil.rmtree(state)
    document.note(moved(design))
    assert len(copies(state)) == 1


@pytest.mark.parametrize("over", [False, True])
def test_what_comes_while_a_save_is_written_is_kept(
    file: Path, opens: Opens, monkeypatch: pytest.MonkeyPatch, over: bool
) -> None:
    """It is a conflict, or is kept as a backup, as what had come before."""
    document = opens()
    design = moved(design_of(document))
    theirs = TEXT.replace("60.0", "70.0").encode()
    write = os.write

    def late(descriptor: int, data: bytes) -> int:
        monkeypatch.setattr(os, "write", write)
        file.write_bytes(theirs)
        return write(descriptor, data)

    monkeypatch.setattr(os, "write", late)
    answer = document.save(design, over=over)
    assert answer["type"] == ("saved" if over else "conflict")
    kept = file.with_name("bird-backup.toml") if over else file
    assert kept.read_bytes() == theirs
    assert sorted(file.parent.iterdir()) == sorted({file, kept})


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
def test_a_pipe_that_comes_in_the_last_moment_is_not_waited_for(
    file: Path, opens: Opens, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is no design, and whoever keeps the file goes on."""
    document = opens()
    design = moved(design_of(document))
    file.unlink()
    os.mkfifo(file)
    monkeypatch.setattr("voronoi_tiles.studio.design_document.is_special", lambda _path: False)
    assert "is empty" in document.save(design)["note"]


def test_a_change_right_after_a_save_is_noticed(file: Path, opens: Opens, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is theirs, though it is there before the file was looked at again."""
    document = opens()
    theirs = TEXT.replace("60.0", "70.0").encode()
    design = moved(design_of(document))
    replaced = document._replaced

    def then(there: Any, data: bytes) -> bool:
        done = replaced(there, data)
        file.write_bytes(theirs)
        return done

    monkeypatch.setattr(document, "_replaced", then)
    assert document.save(design)["type"] == "saved"
    change = document.changed()
    assert change is not None
    assert change["design"]["cell"]["a"] == 70.0
