"""Folders are filled as a whole or not at all, whatever stands for them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.base.folders import filling, refuse_filled


def filled(folder: str) -> None:
    """Write two files into it."""
    with filling(folder) as made:
        (made / "one").write_text("1", encoding="utf-8")
        (made / "two").write_text("2", encoding="utf-8")


@pytest.mark.parametrize("name", ["new", "new/", "a/b/c", "empty", "empty/", "link", "ahead", "."])
def test_new_and_empty_folders_are_filled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Also by links, and the one that somebody stands in, which stays the same; nothing else is left."""
    (tmp_path / "empty").mkdir()
    (tmp_path / "work").mkdir()
    (tmp_path / "work" / "link").symlink_to(tmp_path / "empty")
    (tmp_path / "work" / "ahead").symlink_to(tmp_path / "later")
    monkeypatch.chdir(tmp_path / ("work" if name in {"link", "ahead"} else "empty" if name == "." else "."))
    folder = Path(name)
    before = folder.stat().st_ino if folder.exists() else None
    filled(name)
    assert sorted(path.name for path in folder.iterdir()) == ["one", "two"]
    assert before in {None, folder.stat().st_ino}
    assert not [*tmp_path.rglob(".*")]


@pytest.mark.parametrize("name", ["new", "a/b/c", "empty"])
def test_nothing_is_left_of_what_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Neither files nor folders that were made for them."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty").mkdir()

    def interrupted() -> None:
        with filling(name) as made:
            (made / "one").write_text("1", encoding="utf-8")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert [*tmp_path.rglob("*")] == [tmp_path / "empty"]


@pytest.mark.parametrize("name", ["full", "file", "file/new", "", "link", "nul\0l"])
def test_what_cannot_be_filled_is_refused_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """By its name, before there is anything to write, and stays as it is."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "mine").touch()
    (tmp_path / "file").touch()
    (tmp_path / "link").symlink_to("full")
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(OutputError) as error:
        refuse_filled(name)
    assert error.value.remedy
    assert name.partition("\0")[0] in str(error.value)
    with pytest.raises(OutputError):
        filled(name)
    assert sorted(tmp_path.rglob("*")) == before


def test_a_folder_that_was_filled_meanwhile_is_left_alone(tmp_path: Path) -> None:
    """By another, after it was found empty or missing."""
    (tmp_path / "empty").mkdir()

    def overtaken(folder: Path) -> None:
        with filling(str(folder)) as made:
            (made / "one").write_text("1", encoding="utf-8")
            folder.mkdir(exist_ok=True)
            (folder / "one").write_text("mine", encoding="utf-8")

    for folder in (tmp_path / "empty", tmp_path / "new"):
        with pytest.raises(OutputError, match=folder.name):
            overtaken(folder)
        assert (folder / "one").read_text(encoding="utf-8") == "mine"
        assert len([*folder.iterdir()]) == 1


def test_a_folder_without_rights_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """At once, and not after minutes of work."""
    monkeypatch.setattr(os, "access", lambda path, _: Path(path) != tmp_path)
    with pytest.raises(OutputError, match="Permission denied"):
        refuse_filled(str(tmp_path / "new"))
