"""Writing files: whole or not at all, whatever happens."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from voronoi_tiles.errors import OutputError
from voronoi_tiles.files import is_special, write_whole

AS_ROOT = hasattr(os, "geteuid") and os.geteuid() == 0


def names(folder: Path) -> list[str]:
    """List a folder: temporary files that were left behind would show."""
    return sorted(path.name for path in folder.iterdir())


def test_a_new_file_is_written_with_the_usual_mode(tmp_path: Path) -> None:
    """The umask applies, as for any file that a program opens."""
    write_whole(tmp_path / "a.svg", b"content")
    (tmp_path / "plain").write_bytes(b"")
    assert (tmp_path / "a.svg").read_bytes() == b"content"
    assert (tmp_path / "a.svg").stat().st_mode == (tmp_path / "plain").stat().st_mode
    assert names(tmp_path) == ["a.svg", "plain"]


def test_an_existing_file_keeps_its_mode(tmp_path: Path) -> None:
    """Replacing the content is no reason to change who may read it."""
    path = tmp_path / "a.svg"
    path.write_bytes(b"old, and longer than the new one")
    path.chmod(0o640)
    write_whole(path, b"new")
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    """The file that a symbolic link names is the one that is replaced."""
    (tmp_path / "real").mkdir()
    link = tmp_path / "link.svg"
    link.symlink_to("real/file.svg")
    write_whole(link, b"1")
    write_whole(link, b"2")
    assert link.is_symlink()
    assert (tmp_path / "real" / "file.svg").read_bytes() == b"2"
    assert names(tmp_path / "real") == ["file.svg"]


@pytest.mark.parametrize("step", ["write", "fsync", "fchmod", "replace"])
def test_a_failure_leaves_the_old_file_and_nothing_else(
    step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A full disk shows at any step; the old file survives each."""

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    path = tmp_path / "a.svg"
    path.write_bytes(b"old")
    with monkeypatch.context() as patch:
        patch.setattr(Path if step == "replace" else os, step, fail)
        with pytest.raises(OutputError, match=r"cannot write .*a\.svg: No space left on device") as caught:
            write_whole(path, b"new")
    assert str(caught.value.path) == str(path)
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.svg"]


def test_an_interruption_leaves_the_old_file_and_nothing_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C while writing is no failure of the file's, but it must not leave a half of it either."""

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    path = tmp_path / "a.svg"
    path.write_bytes(b"old")
    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", interrupt)
        with pytest.raises(KeyboardInterrupt):
            write_whole(path, b"new")
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.svg"]


def test_short_writes_are_continued(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The system may take fewer bytes than it is given."""
    real = os.write
    monkeypatch.setattr(os, "write", lambda descriptor, data: real(descriptor, bytes(data)[:3]))
    write_whole(tmp_path / "a", b"0123456789")
    assert (tmp_path / "a").read_bytes() == b"0123456789"


@pytest.mark.parametrize("name", ["missing/a.svg", "file/a.svg", ".", "a\0b", "n" * 300, ""])
def test_places_that_cannot_be_written(name: str, tmp_path: Path) -> None:
    """A missing folder, a file for a folder, a folder, a broken name, one that is too long, none."""
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(OutputError, match="cannot write"):
        write_whole(f"{tmp_path}/{name}" if name else "", b"new")
    assert names(tmp_path) == ["file"]


@pytest.mark.skipif(AS_ROOT, reason="root may write everywhere")
def test_a_read_only_file_and_a_read_only_folder(tmp_path: Path) -> None:
    """A rename could replace a read-only file; that is not what read-only means."""
    path = tmp_path / "a.svg"
    path.write_bytes(b"old")
    path.chmod(0o444)
    with pytest.raises(OutputError, match="read-only"):
        write_whole(path, b"new")
    tmp_path.chmod(0o555)
    try:
        with pytest.raises(OutputError, match="Permission denied"):
            write_whole(tmp_path / "b.svg", b"new")
    finally:
        tmp_path.chmod(0o755)
    assert path.read_bytes() == b"old"


def test_a_read_only_file_is_refused_before_anything_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same for root, whom the system would not stop."""
    path = tmp_path / "a.svg"
    path.write_bytes(b"old")
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(OutputError, match="read-only"):
        write_whole(path, b"new")
    assert names(tmp_path) == ["a.svg"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a Linux device")
def test_devices_are_written_and_not_replaced() -> None:
    """/dev/null takes everything, /dev/full nothing; both stay devices."""
    write_whole("/dev/null", b"gone")
    with pytest.raises(OutputError, match="No space left on device"):
        write_whole("/dev/full", b"new")
    assert Path("/dev/null").is_char_device()
    assert Path("/dev/full").is_char_device()


def test_a_pipe_by_its_name(tmp_path: Path) -> None:
    """A fifo takes the bytes, and stays a fifo."""
    fifo = tmp_path / "a.svg"
    os.mkfifo(fifo)
    reader = os.open(fifo, os.O_RDONLY | os.O_NONBLOCK)
    try:
        write_whole(fifo, b"content")
        assert os.read(reader, 100) == b"content"
    finally:
        os.close(reader)
    assert fifo.is_fifo()
    assert is_special(str(fifo))
    assert names(tmp_path) == ["a.svg"]


def test_open_descriptors_by_their_names(tmp_path: Path) -> None:
    """/dev/fd/N is what >(command) gives; a file behind it is continued, not replaced."""
    reader, writer = os.pipe()
    try:
        write_whole(f"/dev/fd/{writer}", b"content")
        assert os.read(reader, 100) == b"content"
        assert is_special(f"/dev/fd/{writer}")
    finally:
        os.close(reader)
        os.close(writer)
    with pytest.raises(OutputError, match=r"cannot write /dev/fd/\d+: Bad file descriptor\. "):
        write_whole(f"/dev/fd/{writer}", b"content")
    path = tmp_path / "log"
    path.write_bytes(b"old ")
    with path.open("ab") as log:
        write_whole(f"/dev/fd/{log.fileno()}", b"new")
    assert path.read_bytes() == b"old new"
    assert not is_special(str(path))
    assert not is_special(str(tmp_path))
    assert not is_special("a\0b")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("missing/a.svg", "No such file or directory. Make its folder first"),
        ("file/a.svg", "Not a directory. A part of its path is a file"),
        ("n" * 300, "File name too long. Choose a shorter name."),
        ("a\0b", "null byte. Choose another name or place."),
    ],
)
def test_messages_have_a_remedy(name: str, message: str, tmp_path: Path) -> None:
    """What is wrong, and what to do."""
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(OutputError, match="cannot write") as caught:
        write_whole(tmp_path / name, b"new")
    assert message in str(caught.value)


def test_an_empty_name() -> None:
    """It shows as two quotes."""
    with pytest.raises(OutputError, match=r"^cannot write '': the name is empty\. Choose another name"):
        write_whole("", b"new")


def test_a_standard_output_that_was_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Python has None for it."""
    monkeypatch.setattr(sys, "stdout", None)
    with pytest.raises(OutputError, match=r"^cannot write standard output: it is closed\. "):
        write_whole("-", b"new")


@pytest.mark.skipif(sys.platform == "win32", reason="resource limits are POSIX")
def test_a_disk_that_fills_up_while_writing(tmp_path: Path) -> None:
    """The system itself refuses, in the middle of the file."""
    path = tmp_path / "a.svg"
    path.write_bytes(b"old")
    script = (
        "import resource, sys\n"
        "from voronoi_tiles.errors import OutputError\n"
        "from voronoi_tiles.files import write_whole\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
        "try:\n"
        "    write_whole(sys.argv[1], bytes(5000))\n"
        "except OutputError as error:\n"
        "    print(error)\n"
    )
    result = subprocess.run([sys.executable, "-c", script, path], capture_output=True, text=True, check=True)
    assert "File too large" in result.stdout
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.svg"]


def test_standard_output(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    """- writes the bytes as they are, after what was printed before."""
    print("first")  # noqa: T201 (the order of the two is what is tested)
    write_whole("-", "é\n".encode())
    assert capfdbinary.readouterr().out == "first\né\n".encode()


def test_standard_output_in_memory(capsys: pytest.CaptureFixture[str]) -> None:
    """Notebooks and tests replace sys.stdout by an object without a descriptor."""
    write_whole("-", "é\n".encode())
    assert capsys.readouterr().out == "é\n"
