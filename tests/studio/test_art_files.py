"""Files of art beside the design: none is written over, and the same drawing is not laid there twice."""

from __future__ import annotations

from pathlib import Path

import pytest

from voronoi_tiles.base.errors import OutputError
from voronoi_tiles.studio.art_files import lay_beside


def test_no_file_is_written_over(tmp_path: Path) -> None:
    """What is there under the first names stays, a link that leads nowhere, too."""
    (tmp_path / "bird-art.svg").write_bytes(b"mine")
    (tmp_path / "bird-art-2.svg").symlink_to(tmp_path / "gone.svg")
    (tmp_path / "bird-art-3.svg").mkdir()
    assert lay_beside(str(tmp_path), "bird", b"<svg/>") == "bird-art-4.svg"
    assert (tmp_path / "bird-art-4.svg").read_bytes() == b"<svg/>"
    assert (tmp_path / "bird-art.svg").read_bytes() == b"mine"
    assert not (tmp_path / "gone.svg").exists()


def test_the_same_art_is_there_once(tmp_path: Path) -> None:
    """A design that is taken again has the file that it had."""
    assert lay_beside(str(tmp_path), "bird", b"<svg/>") == "bird-art.svg"
    assert lay_beside(str(tmp_path), "bird", b"<svg></svg>") == "bird-art-2.svg"
    assert lay_beside(str(tmp_path), "bird", b"<svg/>") == "bird-art.svg"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bird-art-2.svg", "bird-art.svg"]


def test_a_folder_that_is_gone(tmp_path: Path) -> None:
    """Is said as for every file that cannot be written."""
    with pytest.raises(OutputError, match=r"bird-art\.svg"):
        lay_beside(str(tmp_path / "gone"), "bird", b"<svg/>")
