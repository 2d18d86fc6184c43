"""Writing files, at once or as a stream: whole or not at all, whatever happens."""

from __future__ import annotations

import io
import os
import stat
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.base.files import is_special, write_whole, writing

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
        ("a\0b", ": its name has a null byte. Choose another name or place."),
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
        "from voronoi_tiles.base.errors import OutputError\n"
        "from voronoi_tiles.base.files import write_whole\n"
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


def test_standard_output_in_memory_takes_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    """A picture is no text: where the object has a buffer for bytes, that takes them; where it has none, only text."""
    inner = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(inner, encoding="ascii"))
    print("first")  # noqa: T201 (the order of the two is what is tested)
    write_whole("-", b"\x89PNG\r\n")
    assert inner.getvalue() == b"first\n\x89PNG\r\n"
    monkeypatch.setattr(sys, "stdout", text := io.StringIO())
    with pytest.raises(OutputError, match="cannot write standard output: 'utf-8' codec can't decode"):
        write_whole("-", b"\x89PNG")
    write_whole("-", "é".encode())
    assert text.getvalue() == "é"


def write_in_portions(path: Path | str, error: BaseException | None = None) -> None:
    """Write three portions as a stream, and raise an error then."""
    with writing(path) as file:
        for portion in (b"one ", b"two ", b"three"):
            file.write(portion)
        if error is not None:
            raise error


def test_a_stream_takes_its_place_at_the_end(tmp_path: Path) -> None:
    """Until the block has ended the old file is what everyone sees; afterwards there is nothing beside the new one."""
    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    path.chmod(0o640)
    with writing(path) as file:
        assert file.write(b"one ") == 4
        assert path.read_bytes() == b"old"
        (temporary,) = set(names(tmp_path)) - {"a.png"}
        assert (tmp_path / temporary).read_bytes() == b"one "
        assert stat.S_IMODE((tmp_path / temporary).stat().st_mode) == 0o640
        file.write(b"two")
    assert path.read_bytes() == b"one two"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert names(tmp_path) == ["a.png"]
    with pytest.raises(ValueError, match="closed"):
        file.write(b"more")


def test_a_stream_makes_a_new_file_and_follows_links(tmp_path: Path) -> None:
    """With the usual mode, and where the link leads; a stream without a write is an empty file."""
    (tmp_path / "real").mkdir()
    (tmp_path / "link.png").symlink_to("real/file.png")
    write_in_portions(tmp_path / "link.png")
    (tmp_path / "plain").write_bytes(b"")
    with writing(tmp_path / "empty"):
        pass
    assert (tmp_path / "link.png").is_symlink()
    assert (tmp_path / "real" / "file.png").read_bytes() == b"one two three"
    assert (tmp_path / "real" / "file.png").stat().st_mode == (tmp_path / "plain").stat().st_mode
    assert (tmp_path / "empty").read_bytes() == b""
    assert names(tmp_path) == ["empty", "link.png", "plain", "real"]
    assert names(tmp_path / "real") == ["file.png"]


def test_a_stream_takes_whatever_holds_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Arrays and views, empty ones too, however few bytes the system takes at a time."""
    real = os.write
    monkeypatch.setattr(os, "write", lambda descriptor, data: real(descriptor, bytes(data)[:3]))
    array = np.arange(12, dtype=np.uint8).reshape(3, 4)
    with writing(tmp_path / "a") as file:
        assert file.writable()
        portions = (array.data, array[:0].data, b"", memoryview(array[1]), bytearray(b"x"))
        assert [file.write(portion) for portion in portions] == [12, 0, 0, 4, 1]
        with io.TextIOWrapper(io.BufferedWriter(file), "utf-8") as text:
            text.write("é")
    assert (tmp_path / "a").read_bytes() == bytes(range(12)) + bytes(range(4, 8)) + "xé".encode()


@pytest.mark.parametrize(
    "error", [KeyError("mine"), FileNotFoundError(2, "mine"), ValueError("mine"), SystemExit("mine")]
)
def test_an_exception_in_the_block_leaves_the_old_file(error: BaseException, tmp_path: Path) -> None:
    """It comes out as it is: what a block does beside writing is none of the file's business."""
    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    for target in (path, tmp_path / "new.png"):
        with pytest.raises(type(error), match="mine") as caught:
            write_in_portions(target, error)
        assert caught.value is error
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.png"]


@pytest.mark.parametrize("step", ["write", "fsync", "fchmod", "replace"])
def test_a_failure_of_a_stream_leaves_the_old_file(step: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same steps may fail as for a file that is written at once, and the same message says so."""

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    with monkeypatch.context() as patch:
        patch.setattr(Path if step == "replace" else os, step, fail)
        with pytest.raises(OutputError, match=r"cannot write .*a\.png: No space left on device\. Make room"):
            write_in_portions(path)
    assert path.read_bytes() == b"old"
    assert names(tmp_path) == ["a.png"]


def test_a_write_that_failed_is_not_forgotten(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Who catches its error and goes on gets it again: a file with a hole in it is not whole."""

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    def write_on() -> None:
        with writing(tmp_path / "a.png") as file:
            file.write(b"one")
            with monkeypatch.context() as patch:
                patch.setattr(os, "write", fail)
                with pytest.raises(OutputError, match="No space left"):
                    file.write(b"two")
            with pytest.raises(OutputError, match="No space left"):
                file.write(b"three")

    with pytest.raises(OutputError, match="No space left"):
        write_on()
    assert names(tmp_path) == []


@pytest.mark.parametrize("name", ["missing/a.svg", "file/a.svg", ".", "a\0b", "n" * 300, ""])
def test_places_where_no_stream_can_begin(name: str, tmp_path: Path) -> None:
    """They are named before the block has done its work."""
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(OutputError, match="cannot write"), writing(f"{tmp_path}/{name}" if name else ""):
        pytest.fail("the block has begun")
    assert names(tmp_path) == ["file"]


def test_a_read_only_file_is_no_place_for_a_stream(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """This too shows at the beginning."""
    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    monkeypatch.setattr(os, "access", lambda *_: False)
    with pytest.raises(OutputError, match="read-only"), writing(path):
        pytest.fail("the block has begun")
    assert names(tmp_path) == ["a.png"]


@pytest.fixture
def pipe() -> Iterator[tuple[int, int]]:
    """Both ends of a pipe, of which nothing blocks when it is empty."""
    reader, writer = os.pipe()
    os.set_blocking(reader, False)
    yield reader, writer
    os.close(reader)
    os.close(writer)


def test_a_stream_to_an_open_descriptor(pipe: tuple[int, int]) -> None:
    """Nothing is sent before the end, and nothing at all after an exception."""
    reader, writer = pipe
    with writing(f"/dev/fd/{writer}") as file:
        file.write(b"one ")
        with pytest.raises(BlockingIOError):
            os.read(reader, 100)
        file.write(b"two")
    assert os.read(reader, 100) == b"one two"
    with pytest.raises(KeyError):
        write_in_portions(f"/dev/fd/{writer}", KeyError())
    with pytest.raises(BlockingIOError):
        os.read(reader, 100)
    closed = os.dup(writer)
    os.close(closed)
    with pytest.raises(OutputError, match="Bad file descriptor"), writing(f"/dev/fd/{closed}"):
        pytest.fail("the block has begun")


def test_a_stream_to_a_pipe_by_its_name(tmp_path: Path) -> None:
    """A fifo takes the bytes at the end, more than one piece of them, and stays a fifo."""
    fifo, content = tmp_path / "a.png", os.urandom(3_000_000)
    os.mkfifo(fifo)
    with (tmp_path / "copy").open("wb") as copy, subprocess.Popen(["cat", fifo], stdout=copy) as cat:  # noqa: S607
        with writing(fifo) as file:
            for portion in (content[:5], content[5:-5], content[-5:]):
                file.write(portion)
        assert cat.wait(60) == 0
    assert (tmp_path / "copy").read_bytes() == content
    assert fifo.is_fifo()


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a Linux device")
def test_a_stream_to_a_device() -> None:
    """/dev/null takes everything, /dev/full nothing, which shows when it is sent."""
    write_in_portions("/dev/null")
    with pytest.raises(OutputError, match="cannot write /dev/full: No space left on device"):
        write_in_portions("/dev/full")
    assert Path("/dev/full").is_char_device()


def test_a_stream_to_standard_output(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    """The bytes as they are, after what was printed before and in the block; nothing after an exception."""
    print("first")  # noqa: T201 (the order is what is tested)
    with writing("-") as file:
        file.write(b"\x89PNG")
        print("second")  # noqa: T201
        file.write(b"\r\n")
    with pytest.raises(KeyError):
        write_in_portions("/dev/stdout", KeyError())
    assert capfdbinary.readouterr().out == b"first\nsecond\n\x89PNG\r\n"


def test_a_stream_to_standard_output_in_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """An object without a descriptor is given everything at once; closed, it is refused at the beginning."""
    monkeypatch.setattr(sys, "stdout", text := io.StringIO())
    with writing("-") as file:
        file.write("é".encode()[:1])
        file.write("é".encode()[1:])
    assert text.getvalue() == "é"
    monkeypatch.setattr(sys, "stdout", None)
    with pytest.raises(OutputError, match="cannot write standard output: it is closed"), writing("-"):
        pytest.fail("the block has begun")


def test_no_room_for_a_temporary_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is kept for standard output fills another disk than the one that is written to: the message names it."""

    def fail(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with monkeypatch.context() as patch:
        patch.setattr(os, "write", fail)
        with pytest.raises(OutputError) as caught:
            write_in_portions("-")
    assert str(caught.value).startswith(f"cannot write a temporary file in {tmp_path}: No space left on device. Make")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "missing"))
    with pytest.raises(OutputError, match="cannot write a temporary file: No such file"), writing("-"):
        pytest.fail("the block has begun")
    assert names(tmp_path) == []


def test_what_is_in_memory_goes_straight_to_standard_output(
    capfdbinary: pytest.CaptureFixture[bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Only a stream needs a temporary file."""
    monkeypatch.setattr(tempfile, "TemporaryFile", None)
    write_whole("-", b"content")
    assert capfdbinary.readouterr().out == b"content"
